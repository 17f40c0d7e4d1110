!> Contact of a side with a rigid die by its end nodes and its control point (control_point_contact).
!>
!> The control point faces one face of the die (face_points): that of the closest point of the middle node when its contact
!> begins, and the same one as long as it lasts. Depths of the end nodes that count in it are those below that face. Where the
!> side already overlaps a face that it comes to face, as beside a corner of the die that the part fills, that is no reason
!> for a pressure: it begins from there (a multiplier that just takes the overlap's). On a new mesh the multiplier is such that
!> the pressure begins as it was carried there, however the side lies.
module side_contact
  use closest_point, only: closest_point_t
  use contact_state, only: at_augmentation, at_penetration, at_piece, at_pressure, at_status, at_xi
  use control_point_contact, only: control_t, end_area, find_control_point, node_t, press_control_point
  use corner_release, only: motion_past_corner, passes_corner, release_t, slide_beyond, slide_past_corner
  use dies, only: die_t
  use face_points, only: closest_on_face
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use materials, only: material_t
  use plane_vectors, only: left_of, turned
  use rigid_contact, only: closest_or_followed, ndof, place_point, press, side_at_start, side_t
  use side_points, only: contact_point_t, touching
  use start_depths, only: state_at_start
  implicit none
  private
  public :: press_side

  !> Parent coordinates of the nodes.
  real(wp), parameter :: place(3) = [-1.0_wp, 0.0_wp, 1.0_wp]

contains

  !> States, forces and matrix of a side.
  pure subroutine press_side(die, law, material, drivers, side, committed, trial, force, stiffness)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :, :)   !! (ndriver, 2, 3) of the law [unit of each driver]
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: committed(:, :)            !! (nstate, 3) [unit of each component]
    real(wp), intent(inout) :: trial(:, :)             !! (nstate, 3) [unit of each component]
    real(wp), intent(inout) :: force(ndof)             !! [force]
    real(wp), intent(inout) :: stiffness(ndof, ndof)   !! [force/unknown]
    type(node_t) :: nodes(3)
    type(release_t) :: release
    real(wp) :: before(ndof), bearing(3), start(size(committed, 1))
    integer :: i

    do i = 1, 3
      call place_point(side, place(i), nodes(i)%point)
    end do
    bearing = bearing_shares(nint(committed(at_status, :)) /= contact_open)
    do i = 1, 3, 2
      call find_closest(die, side, nodes(i), inward(nodes(i)%point, nodes(2)%point, place(i)), committed(:, i), nodes(i)%closest, &
                        release)
      if (nodes(i)%closest%piece == 0) cycle
      start = committed(:, i)
      if (nodes(i)%closest%d > 0) start = state_at_start(die, side, place(i), committed(:, i))
      before = force
      call press(law, material, drivers(:, :, i), side, place(i), end_area(nodes(i)%point, nodes(2)%point), nodes(i)%closest, &
                 0.0_wp, release%share, start, trial(:, i), force, stiffness, &
                 released=side%kept .and. passes_corner(die, committed(:, i), nodes(i)%closest), bearing=bearing(i))
      call add_release(side, nodes(i), release, force - before, stiffness)
    end do
    call press_control(die, law, material, drivers(:, :, 2), side, nodes, bearing(2), committed(:, 2), trial(:, 2), force, &
                       stiffness)
  end subroutine press_side

  !> Shares of the areas of a side's ends and control point that bear pressure, as the step begins: half where the side goes away
  !> from the die there, which a limit of the friction stress must not take for contact. What is in contact then, an end alone or
  !> an end and the control point, bears on a sixth and on a half of the side, as the points of Simpson's rule do.
  pure function bearing_shares(closed) result(shares)
    logical, intent(in) :: closed(3)
    real(wp) :: shares(3)

    shares = 1
    if (.not. any(closed)) return
    if (.not. closed(2)) shares([1, 3]) = 0.5_wp
    if (.not. (closed(1) .and. closed(3))) shares(2) = 0.5_wp
  end function bearing_shares

  !> Closest point of a node, on the face that it slides past where it loses its pressure beside a corner.
  pure subroutine find_closest(die, side, node, normal, committed, closest, release)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: node
    real(wp), intent(in) :: normal(2)   !! inner normal of the part [-]
    real(wp), intent(in) :: committed(:)
    type(closest_point_t), intent(out) :: closest
    type(release_t), intent(out) :: release
    real(wp) :: x(2), e_r(2)

    x = in_axes(side, node%point%x)
    e_r = turned(normal, -side%pilot(3, 2))
    call closest_or_followed(die, x, e_r, side%length, committed, closest)
    if (.not. (closest%piece > 0 .and. closest%d > 0)) &
      call slide_past_corner(die, x, e_r, side%length, committed, closest, release)
    if (closest%piece > 0 .and. abs(closest%d) <= touching*side%length) closest%d = 0
  end subroutine find_closest

  !> Inner normal of the half of a side at its end: the tangent at the end itself is none where the middle node has come to a
  !> quarter of the side.
  pure function inward(node, middle, place) result(normal)
    type(contact_point_t), intent(in) :: node, middle
    real(wp), intent(in) :: place   !! of the end, -1 or 1
    real(wp) :: normal(2)

    normal = left_of(place*(node%x - middle%x))
  end function inward

  !> A point in the axes of the pilot at the end of the step.
  pure function in_axes(side, x) result(y)
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: x(2)
    real(wp) :: y(2)

    y = turned(x - side%pilot(1:2, 2), -side%pilot(3, 2))
  end function in_axes

  !> The share of its pressure that a point has beside a corner changes with its way.
  pure subroutine add_release(side, node, release, force, stiffness)
    type(side_t), intent(in) :: side
    type(node_t), intent(in) :: node
    type(release_t), intent(in) :: release
    real(wp), intent(in) :: force(ndof)
    real(wp), intent(inout) :: stiffness(ndof, ndof)

    if (.not. (side%tangent .and. release%share < 1)) return
    stiffness = stiffness + release%slope/release%share*spread(force, 2, ndof) &
                *spread(motion_past_corner(side, node%point, release), 1, ndof)
  end subroutine add_release

  !> Contact of the control point.
  pure subroutine press_control(die, law, material, drivers, side, nodes, bearing, committed, trial, force, stiffness)
    type(die_t), intent(in) :: die
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:, :)
    type(side_t), intent(in) :: side
    type(node_t), intent(inout) :: nodes(3)
    real(wp), intent(in) :: bearing
    real(wp), intent(in) :: committed(:)
    real(wp), intent(inout) :: trial(:), force(ndof), stiffness(ndof, ndof)
    type(control_t) :: control
    type(release_t) :: release
    real(wp) :: before(ndof), start(size(committed)), depth(2)
    type(closest_point_t) :: seen
    logical :: open, new

    open = nint(committed(at_status)) == contact_open
    new = nint(committed(at_piece)) == 0
    if (open .or. new) then
      call closest_or_followed(die, in_axes(side, nodes(2)%point%x), turned(nodes(2)%point%e_r, -side%pilot(3, 2)), side%length, &
                               committed, nodes(2)%face)
      if (nodes(2)%face%piece == 0) return
    else
      call closest_on_face(die, in_axes(side, nodes(2)%point%x), nint(committed(at_piece)), committed(at_xi), nodes(2)%face)
      call slide_beyond(die, in_axes(side, nodes(2)%point%x), side%length, nodes(2)%face, release)
      if (.not. release%share > 0) return
    end if
    call face_nodes(die, side, nodes, control)
    start = committed
    if (open .and. control%meeting%d > 0) then
      call depth_at_start(die, side, nodes(2)%face, depth)
      start(at_augmentation) = -side%penalty(1)*max(0.0_wp, depth(2) - max(0.0_wp, depth(1)))
      if (new) start(at_penetration) = depth(2)
    else if (new .and. .not. open) then
      call depth_at_start(die, side, nodes(2)%face, depth)
      start(at_augmentation) = committed(at_pressure) - side%penalty(1)*depth(2)
      start(at_penetration) = depth(2)
    end if
    control%meeting%bearing = bearing
    before = force
    seen = nodes(2)%face
    seen%d = control%meeting%d
    call press_control_point(law, material, drivers, side, nodes, control, release%share, &
                             side%kept .and. passes_corner(die, committed, seen), start, trial, force, stiffness)
    call add_release(side, nodes(2), release, force - before, stiffness)
  end subroutine press_control

  !> The nodes below the face of the middle node, and the control point.
  pure subroutine face_nodes(die, side, nodes, control)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    type(node_t), intent(inout) :: nodes(3)
    type(control_t), intent(out) :: control
    integer :: i

    do i = 1, 3, 2
      call closest_on_face(die, in_axes(side, nodes(i)%point%x), nodes(2)%face%piece, nodes(2)%face%xi, nodes(i)%face)
    end do
    do i = 1, 3
      if (abs(nodes(i)%face%d) <= touching*side%length) nodes(i)%face%d = 0
    end do
    call find_control_point(side, nodes, control)
  end subroutine face_nodes

  !> How deep the middle node and the control point are below a face at the start of the step.
  pure subroutine depth_at_start(die, side, face, depth)
    type(die_t), intent(in) :: die
    type(side_t), intent(in) :: side
    type(closest_point_t), intent(in) :: face
    real(wp), intent(out) :: depth(2)   !! [length], 0 where there is none
    type(side_t) :: start
    type(node_t) :: nodes(3)
    type(control_t) :: control
    integer :: i

    start = side_at_start(side)
    do i = 1, 3
      call place_point(start, place(i), nodes(i)%point)
    end do
    depth = 0
    call closest_on_face(die, in_axes(start, nodes(2)%point%x), face%piece, face%xi, nodes(2)%face)
    if (nodes(2)%face%piece == 0) return
    call face_nodes(die, start, nodes, control)
    depth = [nodes(2)%face%d, control%meeting%d]
  end subroutine depth_at_start

end module side_contact
