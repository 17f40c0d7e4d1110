!> The situation of a cycle: what its folder holds, how the program that was called last ended, what was tried. Plain data, filled
!> by `cycle_folder` from files and by hand in tests; `cycle_decision` decides the next action.
module cycle_situation
  use cuts, only: trim_trigger, web_trigger
  use cycle_table, only: try_row_t
  use exchange, only: checkpoint_facts_t
  use remeshing, only: of_distress, trigger_words
  use text, only: to_text, two_digits
  implicit none
  private
  public :: checkpoint_file_t, ended_t, made_mesh_t, situation_t
  public :: ended_nothing, ended_check, ended_lagamine, ended_remdata, ended_known
  public :: due_reason, is_due, is_due_by, must_be_replaced, is_first_mesh, is_read, first_line
  public :: try_name, mesh_name, current_name

  !> What was called last: nothing yet, `lagamine --check`, the solver, the remesher; or its end has been dealt with.
  integer, parameter :: ended_nothing = 0, ended_check = 1, ended_lagamine = 2, ended_remdata = 3, ended_known = 4

  !> Name of the checkpoint of a run, after the name of its deck.
  character(len=*), parameter :: current_name = 'ckp.h5'
  !> Why a mesh is due where bodies are given by their contours.
  character(len=*), parameter :: no_mesh_yet = 'no mesh yet'

  !> A checkpoint that may be there and may be whole.
  type :: checkpoint_file_t
    logical :: found = .false.
    !> Why it is refused; unallocated when it is whole.
    character(len=:), allocatable :: refused
    type(checkpoint_facts_t) :: facts
  end type checkpoint_file_t

  !> How the last program ended.
  type :: ended_t
    integer :: program = ended_nothing
    integer :: code = 0
    !> Seconds after which it was ended for being too slow, 0: it was not.
    integer :: late = 0
    !> Checkpoint it began with, as its name ends; '' for none.
    character(len=:), allocatable :: from
    !> Its errors, never empty.
    character(len=:), allocatable :: said
  end type ended_t

  !> The new mesh in question: the one that is due, or the one the run is on as long as it is not entered in the table.
  type :: made_mesh_t
    integer :: generation = 0
    !> Checkpoint where the old mesh stopped, and the save before it; and the one that the old mesh was made from, where it is the
    !> third generation's: without a mesh if the old one was a first mesh.
    type(checkpoint_file_t) :: old_end, old_earlier, old_source
    !> Number of the try at hand, and its checkpoint.
    integer :: number = 1
    type(checkpoint_file_t) :: made
    !> The remesher's facts are there, which it writes last.
    logical :: has_facts = .false.
    !> Responsible stages as reported by the remesher, the restart and the first steps, '' for none.
    character(len=:), allocatable :: made_stage, restart_stage, steps_stage
    !> The restart refused the mesh.
    logical :: restart_refused = .false.
    !> There is a file of a try, perhaps of another one.
    logical :: has_tries = .false.
  end type made_mesh_t

  type :: situation_t
    !> Folder and name of the deck: what all names of files begin with, but for `table`.
    character(len=:), allocatable :: stem, folder, table
    !> Other ways tried at most, as the user says; negative: as the deck says.
    integer :: tries = -1
    !> Begin anew.
    logical :: fresh = .false.
    type(ended_t) :: ended
    !> The run's checkpoint and the one before.
    type(checkpoint_file_t) :: current, previous
    type(made_mesh_t) :: new
    !> `new%old_end` is the run's checkpoint.
    logical :: end_is_kept = .false.
    type(try_row_t), allocatable :: rows(:)
    !> `summary.json` reports the end of the scene, at this step on this mesh.
    logical :: finished = .false.
    !> Warnings that it has.
    integer :: warnings = 0
    !> There is room on the disk for a new mesh.
    logical :: has_room = .true.
  end type situation_t

contains

  !> The file is there and whole.
  pure function is_read(file)
    type(checkpoint_file_t), intent(in) :: file
    logical :: is_read

    is_read = file%found .and. .not. allocated(file%refused)
  end function is_read

  !> Bodies are given by their contours, and have no mesh yet.
  pure function is_first_mesh(facts)
    type(checkpoint_facts_t), intent(in) :: facts
    logical :: is_first_mesh

    is_first_mesh = facts%elements == 0
  end function is_first_mesh

  pure function is_due(facts)
    type(checkpoint_facts_t), intent(in) :: facts
    logical :: is_due

    is_due = is_first_mesh(facts)
    if (allocated(facts%triggers)) is_due = is_due .or. size(facts%triggers) > 0
  end function is_due

  !> The old mesh cannot go on: steps fail on it, or a body is cut.
  pure function must_be_replaced(facts) result(yes)
    type(checkpoint_facts_t), intent(in) :: facts
    logical :: yes

    yes = is_due_by(facts, of_distress) .or. is_due_by(facts, trim_trigger) .or. is_due_by(facts, web_trigger)
  end function must_be_replaced

  !> This limit has been passed.
  pure function is_due_by(facts, trigger) result(yes)
    type(checkpoint_facts_t), intent(in) :: facts
    character(len=*), intent(in) :: trigger
    logical :: yes
    integer :: k

    yes = .false.
    if (.not. allocated(facts%triggers)) return
    yes = any([(facts%triggers(k)%s == trigger, k=1, size(facts%triggers))])
  end function is_due_by

  !> Why a new mesh is due, '' if it is not.
  pure function due_reason(facts) result(why)
    type(checkpoint_facts_t), intent(in) :: facts
    character(len=:), allocatable :: why
    integer :: k

    why = ''
    if (allocated(facts%triggers)) then
      do k = 1, size(facts%triggers)
        if (k > 1) why = why//'; '
        why = why//trigger_words(facts%triggers(k)%s, facts%values(k), facts%limits(k))
      end do
    end if
    if (is_first_mesh(facts)) why = no_mesh_yet
  end function due_reason

  !> The first line of a program's messages that is not a note.
  pure function first_line(said) result(line)
    character(len=*), intent(in) :: said
    character(len=:), allocatable :: line
    integer :: first, last

    line = ''
    first = 1
    do while (first <= len(said))
      last = first + index(said(first:)//new_line('a'), new_line('a')) - 2
      line = said(first:last)
      if (index(line, 'note: ') /= 1) return
      first = last + 2
    end do
    line = ''
  end function first_line

  !> Name of a file of mesh `generation`, after the name of the deck: g02.end.h5.
  pure function mesh_name(generation, ending) result(name)
    integer, intent(in) :: generation
    character(len=*), intent(in) :: ending
    character(len=:), allocatable :: name

    name = 'g'//two_digits(generation)//'.'//ending
  end function mesh_name

  !> Name of the checkpoint of a try at mesh `generation`.
  pure function try_name(generation, number) result(name)
    integer, intent(in) :: generation, number
    character(len=:), allocatable :: name

    name = mesh_name(generation, 'try'//to_text(number)//'.h5')
  end function try_name

end module cycle_situation
