!> The schema of the checkpoint: its version, the places of its datasets, and how a file is opened and read with care.
module exchange_schema
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use errors, only: error_t, exit_input, fail
  use hdf5_atomic, only: open_verified
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: all_finite, fixation_place, group_place, open_checkpoint, read_matrix, read_triple, refuse_not_finite, schema_name, &
           schema_version, set_place

  !> Raised whenever a dataset changes its name, shape or meaning.
  integer, parameter :: schema_version = 6
  character(len=*), parameter :: schema_name = 'lagamine checkpoint'

contains

  subroutine open_checkpoint(path, file, error)
    character(len=*), intent(in) :: path
    type(hdf5_file_t), intent(inout) :: file
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: schema
    type(error_t), allocatable :: ignored
    integer :: version

    call open_verified(file, path, error)
    if (allocated(error)) return
    schema = ''
    version = 0
    if (file%has_attribute('/', 'schema')) call file%read_attribute('/', 'schema', schema)
    if (file%has_attribute('/', 'schema_version')) call file%read_attribute('/', 'schema_version', version)
    call file%status(error)
    if (allocated(error)) then
      call file%close(ignored)
    else if (schema /= schema_name) then
      call file%close(ignored)
      call fail(error, exit_input, path//': not a checkpoint of lagamine')
    else if (version /= schema_version) then
      call file%close(ignored)
      call fail(error, exit_input, path//': checkpoint of schema '//to_text(version)//', this program reads schema ' &
                //to_text(schema_version))
    end if
  end subroutine open_checkpoint

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

  subroutine read_triple(file, place, triple)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(inout) :: triple(3)
    real(wp), allocatable :: values(:)

    call file%read(place, values)
    if (size(values) == 3) triple = values
    call refuse_not_finite(file, place, all(ieee_is_finite(values)))
  end subroutine read_triple

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

  !> False for NaN too. (A comparison with it would trap in a Debug build.)
  pure function all_finite(values) result(finite)
    real(wp), intent(in) :: values(:, :)
    logical :: finite

    finite = all(ieee_is_finite(values))
  end function all_finite

  !> A state that is not a number would spread through all that follows.
  subroutine refuse_not_finite(file, place, finite)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    logical, intent(in) :: finite

    if (.not. finite) call file%record_error(exit_input, place//': holds what is not a finite number')
  end subroutine refuse_not_finite

end module exchange_schema
