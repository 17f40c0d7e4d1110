!> The schema of the checkpoint: its version, the places of its datasets, and how a file is opened.
module exchange_schema
  use errors, only: error_t, exit_input, fail
  use hdf5_atomic, only: open_verified
  use hdf5_file, only: hdf5_file_t
  use text, only: to_text
  implicit none
  private
  public :: fixation_place, group_place, open_checkpoint, schema_name, schema_version, set_place

  !> Raised whenever a dataset changes its name, shape or meaning.
  integer, parameter :: schema_version = 7
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

end module exchange_schema
