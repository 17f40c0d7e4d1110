!> The contour of a part as a closed chain of stretches, walked by exact curves.
!>
!> Every stretch carries its own curve and its own range of xi, so that a place on the contour is a stretch and a xi: nothing
!> is read from the position of nodes in a list, which annex 2 (fig. 4) shows to go wrong where contact begins and ends.
module contour_chain
  use boundary_sides, only: loop_t
  use kinds, only: wp
  use stretches, only: closest_xi, cross, length_between, point_at, stretch_t, tangent_at, xi_at_length
  use vectors, only: length_of
  implicit none
  private
  public :: chain_t, place_t, chain_of_loop, close_chain, point_on, turn_at, arc_at, place_at_arc, closest_place
  public :: chain_length, largest_gap, joint_after, joint_point, size_of_chain
  public :: kind_mid, kind_end, kind_corner, kind_entry, kind_exit, kind_joint

  !> What a node of the contour is: middle or end of a parabola, an end where the tangent turns, a place where contact
  !> begins or ends, or one where the contour goes on smoothly in another set of sides.
  integer, parameter :: kind_mid = 1, kind_end = 2, kind_corner = 3, kind_entry = 4, kind_exit = 5, kind_joint = 6

  type :: chain_t
    type(stretch_t), allocatable :: stretches(:)
    !> Kind of the joint each stretch begins with (n).
    integer, allocatable :: kinds(:)
    !> Arc length from the start of the chain to the end of each stretch (0:n) [length].
    real(wp), allocatable :: arc(:)
    !> Tangents that turn by more make a corner [radian].
    real(wp) :: corner_turn = huge(1.0_wp)
  end type chain_t

  !> A place on a chain.
  type :: place_t
    integer :: stretch = 1
    real(wp) :: xi = -1.0_wp
  end type place_t

contains

  !> The chain of a loop without contact: its sides as they are.
  pure function chain_of_loop(loop, coordinates, corner_turn) result(chain)
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: coordinates(:, :)   !! of all nodes (2, nnode) [length]
    real(wp), intent(in) :: corner_turn         !! tangents that turn by more make a corner [radian]
    type(chain_t) :: chain
    integer :: k

    allocate (chain%stretches(size(loop%sides, 2)), chain%kinds(size(loop%sides, 2)))
    do k = 1, size(chain%stretches)
      chain%stretches(k)%points = coordinates(:, loop%sides(:, k))
      chain%stretches(k)%middle = loop%sides(2, k)
      chain%stretches(k)%side = k
    end do
    chain%kinds = kind_end
    call close_chain(corner_turn, chain)
  end function chain_of_loop

  !> Corners among the ends and joints, and arc lengths.
  pure subroutine close_chain(corner_turn, chain)
    real(wp), intent(in) :: corner_turn   !! [radian]
    type(chain_t), intent(inout) :: chain
    integer :: k

    chain%corner_turn = corner_turn
    if (allocated(chain%arc)) deallocate (chain%arc)
    allocate (chain%arc(0:size(chain%stretches)))
    chain%arc(0) = 0
    do k = 1, size(chain%stretches)
      if (any(chain%kinds(k) == [kind_end, kind_joint]) .and. abs(turn_at(chain, k)) > corner_turn) &
        chain%kinds(k) = kind_corner
      associate (s => chain%stretches(k))
        chain%arc(k) = chain%arc(k - 1) + length_between(s, s%range(1), s%range(2))
      end associate
    end do
  end subroutine close_chain

  !> Where stretch k begins [length]: a node of the part where one of the two stretches that meet is a whole side's end.
  pure function joint_point(chain, k) result(point)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k
    real(wp) :: point(2)
    integer :: last

    last = merge(size(chain%stretches), k - 1, k == 1)
    associate (before => chain%stretches(last), after => chain%stretches(k))
      if (before%middle > 0 .and. .not. before%range(2) < 1) then
        point = before%points(:, 3)
      else if (after%middle > 0 .and. .not. after%range(1) > -1) then
        point = after%points(:, 1)
      else
        point = point_at(after, after%range(1))
      end if
    end associate
  end function joint_point

  !> Number of the stretch after another.
  pure function joint_after(chain, k) result(next)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k
    integer :: next

    next = mod(k, size(chain%stretches)) + 1
  end function joint_after

  !> Angle the tangent turns by where stretch k begins, to the left above zero [radian].
  pure function turn_at(chain, k) result(turn)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k
    real(wp) :: turn
    real(wp) :: before(2), after(2)
    integer :: last

    last = merge(size(chain%stretches), k - 1, k == 1)
    before = tangent_at(chain%stretches(last), chain%stretches(last)%range(2))
    after = tangent_at(chain%stretches(k), chain%stretches(k)%range(1))
    turn = atan2(cross(before, after), dot_product(before, after))
  end function turn_at

  pure function point_on(chain, place) result(point)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: place
    real(wp) :: point(2)

    point = point_at(chain%stretches(place%stretch), place%xi)
  end function point_on

  pure function chain_length(chain) result(length)
    type(chain_t), intent(in) :: chain
    real(wp) :: length

    length = chain%arc(size(chain%stretches))
  end function chain_length

  !> Arc length from the start of the chain [length].
  pure function arc_at(chain, place) result(arc)
    type(chain_t), intent(in) :: chain
    type(place_t), intent(in) :: place
    real(wp) :: arc

    associate (s => chain%stretches(place%stretch))
      arc = chain%arc(place%stretch - 1) + length_between(s, s%range(1), place%xi)
    end associate
  end function arc_at

  !> Place at an arc length from the start, counted around the chain.
  pure function place_at_arc(chain, arc) result(place)
    type(chain_t), intent(in) :: chain
    real(wp), intent(in) :: arc   !! [length]
    type(place_t) :: place
    real(wp) :: rest
    integer :: low, high, middle

    rest = modulo(arc, chain_length(chain))
    low = 0
    high = size(chain%stretches)
    do while (high - low > 1)
      middle = (low + high)/2
      if (chain%arc(middle) <= rest) then
        low = middle
      else
        high = middle
      end if
    end do
    place%stretch = high
    place%xi = xi_at_length(chain%stretches(high), rest - chain%arc(low))
  end function place_at_arc

  !> The place closest to a point; of two as close the first along the chain.
  pure function closest_place(chain, target) result(place)
    type(chain_t), intent(in) :: chain
    real(wp), intent(in) :: target(2)   !! [length]
    type(place_t) :: place
    real(wp) :: xi, distance, least
    integer :: k

    least = huge(least)
    do k = 1, size(chain%stretches)
      associate (s => chain%stretches(k))
        ! no point of a stretch is farther from its start than it is long
        if (length_of(point_at(s, s%range(1)) - target) - (chain%arc(k) - chain%arc(k - 1)) > least) cycle
        xi = closest_xi(s, target)
        distance = length_of(point_at(s, xi) - target)
      end associate
      if (.not. distance < least) cycle
      least = distance
      place = place_t(k, xi)
    end do
  end function closest_place

  !> Widest gap between a stretch and the next [length].
  pure function largest_gap(chain) result(gap)
    type(chain_t), intent(in) :: chain
    real(wp) :: gap
    integer :: k

    gap = 0
    do k = 1, size(chain%stretches)
      associate (s => chain%stretches(k), next => chain%stretches(joint_after(chain, k)))
        gap = max(gap, length_of(point_at(next, next%range(1)) - point_at(s, s%range(2))))
      end associate
    end do
  end function largest_gap

  !> Diagonal of the box around the ends and middles of the stretches [length].
  pure function size_of_chain(chain) result(extent)
    type(chain_t), intent(in) :: chain
    real(wp) :: extent
    real(wp) :: low(2), high(2), point(2)
    integer :: k, i

    low = huge(low)
    high = -huge(high)
    do k = 1, size(chain%stretches)
      associate (s => chain%stretches(k))
        do i = 0, 2
          point = point_at(s, s%range(1) + 0.5_wp*i*(s%range(2) - s%range(1)))
          low = min(low, point)
          high = max(high, point)
        end do
      end associate
    end do
    extent = length_of(high - low)
  end function size_of_chain

end module contour_chain
