!> Element sizes required by the geometry, at points along contours and dies.
!>
!> A curve of radius R requires elements of R times the angle one element may turn by; a contact interval requires a number of
!> elements across it. Along a boundary curve the sizes grow by no more than the gradation.
module contour_needs
  use arcs, only: arc_t
  use boundary_curves, only: boundary_curve_t, joint_after, kind_end, kind_entry, turn_at
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use offset_parabolas, only: length_between, point_at, tangent_at
  use plane_vectors, only: cross
  use size_field, only: need_t, size_limits_t
  use vectors, only: length_of
  implicit none
  private
  public :: geometry_settings_t, needs_of_boundary, needs_of_die

  type :: geometry_settings_t
    !> Angle an element may turn by, and at a bend of a die [radian].
    real(wp) :: turn = 0.26_wp, turn_at_dies = 0.26_wp
    !> Elements across a contact interval, 0: no requirement.
    integer :: across = 0
  end type geometry_settings_t

  !> Parts of an arc that are sampled, more of one that is longer than as many of the largest elements, up to a limit.
  integer, parameter :: parts = 4, most_parts = 400
  !> A vertex of a die that turns by more is a corner, not one of a polygon that follows a curve: 30 degrees [radian].
  real(wp), parameter :: sharp = 0.52_wp

contains

  !> Size requirements along a boundary curve, including those of nearby dies. Points that require no less than the largest size are
  !> left out.
  pure subroutine needs_of_boundary(boundary, settings, limits, needs, nearby)
    type(boundary_curve_t), intent(in) :: boundary
    type(geometry_settings_t), intent(in) :: settings
    type(size_limits_t), intent(in) :: limits
    type(need_t), allocatable, intent(out) :: needs(:)   !! (nneed)
    type(need_t), optional, intent(in) :: nearby(:)      !! (nneed)
    type(need_t), allocatable :: all(:)
    real(wp) :: contact(size(boundary%arcs)), mean
    integer :: number(size(boundary%arcs)), k, i, last

    do k = 1, size(number)
      number(k) = max(parts, ceiling(min((boundary%arc_length(k) - boundary%arc_length(k - 1))/limits%largest, &
                                         real(most_parts, wp))))
    end do
    allocate (all(sum(number + 1)))
    call sizes_of_contact(boundary, settings, contact)
    i = 1
    do k = 1, size(boundary%arcs)
      last = merge(size(boundary%arcs), k - 1, k == 1)
      associate (s => boundary%arcs(k))
        all(i)%x = point_at(s, s%range(1))
        all(i)%size = limits%largest
        if (boundary%kinds(k) == kind_end) then
          ! the turn between straight sides is concentrated in their joints
          mean = 0.5_wp*(boundary%arc_length(k) - boundary%arc_length(k - 1) + boundary%arc_length(last) &
                         - boundary%arc_length(last - 1))
          all(i)%size = size_of_bend(mean, abs(turn_at(boundary, k)), settings, limits)
          if (all(i)%size < limits%largest) all(i)%radius = 0.5_wp*mean
        end if
        call needs_of_arc(s, settings, limits, all(i + 1:i + number(k)))
        all(i:i + number(k))%size = min(all(i:i + number(k))%size, contact(k))
      end associate
      i = i + number(k) + 1
    end do
    if (present(nearby)) call limit_by(slope_of(limits%gradation), nearby, limits%smallest, all)
    call grade_along(slope_of(limits%gradation), all)
    all%size = max(all%size, limits%smallest)
    if (present(nearby)) then
      if (limits%at_bends < limits%smallest .or. any(nearby%size < limits%smallest)) then
        call limit_by(slope_of(limits%gradation), nearby, min(limits%at_bends, limits%at_corners), all)
        call grade_along(slope_of(limits%gradation), all)
      end if
    end if
    call keep_needs(limits, all, needs)
  end subroutine needs_of_boundary

  !> Size requirements of the curvature of a die, and of its sharp corners that point to the part, where matter turns on the spot:
  !> the smallest size at corners there, while bends have their own. They apply where a contour is near, since sizes grow with
  !> distance.
  pure subroutine needs_of_die(pieces, closed, settings, limits, needs)
    type(arc_t), intent(in) :: pieces(:)   !! (npiece) in the present position of the die
    logical, intent(in) :: closed          !! the last piece ends where the first one begins
    type(geometry_settings_t), intent(in) :: settings
    type(size_limits_t), intent(in) :: limits
    type(need_t), allocatable, intent(out) :: needs(:)   !! (nneed)
    type(need_t) :: all((parts + 1)*size(pieces))
    type(geometry_settings_t) :: at_die
    integer :: k, n, next

    at_die = settings
    at_die%turn = settings%turn_at_dies
    n = parts*size(pieces)
    do k = 1, size(pieces)
      call needs_of_arc(pieces(k), at_die, limits, all(parts*(k - 1) + 1:parts*k))
    end do
    all(:n)%size = max(all(:n)%size, min(limits%smallest, limits%at_bends))
    do k = 1, merge(size(pieces), size(pieces) - 1, closed)
      next = mod(k, size(pieces)) + 1
      if (turn_between(tangent_at(pieces(k), 1.0_wp), tangent_at(pieces(next), -1.0_wp)) > -sharp) cycle
      n = n + 1
      all(n)%x = point_at(pieces(k), 1.0_wp)
      all(n)%size = min(limits%smallest, limits%at_corners)
    end do
    call keep_needs(limits, all(:n), needs)
  end subroutine needs_of_die

  !> Angle from one direction to another, positive to the left.
  pure function turn_between(before, after) result(turn)
    real(wp), intent(in) :: before(2), after(2)   !! [-]
    real(wp) :: turn                              !! [radian]

    turn = atan2(cross(before, after), dot_product(before, after))
  end function turn_between

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
    end do
  end subroutine keep_needs

  !> Requirements at the middles of parts of an arc, by the angle the tangent turns over each; each holds over its part.
  pure subroutine needs_of_arc(arc, settings, limits, needs)
    type(arc_t), intent(in) :: arc
    type(geometry_settings_t), intent(in) :: settings
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(out) :: needs(:)   !! one of each part
    real(wp) :: xi(2), before(2), after(2), length
    integer :: i

    do i = 1, size(needs)
      xi = arc%range(1) + (arc%range(2) - arc%range(1))*[i - 1, i]/size(needs)
      before = tangent_at(arc, xi(1))
      after = tangent_at(arc, xi(2))
      length = length_between(arc, xi(1), xi(2))
      needs(i)%x = point_at(arc, 0.5_wp*(xi(1) + xi(2)))
      needs(i)%radius = 0.5_wp*length
      needs(i)%size = size_of_bend(length, abs(turn_between(before, after)), settings, limits)
    end do
  end subroutine needs_of_arc

  pure function size_of_bend(length, bend, settings, limits) result(h)
    real(wp), intent(in) :: length, bend
    type(geometry_settings_t), intent(in) :: settings
    type(size_limits_t), intent(in) :: limits
    real(wp) :: h

    h = limits%largest
    if (settings%turn*length < h*bend) h = settings%turn*length/bend
  end function size_of_bend

  !> Size required on each arc by the contact it belongs to: length of the contact over the number of elements across.
  pure subroutine sizes_of_contact(boundary, settings, contact)
    type(boundary_curve_t), intent(in) :: boundary
    type(geometry_settings_t), intent(in) :: settings
    real(wp), intent(out) :: contact(:)   !! (n)
    real(wp) :: length
    integer :: n, first, k, step, count

    contact = huge(1.0_wp)
    n = size(boundary%arcs)
    if (settings%across == 0) return
    ! begin where a contact begins, or anywhere if it is all around
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
        length = length + boundary%arc_length(k) - boundary%arc_length(k - 1)
        count = count + 1
        if (step + count == n) exit
        if (begins(joint_after(boundary, k))) exit
      end do
      do k = step, step + count - 1
        associate (one => mod(first + k - 1, n) + 1)
          if (boundary%arcs(one)%interval > 0) contact(one) = length/settings%across
        end associate
      end do
      step = step + count
    end do

  contains

    !> Whether a contact, or a free part, begins with an arc.
    pure function begins(k) result(yes)
      integer, intent(in) :: k
      logical :: yes
      integer :: last

      last = merge(n, k - 1, k == 1)
      yes = in_contact(boundary%arcs(k)) /= in_contact(boundary%arcs(last)) .or. boundary%kinds(k) == kind_entry
    end function begins

    !> The die an arc is in contact with, 0 where it is free.
    pure function in_contact(one) result(die)
      type(arc_t), intent(in) :: one
      integer :: die

      die = merge(one%die, 0, one%interval > 0)
    end function in_contact

  end subroutine sizes_of_contact

  !> Twice around in both directions, so that every requirement reaches every point.
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

  !> Limit requirements by others, which are taken for no smaller than `least`.
  pure subroutine limit_by(slope, others, least, needs)
    real(wp), intent(in) :: slope
    type(need_t), intent(in) :: others(:)
    real(wp), intent(in) :: least   !! [length]
    type(need_t), intent(inout) :: needs(:)
    type(need_t) :: other
    integer :: i, k

    do k = 1, size(others)
      other = others(k)
      other%size = max(other%size, least)
      do i = 1, size(needs)
        call limit_next(slope, other, needs(i))
      end do
    end do
  end subroutine limit_by

  !> Limit a requirement by that of its neighbour. It then holds only within the distance at which the limit reaches its old value.
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
