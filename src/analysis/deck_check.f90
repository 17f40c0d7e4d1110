!> What is reported of a deck before it runs: `--check`, and the warnings that a run begins with.
module deck_check
  use cards_operations, only: list_operations, operations_t, read_operation
  use deck_reader, only: deck_t, read_deck
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use law_api, only: law_t
  use law_registry, only: list_laws
  use physics_check, only: check_operation, check_physics
  use run_options, only: run_options_t, stem_of
  use scene, only: lacks_mesh, scene_t
  use scene_file, only: write_scene
  use scene_summary, only: scene_lines
  use standard_streams, only: print_lines
  use system, only: join_path, make_directory
  use text, only: string_t
  use unknowns_summary, only: unknowns_lines
  implicit none
  private
  public :: check_deck, look_at_deck, as_warnings

contains

  !> What can be said of the deck before a run: of its own mesh or contours, whatever mesh the scene has now. The table of places
  !> and their dies is empty for a later mesh.
  subroutine look_at_deck(options, scene, table, warnings, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: table(:), warnings(:)
    type(error_t), allocatable, intent(out) :: error
    type(law_t), allocatable :: laws(:)
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    type(operations_t) :: operations
    type(scene_t) :: own

    call list_laws(laws)
    ! the part with which a later operation begins is not known to its deck
    if (scene%operation > 1) then
      allocate (table(0))
      call check_operation(scene, laws, warnings)
      return
    end if
    if (scene%generation == 1) then
      call check_physics(scene, laws, table, warnings)
      return
    end if
    call read_deck(options%deck, options%overrides, deck, diagnostics)
    call list_operations(deck, operations, diagnostics)
    call read_operation(deck, operations, 1, own, diagnostics)
    call diagnostics%error(error)
    if (.not. allocated(error)) call check_physics(own, laws, table, warnings)
    if (allocated(table)) deallocate (table)
    allocate (table(0))
  end subroutine look_at_deck

  !> --check: every operation in words; where a folder is given also for scripts: the first one as a deck without any.
  subroutine check_deck(options, deck, diagnostics, operations, scene, error)
    type(run_options_t), intent(in) :: options
    type(deck_t), intent(inout), target :: deck
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(operations_t), intent(inout) :: operations
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(scene_t), allocatable :: one
    character(len=:), allocatable :: ending
    integer :: k

    if (.not. options%default_out) call make_directory(options%out, error)
    do k = 1, max(operations%count, 1)
      if (allocated(error)) return
      allocate (one)
      ending = '.scene.json'
      if (k == max(scene%operation, 1)) then
        one = scene
      else
        call read_operation(deck, operations, k, one, diagnostics)
        call diagnostics%error(error)
        if (allocated(error)) return
      end if
      if (k > 1) ending = '.'//one%operation_name//ending
      call print_check(options, one, error)
      if (.not. (allocated(error) .or. options%default_out)) &
        call write_scene(join_path(options%out, stem_of(options%deck)//ending), one, error)
      deallocate (one)
    end do
  end subroutine check_deck

  !> --check: the scene in words.
  subroutine print_check(options, scene, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: too_large
    type(string_t), allocatable :: lines(:), more(:), table(:), warnings(:)

    call scene_lines(scene, lines)
    allocate (more(0))
    call look_at_deck(options, scene, table, warnings, error)
    if (allocated(error)) return
    call print_lines(lines, error)
    call print_lines(table, error)
    ! a scene that is too large for this machine is reported all the same
    if (.not. lacks_mesh(scene)) call unknowns_lines(scene, more, too_large)
    call print_lines(more, error)
    call print_lines(as_warnings(warnings), error)
    if (.not. allocated(error) .and. allocated(too_large)) call move_alloc(too_large, error)
  end subroutine print_check

  !> Lines that begin with what they are.
  pure function as_warnings(lines) result(marked)
    type(string_t), intent(in) :: lines(:)
    type(string_t) :: marked(size(lines))
    integer :: k

    do k = 1, size(lines)
      marked(k)%s = 'WARNING: '//lines(k)%s
    end do
  end function as_warnings

end module deck_check
