!> Which of the two faces that meet in a corner of a die a side of the part lies on.
!>
!> The closest point of all is right where the side faces it. Beside a corner it may be on the face that the side does not lie on:
!> - a point inside, beside a corner that points to the part, leaves through the face that its own normal meets;
!> - in a corner that the part fills, as that of a container's floor and wall, the end of a side is near both faces, and the signs
!>   of its depths are those of round-off and of the last correction. It keeps to the face that its side lies on, which goes on
!>   beyond the vertex where it has to: multipliers hold the pressure there, along the normal of that face. The other face is that
!>   of the other side which ends there;
!> - a point that presses one face of a corner stays on it, while it is shallow where the corner points to the part, and where the
!>   part fills it until its side lies on the other face rather than on this one and is no more than a small gap away from it: a
!>   pressure that is held would turn with the face from one iteration to the next, and back.
module corner_faces
  use closest_point, only: closest_point_t, closest_within_piece, sense_of_turn, stationary_points, whole_piece
  use kinds, only: wp
  use parabolas, only: tangent_on
  use piecewise_curves, only: adjacent_piece, blunt, piecewise_curve_t
  use plane_vectors, only: angle_between, right_of
  use vectors, only: length_of
  implicit none
  private
  public :: leave_beside, keep_to_face, stay_on_face, closest_on_piece

  !> A side whose normal meets a face at less than this cosine hardly lies on it.
  real(wp), parameter :: beside = 0.7_wp
  !> At less than this cosine it does not.
  real(wp), parameter :: across = 0.5_wp
  !> In an obtuse corner it lies on one face and not on the other when its normal is more than this share of the corner's angle away
  !> from the other's; and less where the point has pressed the one face.
  real(wp), parameter :: away = 2.0_wp/3, still_away = 1.0_wp/3
  !> A face may be deeper by so much of the reach: a part that has risen along the other face belongs to that one.
  real(wp), parameter :: at_corner = 0.01_wp
  !> A point is in a corner that the part fills within so much of the reach, as deep and as far beyond the vertex; in an obtuse one
  !> within `at_corner`.
  real(wp), parameter :: in_corner = 0.25_wp

contains

  !> The face that the side of a point inside lies on, beside a corner that points to the part. Depths along the part's normal,
  !> d/(-e_R.n), are compared.
  pure subroutine leave_beside(curve, point, e_r, reach, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)                  !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)                    !! inner normal of the part, in the pilot's axes [-]
    real(wp), intent(in) :: reach                     !! [length]
    type(closest_point_t), intent(inout) :: closest   !! of all, on a piece
    type(closest_point_t) :: other
    real(wp) :: along, along_other
    integer :: next, piece, way

    piece = closest%piece
    along = -dot_product(e_r, closest%normal)
    if (along > beside) return
    do way = -1, 1, 2
      next = adjacent_piece(curve, piece, way)
      if (next == 0) cycle
      call closest_on_piece(curve, next, point, -real(way, wp), 0.0_wp, other)
      if (other%piece == 0) cycle
      if (.not. (other%d > 0 .and. other%d < at_corner*reach)) cycle
      along_other = -dot_product(e_r, other%normal)
      if (along_other*max(closest%d, 0.0_wp) < along*other%d .or. .not. along_other > along) cycle
      closest = other
      along = along_other
    end do
  end subroutine leave_beside

  !> The face that a point has pressed, in place of the other one of the same corner.
  pure subroutine stay_on_face(curve, point, e_r, reach, pressed, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)     !! inner normal of the part, in the pilot's axes [-]
    real(wp), intent(in) :: reach      !! [length]
    integer, intent(in) :: pressed     !! piece
    type(closest_point_t), intent(inout) :: closest   !! of all, on a piece or the vertex behind it
    type(closest_point_t) :: found
    integer :: way, next, found_on
    real(wp) :: turn

    if (closest%piece == pressed .and. .not. closest%at_vertex) return
    do way = -1, 1, 2
      next = adjacent_piece(curve, pressed, way)
      if (next == 0) cycle
      ! of the corner between both the closest point is on the other face, or it is the vertex behind the first of them
      found_on = next
      if (closest%at_vertex .and. way > 0) found_on = pressed
      if (closest%piece /= found_on) cycle
      turn = turn_at(curve, pressed, next, way)
      if (turn > 0) then
        call try_face(curve, point, e_r, reach, way, pressed, still_away, closest)
        if (closest%piece == pressed .or. closest%d > -at_corner*reach) return
      end if
      if (closest%at_vertex .or. .not. abs(turn) > 0) cycle
      call closest_on_piece(curve, pressed, point, real(way, wp), 0.0_wp, found)
      if (found%piece == 0 .or. .not. abs(found%d) < at_corner*reach) cycle
      closest = found
      return
    end do
  end subroutine stay_on_face

  !> In a corner that the part fills, the face that the side of a point lies on.
  pure subroutine keep_to_face(curve, point, e_r, reach, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2)                  !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)                    !! inner normal of the part, in the pilot's axes [-]
    real(wp), intent(in) :: reach                     !! [length]
    type(closest_point_t), intent(inout) :: closest   !! of all, on a piece or the vertex behind it
    integer :: piece, way, own

    piece = closest%piece
    if (closest%at_vertex) then
      if (.not. closest%d > 0) return
      call try_face(curve, point, e_r, reach, 1, piece, away, closest)
      if (closest%at_vertex) call try_face(curve, point, e_r, reach, -1, &
                                              adjacent_piece(curve, piece, 1), away, closest)
      return
    end if
    do way = -1, 1, 2
      own = adjacent_piece(curve, piece, way)
      if (own > 0) call try_face(curve, point, e_r, reach, -way, own, away, closest)
    end do
  end subroutine keep_to_face

  !> Take a face that ends (1) or begins (-1) in such a corner, if the side lies on it and not on the other one.
  pure subroutine try_face(curve, point, e_r, reach, end, face, share, closest)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: point(2), e_r(2), reach
    integer, intent(in) :: end, face
    real(wp), intent(in) :: share   !! of the corner's angle between the normals of the side and of the other face, at least
    type(closest_point_t), intent(inout) :: closest
    type(closest_point_t) :: found
    real(wp) :: beyond, turn, near
    integer :: other

    other = adjacent_piece(curve, face, end)
    if (.not. turn_at(curve, face, other, end) > 0) return
    associate (own => curve%pieces(:, :, face), opposite => curve%pieces(:, :, other))
      if (.not. meets(tangent_on(own, real(end, wp))) > beside) return
      near = in_corner*reach
      if (meets(tangent_on(opposite, -real(end, wp))) > across) then
        turn = abs(angle_between(tangent_on(own, real(end, wp)), tangent_on(opposite, -real(end, wp))))
        near = at_corner*reach
        if (.not. (turn > blunt .and. abs(closest%d) < near)) return
        if (meets(tangent_on(opposite, -real(end, wp))) > cos(share*turn)) return
      end if
      beyond = near/length_of(tangent_on(own, real(end, wp)))
    end associate
    call closest_on_piece(curve, face, point, real(end, wp), beyond, found)
    if (found%piece == 0) return
    if (.not. (-dot_product(e_r, found%normal) > beside .and. abs(found%d) < near)) return
    if (closest%d > 0 .and. .not. (closest%at_vertex .or. found%d > -at_corner*reach)) return
    closest = found
    closest%xi = min(1.0_wp, max(-1.0_wp, found%xi))

  contains

    !> Cosine between the part's normal and that of a face with this tangent, 1 where the side lies on it.
    pure function meets(tangent) result(cosine)
      real(wp), intent(in) :: tangent(2)
      real(wp) :: cosine

      cosine = -dot_product(e_r, right_of(tangent))
    end function meets
  end subroutine try_face

  !> The curve turns left (1) or right (-1) where a piece is followed by the next (way 1) or preceded by it (-1).
  pure function turn_at(curve, piece, next, way) result(turn)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece, next, way
    real(wp) :: turn

    turn = sense_of_turn(curve%pieces(:, :, merge(piece, next, way > 0)), curve%pieces(:, :, merge(next, piece, way > 0)))
  end function turn_at

  !> Closest point on one piece, or up to `beyond` outside its ends; of several the one nearest to `from`.
  pure subroutine closest_on_piece(curve, piece, point, from, beyond, closest)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: piece
    real(wp), intent(in) :: point(2)       !! in the pilot's axes [length]
    real(wp), intent(in) :: from, beyond   !! parent coordinates [-]
    type(closest_point_t), intent(out) :: closest
    real(wp) :: roots(3), limit
    integer :: n

    limit = whole_piece(2) + beyond
    call stationary_points(curve%pieces(:, :, piece), point, [-limit, limit], n, roots)
    if (n == 0) return
    call closest_within_piece(curve%pieces(:, :, piece), point, roots(minloc(abs(roots(:n) - from), 1)), closest)
    if (closest%piece > 0) closest%piece = piece
  end subroutine closest_on_piece

end module corner_faces
