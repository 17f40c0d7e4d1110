!> Reading what a checkpoint tells of its scene: the mesh for the cards of its deck, or all of it for who has no deck.
module exchange_scene
  use dies, only: die_t, finish_die, is_deformable
  use errors, only: error_t
  use exchange_fields, only: read_declared_fields
  use exchange_parts, only: check_parts, check_remesh
  use exchange_remesher, only: read_remesher
  use exchange_rules, only: read_count, read_flag, read_list, require, require_range
  use exchange_schema, only: fixation_place, group_place, open_checkpoint, set_place
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use mesh, only: side_set_t
  use quadrature, only: rule_of_number
  use remesh, only: remesh_t
  use scene, only: is_solid, plane_state_names, role_body, role_spring, scene_t
  use state_variables, only: find_variable, is_transfer_kind, state_variable, state_variable_t, total_components
  use text, only: string_t, to_text
  implicit none
  private
  public :: checkpoint_facts_t, read_bare_scene, read_facts, read_remesh

  !> A checkpoint in short: where the run stands, on which mesh, and why a new one is due (no triggers: it is not).
  type :: checkpoint_facts_t
    integer :: generation = 1, step = 0, elements = 0
    real(wp) :: time = 0.0_wp
    !> State carried over to a new mesh, not yet in equilibrium.
    logical :: unbalanced = .false.
    integer :: transfer = 0
    !> Steps the mesh is still on probation for, and other ways tried where it is refused.
    integer :: probation = 0, tries = 0
    !> Estimated errors of stress and strain, negative where they were not asked for [-].
    real(wp) :: error_stress = -1.0_wp, error_strain = -1.0_wp
    type(string_t), allocatable :: triggers(:)
    real(wp), allocatable :: values(:), limits(:)
  end type checkpoint_facts_t

  !> Groups, sets and supports of a scene, and points of an element, at most: far above what cards give, far below all memory.
  integer, parameter :: most_parts = 100000, most_points = 64

contains

  !> The mesh of a checkpoint, when it is not the deck's own: then only `generation` is read, and it is 1.
  subroutine read_remesh(file, remesh, error)
    type(hdf5_file_t), intent(inout) :: file
    type(remesh_t), intent(out) :: remesh
    type(error_t), allocatable, intent(out) :: error
    integer :: k, n

    call read_generation(file, remesh%generation)
    call read_count(file, 'progress/step', remesh%step)
    if (remesh%generation > 1) then
      call read_nodes(file, remesh%coordinates, remesh%origin)
      call read_sides(file, size(remesh%coordinates, 2), remesh%sides)
      call read_count(file, 'mesh/ngroup', n, most_parts)
      allocate (remesh%groups(n))
      do k = 1, n
        call file%read(group_place(k)//'/name', remesh%groups(k)%name)
        call file%read(group_place(k)//'/role', remesh%groups(k)%role)
        call require_range(file, group_place(k)//'/role', remesh%groups(k)%role, role_body, role_spring)
        call read_connectivity(file, k, size(remesh%coordinates, 2), remesh%groups(k)%connectivity)
      end do
      if (.not. file%failed()) call check_remesh(file, remesh)
    end if
    call file%status(error)
  end subroutine read_remesh

  !> What a checkpoint tells of its scene without the deck: mesh, groups with the variables of their state, dies, remeshing. For
  !> who knows no law; enough to read the state with `read_state` and to write it with `write_checkpoint`.
  subroutine read_bare_scene(file, scene, error)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(out) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: names(:)
    integer :: k, n, nnode

    scene%title = ''
    call file%read('mesh/plane_state', scene%plane_state)
    call require_range(file, 'mesh/plane_state', scene%plane_state, 1, size(plane_state_names))
    call read_flag(file, 'mesh/finite', scene%finite)
    call read_generation(file, scene%generation)
    call read_nodes(file, scene%mesh%coordinates, scene%mesh%origin)
    nnode = size(scene%mesh%coordinates, 2)
    call file%require_shape('mesh/labels', [nnode])
    call file%read('mesh/labels', scene%mesh%labels)
    allocate (scene%mesh%node_sets(0))
    call read_sides(file, nnode, scene%mesh%sides)
    call read_count(file, 'mesh/nfixation', n, most_parts)
    allocate (scene%fixations(n))
    do k = 1, n
      call file%read(fixation_place(k)//'/nodes', scene%fixations(k)%nodes)
      call require_range(file, fixation_place(k)//'/nodes', scene%fixations(k)%nodes, 1, nnode)
      call file%read(fixation_place(k)//'/component', scene%fixations(k)%component)
      call require_range(file, fixation_place(k)//'/component', scene%fixations(k)%component, 1, 2)
    end do
    call read_declared_fields(file, scene%fields)
    call read_remesher(file, scene%remesher)
    call read_flag(file, 'estimate/wanted', scene%remesh%estimate)
    call file%read('dies_in_order', names)
    allocate (scene%dies(size(names)))
    do k = 1, size(names)
      scene%dies(k)%name = names(k)%s
      call read_die(file, nnode, scene%dies(k))
    end do
    call read_count(file, 'mesh/ngroup', n, most_parts)
    allocate (scene%groups(n), scene%materials(n))
    do k = 1, n
      scene%materials(k)%name = ''
    end do
    do k = 1, n
      call read_bare_group(file, k, scene)
    end do
    if (.not. file%failed()) call check_parts(file, scene)
    call file%status(error)
  end subroutine read_bare_scene

  subroutine read_generation(file, generation)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(out) :: generation

    call file%read('mesh/generation', generation)
    call require_range(file, 'mesh/generation', generation, 1, huge(1))
    if (file%failed()) generation = 1
  end subroutine read_generation

  !> Where nodes are, and where their matter was (2, nnode).
  subroutine read_nodes(file, coordinates, origin)
    type(hdf5_file_t), intent(inout) :: file
    real(wp), allocatable, intent(out) :: coordinates(:, :), origin(:, :)

    call file%require_shape('mesh/coordinates', [2, -1])
    call file%read('mesh/coordinates', coordinates)
    call file%require_shape('mesh/origin', shape(coordinates))
    call file%read('mesh/origin', origin)
  end subroutine read_nodes

  subroutine read_sides(file, nnode, sides)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: nnode
    type(side_set_t), allocatable, intent(out) :: sides(:)
    integer :: k, n

    call read_count(file, 'mesh/nset', n, most_parts)
    allocate (sides(n))
    do k = 1, n
      call file%read(set_place(k)//'/name', sides(k)%name)
      call file%require_shape(set_place(k)//'/nodes', [3, -1])
      call file%read(set_place(k)//'/nodes', sides(k)%nodes)
      call require_range(file, set_place(k)//'/nodes', sides(k)%nodes, 1, nnode)
    end do
  end subroutine read_sides

  !> Nodes of the elements of a group, each once in an element.
  subroutine read_connectivity(file, k, nnode, connectivity)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: k, nnode
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: e, i

    call file%read(group_place(k)//'/connectivity', connectivity)
    call require_range(file, group_place(k)//'/connectivity', connectivity, 1, nnode)
    do e = 1, size(connectivity, 2)
      do i = 2, size(connectivity, 1)
        if (all(connectivity(:i - 1, e) /= connectivity(i, e))) cycle
        call require(file, group_place(k)//'/connectivity', .false., 'has a node twice in element '//to_text(e))
        return
      end do
    end do
  end subroutine read_connectivity

  subroutine read_die(file, nnode, die)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: nnode
    type(die_t), intent(inout) :: die
    integer, allocatable :: nodes(:, :)
    character(len=:), allocatable :: place

    place = 'dies/'//die%name
    call file%require_shape(place//'/pieces', [2, 3, -1])
    call file%read(place//'/pieces', die%pieces)
    call file%require_shape(place//'/nodes', [3, -1])
    call file%read(place//'/nodes', nodes)
    ! a die made of sides has none before its deck has seen a mesh
    if (size(nodes) > 0 .or. size(die%pieces) == 0) then
      call file%require_shape(place//'/nodes', [3, size(die%pieces, 3)])
      call require_range(file, place//'/nodes', nodes, 1, nnode)
      call move_alloc(nodes, die%nodes)
    end if
    if (.not. file%failed()) call finish_die(die)   ! the pieces are in the pilot's axes already
    call read_list(file, place//'/start', die%pilot)
  end subroutine read_die

  subroutine read_bare_group(file, k, scene)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: k
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: place
    integer :: number

    place = group_place(k)
    associate (group => scene%groups(k))
      call file%read(place//'/name', group%name)
      call file%read(place//'/elem', group%elem)
      call file%read(place//'/npoint', number)
      call require_range(file, place//'/npoint', number, -most_points, most_points)
      group%rule = rule_of_number(number)
      call file%read(place//'/role', group%role)
      call require_range(file, place//'/role', group%role, role_body, role_spring)
      call read_count(file, place//'/host', group%host, size(scene%groups))
      call read_connectivity(file, k, size(scene%mesh%coordinates, 2), group%connectivity)
      call read_count(file, place//'/die_number', group%die, size(scene%dies))
      call read_count(file, place//'/material_number', group%material, size(scene%materials))
      if (group%material > 0) call file%read(place//'/material', scene%materials(group%material)%name)
      call read_variables(file, place, group%variables)
      call file%require_shape(place//'/state', [total_components(group%variables), group%rule%n, &
                                                size(group%connectivity, 2)])
      if (group%die == 0) return
      if (.not. is_deformable(scene%dies(group%die))) return
      if (size(scene%dies(group%die)%nodes) > 0) then
        group%pairs = maxval([0, scene%groups(:k - 1)%pairs]) + 1
        call file%require_shape(place//'/pairs', [group%rule%n, size(group%connectivity, 2)])
      end if
    end associate
  end subroutine read_bare_group

  !> The declared state of a group's points.
  subroutine read_variables(file, place, variables)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place   !! of the group
    type(state_variable_t), allocatable, intent(out) :: variables(:)
    type(string_t), allocatable :: names(:), units(:), kinds(:)
    integer, allocatable :: components(:)
    real(wp), allocatable :: initial(:)
    integer :: v

    call file%read(place//'/variables', names)
    call file%require_shape(place//'/unit', [size(names)])
    call file%read(place//'/unit', units)
    call file%require_shape(place//'/transfer', [size(names)])
    call file%read(place//'/transfer', kinds)
    call file%require_shape(place//'/components', [size(names)])
    call file%read(place//'/components', components)
    call file%require_shape(place//'/initial', [size(names)])
    call file%read(place//'/initial', initial)
    if (file%failed()) names = [string_t ::]
    allocate (variables(size(names)))
    do v = 1, size(names)
      call require(file, place//'/components', components(v) == 1 .or. components(v) == 4, 'holds '//to_text(components(v))// &
                   ' for '''//names(v)%s//''', where 1 (a number) or 4 (a tensor) is wanted')
      call require(file, place//'/transfer', is_transfer_kind(kinds(v)%s), &
                   'holds '''//kinds(v)%s//''', which is no kind of transfer')
      call require(file, place//'/variables', find_variable(variables(:v - 1), names(v)%s) == 0, &
                   'holds '''//names(v)%s//''' twice')
      variables(v) = state_variable(names(v)%s, units(v)%s, kinds(v)%s, components(v))
      variables(v)%first = total_components(variables(:v - 1)) + 1
      variables(v)%initial = initial(v)
    end do
  end subroutine read_variables

  !> What a checkpoint tells scripts of itself, once it was found whole and of this schema.
  subroutine read_facts(path, facts, error)
    character(len=*), intent(in) :: path
    type(checkpoint_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(scene_t) :: scene
    type(error_t), allocatable :: ignored
    integer :: g

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call read_bare_scene(file, scene, error)
    if (allocated(error)) then
      call file%close(ignored)
      return
    end if
    facts%generation = scene%generation
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) facts%elements = facts%elements + size(scene%groups(g)%connectivity, 2)
    end do
    call file%read('progress/time', facts%time)
    call read_count(file, 'progress/step', facts%step)
    call read_flag(file, 'progress/unbalanced', facts%unbalanced)
    facts%transfer = scene%remesher%transfer
    facts%tries = scene%remesher%tries
    call read_count(file, 'progress/probation', facts%probation)
    allocate (facts%triggers(0))
    if (scene%remesh%estimate) then
      call file%read('estimate/stress', facts%error_stress)
      call file%read('estimate/strain', facts%error_strain)
      call file%read('remesh/triggers', facts%triggers)
      call file%require_shape('remesh/value', [size(facts%triggers)])
      call file%require_shape('remesh/limit', [size(facts%triggers)])
      call file%read('remesh/value', facts%values)
      call file%read('remesh/limit', facts%limits)
      call check_places(file, scene, size(facts%triggers))
    end if
    call file%close(error)
  end subroutine read_facts

  !> Group and element where a limit was passed, 0 for no such place.
  subroutine check_places(file, scene, ntrigger)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: ntrigger
    integer, allocatable :: group(:), element(:)
    integer :: k

    call file%require_shape('remesh/group', [ntrigger])
    call file%require_shape('remesh/element', [ntrigger])
    call file%read('remesh/group', group)
    call file%read('remesh/element', element)
    call require_range(file, 'remesh/group', group, 0, size(scene%groups))
    if (file%failed()) return
    do k = 1, ntrigger
      if (group(k) == 0) then
        call require_range(file, 'remesh/element', element(k), 0, 0)
      else
        call require_range(file, 'remesh/element', element(k), 0, size(scene%groups(group(k))%connectivity, 2))
      end if
    end do
  end subroutine check_places

end module exchange_scene
