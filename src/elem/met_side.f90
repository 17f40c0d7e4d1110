!> The force between a point of a side and a side of another body that it meets, and how it changes with the motion of both.
!>
!> The closest point, at xi, to a point X makes (X - Y).Y' = 0; with its unit tangent t, the inner normal n, the curvature kappa and
!> w = -n.dY'/|Y'|, the turn of the tangent at fixed xi, the depth d = (X - Y).n and the normal change by
!>
!>     dd = n.(dX - dY),   dn = t (kappa t.(dX - dY) + w)/(1 + kappa d),   dY at fixed xi.
!>
!> The closest point itself moves by dxi = (t.(dX - dY) - d w)/(|Y'| (1 + kappa d)).
!>
!> The slip of a step is the displacement of the point relative to the material point closest to it, in axes that
!> turn with the tangent there: with X0, Y0(xi), t0(xi) at the start of the step it is t0.(Y0 - X0),
!> since t.(X - Y) = 0 at its end. A rigid motion of both bodies makes none. At a vertex between two
!> sides the axes turn with the end of the first.
module met_side
  use closest_point, only: closest_point_t
  use contact_point, only: act, meeting_t
  use contact_state, only: at_status
  use edge_release, only: edge_release_t
  use kinds, only: eps, wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use pair_forces, only: spread_force, spread_matrix
  use pairs, only: nodes_per_piece
  use plane_vectors, only: cross
  use rigid_contact, only: side_t
  use shape_functions, only: line3
  use side_points, only: contact_point_t, most_unknowns
  use vectors, only: length_of
  implicit none
  private
  public :: pressed_point_t, hand_over, press_met, share_state

  !> At a vertex the normal turns about the closest point: turn d = 1 to some round-off.
  real(wp), parameter :: at_vertex = 64*eps

  !> A point of a side that meets sides of another body, one after the other.
  type :: pressed_point_t
    type(contact_point_t) :: point
    !> Shape functions of its side there, and its weight.
    real(wp) :: phi(3) = 0.0_wp, weight = 0.0_wp
    !> What an edge that it slides past leaves of its pressure.
    type(edge_release_t) :: release
    !> Where its unknowns stand among those of the element: of its side, of the side met, of the section; how many they are.
    integer :: place(most_unknowns) = 0, n = 0
    !> Of the side met last: shape functions at the closest point, how that moves along it, and the force on it.
    real(wp) :: psi(3) = 0.0_wp, dxi(most_unknowns) = 0.0_wp, q(2) = 0.0_wp
  end type pressed_point_t

contains

  !> The force between the point and a side that it meets, which bears this share of it; its state goes on to `state`. Unknowns of
  !> the element are x of all nodes, y of all nodes, and the section: those of the side first, then those of its pieces.
  subroutine press_met(law, material, drivers, side, x, du, pieces, met, share, pressed, committed, state, force, stiffness, &
                       unpaired)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: x(:, :)         !! (2, nnode) at the start of the step [length]
    real(wp), intent(in) :: du(:)           !! (ndof) motion in the step [unknown]
    integer, intent(in) :: pieces(:)        !! (npiece) of the die, those whose nodes are among the unknowns
    type(closest_point_t), intent(in) :: met
    real(wp), intent(in) :: share           !! [-]
    type(pressed_point_t), intent(inout) :: pressed
    real(wp), intent(in) :: committed(:)         !! (nstate) [unit of each component]
    real(wp), intent(inout) :: state(:)          !! (nstate) [unit of each component]
    real(wp), intent(inout) :: force(:)          !! (ndof) [force]
    real(wp), intent(inout) :: stiffness(:, :)   !! (ndof, ndof) [force/unknown]
    logical, intent(inout) :: unpaired           !! the side met is none of the pieces
    type(meeting_t) :: meeting
    real(wp) :: dq(2, most_unknowns), dpsi(3)
    integer :: j, k, at, nnode

    pressed%q = 0
    pressed%dxi = 0
    k = findloc(pieces, met%piece, 1)
    if (k == 0) then
      unpaired = .true.
      return
    end if
    nnode = size(x, 2)
    at = 3 + nodes_per_piece*(k - 1)
    pressed%place(7:12) = [at + 1, at + 2, at + 3, nnode + at + 1, nnode + at + 2, nnode + at + 3]
    call line3(met%xi, pressed%psi, dpsi)
    call meet(met, matmul(side%x, pressed%phi), x(:, at + 1:at + 3), du(pressed%place(7:12)), pressed%point, meeting, pressed%dxi)
    associate (q => pressed%q, dxi => pressed%dxi, phi => pressed%phi, psi => pressed%psi, place => pressed%place, &
               n => pressed%n, release => pressed%release)
      if (release%limited) then
        meeting%d = release%depth
        meeting%dd = release%depth_slope*dxi
      end if
      meeting%kept = side%kept
      meeting%penalty_share = side%penalty_share
      call act(law, material, side%dt, drivers, side%penalty, pressed%point, meeting, pressed%weight*share, side%tangent, &
               committed, state, q, dq)
      if (nint(state(at_status)) == contact_open) return
      call spread_force([-phi, psi], q, place, force)
      if (.not. side%tangent) return
      call spread_matrix([-phi, psi], dq(:, :n), place(:n), stiffness)
      ! the closest point moves along its side
      do j = 1, n
        call spread_force([0.0_wp, 0.0_wp, 0.0_wp, dpsi*dxi(j)], q, place, stiffness(:, place(j)))
        if (release%share < 1) call spread_force([-phi, psi]*(release%slope*dxi(j)/release%share), q, place, &
                                                 stiffness(:, place(j)))
      end do
    end associate
  end subroutine press_met

  !> The share of the force made last changes with the way along the side that the point began with.
  subroutine hand_over(pressed, along, change, stiffness)
    type(pressed_point_t), intent(in) :: pressed
    integer, intent(in) :: along(:)              !! (nunknown) places of the unknowns of the side that the point began with
    real(wp), intent(in) :: change(:)            !! (nunknown) of the share over the share, along those unknowns [1/unknown]
    real(wp), intent(inout) :: stiffness(:, :)   !! (ndof, ndof) [force/unknown]
    integer :: j

    do j = 1, pressed%n
      call spread_force([-pressed%phi, pressed%psi]*change(j), pressed%q, pressed%place, stiffness(:, along(j)))
    end do
  end subroutine hand_over

  !> The state of a point that is on two sides: that of the first becomes the mean of both; it is in contact where one of them is.
  pure subroutine share_state(share, other, state)
    real(wp), intent(in) :: share            !! of the other one [-]
    real(wp), intent(in) :: other(:)         !! (nstate) its state [unit of each component]
    real(wp), intent(inout) :: state(:)      !! (nstate) [unit of each component]
    real(wp) :: status

    status = state(at_status)
    if (nint(status) == contact_open .or. share > 0.5_wp .and. nint(other(at_status)) /= contact_open) status = other(at_status)
    state = state + share*(other - state)
    state(at_status) = status
  end subroutine share_state

  !> Depth, slip and turn of the normal where a point meets a side, with their derivatives, and the motion of the closest
  !> point along the side. Unknowns 7 to 12 are those of the side met.
  pure subroutine meet(closest, start, x, du, point, meeting, dxi)
    type(closest_point_t), intent(in) :: closest
    real(wp), intent(in) :: start(2)   !! the point at the start of the step [length]
    real(wp), intent(in) :: x(2, 3)    !! the side met, at the start of the step [length]
    real(wp), intent(in) :: du(6)      !! motion of its nodes, x then y
    type(contact_point_t), intent(in) :: point
    type(meeting_t), intent(out) :: meeting
    real(wp), intent(out) :: dxi(most_unknowns)
    real(wp) :: psi(3), dpsi(3), y(2, 3), t(2), n(2), first0(2), first(2), axis0(2), axis(2), t0(2), n0(2), gap0(2)
    real(wp) :: relative(2, most_unknowns), tangential(most_unknowns), turn_of_axes(most_unknowns), still, bend0

    call line3(closest%xi, psi, dpsi)
    y(1, :) = x(1, :) + du(1:3)
    y(2, :) = x(2, :) + du(4:6)
    first0 = matmul(x, dpsi)
    first = matmul(y, dpsi)
    axis0 = first0/length_of(first0)
    axis = first/length_of(first)
    n = closest%normal
    t = [-n(2), n(1)]
    meeting%d = closest%d
    meeting%normal = n

    relative = point%dx
    relative(1, 7:9) = -psi
    relative(2, 10:12) = -psi
    meeting%dd = matmul(n, relative)
    tangential = matmul(t, relative)
    turn_of_axes = 0
    turn_of_axes(7:9) = -axis(2)*dpsi/length_of(first)
    turn_of_axes(10:12) = axis(1)*dpsi/length_of(first)
    ! 1/(1 + kappa d), 0 at a vertex
    still = 1 - closest%turn*closest%d
    if (abs(still) <= at_vertex) still = 0
    meeting%turn = closest%turn*tangential + still*turn_of_axes

    dxi = still*(tangential - closest%d*turn_of_axes)/length_of(first)

    ! the tangent of the fan at a vertex, in axes that turn with the side
    t0 = dot_product(axis, t)*axis0 + cross(axis, t)*[-axis0(2), axis0(1)]
    n0 = [t0(2), -t0(1)]
    gap0 = start - matmul(x, psi)
    meeting%slip = -dot_product(t0, gap0)
    if (abs(still) > 0) then
      bend0 = cross(first0, x(:, 1) - 2*x(:, 2) + x(:, 3))/length_of(first0)**3
      meeting%dslip = length_of(first0)*(1 + bend0*dot_product(n0, gap0))*dxi
    else
      meeting%dslip = dot_product(n0, gap0)*(meeting%turn - turn_of_axes)
    end if
  end subroutine meet

end module met_side
