!> How a run goes on whose body has met itself where no card gives its sides contact: as from a checkpoint, of a scene that has such
!> contact (folding_bodies).
module folding_run
  use added_contact, only: take_over_state
  use bodies, only: bodies_of_nodes
  use cards_operations, only: operations_t, read_operation
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_no_convergence, fail
  use exchange, only: write_checkpoint
  use next_operation, only: remesh_of
  use own_contact, only: first_group, list_folding, passes_itself_advice, passes_itself_words
  use remesh, only: remesh_t
  use run_record, only: ends_now, run_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: add_text
  implicit none
  private
  public :: save_with_contact

contains

  !> The checkpoint from which the run goes on: that of its last accepted step, with the contact that it needs.
  subroutine save_with_contact(deck, diagnostics, operations, scene, solution, folding, run, error)
    type(deck_t), intent(inout), target :: deck
    type(diagnostics_t), intent(inout), target :: diagnostics   !! without mistakes
    type(operations_t), intent(inout) :: operations
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: folding   !! a group of the body that has met itself
    type(run_t), intent(in) :: run
    type(error_t), allocatable, intent(out) :: error
    type(remesh_t) :: remesh
    type(scene_t) :: next
    type(solution_t) :: after
    integer :: operation, first

    operation = max(scene%operation, 1)
    call list_folding(scene, operations%folding)
    associate (body => bodies_of_nodes(scene))
      first = first_group(scene, body, body(scene%groups(folding)%connectivity(1, 1)))
    end associate
    call add_text(operations%folding, scene%groups(first)%name)
    if (scene%generation == operation) then
      ! no mesh but the deck's own so far
      call read_operation(deck, operations, operation, next, diagnostics)
      next%generation = scene%generation
    else
      call remesh_of(scene, solution%step, remesh)
      call read_operation(deck, operations, operation, next, diagnostics, remesh)
    end if
    call diagnostics%error(error)
    if (.not. allocated(error) .and. size(next%dies) == size(scene%dies)) &
      call fail(error, exit_no_convergence, passes_itself_words//': '//run%folds//', where supports hold its sides', &
                passes_itself_advice)
    if (allocated(error)) return
    call take_over_state(solution, next, after)
    call write_checkpoint(run%stem//'.ckp.h5', run%deck_path, run%deck_text, next, after, ends_now(next, after), error, &
                          between_saves=.true.)
  end subroutine save_with_contact

end module folding_run
