!> Corners of a die rounded by arcs of circle.
!>
!> The arc touches both arms in tangent: its centre is where the arms' offsets by the radius meet, on
!> the side to which the curve turns. With l the unit vector at the left of the curve, k its signed
!> curvature and s = 1 for a turn to the left, -1 to the right,
!> Y1(xi1) + s r l1 = Y2(xi2) + s r l2, where d(Y + s r l)/dxi = (1 - s r k) Y': two equations for two
!> parent coordinates, by Newton's method from the corner. Parts of parabolas are parabolas, so the arms stay exact.
module fillets
  use circle_arcs, only: arc_pieces
  use kinds, only: wp
  use parabolas, only: curvature_on, part_of, point_on, tangent_on
  use plane_vectors, only: angle_between, left_of, turned
  use vectors, only: length_of
  implicit none
  private
  public :: round_corner

  !> Arms go on smoothly, or fold back, when the sine of the turn is below this.
  real(wp), parameter :: least_turn = 1.0e-6_wp
  !> Parent coordinates are found to this share of a piece; what is left of an arm is longer than this share of the radius.
  real(wp), parameter :: xi_tolerance = 1.0e-13_wp, least_rest = 1.0e-9_wp
  !> Newton's method takes one iteration on segments, a few more on parabolas; an arm is followed piece by piece.
  integer, parameter :: max_iterations = 50

contains

  !> Put an arc in place of the corner between the last piece of an arm and the first one of the next.
  pure subroutine round_corner(before, after, radius, tolerance, rounded, rest, message)
    real(wp), intent(in) :: before(:, :, :), after(:, :, :)   !! (2, 3, npiece) in the order of the curve [length]
    real(wp), intent(in) :: radius, tolerance                 !! > 0 [length]
    real(wp), allocatable, intent(out) :: rounded(:, :, :)    !! (2, 3, npiece) what replaces both [length]
    integer, intent(out) :: rest                              !! pieces of the next arm that are left, the last ones
    character(len=:), allocatable, intent(out) :: message     !! empty when all is well
    real(wp), allocatable :: arc(:, :, :)
    real(wp) :: turn, sense, xi(2), first(2), last(2), centre(2), half
    integer :: i, j

    message = ''
    rest = size(after, 3)
    i = size(before, 3)
    j = 1
    turn = angle_between(tangent_on(before(:, :, i), 1.0_wp), tangent_on(after(:, :, j), -1.0_wp))
    sense = sign(1.0_wp, turn)
    if (abs(sin(turn)) <= least_turn) then
      message = 'the pieces before and after a fillet meet in a corner; these go on smoothly'
      if (cos(turn) < 0) message = 'the pieces before and after a fillet meet in a corner; these fold back on one another'
      return
    end if
    call touch(before, after, sense*radius, turn, i, j, xi)
    if (i == 0) then
      message = 'the radius of the fillet is too large: its arc does not touch both neighbours within their length'
      return
    end if
    first = point_on(before(:, :, i), xi(1))
    last = point_on(after(:, :, j), xi(2))
    centre = first + sense*radius*left_of(tangent_on(before(:, :, i), xi(1)))
    half = 0.5_wp*angle_between(tangent_on(before(:, :, i), xi(1)), tangent_on(after(:, :, j), xi(2)))
    call arc_pieces(first, centre + turned(first - centre, half), last, tolerance, arc, message)
    if (message /= '') return
    rest = size(after, 3) - j + 1
    allocate (rounded(2, 3, i + size(arc, 3) + rest))
    rounded(:, :, :i) = before(:, :, :i)
    rounded(:, :, i) = part_of(before(:, :, i), -1.0_wp, xi(1))
    rounded(:, :, i + 1:i + size(arc, 3)) = arc
    rounded(:, :, i + size(arc, 3) + 1:) = after(:, :, j:)
    rounded(:, :, i + size(arc, 3) + 1) = part_of(after(:, :, j), xi(2), 1.0_wp)
    rounded(:, 3, i) = first
    rounded(:, 1, i + size(arc, 3) + 1) = last
  end subroutine round_corner

  !> Pieces i and j and the parent coordinates on them where a circle touches; i = 0 when there is none.
  pure subroutine touch(before, after, offset, turn, i, j, xi)
    real(wp), intent(in) :: before(:, :, :), after(:, :, :)
    real(wp), intent(in) :: offset         !! radius, its sign that of the turn
    real(wp), intent(in) :: turn           !! angle of the corner
    integer, intent(inout) :: i, j
    real(wp), intent(out) :: xi(2)
    real(wp) :: along(2, 2), gap(2), change(2), back, det, rest(2)
    integer :: iteration

    ! where the arms are straight the circle touches them so far from the corner
    back = abs(offset*tan(0.5_wp*turn))
    xi = [1 - back/length_of(tangent_on(before(:, :, i), 1.0_wp)), -1 + back/length_of(tangent_on(after(:, :, j), -1.0_wp))]
    do iteration = 1, max_iterations + size(before, 3) + size(after, 3)
      ! a parent coordinate before the start of its piece belongs to the piece before, and so on
      if (xi(1) < -1 .and. i > 1) then
        i = i - 1
        xi(1) = 1
      end if
      if (xi(2) > 1 .and. j < size(after, 3)) then
        j = j + 1
        xi(2) = -1
      end if
      xi = max(-3.0_wp, min(3.0_wp, xi))
      along(:, 1) = (1 - offset*curvature_on(before(:, :, i), xi(1)))*tangent_on(before(:, :, i), xi(1))
      along(:, 2) = -(1 - offset*curvature_on(after(:, :, j), xi(2)))*tangent_on(after(:, :, j), xi(2))
      gap = point_on(after(:, :, j), xi(2)) + offset*left_of(tangent_on(after(:, :, j), xi(2))) &
            - point_on(before(:, :, i), xi(1)) - offset*left_of(tangent_on(before(:, :, i), xi(1)))
      det = along(1, 1)*along(2, 2) - along(1, 2)*along(2, 1)
      if (.not. abs(det) > 0) exit
      change = [gap(1)*along(2, 2) - gap(2)*along(1, 2), along(1, 1)*gap(2) - along(2, 1)*gap(1)]/det
      xi = xi + change
      if (all(abs(change) <= xi_tolerance)) then
        rest = [length_of(point_on(before(:, :, i), xi(1)) - before(:, 1, i)), &
                length_of(after(:, 3, j) - point_on(after(:, :, j), xi(2)))]
        if (any(abs(xi) > 1) .or. any(rest < least_rest*abs(offset))) exit
        ! a circle larger than the bend it lies in touches it from the wrong side
        if (offset*curvature_on(before(:, :, i), xi(1)) >= 1 .or. offset*curvature_on(after(:, :, j), xi(2)) >= 1) exit
        return
      end if
    end do
    i = 0
  end subroutine touch

end module fillets
