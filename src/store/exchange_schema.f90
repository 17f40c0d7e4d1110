!> The schema of the checkpoint: its version, the visit of the members beside scene and solution, and how a file is opened.
module exchange_schema
  use errors, only: error_t, exit_input, fail
  use hash, only: sha256
  use hdf5_atomic, only: open_verified
  use member_reader, only: member_reader_t
  use text, only: to_text
  use visitors, only: kept, visitor_t
  implicit none
  private
  public :: deck_source, deck_source_t, group_place, open_checkpoint, schema_name, schema_version, visit_deck_source

  !> Raised whenever a member changes its name, shape or meaning.
  integer, parameter :: schema_version = 32
  character(len=*), parameter :: schema_name = 'lagamine checkpoint'

  !> The deck a checkpoint is made from.
  type :: deck_source_t
    character(len=:), allocatable :: path
    !> All that the deck says, files and parameters put in; and its hash.
    character(len=:), allocatable :: text, sha256
  end type deck_source_t

contains

  !> Open a checkpoint that is whole and of this schema. With `is_ours`, where a program of ours has just written it, the hash is
  !> enough.
  subroutine open_checkpoint(path, reader, error, is_ours)
    character(len=*), intent(in) :: path
    class(member_reader_t), intent(inout) :: reader
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: is_ours
    character(len=:), allocatable :: schema
    type(error_t), allocatable :: ignored
    integer :: version
    logical :: verify

    reader%place = ''
    verify = .true.
    if (present(is_ours)) verify = .not. is_ours
    if (verify) then
      call open_verified(reader%file, path, error)
    else
      call reader%file%open(path, error)
    end if
    if (allocated(error)) return
    schema = ''
    version = 0
    associate (file => reader%file)
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
    end associate
  end subroutine open_checkpoint

  pure function deck_source(path, text) result(source)
    character(len=*), intent(in) :: path, text
    type(deck_source_t) :: source

    source%path = path
    source%text = text
    source%sha256 = sha256(text)
  end function deck_source

  subroutine visit_deck_source(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(deck_source_t), intent(inout) :: self

    call visitor%enter('deck')
    call visitor%long_text('path', self%path, kept)
    call visitor%long_text('text', self%text, kept)
    call visitor%member('sha256', self%sha256, kept)
    call visitor%leave('deck')
  end subroutine visit_deck_source

  !> Where a group of elements stands.
  pure function group_place(g) result(place)
    integer, intent(in) :: g
    character(len=:), allocatable :: place

    place = 'groups/'//to_text(g)
  end function group_place

end module exchange_schema
