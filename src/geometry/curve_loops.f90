!> Where a curve of parabolas crosses itself.
!>
!> Where two of its pieces have a point in common the curve passes it twice, on two strands. They cross when the one comes from one
!> side of the other and leaves to its other side; a corner that only touches, an end that stands on the curve, and strands that
!> lie on each other do not. A crossing that leaves as little between the strands as an eighth of a piece bulges is not seen
!> (arc_crossings).
module curve_loops
  use arc_crossings, only: crossings_between, most_crossings, touching
  use box_tree, only: box_tree_t, build_tree, items_meeting
  use kinds, only: pi, wp
  use offset_parabolas, only: offset_parabola_t
  use parabolas, only: point_on, tangent_on
  use piecewise_curves, only: adjacent_piece, piecewise_curve_t
  use plane_vectors, only: angle_between
  implicit none
  private
  public :: find_loop

  !> Directions in which a strand leaves a point, ahead and back; one of them alone at an end of the curve.
  type :: strand_t
    real(wp) :: ahead(2) = 0.0_wp, back(2) = 0.0_wp   !! [of any length]
    logical :: goes_through = .true.
  end type strand_t

  !> Directions that differ by less are the same [radian].
  real(wp), parameter :: same_direction = 1.0e-6_wp
  !> Pieces that follow one another meet in their joint: what is found so near to it, in parent coordinates, is the joint.
  real(wp), parameter :: at_joint = 1.0e-3_wp

contains

  !> The first piece that crosses one before it.
  pure subroutine find_loop(curve, pieces, point)
    class(piecewise_curve_t), intent(in) :: curve   !! prepared for search
    integer, intent(out) :: pieces(2)               !! in the order of the curve; 0 where none cross
    real(wp), intent(out) :: point(2)               !! where they cross [length]
    type(offset_parabola_t), allocatable :: arcs(:)
    type(box_tree_t) :: tree
    real(wp) :: xi(2, most_crossings)
    integer, allocatable :: meeting(:)
    integer :: n, found, number, j, k, m, r

    pieces = 0
    point = 0
    n = size(curve%pieces, 3)
    allocate (arcs(n), meeting(n))
    do k = 1, n
      arcs(k)%points = curve%pieces(:, :, k)
    end do
    call build_tree(curve%boxes, [(k, k=1, n)], tree)
    do k = 2, n
      call items_meeting(tree, curve%boxes(:, k), found, meeting)
      do m = 1, found
        j = meeting(m)
        if (j >= k) cycle
        call crossings_between(arcs(j), arcs(k), number, xi)
        do r = 1, number
          if (is_joint(curve, [j, k], xi(:, r)) .or. is_joint(curve, [k, j], xi([2, 1], r))) cycle
          if (.not. cross_over(strand_at(curve, j, xi(1, r)), strand_at(curve, k, xi(2, r)))) cycle
          pieces = [j, k]
          point = point_on(curve%pieces(:, :, j), xi(1, r))
          return
        end do
      end do
    end do
  end subroutine find_loop

  !> A point common to two pieces is the joint in which the second follows the first.
  pure function is_joint(curve, pieces, xi) result(yes)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: pieces(2)
    real(wp), intent(in) :: xi(2)   !! on the one and on the other [-]
    logical :: yes

    yes = adjacent_piece(curve, pieces(1), 1) == pieces(2) .and. xi(1) > 1 - at_joint .and. xi(2) < -1 + at_joint
  end function is_joint

  !> The curve at a place.
  pure function strand_at(curve, piece, xi) result(strand)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece
    real(wp), intent(in) :: xi   !! on the piece [-]
    type(strand_t) :: strand
    integer :: way, other

    strand%ahead = tangent_on(curve%pieces(:, :, piece), xi)
    strand%back = -strand%ahead
    if (abs(xi) < 1 - 2*touching) return
    way = merge(-1, 1, xi < 0)
    other = adjacent_piece(curve, piece, way)
    strand%goes_through = other > 0
    if (other == 0) return
    if (way > 0) strand%ahead = tangent_on(curve%pieces(:, :, other), -1.0_wp)
    if (way < 0) strand%back = -tangent_on(curve%pieces(:, :, other), 1.0_wp)
  end function strand_at

  !> One strand goes from one side of the other to its other side.
  pure function cross_over(one, other) result(yes)
    type(strand_t), intent(in) :: one, other
    logical :: yes
    real(wp) :: left, places(2)

    yes = .false.
    if (.not. (one%goes_through .and. other%goes_through)) return
    ! on the left of a strand is what its direction ahead turns over on the way to that back
    left = modulo(angle_between(one%ahead, one%back), 2*pi)
    places = modulo([angle_between(one%ahead, other%ahead), angle_between(one%ahead, other%back)], 2*pi)
    yes = any(is_between(0.0_wp, left)) .and. any(is_between(left, 2*pi))

  contains

    pure function is_between(low, high) result(is)
      real(wp), intent(in) :: low, high
      logical :: is(2)

      is = places > low + same_direction .and. places < high - same_direction
    end function is_between

  end function cross_over

end module curve_loops
