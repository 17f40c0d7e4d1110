!> Scenes of blocks and dies in known states, for the tests of the contour.
module contour_cases
  use block_mesh, only: block_t, mesh_block
  use boundary_curves, only: boundary_curve_t
  use contact_contour, only: find_contact_ends
  use contact_ends, only: contact_end_t
  use contour_contacts, only: contact_t
  use corrected_contours, only: contour_t
  use dies, only: die_t, finish_die, present_die
  use fields, only: displacement_field, mechanical_fields, pilot_field
  use kinds, only: wp
  use loop_intervals, only: side_point_t
  use quadrature, only: line_rule, rule_of_number
  use scene, only: axisymmetric, group_t, plane_strain, role_body, role_contact, scene_t
  use shape_functions, only: line3
  use solution, only: present_coordinates, solution_t, start_solution
  use state_variables, only: state_variable, transfer_recompute
  use vectors, only: length_of
  implicit none
  private
  public :: begin_scene, add_block, join_nodes, add_contact, add_die, polyline, start, ends_of, touch, box, arc_side
  public :: joints_of_kind, limit_place_t, limit_places

  !> Where a beginning or an end of contact is.
  type :: limit_place_t
    !> Contour, and its arc that begins there.
    integer :: contour = 0, arc = 0
    integer :: group = 0
    !> The die, its piece and the parent coordinate on it.
    integer :: die = 0, piece = 0
    real(wp) :: die_xi = 0.0_wp
    !> Side of the loop and the parent coordinate on it.
    integer :: side = 0
    real(wp) :: part_xi = 0.0_wp
  end type limit_place_t

contains

  !> A scene without anything.
  subroutine begin_scene(scene, round)
    type(scene_t), intent(out) :: scene
    logical, intent(in) :: round   !! about an axis

    scene%plane_state = merge(axisymmetric, plane_strain, round)
    scene%section = merge([0.0_wp, 1.0_wp, 0.0_wp], [1.0_wp, 0.0_wp, 0.0_wp], round)
    scene%fields = mechanical_fields()
    allocate (scene%groups(0), scene%dies(0), scene%fixations(0), scene%mesh%coordinates(2, 0), scene%mesh%sides(0), &
              scene%mesh%labels(0))
  end subroutine begin_scene

  !> A rectangle of straight sides.
  function box(low, high, divisions) result(block)
    real(wp), intent(in) :: low(2), high(2)
    integer, intent(in) :: divisions(2)
    type(block_t) :: block

    block%corners = reshape([low, high(1), low(2), high, low(1), high(2)], [2, 4])
    block%divisions = divisions
  end function box

  !> Add a block as a group, with its four sides as sets NAME.1 ... NAME.4.
  subroutine add_block(scene, name, block)
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: name
    type(block_t), intent(in) :: block
    type(group_t) :: group
    real(wp), allocatable :: coordinates(:, :), all_coordinates(:, :)
    integer, allocatable :: connectivity(:, :), side_nodes(:, :)
    integer :: side_first(5), k, n

    call mesh_block(block, coordinates, connectivity, side_first, side_nodes)
    n = size(scene%mesh%coordinates, 2)
    allocate (all_coordinates(2, n + size(coordinates, 2)))
    all_coordinates(:, :n) = scene%mesh%coordinates
    all_coordinates(:, n + 1:) = coordinates
    call move_alloc(all_coordinates, scene%mesh%coordinates)
    scene%mesh%labels = [(k, k=1, size(scene%mesh%coordinates, 2))]
    group%name = name
    group%elem = 'PL8LS'
    group%role = role_body
    group%material = 1
    group%rule%n = 4
    group%connectivity = n + connectivity
    allocate (group%variables(0))
    call append_group(scene, group)
    do k = 1, 4
      call append_set(scene, name//'.'//achar(48 + k), n + side_nodes(:, side_first(k):side_first(k + 1) - 1))
    end do
  end subroutine add_block

  subroutine append_group(scene, group)
    type(scene_t), intent(inout) :: scene
    type(group_t), intent(in) :: group
    type(group_t), allocatable :: groups(:)

    allocate (groups(size(scene%groups) + 1))
    groups(:size(scene%groups)) = scene%groups
    groups(size(groups)) = group
    call move_alloc(groups, scene%groups)
  end subroutine append_group

  subroutine append_set(scene, name, nodes)
    use mesh, only: side_set_t
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: name
    integer, intent(in) :: nodes(:, :)
    type(side_set_t), allocatable :: sets(:)

    allocate (sets(size(scene%mesh%sides) + 1))
    sets(:size(scene%mesh%sides)) = scene%mesh%sides
    sets(size(sets))%name = name
    sets(size(sets))%nodes = nodes
    call move_alloc(sets, scene%mesh%sides)
  end subroutine append_set

  !> Coincident nodes become one, in all blocks.
  subroutine join_nodes(scene)
    type(scene_t), intent(inout) :: scene
    integer :: into(size(scene%mesh%coordinates, 2)), i, k, j
    real(wp), parameter :: apart = 1.0e-9_wp

    do i = 1, size(into)
      into(i) = i
      do k = 1, i - 1
        if (abs(scene%mesh%coordinates(1, i) - scene%mesh%coordinates(1, k)) > apart) cycle
        if (length_of(scene%mesh%coordinates(:, i) - scene%mesh%coordinates(:, k)) > apart) cycle
        into(i) = k
        exit
      end do
    end do
    do k = 1, size(scene%groups)
      do j = 1, size(scene%groups(k)%connectivity, 2)
        scene%groups(k)%connectivity(:, j) = into(scene%groups(k)%connectivity(:, j))
      end do
    end do
    do k = 1, size(scene%mesh%sides)
      do j = 1, size(scene%mesh%sides(k)%nodes, 2)
        scene%mesh%sides(k)%nodes(:, j) = into(scene%mesh%sides(k)%nodes(:, j))
      end do
    end do
  end subroutine join_nodes

  !> A curved side of a block: the arc about a centre.
  subroutine arc_side(block, side, centre)
    use block_mesh, only: side_arc
    type(block_t), intent(inout) :: block
    integer, intent(in) :: side
    real(wp), intent(in) :: centre(2)

    block%form(side) = side_arc
    block%point(:, side) = centre
  end subroutine arc_side

  !> A die of straight pieces through points, about a pilot.
  function polyline(points, pilot) result(die)
    real(wp), intent(in) :: points(:, :)
    real(wp), intent(in) :: pilot(3)
    type(die_t) :: die
    integer :: k

    allocate (die%pieces(2, 3, size(points, 2) - 1))
    do k = 1, size(die%pieces, 3)
      die%pieces(:, 1, k) = points(:, k)
      die%pieces(:, 2, k) = 0.5_wp*(points(:, k) + points(:, k + 1))
      die%pieces(:, 3, k) = points(:, k + 1)
    end do
    die%pilot = pilot
    die%name = 'tool'
    call finish_die(die)
  end function polyline

  subroutine add_die(scene, die)
    type(scene_t), intent(inout) :: scene
    type(die_t), intent(in) :: die
    type(die_t), allocatable :: dies(:)

    allocate (dies(size(scene%dies) + 1))
    dies(:size(scene%dies)) = scene%dies
    dies(size(dies)) = die
    call move_alloc(dies, scene%dies)
  end subroutine add_die

  !> Contact elements on a set of sides.
  subroutine add_contact(scene, set, die, npoint)
    type(scene_t), intent(inout) :: scene
    integer, intent(in) :: set, die, npoint
    type(group_t) :: group

    group%name = scene%mesh%sides(set)%name
    group%elem = 'CNT2D'
    group%role = role_contact
    group%material = 1
    group%die = die
    group%rule = rule_of_number(npoint)
    group%connectivity = scene%mesh%sides(set)%nodes
    allocate (group%variables, source=[state_variable('penetration', 'length', transfer_recompute), &
                                      state_variable('contact_status', '-', transfer_recompute)])
    group%variables(1)%first = 1
    group%variables(2)%first = 2
    call append_group(scene, group)
  end subroutine add_contact

  !> A solution without displacement.
  subroutine start(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(out) :: solution

    call start_solution(scene, solution)
  end subroutine start

  !> Points whose depth in a flat die y = height (the body above it when `above`) is positive are in contact.
  subroutine touch(scene, solution, group, height, above)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer, intent(in) :: group
    real(wp), intent(in) :: height
    logical, intent(in) :: above
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: phi(3), dphi(3), depth
    integer :: e, p

    call line_rule(scene%groups(group)%rule, xi, weight)
    associate (nodes => scene%groups(group)%connectivity, state => solution%groups(group)%committed)
      do e = 1, size(nodes, 2)
        do p = 1, size(xi)
          call line3(xi(p), phi, dphi)
          depth = dot_product(phi, scene%mesh%coordinates(2, nodes(:, e)) &
                              + solution%fields(displacement_field)%value(2, nodes(:, e))) - height
          if (.not. above) depth = -depth
          state(1, p, e) = depth
          state(2, p, e) = merge(1, 0, depth > 0)
        end do
      end do
    end associate
  end subroutine touch

  !> Where contact begins and ends in all groups, found as the solver finds it.
  subroutine ends_of(scene, solution, ends)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))
    integer :: g

    allocate (ends(0))
    x = present_coordinates(scene, solution)
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g)%committed)
        if (group%die == 0) cycle
        call find_contact_ends(group, g, present_die(scene%dies(group%die), x), solution%fields(pilot_field)%value(:, group%die), &
                               scene%mesh%coordinates, x, nint(state(2, :, :)), state(1, :, :), ends)
      end associate
    end do
  end subroutine ends_of

  !> Arcs that begin with a joint of given kinds, in order.
  pure function joints_of_kind(boundary, kinds) result(joints)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: kinds(:)
    integer, allocatable :: joints(:)
    integer :: k

    allocate (joints, source=pack([(k, k=1, size(boundary%kinds))], [(any(boundary%kinds(k) == kinds), k=1, size(boundary%kinds))]))
  end function joints_of_kind

  !> Beginnings and ends of contact, in the order of the report of `build_contours`.
  pure function limit_places(contours) result(places)
    type(contour_t), intent(in) :: contours(:)
    type(limit_place_t), allocatable :: places(:)
    integer :: c, k

    allocate (places(0))
    do c = 1, size(contours)
      do k = 1, size(contours(c)%contacts)
        associate (contact => contours(c)%contacts(k))
          if (contact%begins) places = [places, place_of(contact, c, size(contours(c)%loop%sides, 2), .true.)]
          if (contact%ends) places = [places, place_of(contact, c, size(contours(c)%loop%sides, 2), .false.)]
        end associate
      end do
    end do
  end function limit_places

  pure function place_of(contact, contour, nside, begins) result(place)
    type(contact_t), intent(in) :: contact
    integer, intent(in) :: contour, nside
    logical, intent(in) :: begins
    type(limit_place_t) :: place
    type(side_point_t) :: point

    place%contour = contour
    place%arc = merge(contact%first, contact%next, begins)
    place%group = contact%interval%group
    place%die = contact%number
    associate (section => contact%sections(merge(1, size(contact%sections), begins)))
      associate (closest => section%closest_points(merge(1, size(section%closest_points), begins)))
        place%piece = closest%piece
        place%die_xi = closest%xi
      end associate
    end associate
    point = contact%interval%to
    if (begins) point = contact%interval%from
    place%part_xi = point%xi
    place%side = modulo(point%side - 1, nside) + 1
  end function place_of

end module contour_cases
