!> The checkpoint: exchange between solver and REMDATA, and restart file.
!>
!> This module owns the schema; nothing else names a dataset of it. Every state array carries the
!> names, units and transfer kinds of its variables, taken from the laws and elements that declare
!> them: who reads it needs to know no law.
module exchange
  use contact_ends, only: contact_end_t
  use dies, only: is_deformable
  use errors, only: error_t, exit_input, fail
  use hash, only: sha256
  use hdf5_atomic, only: commit_atomic, create_atomic, open_verified
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use pairs, only: pairs_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: write_checkpoint, read_deck_of_checkpoint, read_checkpoint, read_contact_ends, schema_version

  !> Raised whenever a dataset changes its name, shape or meaning.
  integer, parameter :: schema_version = 2
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
    call write_ends(file, ends)
    call commit_atomic(file, error, keep_previous=.true.)
  end subroutine write_checkpoint

  subroutine write_mesh(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    integer :: k

    call file%write('mesh/generation', scene%generation)
    call file%write('mesh/coordinates', scene%mesh%coordinates)
    call file%write_attribute('mesh/coordinates', 'unit', 'length')
    call file%write('mesh/labels', scene%mesh%labels)
    do k = 1, size(scene%mesh%sides)
      call file%write('mesh/sides/'//scene%mesh%sides(k)%name, scene%mesh%sides(k)%nodes)
    end do
  end subroutine write_mesh

  subroutine write_dies(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: k

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
        if (group%die > 0) call file%write(place//'/die', scene%dies(group%die)%name)
        if (group%material > 0) call file%write(place//'/material', scene%materials(group%material)%name)
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
        call file%write(place//'/state', solution%groups(g)%committed)
        deallocate (names, units, kinds)
      end associate
    end do
  end subroutine write_states

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

    call open_checkpoint(path, file, error)
    if (allocated(error)) return
    call file%read('progress/time', solution%time)
    call file%read('progress/step', solution%step)
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
    call read_dies(file, scene, solution)
    call read_states(file, scene, solution)
    call file%close(error)
  end subroutine read_checkpoint

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
  end subroutine read_triple

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
      else
        call file%record_error(exit_input, group_place(g)//'/state: does not fit the deck''s group '//scene%groups(g)%name)
      end if
    end do
  end subroutine read_states

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
    else
      call file%record_error(exit_input, place//': does not fit the deck''s mesh')
    end if
  end subroutine read_matrix

end module exchange
