!> The old checkpoint as the remesher reads it: its deck, scene, state and ends of contact.
module old_checkpoint
  use contact_ends, only: contact_end_t
  use errors, only: error_t
  use exchange, only: open_checkpoint, read_bare_scene, read_contact_ends, read_deck_of_checkpoint, read_state
  use member_reader, only: member_reader_t
  use scene, only: scene_t
  use solution, only: solution_t, start_solution
  implicit none
  private
  public :: read_old_checkpoint

contains

  !> Read the whole checkpoint; it is opened, and its hash compared, once.
  subroutine read_old_checkpoint(path, deck_path, deck_text, scene, solution, ends, error)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(scene_t), intent(out) :: scene
    type(solution_t), intent(out) :: solution
    type(contact_end_t), allocatable, intent(out) :: ends(:)   !! (nend)
    type(error_t), allocatable, intent(out) :: error
    type(member_reader_t) :: reader
    type(error_t), allocatable :: ignored

    call open_checkpoint(path, reader, error)
    if (allocated(error)) return
    call read_deck_of_checkpoint(reader, deck_path, deck_text, error)
    if (.not. allocated(error)) call read_bare_scene(reader, scene, error)
    if (.not. allocated(error)) call start_solution(scene, solution)
    if (.not. allocated(error)) call read_state(reader, scene, solution, error)
    if (.not. allocated(error)) call read_contact_ends(reader, scene, ends, error)
    call reader%file%close(ignored)
  end subroutine read_old_checkpoint

end module old_checkpoint
