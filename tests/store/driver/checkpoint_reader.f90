!> Reads checkpoints as the programs do, one after the other in one process: for tests that try very many.
!>
!> usage: checkpoint_reader DECK < paths
!> For each path a line: exit codes of what `remdata`, `remdata --about` and `lagamine --resume` read of the file, then the first
!> message.
program checkpoint_reader
  use, intrinsic :: iso_fortran_env, only: input_unit, output_unit
  use arguments, only: argument
  use contact_ends, only: contact_end_t
  use deck_reader, only: deck_t, fingerprint_text, read_deck
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_bug, exit_done, exit_input, fail
  use exchange, only: checkpoint_facts_t, open_checkpoint, read_bare_scene, read_contact_ends, read_deck_of_checkpoint, &
    read_facts, read_facts_alone, read_remesh, read_state
  use member_reader, only: member_reader_t
  use remesh, only: remesh_t
  use scene, only: lacks_mesh, scene_t
  use scene_reader, only: read_scene
  use solution, only: solution_t, start_solution
  use system, only: program_stop
  use text, only: string_t, to_text
  implicit none
  character(len=:), allocatable :: deck_path
  character(len=4096) :: path
  type(error_t), allocatable :: error
  character(len=:), allocatable :: line, message
  integer :: status

  call argument(1, deck_path)
  do
    read (input_unit, '(a)', iostat=status) path
    if (status /= 0) exit
    line = ''
    message = ''
    call as_remesher(trim(path), error)
    call note()
    call about(trim(path), error)
    call note()
    call as_solver(trim(path), error)
    call note()
    write (output_unit, '(a)') line//message
    flush (output_unit)
  end do
  call program_stop(exit_done)

contains

  subroutine note()
    if (allocated(error)) then
      line = line//to_text(error%code)//' '
      if (message == '') message = first_line(error%message)
    else
      line = line//'0 '
    end if
  end subroutine note

  subroutine as_remesher(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(member_reader_t) :: reader
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(contact_end_t), allocatable :: ends(:)
    type(error_t), allocatable :: ignored
    character(len=:), allocatable :: name, text

    call open_checkpoint(path, reader, error)
    if (allocated(error)) return
    call read_deck_of_checkpoint(reader, name, text, error)
    if (.not. allocated(error)) call read_bare_scene(reader, scene, error)
    if (.not. allocated(error)) call start_solution(scene, solution)
    if (.not. allocated(error)) call read_state(reader, scene, solution, error)
    if (.not. allocated(error)) call read_contact_ends(reader, scene, ends, error)
    call reader%file%close(ignored)
  end subroutine as_remesher

  !> What is read alone of a file that is taken for good is what is read of all of it.
  subroutine about(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_facts_t) :: facts, alone

    call read_facts(path, facts, error)
    if (allocated(error)) return
    call read_facts_alone(path, alone, error)
    if (allocated(error)) return
    if (.not. are_same(facts, alone)) call fail(error, exit_bug, 'read_facts and read_facts_alone differ')
  end subroutine about

  pure function are_same(a, b)
    type(checkpoint_facts_t), intent(in) :: a, b
    logical :: are_same
    integer :: k

    are_same = all([a%generation, a%step, a%elements, a%operation, a%remeshings, a%transfer, a%probation, a%tries] == &
                   [b%generation, b%step, b%elements, b%operation, b%remeshings, b%transfer, b%probation, b%tries]) &
               .and. .not. any([a%time, a%error_stress, a%error_strain] /= [b%time, b%error_stress, b%error_strain]) &
               .and. all([a%unbalanced, a%has_zones] .eqv. [b%unbalanced, b%has_zones]) &
               .and. size(a%triggers) == size(b%triggers)
    if (.not. are_same) return
    are_same = .not. any(a%values /= b%values .or. a%limits /= b%limits) .and. &
               all([(a%triggers(k)%s == b%triggers(k)%s, k=1, size(a%triggers))])
  end function are_same

  subroutine as_solver(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(member_reader_t) :: reader
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(remesh_t), allocatable :: remesh
    type(error_t), allocatable :: ignored
    character(len=:), allocatable :: name, text, own
    type(string_t), allocatable :: folding(:)
    logical :: at_rest

    call open_checkpoint(path, reader, error)
    if (allocated(error)) return
    call read_deck(deck_path, [string_t ::], deck, diagnostics)
    call fingerprint_text(deck, own)
    call read_deck_of_checkpoint(reader, name, text, error)
    if (.not. allocated(error)) then
      if (text /= own) call fail(error, exit_input, 'another deck')
    end if
    allocate (remesh, folding(0))
    if (.not. allocated(error)) call read_remesh(reader, remesh, error)
    if (.not. allocated(error)) then
      folding = remesh%folding
      if (remesh%generation == 1) deallocate (remesh)
      call read_scene(deck, scene, diagnostics, remesh, folding=folding)
      call diagnostics%error(error)
      if (allocated(remesh) .and. .not. allocated(error)) then
        if (scene%generation /= remesh%generation) call fail(error, exit_input, 'its groups or sides are not those of the deck')
      end if
    end if
    if (.not. allocated(error)) then
      at_rest = lacks_mesh(scene)
      if (allocated(remesh)) at_rest = remesh%step == 0
      call start_solution(scene, solution)
      if (.not. at_rest) call read_state(reader, scene, solution, error)
    end if
    call reader%file%close(ignored)
  end subroutine as_solver

  pure function first_line(text) result(line)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line

    line = text(:index(text//new_line('a'), new_line('a')) - 1)
  end function first_line

end program checkpoint_reader
