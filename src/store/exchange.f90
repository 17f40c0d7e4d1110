!> The checkpoint: exchange between solver and REMDATA, and restart file.
!>
!> This module owns the schema; nothing else names a dataset of it. Every state array carries the
!> names, units and transfer kinds of its variables, taken from the laws and elements that declare
!> them: who reads it needs to know no law.
module exchange
  use contact_ends, only: contact_end_t
  use dies, only: die_t, finish_die, is_deformable
  use errors, only: error_t, exit_input, fail
  use hash, only: sha256
  use hdf5_atomic, only: commit_atomic, create_atomic, open_verified
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use materials, only: material_t
  use pairs, only: pairs_t
  use remesh, only: remesh_t
  use remesher_options, only: has_contours, has_zones, remesher_options_t
  use remeshing, only: estimate_t
  use scene, only: is_solid, scene_t
  use state_variables, only: state_variable
  use solution, only: solution_t
  use text, only: string_t, to_text
  use zone_marks, only: contour_card_t, zone_card_t, zone_mark_t
  implicit none
  private
  public :: write_checkpoint, read_deck_of_checkpoint, read_remesh, read_checkpoint, read_bare_scene, read_contact_ends
  public :: checkpoint_facts_t, read_facts, schema_version

  !> A checkpoint in short: where the run stands, on which mesh, and why a new one is due (no triggers: it is not).
  type :: checkpoint_facts_t
    integer :: generation = 1, step = 0, elements = 0
    real(wp) :: time = 0.0_wp
    !> State carried over to a new mesh, not yet in equilibrium.
    logical :: unbalanced = .false.
    integer :: transfer = 0
    !> Estimated errors of stress and strain, negative where they were not asked for [-].
    real(wp) :: error_stress = -1.0_wp, error_strain = -1.0_wp
    type(string_t), allocatable :: triggers(:)
    real(wp), allocatable :: values(:), limits(:)
  end type checkpoint_facts_t

  !> Raised whenever a dataset changes its name, shape or meaning.
  integer, parameter :: schema_version = 4
  character(len=*), parameter :: schema_name = 'lagamine checkpoint'

contains

  !> Write the whole state of a run, atomically; the one before is kept beside it.
  subroutine write_checkpoint(path, deck_path, deck_text, scene, solution, ends, error)
    character(len=*), intent(in) :: path, deck_path, deck_text
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), intent(in) :: ends(:)   !! where contact begins and ends now
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file

    call create_atomic(file, path, error)
    if (allocated(error)) return
    call file%write_attribute('/', 'schema', schema_name)
    call file%write_attribute('/', 'schema_version', schema_version)
    call file%write('deck/path', deck_path)
    call file%write('deck/text', deck_text)
    call file%write('deck/sha256', sha256(deck_text))
    call write_mesh(file, scene)
    call write_dies(file, scene, solution)
    call write_progress(file, solution)
    call write_states(file, scene, solution)
    if (scene%remesh%estimate) call write_estimate(file, scene, solution%estimate)
    call write_ends(file, ends)
    call commit_atomic(file, error, keep_previous=.true.)
  end subroutine write_checkpoint

  subroutine write_mesh(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    integer :: k

    call file%write('mesh/generation', scene%generation)
    call file%write('mesh/plane_state', scene%plane_state)
    call file%write('mesh/coordinates', scene%mesh%coordinates)
    call file%write_attribute('mesh/coordinates', 'unit', 'length')
    call file%write('mesh/origin', scene%mesh%origin)
    call file%write_attribute('mesh/origin', 'unit', 'length')
    call file%write('mesh/labels', scene%mesh%labels)
    call file%write('mesh/nset', size(scene%mesh%sides))
    do k = 1, size(scene%mesh%sides)
      call file%write(set_place(k)//'/name', scene%mesh%sides(k)%name)
      call file%write(set_place(k)//'/nodes', scene%mesh%sides(k)%nodes)
    end do
    call file%write('mesh/ngroup', size(scene%groups))
    call file%write('mesh/nfixation', size(scene%fixations))
    do k = 1, size(scene%fixations)
      call file%write(fixation_place(k)//'/nodes', scene%fixations(k)%nodes)
      call file%write(fixation_place(k)//'/component', scene%fixations(k)%component)
    end do
    call write_remesher(file, scene%remesher)
  end subroutine write_mesh

  !> What the deck asks of the remesher.
  subroutine write_remesher(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(in) :: remesher

    call file%write('remesher/wanted', merge(1, 0, remesher%wanted))
    call file%write('remesher/transfer', [remesher%transfer, remesher%neighbours])
    call file%write('remesher/exponent', remesher%exponent)
    call file%write('remesher/size', [remesher%smallest, remesher%largest])
    call file%write('remesher/strain_error', remesher%strain_error)
    call file%write('remesher/count', [remesher%most_elements, remesher%across_contact])
    call file%write('remesher/turn', remesher%turn)
    if (has_zones(remesher)) call write_zones(file, remesher%marks, remesher%zones)
    if (has_contours(remesher)) call write_contours(file, remesher%contours)
  end subroutine write_remesher

  subroutine read_remesher(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(out) :: remesher
    integer, allocatable :: numbers(:)
    real(wp), allocatable :: sizes(:)
    integer :: wanted

    wanted = 0
    call file%read('remesher/wanted', wanted)
    remesher%wanted = wanted == 1
    call file%read('remesher/transfer', numbers)
    if (size(numbers) == 2) then
      remesher%transfer = numbers(1)
      remesher%neighbours = numbers(2)
    end if
    call file%read('remesher/exponent', remesher%exponent)
    call file%read('remesher/size', sizes)
    if (size(sizes) == 2) then
      remesher%smallest = sizes(1)
      remesher%largest = sizes(2)
    end if
    call file%read('remesher/strain_error', remesher%strain_error)
    call file%read('remesher/count', numbers)
    if (size(numbers) == 2) then
      remesher%most_elements = numbers(1)
      remesher%across_contact = numbers(2)
    end if
    call file%read('remesher/turn', remesher%turn)
    if (file%has('remesher/zones')) call read_zones(file, remesher)
    if (file%has('remesher/contours')) call read_contours(file, remesher%contours)
  end subroutine read_remesher

  !> Zones and their points, with the names that messages call them by. A row each of numbers: what a point is, axis, pick, by
  !> matter, stays, die; and of a zone: group, four points.
  subroutine write_zones(file, marks, zones)
    type(hdf5_file_t), intent(inout) :: file
    type(zone_mark_t), intent(in) :: marks(:)
    type(zone_card_t), intent(in) :: zones(:)
    integer :: k

    call file%write('remesher/points/name', names_of(marks%name))
    call file%write('remesher/points/numbers', reshape([(marks(k)%form, marks(k)%axis, marks(k)%pick, &
                                                         merge(1, 0, marks(k)%by_matter), merge(1, 0, marks(k)%stays), &
                                                         marks(k)%die, k=1, size(marks))], [6, size(marks)]))
    call file%write('remesher/points/place', reshape([(marks(k)%x, k=1, size(marks))], [2, size(marks)]))
    call file%write_attribute('remesher/points/place', 'unit', 'length')
    call file%write('remesher/zones/name', names_of(zones%name))
    call file%write('remesher/zones/numbers', reshape([(zones(k)%group, zones(k)%marks, k=1, size(zones))], [5, size(zones)]))

  contains

    pure function names_of(list) result(names)
      character(len=*), intent(in) :: list(:)
      type(string_t) :: names(size(list))
      integer :: i

      do i = 1, size(list)
        names(i)%s = trim(list(i))
      end do
    end function names_of

  end subroutine write_zones

  subroutine read_zones(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(inout) :: remesher
    type(string_t), allocatable :: names(:), zone_names(:)
    integer, allocatable :: numbers(:, :), corners(:, :)
    real(wp), allocatable :: places(:, :)
    integer :: k

    call file%read('remesher/points/name', names)
    call file%read('remesher/points/numbers', numbers)
    call file%read('remesher/points/place', places)
    call file%read('remesher/zones/name', zone_names)
    call file%read('remesher/zones/numbers', corners)
    if (any(shape(numbers) /= [6, size(names)]) .or. any(shape(places) /= [2, size(names)]) &
        .or. any(shape(corners) /= [5, size(zone_names)])) then
      call file%record_error(exit_input, 'remesher/zones: names and numbers do not fit')
      return
    end if
    allocate (remesher%marks(size(names)), remesher%zones(size(zone_names)))
    do k = 1, size(names)
      remesher%marks(k) = zone_mark_t(name=names(k)%s, form=numbers(1, k), x=places(:, k), axis=numbers(2, k), &
                                      pick=numbers(3, k), by_matter=numbers(4, k) == 1, stays=numbers(5, k) == 1, &
                                      die=numbers(6, k))
    end do
    do k = 1, size(zone_names)
      remesher%zones(k) = zone_card_t(name=zone_names(k)%s, group=corners(1, k), marks=corners(2:, k))
    end do
  end subroutine read_zones

  !> Contours of bodies: parabolas, the side of the body that each is of, and the group of the body.
  subroutine write_contours(file, contours)
    type(hdf5_file_t), intent(inout) :: file
    type(contour_card_t), intent(in) :: contours(:)
    integer :: k

    call file%write('remesher/contours/group', contours%group)
    do k = 1, size(contours)
      call file%write('remesher/contours/'//to_text(k)//'/pieces', contours(k)%pieces)
      call file%write_attribute('remesher/contours/'//to_text(k)//'/pieces', 'unit', 'length')
      call file%write('remesher/contours/'//to_text(k)//'/side', contours(k)%row)
    end do
  end subroutine write_contours

  subroutine read_contours(file, contours)
    type(hdf5_file_t), intent(inout) :: file
    type(contour_card_t), allocatable, intent(out) :: contours(:)
    integer, allocatable :: groups(:)
    integer :: k

    call file%read('remesher/contours/group', groups)
    allocate (contours(size(groups)))
    do k = 1, size(groups)
      contours(k)%group = groups(k)
      call file%read('remesher/contours/'//to_text(k)//'/pieces', contours(k)%pieces)
      call file%read('remesher/contours/'//to_text(k)//'/side', contours(k)%row)
      if (any(shape(contours(k)%pieces) /= [2, 3, size(contours(k)%row)])) &
        call file%record_error(exit_input, 'remesher/contours: pieces and sides do not fit')
    end do
  end subroutine read_contours

  subroutine write_dies(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t) :: names(size(scene%dies))
    integer :: k
    do k = 1, size(scene%dies)
      names(k)%s = scene%dies(k)%name
    end do
    call file%write('dies_in_order', names)
    call file%group('dies')
    do k = 1, size(scene%dies)
      call file%write('dies/'//scene%dies(k)%name//'/pieces', scene%dies(k)%pieces)
      if (is_deformable(scene%dies(k))) call file%write('dies/'//scene%dies(k)%name//'/nodes', scene%dies(k)%nodes)
      call file%write('dies/'//scene%dies(k)%name//'/start', scene%dies(k)%pilot)
      call file%write('dies/'//scene%dies(k)%name//'/pilot', solution%pilots(:, k))
      call file%write('dies/'//scene%dies(k)%name//'/last_increment', solution%last_pilot_increment(:, k))
      call file%write('dies/'//scene%dies(k)%name//'/applied', solution%pilot_applied(:, k))
    end do
  end subroutine write_dies

  subroutine write_progress(file, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(solution_t), intent(in) :: solution

    call file%write('progress/time', solution%time)
    call file%write('progress/step', solution%step)
    call file%write('progress/unbalanced', merge(1, 0, solution%unbalanced))
    call file%write('progress/last_step', solution%last_step)
    call file%write('progress/next_step', solution%next_step)
    call file%write('progress/iterations', solution%iterations)
    call file%write('progress/cutbacks', solution%cutbacks)
    call file%write('progress/external_work', solution%external_work)
    call file%write('progress/initial_volume', solution%initial_volume)
    call file%write('progress/force_floor', solution%force_floor)
    call file%write('progress/worst', [solution%worst_linear_residual, solution%worst_penetration, &
                                      solution%worst_penetration_ratio, solution%least_dissipation, &
                                      solution%worst_sample, solution%worst_sample_ratio])
    call file%write('progress/spurious_mode', [solution%worst_spurious, real(solution%spurious_group, wp), &
                                              real(solution%spurious_element, wp)])
    call file%write('section/position', solution%section)
    call file%write('section/last_increment', solution%last_section_increment)
    call file%write('section/applied', solution%section_applied)
    call file%write('nodes/displacement', solution%displacement)
    call file%write_attribute('nodes/displacement', 'unit', 'length')
    call file%write('nodes/last_increment', solution%last_increment)
    call file%write('nodes/applied', solution%applied)
  end subroutine write_progress

  subroutine write_states(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: place
    type(string_t), allocatable :: names(:), units(:), kinds(:)
    integer :: g, v

    do g = 1, size(scene%groups)
      place = group_place(g)
      associate (group => scene%groups(g))
        call file%write(place//'/name', group%name)
        call file%write(place//'/elem', group%elem)
        call file%write(place//'/npoint', group%npoint)
        call file%write(place//'/connectivity', group%connectivity)
        if (group%die > 0) then
          call file%write(place//'/die', scene%dies(group%die)%name)
          call file%write(place//'/die_number', group%die)
        end if
        if (group%material > 0) then
          call file%write(place//'/material', scene%materials(group%material)%name)
          call file%write(place//'/material_number', group%material)
        end if
        if (group%pairs > 0) call file%write(place//'/pairs', solution%pairs(group%pairs)%piece)
        if (size(group%variables) == 0) cycle
        allocate (names(size(group%variables)), units(size(group%variables)), kinds(size(group%variables)))
        do v = 1, size(group%variables)
          names(v)%s = group%variables(v)%name
          units(v)%s = group%variables(v)%unit
          kinds(v)%s = group%variables(v)%transfer
        end do
        call file%write(place//'/variables', names)
        call file%write(place//'/unit', units)
        call file%write(place//'/transfer', kinds)
        call file%write(place//'/components', group%variables%ncomp)
        call file%write(place//'/initial', group%variables%initial)
        call file%write(place//'/state', solution%groups(g)%committed)
        deallocate (names, units, kinds)
      end associate
    end do
  end subroutine write_states

  !> Errors of the mesh, element by element in the groups, and why a new one is due: triggers with value, limit, group and
  !> element (0: no place).
  subroutine write_estimate(file, scene, estimate)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(estimate_t), intent(in) :: estimate
    type(string_t), allocatable :: names(:)
    integer :: g, k, n, last

    call file%write('estimate/stress', estimate%stress)
    call file%write('estimate/strain', estimate%strain)
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      n = last + 1
      last = last + size(scene%groups(g)%connectivity, 2)
      call file%write(group_place(g)//'/error_stress', estimate%stress_of(n:last))
      call file%write(group_place(g)//'/error_strain', estimate%strain_of(n:last))
      call file%write(group_place(g)//'/strain_sums', estimate%strain_sums(:, n:last))
    end do
    call file%write('remesh/last_stop', estimate%last_stop)
    if (size(estimate%triggers) == 0) return
    allocate (names(size(estimate%triggers)))
    do k = 1, size(names)
      names(k)%s = estimate%triggers(k)%name
    end do
    call file%write('remesh/triggers', names)
    call file%write('remesh/value', estimate%triggers%value)
    call file%write('remesh/limit', estimate%triggers%limit)
    call file%write('remesh/group', estimate%triggers%group)
    call file%write('remesh/element', estimate%triggers%element)
  end subroutine write_estimate

  !> Where contact begins and ends, for the remesher: one entry each. The solver does not read them back.
  subroutine write_ends(file, ends)
    type(hdf5_file_t), intent(inout) :: file
    type(contact_end_t), intent(in) :: ends(:)

    call file%write('contact_ends/begins', merge(1, 0, ends%begins))
    call file%write('contact_ends/group', ends%group)
    call file%write('contact_ends/side', ends%side)
    call file%write('contact_ends/place', ends%place)
    call file%write('contact_ends/die_piece', ends%piece)
    call file%write('contact_ends/die_xi', ends%xi)
  end subroutine write_ends

  !> Where contact begins and ends at the instant of a checkpoint.
  subroutine read_contact_ends(path, ends, error)
    character(len=*), intent(in) :: path
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer, allocatable :: begins(:), group(:), side(:), piece(:)
    real(wp), allocatable :: place(:), xi(:)
    integer :: n

    allocate (ends(0))
    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call file%read('contact_ends/begins', begins)
    call file%read('contact_ends/group', group)
    call file%read('contact_ends/side', side)
    call file%read('contact_ends/place', place)
    call file%read('contact_ends/die_piece', piece)
    call file%read('contact_ends/die_xi', xi)
    n = size(begins)
    if (any([size(group), size(side), size(place), size(piece), size(xi)] /= n)) &
      call file%record_error(exit_input, 'contact_ends: lists of unlike lengths')
    call file%close(error)
    if (allocated(error)) return
    deallocate (ends)
    allocate (ends(n))
    ends%begins = begins == 1
    ends%group = group
    ends%side = side
    ends%place = place
    ends%piece = piece
    ends%xi = xi
  end subroutine read_contact_ends

  pure function group_place(g) result(place)
    integer, intent(in) :: g
    character(len=:), allocatable :: place

    place = 'groups/'//to_text(g)
  end function group_place

  pure function set_place(k) result(place)
    integer, intent(in) :: k
    character(len=:), allocatable :: place

    place = 'mesh/sides/'//to_text(k)
  end function set_place

  pure function fixation_place(k) result(place)
    integer, intent(in) :: k
    character(len=:), allocatable :: place

    place = 'mesh/fixations/'//to_text(k)
  end function fixation_place

  !> The mesh of a checkpoint, when it is not the deck's own: then only `generation` is read, and it is 1.
  subroutine read_remesh(path, remesh, error)
    character(len=*), intent(in) :: path
    type(remesh_t), intent(out) :: remesh
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer :: k, n

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
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
    call file%close(error)
  end subroutine read_remesh

  !> The deck a checkpoint was made from, after schema and digest were found right.
  subroutine read_deck_of_checkpoint(path, deck_path, deck_text, error)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call file%read('deck/path', deck_path)
    call file%read('deck/text', deck_text)
    call file%close(error)
  end subroutine read_deck_of_checkpoint

  !> What a checkpoint tells scripts of itself, once it was found whole and of this schema.
  subroutine read_facts(path, facts, error)
    character(len=*), intent(in) :: path
    type(checkpoint_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(scene_t) :: scene
    real(wp), allocatable :: values(:), limits(:)
    integer :: unbalanced, g

    call read_bare_scene(path, scene, error)
    if (allocated(error)) return
    facts%generation = scene%generation
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) facts%elements = facts%elements + size(scene%groups(g)%connectivity, 2)
    end do
    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call file%read('progress/time', facts%time)
    call file%read('progress/step', facts%step)
    unbalanced = 0
    call file%read('progress/unbalanced', unbalanced)
    facts%unbalanced = unbalanced == 1
    facts%transfer = scene%remesher%transfer
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

  subroutine open_checkpoint(path, file, error)
    character(len=*), intent(in) :: path
    type(hdf5_file_t), intent(inout) :: file
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: schema
    type(error_t), allocatable :: ignored
    integer :: version

    call file%open(path, error)
    if (allocated(error)) return
    schema = ''
    version = 0
    if (file%has_attribute('/', 'schema')) call file%read_attribute('/', 'schema', schema)
    if (file%has_attribute('/', 'schema_version')) call file%read_attribute('/', 'schema_version', version)
    call file%close(ignored)
    if (schema /= schema_name) then
      call fail(error, exit_input, path//': not a checkpoint of lagamine')
    else if (version /= schema_version) then
      call fail(error, exit_input, path//': checkpoint of schema '//to_text(version)//', this program reads schema ' &
                //to_text(schema_version))
    else
      call open_verified(file, path, error)
    end if
  end subroutine open_checkpoint

  !> Take up the state of a checkpoint in a scene read from the same deck.
  subroutine read_checkpoint(path, scene, solution, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! started from the scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    real(wp), allocatable :: worst(:)
    real(wp) :: spurious(3)
    integer :: unbalanced

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call file%read('progress/time', solution%time)
    call file%read('progress/step', solution%step)
    unbalanced = 0
    call file%read('progress/unbalanced', unbalanced)
    solution%unbalanced = unbalanced == 1
    call file%read('progress/last_step', solution%last_step)
    call file%read('progress/next_step', solution%next_step)
    call file%read('progress/iterations', solution%iterations)
    call file%read('progress/cutbacks', solution%cutbacks)
    call file%read('progress/external_work', solution%external_work)
    call file%read('progress/initial_volume', solution%initial_volume)
    call file%read('progress/force_floor', solution%force_floor)
    call file%read('progress/worst', worst)
    if (size(worst) == 6) then
      solution%worst_linear_residual = worst(1)
      solution%worst_penetration = worst(2)
      solution%worst_penetration_ratio = worst(3)
      solution%least_dissipation = worst(4)
      solution%worst_sample = worst(5)
      solution%worst_sample_ratio = worst(6)
    end if
    call read_matrix(file, 'nodes/displacement', solution%displacement)
    call read_matrix(file, 'nodes/last_increment', solution%last_increment)
    call read_matrix(file, 'nodes/applied', solution%applied)
    spurious = 0
    call read_triple(file, 'progress/spurious_mode', spurious)
    solution%worst_spurious = spurious(1)
    solution%spurious_group = nint(spurious(2))
    solution%spurious_element = nint(spurious(3))
    call read_triple(file, 'section/position', solution%section)
    call read_triple(file, 'section/last_increment', solution%last_section_increment)
    call read_triple(file, 'section/applied', solution%section_applied)
    call refuse_not_finite(file, 'progress', all(abs([solution%time, solution%last_step, solution%next_step, &
                                                      solution%external_work, solution%initial_volume]) <= huge(1.0_wp)))
    call read_dies(file, scene, solution)
    call read_states(file, scene, solution)
    if (scene%remesh%estimate) call read_estimate(file, scene, solution%estimate)
    call file%close(error)
  end subroutine read_checkpoint

  !> What a checkpoint tells of its scene without the deck: mesh, groups with the variables of their state, dies, remeshing. For
  !> who knows no law; enough to read the state with `read_checkpoint` and to write it with `write_checkpoint`.
  subroutine read_bare_scene(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(out) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(string_t), allocatable :: names(:)
    integer :: k, n

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    scene%title = ''
    call file%read('mesh/plane_state', scene%plane_state)
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
    call file%close(error)
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

  subroutine read_dies(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: k

    do k = 1, size(scene%dies)
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/pilot', solution%pilots(:, k))
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/last_increment', solution%last_pilot_increment(:, k))
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/applied', solution%pilot_applied(:, k))
    end do
  end subroutine read_dies

  subroutine read_triple(file, place, triple)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(inout) :: triple(3)
    real(wp), allocatable :: values(:)

    call file%read(place, values)
    if (size(values) == 3) triple = values
    call refuse_not_finite(file, place, all(abs(values) <= huge(1.0_wp)))
  end subroutine read_triple

  !> A state that is not a number would spread through all that follows.
  subroutine refuse_not_finite(file, place, finite)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    logical, intent(in) :: finite

    if (.not. finite) call file%record_error(exit_input, place//': holds what is not a finite number')
  end subroutine refuse_not_finite

  !> False for NaN too, which is not in any order.
  pure function all_finite(values) result(finite)
    real(wp), intent(in) :: values(:, :)
    logical :: finite

    finite = all(abs(values) <= huge(1.0_wp))
  end function all_finite

  subroutine read_states(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: state(:, :, :)
    integer :: g

    do g = 1, size(scene%groups)
      if (size(scene%groups(g)%variables) == 0) cycle
      if (scene%groups(g)%pairs > 0) call read_pairs(file, group_place(g)//'/pairs', solution%pairs(scene%groups(g)%pairs))
      call file%read(group_place(g)//'/state', state)
      if (all(shape(state) == shape(solution%groups(g)%committed))) then
        solution%groups(g)%committed = state
        solution%groups(g)%trial = state
        call refuse_not_finite(file, group_place(g)//'/state', all(abs(state) <= huge(1.0_wp)))
      else
        call file%record_error(exit_input, group_place(g)//'/state: does not fit the deck''s group '//scene%groups(g)%name)
      end if
    end do
  end subroutine read_states

  !> Errors so far. What made the run stop is of the past: it has gone on.
  subroutine read_estimate(file, scene, estimate)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(estimate_t), intent(inout) :: estimate
    real(wp), allocatable :: stress(:), strain(:), sums(:, :)
    integer :: g, n, last

    call file%read('estimate/stress', estimate%stress)
    call file%read('estimate/strain', estimate%strain)
    call file%read('remesh/last_stop', estimate%last_stop)
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      n = last + 1
      last = last + size(scene%groups(g)%connectivity, 2)
      call file%read(group_place(g)//'/error_stress', stress)
      call file%read(group_place(g)//'/error_strain', strain)
      call file%read(group_place(g)//'/strain_sums', sums)
      if (size(stress) == last - n + 1 .and. size(strain) == last - n + 1 .and. size(sums) == 2*(last - n + 1)) then
        estimate%stress_of(n:last) = stress
        estimate%strain_of(n:last) = strain
        estimate%strain_sums(:, n:last) = sums
      else
        call file%record_error(exit_input, group_place(g)//'/strain_sums: does not fit the deck''s group '//scene%groups(g)%name)
      end if
    end do
  end subroutine read_estimate

  !> Pairs decide the order in which the matrix is eliminated: a run that goes on needs them, to the last bit.
  subroutine read_pairs(file, place, pairs)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(pairs_t), intent(inout) :: pairs
    integer, allocatable :: piece(:, :)

    call file%read(place, piece)
    if (all(shape(piece) == shape(pairs%piece))) then
      pairs%piece = piece
    else
      call file%record_error(exit_input, place//': does not fit the deck''s contact')
    end if
  end subroutine read_pairs

  !> Read an array that must have the shape of the one it replaces.
  subroutine read_matrix(file, place, matrix)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(inout) :: matrix(:, :)
    real(wp), allocatable :: values(:, :)

    call file%read(place, values)
    if (all(shape(values) == shape(matrix))) then
      matrix = values
      call refuse_not_finite(file, place, all_finite(values))
    else
      call file%record_error(exit_input, place//': does not fit the deck''s mesh')
    end if
  end subroutine read_matrix

end module exchange
