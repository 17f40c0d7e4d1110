!> Writing the checkpoint.
!>
!> Every state array carries the names, units and transfer kinds of its variables, taken from the laws and elements that declare
!> them: reading needs no law. What a scene does not have is written all the same, as 0 or empty, so that a missing member is
!> always a mistake.
module exchange_write
  use contact_ends, only: contact_end_t
  use errors, only: error_t
  use exchange_schema, only: deck_source, deck_source_t, schema_name, schema_version, visit_deck_source
  use hdf5_atomic, only: commit_atomic, create_atomic
  use hdf5_file, only: hdf5_file_t
  use member_writer, only: member_writer_t
  use scene, only: scene_t
  use solution, only: solution_t
  use system, only: file_exists
  use visit_remesher, only: visit_contact_ends
  use visit_scene, only: visit_scene_members
  use visit_solution, only: visit_solution_members
  implicit none
  private
  public :: write_checkpoint

contains

  !> Write the whole state of a run, atomically; the one before is kept beside it, unless it was written between saves: what was
  !> kept beside that stays then, so that a run which was stopped and goes on leaves the same two files as one in one go.
  subroutine write_checkpoint(path, deck_path, deck_text, scene, solution, ends, error, between_saves)
    character(len=*), intent(in) :: path, deck_path, deck_text
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), intent(in) :: ends(:)   !! (nend) where contact begins and ends now
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: between_saves   !! a signal stops the run, and no save is due (default: one is)
    type(member_writer_t) :: writer
    type(deck_source_t) :: deck
    ! a visitor may change what it visits: this one is shown copies
    type(scene_t), allocatable :: shown_scene
    type(solution_t), allocatable :: shown_solution
    type(contact_end_t), allocatable :: shown_ends(:)

    call create_atomic(writer%file, path, error)
    if (allocated(error)) return
    call writer%file%write_attribute('/', 'schema', schema_name)
    call writer%file%write_attribute('/', 'schema_version', schema_version)
    deck = deck_source(deck_path, deck_text)
    call visit_deck_source(writer, deck)
    allocate (shown_scene, source=scene)
    call visit_scene_members(writer, shown_scene)
    allocate (shown_solution, source=solution)
    if (present(between_saves)) shown_solution%between_saves = between_saves
    call visit_solution_members(writer, shown_solution)
    allocate (shown_ends, source=ends)
    call visit_contact_ends(writer, shown_ends)
    call commit_atomic(writer%file, error, keep_previous=.not. is_between_saves(path))
  end subroutine write_checkpoint

  !> Is there a checkpoint called `path` that was written between saves?
  function is_between_saves(path)
    character(len=*), intent(in) :: path
    logical :: is_between_saves
    type(hdf5_file_t) :: file
    type(error_t), allocatable :: error
    integer :: number

    is_between_saves = .false.
    if (.not. file_exists(path)) return
    ! its hash is not compared: no more than one flag is asked for
    call file%open(path, error, hashed=.true.)
    if (allocated(error)) return
    number = 0
    if (file%has_attribute('progress', 'between_saves')) call file%read_attribute('progress', 'between_saves', number)
    call file%close(error)
    is_between_saves = number == 1 .and. .not. allocated(error)
  end function is_between_saves

end module exchange_write
