!> A point of a side that slides past a corner of a die, from the face that pressed it into the free.
!>
!> Beside the corner nothing holds it any more, and a corner inside the side takes over only as it moves away from the
!> point (corner_contact). A pressure that ended at once would leave positions without equilibrium. So the face goes on beyond
!> its corner, as the line along its tangent, for `releasing` of half a side, and the pressure falls to zero on that way.
module corner_release
  use closest_point, only: closest_point_t, closest_within_piece, past_end
  use contact_state, only: at_penetration, at_piece, at_status, at_xi
  use dies, only: die_t
  use kinds, only: wp
  use law_api, only: contact_open
  use piecewise_curves, only: adjacent_piece, blunt
  use plane_vectors, only: cross, right_of, turned
  use rigid_contact, only: ndof, side_t
  use side_points, only: contact_point_t
  implicit none
  private
  public :: release_t, slide_past_corner, slide_beyond, motion_past_corner, passes_corner

  !> Way past a corner over half the side on which a point loses its pressure: that on which a corner gains it.
  real(wp), parameter :: releasing = 0.05_wp

  !> A point that comes to a corner is on the face when it is less deep than this share of its side, and its side lies along the
  !> face within this cosine: one that has risen beside the corner is not.
  real(wp), parameter :: shallow = 0.01_wp, facing = 0.7_wp

  !> What is left of the pressure, and its change with the way past the corner [1/length]; the tangent of the face that way.
  type :: release_t
    real(wp) :: share = 1.0_wp, slope = 0.0_wp, tangent(2) = 0.0_wp
  end type release_t

contains

  !> The face that a point was on, or over, when the step began, beyond its corner, or comes to where it has faced none yet;
  !> `closest` stays where there is none. A point that has left a face and is over the other one is not taken back by the first.
  pure subroutine slide_past_corner(die, point, e_r, length, committed, closest, release)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)       !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)         !! inner normal of the part there, in the pilot's axes [-]
    real(wp), intent(in) :: length         !! of the side [length]
    real(wp), intent(in) :: committed(:)   !! (nstate) of the point [unit of each component]
    type(closest_point_t), intent(inout) :: closest
    type(release_t), intent(out) :: release
    real(wp) :: way, depth, outward(2), normal(2)
    integer :: k, piece, side
    logical :: was_open

    piece = nint(committed(at_piece))
    was_open = nint(committed(at_status)) == contact_open
    do k = 1, size(die%corners, 2)
      do side = 1, 2
        ! the face before the corner goes on along its tangent, the one behind it against it
        if (face_at(die, k, side) == 0) cycle
        if (piece > 0 .and. face_at(die, k, side) /= piece) cycle
        outward = merge(die%corners(3:4, k), -die%corners(5:6, k), side == 1)
        way = dot_product(point - die%corners(1:2, k), outward)
        if (.not. (way > 0 .and. way < 0.5_wp*releasing*length)) cycle
        depth = dot_product(point - die%corners(1:2, k), right_of(merge(outward, -outward, side == 1)))
        normal = right_of(merge(outward, -outward, side == 1))
        ! pressure that was augmented holds also where the point has left the face by less than that takes
        if (was_open .and. .not. depth > 0) cycle
        if (was_open .and. .not. (depth < shallow*length .and. dot_product(normal, e_r) < -facing)) cycle
        closest = closest_point_t(piece=face_at(die, k, side), xi=merge(1.0_wp, -1.0_wp, side == 1), d=depth, normal=normal)
        release%slope = -2/(releasing*length)
        release%share = 1 + release%slope*way
        release%tangent = outward
        call mark_released(release, closest)
        return
      end do
    end do
  end subroutine slide_past_corner

  !> The piece before (1) or behind (2) a corner, 0 where the curve ends there.
  pure function face_at(die, corner, side) result(piece)
    type(die_t), intent(in) :: die
    integer, intent(in) :: corner, side
    integer :: piece

    piece = die%corner_piece(corner)
    if (die%corner_xi(corner) < 0) then
      if (side == 1) piece = 0
    else if (side == 2) then
      piece = adjacent_piece(die, piece, 1)
    end if
  end function face_at

  !> Where less than half of a point's pressure is left its parent coordinate is beyond the end of the face (is_released): the state
  !> of a point that stands on a corner, or just beyond it, stays that of one on the face.
  pure subroutine mark_released(release, closest)
    type(release_t), intent(in) :: release
    type(closest_point_t), intent(inout) :: closest   !! at the end of its face

    if (release%share < 0.5_wp) closest%xi = sign(past_end, closest%xi)
  end subroutine mark_released

  !> A point has lost depth on a way along the die that passes a corner.
  pure function passes_corner(die, committed, closest) result(yes)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: committed(:)             !! (nstate) of the point [unit of each component]
    type(closest_point_t), intent(in) :: closest     !! at the end of the step
    logical :: yes
    type(closest_point_t) :: before

    yes = .false.
    if (nint(committed(at_piece)) == 0 .or. closest%d >= committed(at_penetration)) return
    associate (piece => die%pieces(:, :, nint(committed(at_piece))))
      call closest_within_piece(piece, piece(:, 2), committed(at_xi), before)
    end associate
    ! a die that turns by as much as a corner has one on the way, or a bend as small
    yes = abs(cross(before%normal, closest%normal)) > blunt
  end function passes_corner

  !> What is left of the pressure of a point that goes on beyond the corner at the end of its face.
  pure subroutine slide_beyond(die, point, length, closest, release)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)                 !! in the pilot's axes [length]
    real(wp), intent(in) :: length                   !! of the side [length]
    type(closest_point_t), intent(inout) :: closest  !! on the face
    type(release_t), intent(out) :: release
    real(wp) :: way, outward(2)
    integer :: k, side

    do k = 1, size(die%corners, 2)
      do side = 1, 2
        if (face_at(die, k, side) == 0 .or. face_at(die, k, side) /= closest%piece) cycle
        outward = merge(die%corners(3:4, k), -die%corners(5:6, k), side == 1)
        way = dot_product(point - die%corners(1:2, k), outward)
        if (.not. way > 0) cycle
        release%slope = -2/(releasing*length)
        release%share = max(0.0_wp, 1 + release%slope*way)
        release%tangent = outward
        call mark_released(release, closest)
        return
      end do
    end do
  end subroutine slide_beyond

  !> Derivatives of the way past the corner.
  pure function motion_past_corner(side, point, release) result(motion)
    type(side_t), intent(in) :: side
    type(contact_point_t), intent(in) :: point
    type(release_t), intent(in) :: release
    real(wp) :: motion(ndof)   !! [length/unknown]
    real(wp) :: relative(2, ndof), lever(2), tangent(2)

    tangent = turned(release%tangent, side%pilot(3, 2))
    lever = point%x - side%pilot(1:2, 2)
    relative = point%dx(:, :ndof)
    relative(1, 7) = relative(1, 7) - 1
    relative(2, 8) = relative(2, 8) - 1
    relative(:, 9) = relative(:, 9) - [-lever(2), lever(1)]
    motion = matmul(tangent, relative)
  end function motion_past_corner

end module corner_release
