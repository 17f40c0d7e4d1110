!> Reading what a checkpoint tells of its scene: the mesh for the cards of its deck, or all of it for who has no deck.
module exchange_scene
  use dies, only: die_t, finish_die
  use errors, only: error_t, exit_input
  use exchange_remesher, only: read_remesher
  use exchange_schema, only: all_finite, fixation_place, group_place, open_checkpoint, read_triple, refuse_not_finite, set_place
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use materials, only: material_t
  use remesh, only: remesh_t
  use scene, only: is_solid, scene_t
  use state_variables, only: state_variable
  use text, only: string_t
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

contains

  !> The mesh of a checkpoint, when it is not the deck's own: then only `generation` is read, and it is 1.
  subroutine read_remesh(file, remesh, error)
    type(hdf5_file_t), intent(inout) :: file
    type(remesh_t), intent(out) :: remesh
    type(error_t), allocatable, intent(out) :: error
    integer :: k, n

    call file%read('mesh/generation', remesh%generation)
    call file%read('progress/step', remesh%step)
    if (remesh%generation > 1) then
      call file%read('mesh/coordinates', remesh%coordinates)
      call file%read('mesh/origin', remesh%origin)
      call refuse_not_finite(file, 'mesh/coordinates', all_finite(remesh%coordinates) .and. all_finite(remesh%origin))
      n = 0
      call file%read('mesh/nset', n)
      allocate (remesh%sides(n))
      do k = 1, n
        call file%read(set_place(k)//'/name', remesh%sides(k)%name)
        call file%read(set_place(k)//'/nodes', remesh%sides(k)%nodes)
      end do
      n = 0
      call file%read('mesh/ngroup', n)
      allocate (remesh%groups(n))
      do k = 1, n
        call file%read(group_place(k)//'/name', remesh%groups(k)%name)
        call file%read(group_place(k)//'/connectivity', remesh%groups(k)%connectivity)
      end do
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
    integer :: k, n, finite

    scene%title = ''
    call file%read('mesh/plane_state', scene%plane_state)
    finite = 1
    call file%read('mesh/finite', finite)
    scene%finite = finite == 1
    call file%read('mesh/generation', scene%generation)
    call file%read('mesh/coordinates', scene%mesh%coordinates)
    call file%read('mesh/origin', scene%mesh%origin)
    call refuse_not_finite(file, 'mesh/coordinates', all_finite(scene%mesh%coordinates) .and. all_finite(scene%mesh%origin))
    call file%read('mesh/labels', scene%mesh%labels)
    allocate (scene%mesh%node_sets(0))
    n = 0
    call file%read('mesh/nset', n)
    allocate (scene%mesh%sides(n))
    do k = 1, n
      call file%read(set_place(k)//'/name', scene%mesh%sides(k)%name)
      call file%read(set_place(k)//'/nodes', scene%mesh%sides(k)%nodes)
    end do
    n = 0
    call file%read('mesh/nfixation', n)
    allocate (scene%fixations(n))
    do k = 1, n
      call file%read(fixation_place(k)//'/nodes', scene%fixations(k)%nodes)
      call file%read(fixation_place(k)//'/component', scene%fixations(k)%component)
    end do
    call read_remesher(file, scene%remesher)
    scene%remesh%estimate = file%has('estimate/stress')
    call file%read('dies_in_order', names)
    allocate (scene%dies(size(names)))
    do k = 1, size(names)
      scene%dies(k)%name = names(k)%s
      call read_die(file, scene%dies(k))
    end do
    n = 0
    call file%read('mesh/ngroup', n)
    allocate (scene%groups(n))
    do k = 1, n
      call read_bare_group(file, k, scene)
    end do
    call file%status(error)
  end subroutine read_bare_scene

  subroutine read_die(file, die)
    type(hdf5_file_t), intent(inout) :: file
    type(die_t), intent(inout) :: die

    call file%read('dies/'//die%name//'/pieces', die%pieces)
    if (file%has('dies/'//die%name//'/nodes')) call file%read('dies/'//die%name//'/nodes', die%nodes)
    call finish_die(die)   ! the pieces are in the pilot's axes already
    call read_triple(file, 'dies/'//die%name//'/start', die%pilot)
  end subroutine read_die

  subroutine read_bare_group(file, k, scene)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: k
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: place
    type(string_t), allocatable :: names(:), units(:), kinds(:)
    type(material_t), allocatable :: more(:)
    integer, allocatable :: components(:)
    real(wp), allocatable :: initial(:)
    integer :: v

    if (.not. allocated(scene%materials)) allocate (scene%materials(0))
    place = group_place(k)
    associate (group => scene%groups(k))
      call file%read(place//'/name', group%name)
      call file%read(place//'/elem', group%elem)
      call file%read(place//'/npoint', group%npoint)
      call file%read(place//'/connectivity', group%connectivity)
      if (file%has(place//'/die_number')) call file%read(place//'/die_number', group%die)
      if (file%has(place//'/pairs')) group%pairs = maxval([0, scene%groups%pairs]) + 1
      allocate (group%variables(0))
      if (file%has(place//'/material_number')) then
        call file%read(place//'/material_number', group%material)
        if (group%material > size(scene%materials)) then
          allocate (more(group%material))
          more(:size(scene%materials)) = scene%materials
          call move_alloc(more, scene%materials)
        end if
        call file%read(place//'/material', scene%materials(group%material)%name)
      end if
      if (.not. file%has(place//'/variables')) return
      call file%read(place//'/variables', names)
      call file%read(place//'/unit', units)
      call file%read(place//'/transfer', kinds)
      call file%read(place//'/components', components)
      call file%read(place//'/initial', initial)
      if (size(units) /= size(names) .or. size(kinds) /= size(names) .or. size(components) /= size(names) &
          .or. size(initial) /= size(names)) then
        call file%record_error(exit_input, place//'/variables: names, units and kinds do not fit')
        return
      end if
      deallocate (group%variables)
      allocate (group%variables(size(names)))
      do v = 1, size(names)
        group%variables(v) = state_variable(names(v)%s, units(v)%s, kinds(v)%s, components(v))
        group%variables(v)%first = sum(components(:v - 1)) + 1
        group%variables(v)%initial = initial(v)
      end do
    end associate
  end subroutine read_bare_group

  !> What a checkpoint tells scripts of itself, once it was found whole and of this schema.
  subroutine read_facts(path, facts, error)
    character(len=*), intent(in) :: path
    type(checkpoint_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(scene_t) :: scene
    type(error_t), allocatable :: ignored
    real(wp), allocatable :: values(:), limits(:)
    integer :: unbalanced, g

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
    call file%read('progress/step', facts%step)
    unbalanced = 0
    call file%read('progress/unbalanced', unbalanced)
    facts%unbalanced = unbalanced == 1
    facts%transfer = scene%remesher%transfer
    facts%tries = scene%remesher%tries
    call file%read('progress/probation', facts%probation)
    allocate (facts%triggers(0))
    if (file%has('estimate/stress')) then
      call file%read('estimate/stress', facts%error_stress)
      call file%read('estimate/strain', facts%error_strain)
    end if
    if (file%has('remesh/triggers')) then
      call file%read('remesh/triggers', facts%triggers)
      call file%read('remesh/value', values)
      call file%read('remesh/limit', limits)
      if (any([size(values), size(limits)] /= size(facts%triggers))) then
        call file%record_error(exit_input, 'remesh/triggers: lists of unlike lengths')
      else
        facts%values = values
        facts%limits = limits
      end if
    end if
    call file%close(error)
  end subroutine read_facts

end module exchange_scene
