!> Contact of a side, a parabola, by three conditions: at its end nodes and at its control point.
!>
!> The depth along a side, interpolated between its nodes, is a quadratic. Its Bernstein coefficients
!>
!>     d_1,   b = 2 d_m - (d_1 + d_2)/2,   d_2
!>
!> with the depths d_1, d_m, d_2 of the nodes, bound it: where none is positive, the side is nowhere in the die (convex hull
!> property of Bezier curves: G. Farin, Curves and Surfaces for CAGD, 5th ed., Morgan Kaufmann 2002, sec. 5.2). So a side that lies
!> on the die with one end leaves it along the die's tangent there; with a condition at its middle node it would bulge into the
!> die between the nodes. There are as many conditions as nodes.
!>
!> Where the die bends within the side, or has a corner there, the depths of the nodes are those of no quadratic: past a bend an
!> end may be far away, and the side rests on the die all the same. So the depth that counts is that under the die's tangent at
!> the closest point of the middle node, d_t, but for as much as a die of small curvature departs from its tangent:
!>
!>     d' = d_t - rho(d_t - d),   rho(e) = e (1 - (e/E)**2)**2 where |e| < E, else 0
!>
!> On a straight die d_t = d, and d' = d exactly; E is a quarter of the side, which a circle departs by where its radius is half
!> a side.
!>
!> The force is p db, the pressure times the derivatives of b with the tangent of the die held: on a flat die it does no work on a
!> side that slides at the same b. That the tangent turns on a curved die as the closest point of the middle node moves is in the
!> derivatives of the pressure and in the matrix, not in the force: it would push the middle node along the die, without friction.
!> What the force lacks for p db is this, for a motion s of the middle node along the die and its curvature k at the distance d_m,
!>
!>     -p k s/2 (w_1 t.(x_1 - x_m) + w_2 t.(x_2 - x_m)),   w = 1 - drho/de of the end,
!>
!> nothing where the middle node is half way along the tangent t and both ends depart alike. The areas are those of contact_areas.
module control_point_contact
  use closest_point, only: closest_point_t
  use contact_point, only: answer, meeting_t
  use contact_state, only: at_penetration, at_piece, at_xi
  use kinds, only: wp
  use law_api, only: law_t
  use materials, only: material_t
  use rigid_contact, only: drift_t, meet, ndof, side_t
  use shape_functions, only: line3
  use side_points, only: contact_point_t, most_unknowns
  use vectors, only: length_of
  implicit none
  private
  public :: node_t, control_t, find_control_point, press_control_point, end_area
  public :: control_shares

  !> Shares of the depths of the nodes in that of the control point, and of their motions in its.
  real(wp), parameter :: control_shares(3) = [-0.5_wp, 2.0_wp, -0.5_wp]
  !> E over the chord of the side at the start of the step.
  real(wp), parameter :: bend_range = 0.25_wp

  !> A node of the side, its closest point on the die, and that on the face of the die which the control point faces.
  type :: node_t
    type(contact_point_t) :: point
    type(closest_point_t) :: closest, face
  end type node_t

  !> What a node has in the depth of the control point: how it meets the die, its share db/dd and the derivatives of that.
  type :: node_share_t
    integer :: node = 0
    type(meeting_t) :: meeting
    real(wp) :: share = 0.0_wp, dshare(ndof) = 0.0_wp, lever(2) = 0.0_wp, dlever(2, ndof) = 0.0_wp
  end type node_share_t

  !> The control point: depth and slip, and its parts.
  type :: control_t
    type(meeting_t) :: meeting
    type(node_share_t) :: parts(5)
    integer :: n = 0
  end type control_t

contains

  !> Depth and slip of the control point.
  pure subroutine find_control_point(side, nodes, control)
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: nodes(3)
    type(control_t), intent(out) :: control
    type(node_share_t) :: own, tangent
    real(wp) :: rho(0:2), de(ndof), range
    integer :: i

    range = bend_range*length_of(side%x(:, 3) - side%x(:, 1))
    own = meet_node(side, nodes, 2, nodes(2)%face)
    call add_part(control, own, control_shares(2))
    control%meeting%normal = control%parts(1)%meeting%normal
    control%meeting%d = control_shares(2)*nodes(2)%face%d
    do i = 1, 3, 2
      tangent = meet_tangent(side, nodes, i)
      rho = 0
      if (nodes(i)%face%piece > 0) then
        own = meet_node(side, nodes, i, nodes(i)%face)
        rho = departure(tangent%meeting%d - own%meeting%d, range)
      end if
      if (abs(rho(1)) > 0 .or. abs(rho(2)) > 0) then
        de = tangent%meeting%dd(:ndof) - own%meeting%dd(:ndof)
        own%dshare = control_shares(i)*rho(2)*de
        tangent%dshare = -own%dshare
        call add_part(control, own, control_shares(i)*rho(1))
      end if
      call add_part(control, tangent, control_shares(i)*(1 - rho(1)))
      control%meeting%d = control%meeting%d + control_shares(i)*(tangent%meeting%d - rho(0))
    end do
    control%meeting%dd = 0
    control%meeting%slip = 0
    control%meeting%dslip = 0
    control%meeting%turn = 0
    do i = 1, control%n
      associate (part => control%parts(i), whole => control%meeting)
        whole%dd = whole%dd + part%share*part%meeting%dd
        whole%slip = whole%slip + part%share*part%meeting%slip
        whole%dslip = whole%dslip + part%share*part%meeting%dslip
        whole%dslip(:ndof) = whole%dslip(:ndof) + part%dshare*part%meeting%slip
      end associate
    end do
  end subroutine find_control_point

  !> One more part of a control point.
  pure subroutine add_part(control, part, share)
    type(control_t), intent(inout) :: control
    type(node_share_t), intent(in) :: part
    real(wp), intent(in) :: share   !! db/dd [-]

    control%n = control%n + 1
    control%parts(control%n) = part
    control%parts(control%n)%share = share
  end subroutine add_part

  !> What counts of a departure of the die from its tangent, and two derivatives.
  pure function departure(e, range) result(rho)
    real(wp), intent(in) :: e, range   !! [length]
    real(wp) :: rho(0:2)
    real(wp) :: x

    rho = 0
    x = e/range
    if (abs(x) < 1) rho = [e*(1 - x**2)**2, (1 - x**2)*(1 - 5*x**2), x*(20*x**2 - 12)/range]
  end function departure

  !> How a node meets a point of the die.
  pure function meet_node(side, nodes, i, closest, turn) result(part)
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: nodes(3)
    integer, intent(in) :: i
    type(closest_point_t), intent(in) :: closest
    type(drift_t), intent(in), optional :: turn
    type(node_share_t) :: part
    real(wp) :: phi(3), dphi(3)

    part%node = i
    part%lever = nodes(i)%point%x - side%pilot(1:2, 2)
    part%dlever = nodes(i)%point%dx(:, :ndof)
    part%dlever(1, 7) = part%dlever(1, 7) - 1
    part%dlever(2, 8) = part%dlever(2, 8) - 1
    call line3(real(i - 2, wp), phi, dphi)
    call meet(side, phi, dphi, closest, part%lever, part%dlever, part%meeting, turn)
  end function meet_node

  !> How an end node meets the tangent of the die at the closest point of the middle node. The tangent turns as that moves.
  pure function meet_tangent(side, nodes, i) result(part)
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: nodes(3)
    integer, intent(in) :: i
    type(node_share_t) :: part, middle
    type(closest_point_t) :: line
    type(drift_t) :: turn
    real(wp) :: n(2), t(2), way(2), relative(2, ndof)

    middle = meet_node(side, nodes, 2, nodes(2)%face)
    n = middle%meeting%normal
    t = [-n(2), n(1)]
    way = nodes(i)%point%x - nodes(2)%point%x + n*nodes(2)%face%d
    line = nodes(2)%face
    line%d = dot_product(n, way)
    relative = middle%dlever
    relative(:, 9) = relative(:, 9) - [-middle%lever(2), middle%lever(1)]
    turn%spin = middle%meeting%turn(:ndof)
    part = meet_node(side, nodes, i, line, turn)
    part%meeting%dd(:ndof) = part%meeting%dd(:ndof) + dot_product(t, way)*nodes(2)%face%turn*matmul(t, relative)
  end function meet_tangent

  !> Contact of the control point: state, forces, matrix.
  pure subroutine press_control_point(law, material, drivers, side, nodes, control, share, released, committed, trial, force, &
                                      stiffness)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: nodes(3)
    type(control_t), intent(inout) :: control
    real(wp), intent(in) :: share           !! of the force that acts, beside a corner of the die [-]
    logical, intent(in) :: released         !! its contact is not kept
    real(wp), intent(in) :: committed(:)               !! (nstate) [unit of each component]
    real(wp), intent(inout) :: trial(:)                !! (nstate) [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    real(wp) :: law_tangent(2, 2), area, darea(ndof), dslip(most_unknowns), pressure, tau, dp(ndof), dtau(ndof)
    real(wp) :: q(2), dq(2, ndof), traction(2), n(2), t(2), moment, dmoment(ndof)
    logical :: open
    integer :: i, j

    trial(at_penetration) = control%meeting%d
    trial(at_piece) = nodes(2)%face%piece
    trial(at_xi) = nodes(2)%face%xi
    control%meeting%kept = side%kept .and. .not. released
    control%meeting%penalty_share = side%penalty_share
    call answer(law, material, side%dt, drivers, side%penalty, control%meeting, committed, trial, pressure, tau, law_tangent, &
                dslip, open)
    if (open) return
    associate (point => nodes(2)%point)
      area = 2.0_wp/3*share*point%length*point%thickness
      darea = 2.0_wp/3*share*(point%dlength(:ndof)*point%thickness + point%length*point%dthickness(:ndof))
    end associate
    dp = law_tangent(1, 1)*control%meeting%dd(:ndof) + law_tangent(1, 2)*dslip(:ndof)
    dtau = law_tangent(2, 1)*control%meeting%dd(:ndof) + law_tangent(2, 2)*dslip(:ndof)
    do i = 1, control%n
      associate (part => control%parts(i), x => control%parts(i)%node)
        n = part%meeting%normal
        t = [-n(2), n(1)]
        traction = -(pressure*n + tau*t)
        q = traction*area*part%share
        moment = part%lever(1)*q(2) - part%lever(2)*q(1)
        force(x) = force(x) - q(1)
        force(x + 3) = force(x + 3) - q(2)
        force(7:8) = force(7:8) + q
        force(9) = force(9) + moment
        if (.not. side%tangent) cycle
        do j = 1, ndof
          dq(:, j) = -(dp(j)*n + dtau(j)*t + part%meeting%turn(j)*(pressure*t - tau*n))*area*part%share &
                     + traction*(darea(j)*part%share + area*part%dshare(j))
        end do
        dmoment = part%dlever(1, :)*q(2) - part%dlever(2, :)*q(1) + part%lever(1)*dq(2, :) - part%lever(2)*dq(1, :)
        stiffness(x, :) = stiffness(x, :) - dq(1, :)
        stiffness(x + 3, :) = stiffness(x + 3, :) - dq(2, :)
        stiffness(7:8, :) = stiffness(7:8, :) + dq
        stiffness(9, :) = stiffness(9, :) + dmoment
      end associate
    end do
  end subroutine press_control_point

  !> An end node as a point that has the area of its Bernstein polynomial: its length is that area, its thickness 1.
  pure function end_area(node, middle) result(point)
    type(contact_point_t), intent(in) :: node, middle
    type(contact_point_t) :: point

    point = node
    point%length = (node%length*node%thickness + middle%length*middle%thickness)/3
    point%dlength = (node%dlength*node%thickness + node%length*node%dthickness &
                     + middle%dlength*middle%thickness + middle%length*middle%dthickness)/3
    point%thickness = 1
    point%dthickness = 0
  end function end_area

end module control_point_contact
