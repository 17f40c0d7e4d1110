!> Reading a checkpoint: from a file that `open_checkpoint` has found whole, once for all that is read from it.
module exchange_read
  use contact_ends, only: contact_end_t
  use errors, only: error_t
  use exchange_members, only: check_contact_ends, check_scene, check_solution
  use exchange_parts, only: check_parts, check_shapes
  use exchange_rules, only: require
  use exchange_schema, only: deck_source_t, visit_deck_source
  use hash, only: sha256
  use member_reader, only: member_reader_t
  use next_operation, only: remesh_of
  use own_contact, only: list_folding
  use remesh, only: remesh_t
  use scene, only: scene_t
  use solution, only: solution_t, start_solution
  use visit_remesher, only: visit_contact_ends
  use visit_scene, only: visit_scene_members
  use visit_solution, only: visit_solution_members
  implicit none
  private
  public :: read_bare_scene, read_contact_ends, read_deck_of_checkpoint, read_remesh, read_state

contains

  !> The deck a checkpoint was made from.
  subroutine read_deck_of_checkpoint(reader, deck_path, deck_text, error)
    type(member_reader_t), intent(inout) :: reader
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(error_t), allocatable, intent(out) :: error
    type(deck_source_t) :: deck

    call visit_deck_source(reader, deck)
    call require(reader%file, 'deck/sha256', deck%sha256 == sha256(deck%text), 'is not that of deck/text')
    deck_path = deck%path
    deck_text = deck%text
    call reader%file%status(error)
  end subroutine read_deck_of_checkpoint

  !> The scene as far as a checkpoint holds it, without the deck: mesh, groups with the variables of their state, dies, remeshing.
  !> For programs that know no laws; enough to read the state with `read_state` and to write it with `write_checkpoint`.
  subroutine read_bare_scene(reader, scene, error)
    type(member_reader_t), intent(inout) :: reader
    type(scene_t), intent(out) :: scene
    type(error_t), allocatable, intent(out) :: error

    scene%title = ''
    call visit_scene_members(reader, scene)
    call check_scene(reader%file, scene)
    if (.not. reader%file%failed()) call check_parts(reader%file, scene)
    call reader%file%status(error)
  end subroutine read_bare_scene

  !> Take up the state of a checkpoint. `estimate%triggers` state why the run stopped there, if for a new mesh; a run that
  !> goes on drops them.
  subroutine read_state(reader, scene, solution, error)
    type(member_reader_t), intent(inout) :: reader
    type(scene_t), intent(in) :: scene            !! of the same deck
    type(solution_t), intent(inout) :: solution   !! started from the scene
    type(error_t), allocatable, intent(out) :: error
    integer :: g

    call visit_solution_members(reader, solution)
    if (.not. reader%file%failed()) call check_solution(reader%file, scene, solution)
    if (.not. reader%file%failed()) call check_shapes(reader%file, scene, solution)
    do g = 1, size(solution%groups)
      solution%groups(g)%trial = solution%groups(g)%committed
    end do
    call reader%file%status(error)
  end subroutine read_state

  !> The mesh of a checkpoint, when it is not the deck's own: then only generation, which is 1, and operation are filled.
  subroutine read_remesh(reader, remesh, error)
    type(member_reader_t), intent(inout) :: reader
    type(remesh_t), intent(out) :: remesh
    type(error_t), allocatable, intent(out) :: error
    type(scene_t) :: scene
    type(solution_t) :: solution

    call read_bare_scene(reader, scene, error)
    if (allocated(error)) return
    remesh%operation = scene%operation
    call list_folding(scene, remesh%folding)
    if (scene%generation == 1) return
    call start_solution(scene, solution)
    call read_state(reader, scene, solution, error)
    if (.not. allocated(error)) call remesh_of(scene, solution%step, remesh)
  end subroutine read_remesh

  !> Where contact begins and ends at the instant of a checkpoint.
  subroutine read_contact_ends(reader, scene, ends, error)
    type(member_reader_t), intent(inout) :: reader
    type(scene_t), intent(in) :: scene
    type(contact_end_t), allocatable, intent(out) :: ends(:)   !! (n)
    type(error_t), allocatable, intent(out) :: error

    call visit_contact_ends(reader, ends)
    if (.not. reader%file%failed()) call check_contact_ends(reader%file, scene, ends)
    call reader%file%status(error)
  end subroutine read_contact_ends

end module exchange_read
