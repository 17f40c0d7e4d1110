!> Sizes that the geometry asks for, at points along contours and dies.
!>
!> A bend of radius R wants elements of R times the angle one element may turn by; a stretch of contact wants a number of
!> elements across it. Along a chain the sizes grow by no more than the gradation.
module contour_needs
  use contour_chain, only: chain_t, joint_after, kind_end, kind_entry, turn_at
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use size_field, only: need_t, size_limits_t
  use stretches, only: cross, length_between, point_at, stretch_t, tangent_at
  use vectors, only: length_of
  implicit none
  private
  public :: geometry_wish_t, needs_of_chain, needs_of_die

  type :: geometry_wish_t
    !> Angle an element may turn by [radian].
    real(wp) :: turn = 0.26_wp
    !> Elements across a stretch of contact, 0: as they come.
    integer :: across = 0
  end type geometry_wish_t

  !> Parts of a stretch that are looked at, more of one that is longer than as many of the largest elements, up to a limit.
  integer, parameter :: parts = 4, most_parts = 400

contains

  !> Needs along a chain, where bends of dies nearby have their say too. Places that want the largest size or more are left out.
  pure subroutine needs_of_chain(chain, wish, limits, needs, nearby)
    type(chain_t), intent(in) :: chain
    type(geometry_wish_t), intent(in) :: wish
    type(size_limits_t), intent(in) :: limits
    type(need_t), allocatable, intent(out) :: needs(:)
    type(need_t), optional, intent(in) :: nearby(:)
    type(need_t), allocatable :: all(:)
    real(wp) :: contact(size(chain%stretches)), mean
    integer :: number(size(chain%stretches)), k, i, last

    do k = 1, size(number)
      number(k) = max(parts, ceiling(min((chain%arc(k) - chain%arc(k - 1))/limits%largest, real(most_parts, wp))))
    end do
    allocate (all(sum(number + 1)))
    call sizes_of_contact(chain, wish, contact)
    i = 1
    do k = 1, size(chain%stretches)
      last = merge(size(chain%stretches), k - 1, k == 1)
      associate (s => chain%stretches(k))
        all(i)%x = point_at(s, s%range(1))
        all(i)%size = limits%largest
        if (chain%kinds(k) == kind_end) then
          ! between straight sides the bend is in their joints
          mean = 0.5_wp*(chain%arc(k) - chain%arc(k - 1) + chain%arc(last) - chain%arc(last - 1))
          all(i)%size = size_of_bend(mean, abs(turn_at(chain, k)), wish, limits)
          if (all(i)%size < limits%largest) all(i)%radius = 0.5_wp*mean
        end if
        call needs_of_stretch(s, wish, limits, all(i + 1:i + number(k)))
        all(i:i + number(k))%size = min(all(i:i + number(k))%size, contact(k))
      end associate
      i = i + number(k) + 1
    end do
    if (present(nearby)) then
      do i = 1, size(all)
        do k = 1, size(nearby)
          call limit_next(slope_of(limits%gradation), nearby(k), all(i))
        end do
      end do
    end if
    call grade_along(slope_of(limits%gradation), all)
    call keep_needs(limits, all, needs)
  end subroutine needs_of_chain

  !> Needs of the bends of a die. They count where a contour is near, for sizes grow with distance.
  pure subroutine needs_of_die(pieces, wish, limits, needs)
    type(stretch_t), intent(in) :: pieces(:)   !! where the die stands
    type(geometry_wish_t), intent(in) :: wish
    type(size_limits_t), intent(in) :: limits
    type(need_t), allocatable, intent(out) :: needs(:)
    type(need_t) :: all(parts*size(pieces))
    integer :: k

    do k = 1, size(pieces)
      call needs_of_stretch(pieces(k), wish, limits, all(parts*(k - 1) + 1:parts*k))
    end do
    call keep_needs(limits, all, needs)
  end subroutine needs_of_die

  pure subroutine keep_needs(limits, all, needs)
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(in) :: all(:)
    type(need_t), allocatable, intent(out) :: needs(:)
    integer :: i, n

    allocate (needs(count(all%size < limits%largest)))
    n = 0
    do i = 1, size(all)
      if (.not. all(i)%size < limits%largest) cycle
      n = n + 1
      needs(n) = all(i)
      needs(n)%size = max(needs(n)%size, limits%smallest)
    end do
  end subroutine keep_needs

  !> Needs in the middles of parts of a stretch, by what the tangent turns over each; each holds over its part.
  pure subroutine needs_of_stretch(stretch, wish, limits, needs)
    type(stretch_t), intent(in) :: stretch
    type(geometry_wish_t), intent(in) :: wish
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(out) :: needs(:)   !! one of each part
    real(wp) :: xi(2), before(2), after(2), length
    integer :: i

    do i = 1, size(needs)
      xi = stretch%range(1) + (stretch%range(2) - stretch%range(1))*[i - 1, i]/size(needs)
      before = tangent_at(stretch, xi(1))
      after = tangent_at(stretch, xi(2))
      length = length_between(stretch, xi(1), xi(2))
      needs(i)%x = point_at(stretch, 0.5_wp*(xi(1) + xi(2)))
      needs(i)%radius = 0.5_wp*length
      needs(i)%size = size_of_bend(length, abs(atan2(cross(before, after), dot_product(before, after))), wish, limits)
    end do
  end subroutine needs_of_stretch

  pure function size_of_bend(length, bend, wish, limits) result(h)
    real(wp), intent(in) :: length, bend
    type(geometry_wish_t), intent(in) :: wish
    type(size_limits_t), intent(in) :: limits
    real(wp) :: h

    h = limits%largest
    if (wish%turn*length < h*bend) h = wish%turn*length/bend
  end function size_of_bend

  !> Size each stretch wants for the contact it belongs to: its length over the number across.
  pure subroutine sizes_of_contact(chain, wish, contact)
    type(chain_t), intent(in) :: chain
    type(geometry_wish_t), intent(in) :: wish
    real(wp), intent(out) :: contact(:)    !! (n)
    real(wp) :: length
    integer :: n, first, k, step, count

    contact = huge(1.0_wp)
    n = size(chain%stretches)
    if (wish%across == 0) return
    ! begin where a contact does, or anywhere when the die is all around
    first = 1
    do k = n, 1, -1
      if (begins(k)) first = k
    end do
    step = 0
    do while (step < n)
      length = 0
      count = 0
      do
        k = mod(first + step + count - 1, n) + 1
        length = length + chain%arc(k) - chain%arc(k - 1)
        count = count + 1
        if (step + count == n) exit
        if (begins(joint_after(chain, k))) exit
      end do
      do k = step, step + count - 1
        associate (one => mod(first + k - 1, n) + 1)
          if (chain%stretches(one)%run > 0) contact(one) = length/wish%across
        end associate
      end do
      step = step + count
    end do

  contains

    !> Whether a contact, or a free part, begins with a stretch.
    pure function begins(k) result(yes)
      integer, intent(in) :: k
      logical :: yes
      integer :: last

      last = merge(n, k - 1, k == 1)
      yes = in_contact(chain%stretches(k)) /= in_contact(chain%stretches(last)) .or. chain%kinds(k) == kind_entry
    end function begins

    !> The die a stretch bears on, 0 where it is free.
    pure function in_contact(one) result(die)
      type(stretch_t), intent(in) :: one
      integer :: die

      die = merge(one%die, 0, one%run > 0)
    end function in_contact

  end subroutine sizes_of_contact

  !> Twice around in both directions: what begins anywhere has then been everywhere.
  pure subroutine grade_along(slope, needs)
    real(wp), intent(in) :: slope
    type(need_t), intent(inout) :: needs(:)
    integer :: i, n

    n = size(needs)
    do i = 0, 2*n - 1
      call limit_next(slope, needs(mod(i, n) + 1), needs(mod(i + 1, n) + 1))
    end do
    do i = 2*n, 1, -1
      call limit_next(slope, needs(mod(i, n) + 1), needs(mod(i - 1, n) + 1))
    end do
  end subroutine grade_along

  !> Keep a need below what the one beside it allows. It then holds no farther than to where it comes up to what it was.
  pure subroutine limit_next(slope, one, next)
    real(wp), intent(in) :: slope
    type(need_t), intent(in) :: one
    type(need_t), intent(inout) :: next
    real(wp) :: most, drop

    most = one%size + slope*max(0.0_wp, length_of(next%x - one%x) - one%radius)
    if (.not. next%size > most) return
    drop = next%size - most
    if (slope*next%radius > drop) then
      next%radius = next%radius - drop/slope
    else
      next%radius = 0
    end if
    next%size = most
  end subroutine limit_next

end module contour_needs
