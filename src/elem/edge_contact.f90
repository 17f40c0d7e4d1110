!> Edges of a deformable die, the sharp corners of its body, as points of contact of their own with the sides that face it.
!>
!> As the corner of a rigid die (corner_contact) an edge sticks into a side between its points, however many there are: the deepest
!> one in each interval between two points acts there, on what is deeper than half the allowed penetration, along the side's own
!> inner normal, or along that of the face which the side lies on (side_corners). It stands for half of the side (corner_weights).
!> The force goes to the nodes of the side by their shape functions, its opposite to the node of the edge.
!>
!> With the place y(xi) on the side closest to the edge V, (V - y).y' = 0, it moves by
!>
!>     dxi = (y'.(dV - dy) + (V - y).dy')/(y'.y' - (V - y).y''),   dy, dy' at fixed xi.
!>
!> The slip of a step is what the material point at xi has moved relative to the edge, in axes that turn with the side, or with the
!> face: a rigid motion of both bodies makes none.
module edge_contact
  use contact_overlap, only: share_to_contact
  use contact_penalties, only: allowed_penetration
  use contact_point, only: act, meeting_t
  use contact_state, only: at_augmentation, at_penetration, at_piece, at_status, at_work, at_xi, contact_block
  use corner_states, only: corner_share
  use corner_weights, only: corner_length, handing_over, interval_before, share_past_node
  use dies, only: die_t
  use edge_states, only: edge_at_start
  use elem_api, only: report_t
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use pair_forces, only: spread_force, spread_matrix
  use pairs, only: nodes_per_piece
  use piecewise_curves, only: adjacent_piece
  use plane_vectors, only: cross, left_of
  use rigid_contact, only: side_t
  use shape_functions, only: line3
  use side_corners, only: corner_t, deepest_corner
  use side_points, only: contact_point_t, most_unknowns, no_surface, side_point, thinning
  use vectors, only: length_of
  implicit none
  private
  public :: press_edges

  !> y'' of a side over its nodes.
  real(wp), parameter :: second(3) = [1.0_wp, -2.0_wp, 1.0_wp]

  !> No depth of contact is as large: an edge that was deeper behind a side as the step began, over its length, without being in
  !> contact with it, is beside another side of the body, as where that lies round the edge with a corner of its own.
  real(wp), parameter :: deepest_start = 0.1_wp

  !> Nodes of a piece of the die at the start of the step [length], and their motion, x then y; the edge is the first or the third.
  type :: edge_piece_t
    real(wp) :: x(2, 3) = 0.0_wp, du(6) = 0.0_wp
    integer :: node = 0
  end type edge_piece_t

contains

  !> Contact of a side with the edges of a die. States are of all points of the side (nstate, npoint). Unknowns of the element are x
  !> of all nodes, y of all nodes, and the section: those of the side first, then those of its pieces.
  pure subroutine press_edges(die, law, material, drivers, axisym, side, xi, pieces, x, du, committed, trial, force, &
                              stiffness, report)
    type(die_t), intent(in) :: die                     !! as it is now, with its edges
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :, :)           !! (ndriver, 2, npoint) of the law [unit of each driver]
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: xi(:)                      !! (npoint) [-]
    integer, intent(in) :: pieces(:)                   !! (npiece) of the die, those whose nodes are among the unknowns
    real(wp), intent(in) :: x(:, :)                    !! (2, nnode) at the start of the step [length]
    real(wp), intent(in) :: du(:)                      !! (nunknown) motion in the step [unknown]
    real(wp), intent(in) :: committed(:, :)            !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: trial(:, :)             !! (nstate, npoint) [unit of each component]
    real(wp), intent(inout) :: force(:)                !! (nunknown) [force]
    real(wp), intent(inout) :: stiffness(:, :)         !! (nunknown, nunknown) [force/unknown]
    type(report_t), intent(inout) :: report
    type(corner_t) :: corner
    type(edge_piece_t) :: piece
    real(wp) :: nodes(2, 3), from, to, done, before(contact_block(.true., size(trial, 1))), worn(1)
    integer :: place(most_unknowns), p, n, at_place

    if (size(die%corners, 2) == 0 .or. .not. allowed_penetration(material) > 0) return
    nodes = side%x + reshape(side%du([1, 4, 2, 5, 3, 6]), [2, 3])
    if (.not. is_near(die, nodes, side%length)) return
    n = size(before)
    at_place = 2*n + 1
    do p = 1, size(xi)
      call interval_before(xi, p, from, to)
      if (.not. to > from) cycle
      call deepest_corner(die, nodes, from, to, side%length, corner, handing_over)
      if (.not. corner%found) cycle
      call take_piece(die, corner, pieces, x, du, piece, place)
      ! an edge that none of the side's points is coupled with is farther away than any of its points
      if (piece%node == 0) cycle
      before = edge_at_start(committed, p, corner%piece)
      if (nint(before(at_status)) == contact_open .and. depth_at_start(side, corner%place, piece) > deepest_start*side%length) cycle
      trial(at_place:, p) = [corner%place, share_past_node(corner%place)]
      associate (now => trial(n + 1:2*n, p))
        worn = thinning(committed(at_place:at_place, p), [corner%place], side%section, side%thickening, side%x, side%du(1:6))
        now(at_work) = before(at_work)*worn(1)
        done = now(at_work)
        call edge_at(law, material, drivers(:, :, p), axisym, side, corner, piece, corner_length(xi, p, .true.), place, before, &
                     now, force, stiffness)
        ! friction acts with the share of the edge
        now(at_work) = done + share_past_node(corner%place)*(now(at_work) - done)
        if (nint(before(at_status)) /= contact_open) then
          report%jump = max(report%jump, abs(now(at_penetration) - before(at_penetration))/side%length)
        end if
        report%event = min(report%event, share_to_contact(before, now, side%length))
      end associate
    end do
  end subroutine press_edges

  !> How deep an edge was behind a place of the side as the step began [length].
  pure function depth_at_start(side, place, piece) result(depth)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: place   !! [-]
    type(edge_piece_t), intent(in) :: piece
    real(wp) :: depth
    real(wp) :: phi(3), dphi(3)

    call line3(place, phi, dphi)
    depth = dot_product(piece%x(:, piece%node) - matmul(side%x, phi), left_of(matmul(side%x, dphi)))
  end function depth_at_start

  !> There is an edge within `reach` of the box around a side.
  pure function is_near(die, nodes, reach) result(near)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: nodes(2, 3)   !! [length]
    real(wp), intent(in) :: reach         !! [length]
    logical :: near
    integer :: k

    near = .false.
    do k = 1, size(die%corners, 2)
      near = near .or. all(die%corners(1:2, k) > minval(nodes, 2) - reach .and. die%corners(1:2, k) < maxval(nodes, 2) + reach)
    end do
  end function is_near

  !> The piece of an edge whose nodes take part: that of the face whose normal acts, else whichever the side is coupled with.
  pure subroutine take_piece(die, corner, pieces, x, du, piece, place)
    type(die_t), intent(in) :: die
    type(corner_t), intent(in) :: corner
    integer, intent(in) :: pieces(:)
    real(wp), intent(in) :: x(:, :), du(:)
    type(edge_piece_t), intent(out) :: piece
    integer, intent(out) :: place(most_unknowns)   !! of the unknowns of side, piece and section among those of the element
    integer :: k, at, nnode

    k = 0
    if (corner%face < 2) k = findloc(pieces, corner%piece, 1)
    piece%node = 3
    if (k == 0 .and. corner%face /= 1) then
      k = findloc(pieces, adjacent_piece(die, corner%piece, 1), 1)
      piece%node = 1
    end if
    place = 0
    if (k == 0) piece%node = 0
    if (k == 0) return
    nnode = size(x, 2)
    at = 3 + nodes_per_piece*(k - 1)
    place = [1, 2, 3, nnode + 1, nnode + 2, nnode + 3, at + 1, at + 2, at + 3, nnode + at + 1, nnode + at + 2, nnode + at + 3, &
             2*nnode + 1, 2*nnode + 2, 2*nnode + 3]
    piece%x = x(:, at + 1:at + 3)
    piece%du = du(place(7:12))
  end subroutine take_piece

  !> Contact at one edge: state, forces, matrix.
  pure subroutine edge_at(law, material, drivers, axisym, side, corner, piece, weight, place, committed, trial, force, stiffness)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    logical, intent(in) :: axisym
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    type(edge_piece_t), intent(in) :: piece
    real(wp), intent(in) :: weight
    integer, intent(in) :: place(most_unknowns)
    real(wp), intent(in) :: committed(:)
    real(wp), intent(inout) :: trial(:), force(:), stiffness(:, :)
    type(contact_point_t) :: point
    type(meeting_t) :: meeting
    real(wp) :: phi(3), dphi(3), psi(3), dxi(most_unknowns), q(2), dq(2, most_unknowns), allowed, share, toward_end
    integer :: j, n

    call line3(corner%place, phi, dphi)
    call side_point(phi, dphi, side%section, side%x, side%du(1:6), most_unknowns, point)
    trial([at_penetration, at_piece, at_xi]) = [corner%d, real(corner%piece, wp), corner%xi]
    if (axisym .and. point%x(1) <= no_surface*side%length) return
    allowed = corner_share*allowed_penetration(material)*side%length
    share = share_past_node(corner%place)
    ! its gap is known; where it is far enough beyond an end the next side has it
    if (.not. (committed(at_augmentation) + side%penalty(1)*(corner%d - allowed) > 0 .and. share > 0)) return
    call follow_edge(side, corner, piece, dphi, point, meeting, dxi)
    meeting%allowed = allowed
    meeting%kept = side%kept
    meeting%penalty_share = side%penalty_share
    call act(law, material, side%dt, drivers, side%penalty, point, meeting, weight*share, side%tangent, committed, trial, q, dq)
    if (nint(trial(at_status)) == contact_open) return
    psi = 0
    psi(piece%node) = 1
    call spread_force([-phi, psi], q, place, force)
    if (.not. side%tangent) return
    n = most_unknowns
    if (maxval(place) > size(force)) n = most_unknowns - 3
    ! the share changes with the position: d(ln share) = -sign(place)/(1 + handing_over - |place|) d(place)
    toward_end = 0
    if (share < 1) toward_end = sign(1.0_wp, corner%place)/(1 + handing_over - abs(corner%place))
    do j = 1, n
      dq(:, j) = dq(:, j) - toward_end*dxi(j)*q
    end do
    call spread_matrix([-phi, psi], dq(:, :n), place(:n), stiffness)
    ! the edge moves along the side
    do j = 1, n
      call spread_force([-dphi*dxi(j), 0.0_wp, 0.0_wp, 0.0_wp], q, place, stiffness(:, place(j)))
    end do
  end subroutine edge_at

  !> Depth, slip and turn of the normal at an edge, with their derivatives; its position on the side, and the point there, move.
  pure subroutine follow_edge(side, corner, piece, dphi, point, meeting, dxi)
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    type(edge_piece_t), intent(in) :: piece
    real(wp), intent(in) :: dphi(3)
    type(contact_point_t), intent(inout) :: point   !! that at a fixed position becomes the one that moves
    type(meeting_t), intent(out) :: meeting
    real(wp), intent(out) :: dxi(most_unknowns)
    real(wp), dimension(2, most_unknowns) :: relative, dtangent
    real(wp) :: phi(3), way(2), bend(2), t(2), first0(2), start(2), apart(2), dpsi(3), axis0(2), axis(2)
    integer :: j

    call line3(corner%place, phi, dpsi)
    way = piece%x(:, piece%node) + piece%du([piece%node, piece%node + 3]) - point%x
    bend = matmul(side%x, second) + [dot_product(second, side%du(1:3)), dot_product(second, side%du(4:6))]
    dtangent = 0
    dtangent(1, 1:3) = dphi
    dtangent(2, 4:6) = dphi
    relative = point%dx
    relative(1, 6 + piece%node) = relative(1, 6 + piece%node) - 1
    relative(2, 9 + piece%node) = relative(2, 9 + piece%node) - 1
    dxi = (matmul(way, dtangent) - matmul(point%tangent, relative))/(point%length**2 - dot_product(way, bend))
    do j = 1, most_unknowns
      relative(:, j) = relative(:, j) + point%tangent*dxi(j)
      point%dx(:, j) = point%dx(:, j) + point%tangent*dxi(j)
      dtangent(:, j) = dtangent(:, j) + bend*dxi(j)
    end do
    point%dlength = matmul(point%tangent, dtangent)/point%length
    point%dthickness = point%dthickness + dot_product(side%section(2:3), point%tangent)*dxi

    meeting%d = corner%d
    meeting%normal = corner%normal
    t = left_of(corner%normal)
    ! the material point and the edge at the start of the step
    start = matmul(side%x, phi)
    first0 = matmul(side%x, dphi)
    apart = start - piece%x(:, piece%node)
    if (corner%own) then
      meeting%turn = matmul(point%e_r, dtangent)/point%length
      meeting%dd = matmul(corner%normal, relative)
      meeting%slip = -dot_product(first0, apart)/length_of(first0)
      meeting%dslip = -(length_of(first0) + cross(first0, matmul(side%x, second))*cross(first0, apart)/length_of(first0)**3)*dxi
    else
      call line3(merge(1.0_wp, -1.0_wp, piece%node == 3), phi, dpsi)
      axis0 = matmul(piece%x, dpsi)
      axis = axis0 + [dot_product(dpsi, piece%du(1:3)), dot_product(dpsi, piece%du(4:6))]
      meeting%turn = 0
      meeting%turn(7:9) = -axis(2)*dpsi/dot_product(axis, axis)
      meeting%turn(10:12) = axis(1)*dpsi/dot_product(axis, axis)
      axis0 = axis0/length_of(axis0)
      meeting%dd = matmul(corner%normal, relative) - dot_product(t, way)*meeting%turn
      meeting%slip = -dot_product(t, way) - dot_product(axis0, apart)
      meeting%dslip = matmul(t, relative) - corner%d*meeting%turn - dot_product(axis0, first0)*dxi
    end if
  end subroutine follow_edge

end module edge_contact
