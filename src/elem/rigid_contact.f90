!> A point of a side against a rigid die: how the two meet, and where the force between them goes.
!>
!> The slip of a step is the displacement of the part's point relative to the die, taken in the axes of the
!> pilot, along the die's tangent: a rigid motion of part and die together makes none. The force acts
!> on the nodes of the side by their shape functions, and on the pilot with its moment.
!>
!> A point may be one that moves along its side as that moves, as that of a corner of the die does: drift_t.
module rigid_contact
  use closest_point, only: closest_point_t
  use contact_point, only: act, meeting_t
  use contact_state, only: at_penetration, at_piece, at_status, at_xi
  use corner_faces, only: stay_on_face
  use curve_search, only: closest_facing_point, follow_closest_point
  use dies, only: die_t
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use plane_vectors, only: turned
  use shape_functions, only: line3
  use side_points, only: contact_point_t, most_unknowns, side_point
  implicit none
  private
  public :: side_t, drift_t, place_point, press, meet, outer, closest_or_followed, motion_of_depth, nodes_in_axes, side_at_start
  public :: is_kept, ndof

  !> Local unknowns: x of the side's nodes, y of them, pilot x, y, angle, section; the last three are
  !> there in generalised plane strain only.
  integer, parameter :: ndof = 12

  !> A side in a step.
  type :: side_t
    !> Nodes at the start of the step [length], and motion of all local unknowns.
    real(wp) :: x(2, 3) = 0.0_wp, du(ndof) = 0.0_wp
    !> Pilot (x, y, angle) at the start of the step and at its end.
    real(wp) :: pilot(3, 2) = 0.0_wp
    !> Section at the end of the step (sections), and its change in the step.
    real(wp) :: section(3) = 0.0_wp, thickening(3) = 0.0_wp
    !> Chord in the mesh as it began: the distance within which the side searches [length].
    real(wp) :: length = 0.0_wp
    !> Normal and tangential penalty [stress/length].
    real(wp) :: penalty(2) = 0.0_wp
    !> End that is a node on the axis, 1 or 2; 0 for none.
    integer :: axis_end = 0
    !> Length of the step [time].
    real(wp) :: dt = 0.0_wp
    !> Matrices are wanted; contact is kept (instant_t).
    logical :: tangent = .true., kept = .false.
    !> Share of the penalties of points without a pressure at the start of the step (instant_t) [-].
    real(wp) :: penalty_share = 1.0_wp
  end type side_t

  !> Derivatives of a point's position on the side, and of the angle by which the normal of depth turns.
  type :: drift_t
    real(wp), dimension(ndof) :: dxi = 0.0_wp, spin = 0.0_wp
  end type drift_t

contains

  !> A side as it was at the start of the step, its die where that was.
  pure function side_at_start(side) result(start)
    type(side_t), intent(in) :: side
    type(side_t) :: start

    start = side
    start%du = 0
    start%pilot(:, 2) = side%pilot(:, 1)
  end function side_at_start

  !> The contact of a place of a side is kept: closed at the start of the step, its law is linearised at the depth that it had.
  pure function is_kept(side, committed) result(yes)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: committed(:)   !! (nstate) of the place [unit of each component]
    logical :: yes

    yes = side%kept .and. nint(committed(at_status)) /= contact_open
  end function is_kept

  !> Nodes of a side in the axes of the pilot, at the end of the step.
  pure function nodes_in_axes(side) result(nodes)
    type(side_t), intent(in) :: side
    real(wp) :: nodes(2, 3)   !! [length]
    integer :: k

    do k = 1, 3
      nodes(:, k) = turned([side%x(1, k) + side%du(k), side%x(2, k) + side%du(k + 3)] - side%pilot(1:2, 2), -side%pilot(3, 2))
    end do
  end function nodes_in_axes

  !> The point of a side at a parent coordinate, in the present geometry.
  pure subroutine place_point(side, xi, point)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi
    type(contact_point_t), intent(out) :: point
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    call side_point(phi, dphi, side%section, side%x, side%du(1:6), ndof, point)
  end subroutine place_point

  !> Contact of a point with its closest point on the die: state, forces, matrix.
  pure subroutine press(law, material, drivers, side, xi, point, closest, allowed, weight, committed, trial, force, stiffness, &
                        drift, released, dallowed, bearing)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi   !! parent coordinate on the side [-]
    type(contact_point_t), intent(in) :: point
    type(closest_point_t), intent(in) :: closest   !! in the pilot's axes
    real(wp), intent(in) :: allowed    !! depth that needs no pressure [length]
    real(wp), intent(in) :: weight
    real(wp), intent(in) :: committed(:)               !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)                !! (nstate) [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(drift_t), intent(in), optional :: drift       !! of a point that is not fixed on its side
    logical, intent(in), optional :: released          !! its contact is not kept
    real(wp), intent(in), optional :: dallowed(ndof)   !! derivatives of `allowed` [length/unknown]
    real(wp), intent(in), optional :: bearing          !! share of the area that bears the pressure [-]
    type(meeting_t) :: meeting
    real(wp) :: phi(3), dphi(3), lever(2), q(2), moment, dlever(2, ndof), dmoment(ndof), dq(2, most_unknowns)
    integer :: j, k

    trial(at_penetration) = closest%d
    trial(at_piece) = closest%piece
    trial(at_xi) = closest%xi
    call line3(xi, phi, dphi)
    lever = point%x - side%pilot(1:2, 2)
    dlever = point%dx(:, :ndof)
    dlever(1, 7) = dlever(1, 7) - 1
    dlever(2, 8) = dlever(2, 8) - 1
    call meet(side, phi, dphi, closest, lever, dlever, meeting, drift)
    meeting%allowed = allowed
    if (present(dallowed)) meeting%dd(:ndof) = meeting%dd(:ndof) - dallowed
    meeting%kept = side%kept
    meeting%penalty_share = side%penalty_share
    if (present(bearing)) meeting%bearing = bearing
    if (present(released)) meeting%kept = meeting%kept .and. .not. released
    call act(law, material, side%dt, drivers, side%penalty, point, meeting, weight, side%tangent, committed, trial, q, dq)
    if (nint(trial(at_status)) == contact_open) return

    moment = lever(1)*q(2) - lever(2)*q(1)
    force(1:3) = force(1:3) - phi*q(1)
    force(4:6) = force(4:6) - phi*q(2)
    force(7:8) = force(7:8) + q
    force(9) = force(9) + moment
    if (.not. side%tangent) return
    dmoment = dlever(1, :)*q(2) - dlever(2, :)*q(1) + lever(1)*dq(2, :ndof) - lever(2)*dq(1, :ndof)
    do j = 1, ndof
      do k = 1, 3
        stiffness(k, j) = stiffness(k, j) - phi(k)*dq(1, j)
        stiffness(k + 3, j) = stiffness(k + 3, j) - phi(k)*dq(2, j)
      end do
      stiffness(7:8, j) = stiffness(7:8, j) + dq(:, j)
      stiffness(9, j) = stiffness(9, j) + dmoment(j)
    end do
    if (.not. present(drift)) return
    stiffness(1:3, :) = stiffness(1:3, :) - q(1)*spread(dphi, 2, ndof)*spread(drift%dxi, 1, 3)
    stiffness(4:6, :) = stiffness(4:6, :) - q(2)*spread(dphi, 2, ndof)*spread(drift%dxi, 1, 3)
  end subroutine press

  !> Derivatives of the depth of a point of a side.
  pure function motion_of_depth(side, point, closest) result(dd)
    type(side_t), intent(in) :: side
    type(contact_point_t), intent(in) :: point
    type(closest_point_t), intent(in) :: closest   !! in the pilot's axes
    real(wp) :: dd(ndof)                           !! [length/unknown]
    real(wp) :: n(2), lever(2)

    n = turned(closest%normal, side%pilot(3, 2))
    lever = point%x - side%pilot(1:2, 2)
    dd = matmul(n, point%dx(:, :ndof))
    dd(7:8) = dd(7:8) - n
    dd(9) = dd(9) - dot_product(n, [-lever(2), lever(1)])
  end function motion_of_depth

  !> Depth, slip and turn of the normal, with their derivatives.
  pure subroutine meet(side, phi, dphi, closest, lever, dlever, meeting, drift)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: phi(3), dphi(3)   !! [-]
    type(closest_point_t), intent(in) :: closest
    real(wp), intent(in) :: lever(2)          !! from the pilot to the point [length]
    real(wp), intent(in) :: dlever(2, ndof)   !! derivatives of it [length/unknown]
    type(meeting_t), intent(out) :: meeting
    type(drift_t), intent(in), optional :: drift
    real(wp) :: n(2), t(2), turn(2), way(2), relative(2, ndof), dway(2, ndof), dt(2, ndof), rotation
    integer :: j

    n = turned(closest%normal, side%pilot(3, 2))
    t = [-n(2), n(1)]
    meeting%d = closest%d
    meeting%normal = n

    ! motion of the point relative to the die, and what it does to depth and normal
    relative = dlever
    relative(:, 9) = relative(:, 9) - [-lever(2), lever(1)]
    meeting%dd = 0
    meeting%dd(:ndof) = matmul(n, relative)
    meeting%turn = 0
    meeting%turn(:ndof) = closest%turn*matmul(t, relative)
    meeting%turn(9) = meeting%turn(9) + 1
    if (present(drift)) meeting%turn(:ndof) = drift%spin
    do j = 1, ndof
      dt(:, j) = -meeting%turn(j)*n
    end do

    ! displacement relative to the die, in its axes, turned into the present ones
    rotation = side%pilot(3, 2) - side%pilot(3, 1)
    turn = turned(matmul(side%x, phi) - side%pilot(1:2, 1), rotation)
    way = lever - turn
    dway = dlever
    dway(:, 9) = dway(:, 9) - [-turn(2), turn(1)]
    if (present(drift)) dway = dway - outer(turned(matmul(side%x, dphi), rotation), drift%dxi)
    meeting%slip = dot_product(t, way)
    meeting%dslip = 0
    meeting%dslip(:ndof) = matmul(t, dway) + matmul(way, dt)
  end subroutine meet

  !> Closest point on the die; where the point that continues the last accepted one shows that the side is inside, that one.
  pure subroutine closest_or_followed(die, point, e_r, reach, committed, closest)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)       !! in the pilot's axes [length]
    real(wp), intent(in) :: e_r(2)         !! inner normal of the part there, in the pilot's axes [-]
    real(wp), intent(in) :: reach          !! [length]
    real(wp), intent(in) :: committed(:)   !! (nstate) of the point [unit of each component]
    type(closest_point_t), intent(out) :: closest
    type(closest_point_t) :: same
    integer :: piece

    call closest_facing_point(die, point, e_r, reach, closest)
    piece = nint(committed(at_piece))
    if (piece == 0) return
    call follow_closest_point(die, point, e_r, reach, piece, committed(at_xi), same)
    if (same%piece > 0 .and. same%d > 0) closest = same
    if (nint(committed(at_status)) /= contact_open .and. closest%piece > 0) &
      call stay_on_face(die, point, e_r, reach, piece, closest)
  end subroutine closest_or_followed

  !> Outer product of two vectors.
  pure function outer(a, b) result(c)
    real(wp), intent(in) :: a(2), b(ndof)   !! [of any unit]
    real(wp) :: c(2, ndof)

    c = spread(a, 2, ndof)*spread(b, 1, 2)
  end function outer

end module rigid_contact
