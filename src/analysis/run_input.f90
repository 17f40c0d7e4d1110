!> What a run begins with: deck, operations, scene, and the mesh of a checkpoint; with all mistakes at once.
module run_input
  use cards_operations, only: list_operations, operations_t, read_operation
  use deck_reader, only: deck_t, of_scene, read_deck, refuse_other_kind
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_input, fail
  use exchange, only: open_checkpoint, read_deck_of_checkpoint, read_remesh
  use history, only: add_columns
  use member_reader, only: member_reader_t
  use next_operation, only: mesh_for_operation
  use remesh, only: remesh_t
  use run_options, only: run_options_t
  use scene, only: lacks_mesh, scene_t
  use steel_files, only: fingerprint_with_files
  implicit none
  private
  public :: read_input, read_next_operation

contains

  !> Deck and scene, with all mistakes at once.
  subroutine read_input(options, deck, diagnostics, operations, scene, text, at_rest, checkpoint, error)
    type(run_options_t), intent(in) :: options
    type(deck_t), intent(out), target :: deck
    type(diagnostics_t), intent(inout), target :: diagnostics   !! without mistakes
    type(operations_t), intent(out) :: operations
    type(scene_t), intent(out) :: scene
    character(len=:), allocatable, intent(out) :: text
    logical, intent(out) :: at_rest   !! there is a new mesh, but no step has been made
    type(member_reader_t), intent(inout) :: checkpoint   !! open afterwards, where one is resumed
    type(error_t), allocatable, intent(out) :: error
    type(remesh_t), allocatable :: remesh
    type(error_t), allocatable :: unfit
    logical :: sound, other_kind
    integer :: operation, generation

    call read_deck(options%deck, options%overrides, deck, diagnostics)
    other_kind = .false.
    if (deck%complete) call refuse_other_kind(deck, of_scene, diagnostics, other_kind)
    if (other_kind .or. .not. deck%complete) then
      ! what a missing file holds is not known, nor what is wrong without it
      at_rest = .false.
      call diagnostics%error(error)
      return
    end if
    sound = diagnostics%count() == 0
    if (sound .and. allocated(options%resume)) then
      call fingerprint_with_files(deck, text)
      call open_checkpoint(options%resume, checkpoint, unfit)
      if (.not. allocated(unfit)) call read_mesh_of(checkpoint, text, remesh, unfit)
    end if
    call list_operations(deck, operations, diagnostics)
    if (allocated(options%fineness)) operations%fineness = options%fineness
    if (allocated(remesh)) operations%folding = remesh%folding
    operation = 1
    if (operations%count > 0) call read_all(deck, operations, diagnostics, scene)
    generation = 1
    if (allocated(remesh)) then
      operation = max(remesh%operation, 1)
      generation = remesh%generation
      ! the deck's own mesh
      if (generation == operation) deallocate (remesh)
    end if
    ! an empty deck has no other mistakes
    if (operations%count > 0) then
      if (generation > 1 .and. diagnostics%count() == 0 .and. operation <= operations%count) then
        call read_operation(deck, operations, operation, scene, diagnostics, remesh)
        if (.not. allocated(remesh)) scene%generation = generation
      end if
    else if (sound .or. size(deck%cards) > 0) then
      call read_operation(deck, operations, operation, scene, diagnostics, remesh)
    end if
    call diagnostics%error(error)
    if (allocated(remesh)) then
      if (scene%generation /= remesh%generation) then
        ! the deck was read without elements of blocks: its errors do not count
        if (allocated(error)) deallocate (error)
        call fail(unfit, exit_input, options%resume//': its groups or sides are not those of the deck')
      end if
    end if
    if (.not. allocated(error) .and. allocated(unfit)) call move_alloc(unfit, error)
    if (.not. allocated(error)) call fingerprint_with_files(deck, text)
    at_rest = allocated(remesh)
    if (at_rest) at_rest = remesh%step == 0
    if (.not. allocated(remesh)) at_rest = lacks_mesh(scene)
  end subroutine read_input

  !> All operations on the deck's own mesh, for their mistakes, their times and the columns of the history; the first one's scene.
  subroutine read_all(deck, operations, diagnostics, scene)
    type(deck_t), intent(inout), target :: deck
    type(operations_t), intent(inout) :: operations
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(scene_t), intent(out) :: scene
    type(scene_t), allocatable :: one
    integer :: k

    do k = 1, operations%count
      allocate (one)
      call read_operation(deck, operations, k, one, diagnostics)
      if (k == 1) scene = one
      if (diagnostics%count() == 0) call add_columns(one, operations%columns)
      deallocate (one)
    end do
  end subroutine read_all

  !> The mesh of a checkpoint, which must come from the same deck: of the deck's own only its generation and operation.
  subroutine read_mesh_of(checkpoint, text, remesh, error)
    type(member_reader_t), intent(inout) :: checkpoint
    character(len=*), intent(in) :: text
    type(remesh_t), allocatable, intent(out) :: remesh
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: old_path, old_text

    call read_deck_of_checkpoint(checkpoint, old_path, old_text, error)
    if (allocated(error)) return
    if (old_text /= text) then
      call fail(error, exit_input, checkpoint%file%path()//': made from another deck than the one given (it was '//old_path//')', &
                'resume with the same deck and the same -p options')
      return
    end if
    allocate (remesh)
    call read_remesh(checkpoint, remesh, error)
  end subroutine read_mesh_of

  !> The scene of the operation after that of a scene, on its mesh.
  subroutine read_next_operation(deck, diagnostics, operations, scene, step, next, error)
    type(deck_t), intent(inout), target :: deck
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(operations_t), intent(inout) :: operations
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: step
    type(scene_t), intent(out) :: next
    type(error_t), allocatable, intent(out) :: error
    type(remesh_t) :: remesh

    if (scene%generation == scene%operation) then
      ! no mesh but the deck's own so far
      call read_operation(deck, operations, scene%operation + 1, next, diagnostics)
      next%generation = scene%generation + 1
    else
      call mesh_for_operation(scene, step, remesh)
      call read_operation(deck, operations, scene%operation + 1, next, diagnostics, remesh)
    end if
    call diagnostics%error(error)
  end subroutine read_next_operation

end module run_input
