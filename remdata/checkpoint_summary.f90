!> `remdata --about`: the contents of a checkpoint, for scripts: a key and its value on each line. `remdata --schema`: what is in a
!> checkpoint, for people.
module checkpoint_summary
  use cycle_situation, only: due_reason
  use errors, only: error_t
  use exact_numbers, only: exact_text
  use exchange, only: checkpoint_facts_t, describe_checkpoint, read_facts
  use standard_streams, only: print_line, print_lines
  use text, only: string_t, to_text
  implicit none
  private
  public :: print_about, print_schema

contains

  !> Print the contents of the file, or report why it is refused.
  subroutine print_about(path, error)
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_facts_t) :: facts
    character(len=:), allocatable :: why

    call read_facts(path, facts, error)
    if (allocated(error)) return
    call print_line('generation '//to_text(facts%generation), error)
    if (facts%operation > 0) call print_line('operation '//to_text(facts%operation), error)
    call print_line('step '//to_text(facts%step), error)
    call print_line('time '//exact_text(facts%time), error)
    call print_line('unbalanced '//to_text(merge(1, 0, facts%unbalanced)), error)
    call print_line('elements '//to_text(facts%elements), error)
    call print_line('transfer '//to_text(facts%transfer), error)
    call print_line('probation '//to_text(facts%probation), error)
    call print_line('tries '//to_text(facts%tries), error)
    if (facts%error_stress >= 0) call print_line('error_stress_pct '//to_text(100*facts%error_stress, 4), error)
    if (facts%error_strain >= 0) call print_line('error_strain_pct '//to_text(100*facts%error_strain, 4), error)
    why = due_reason(facts)
    if (len(why) > 0) call print_line('due '//why, error)
  end subroutine print_about

  subroutine print_schema(error)
    type(error_t), allocatable, intent(inout) :: error
    type(string_t), allocatable :: lines(:)

    call describe_checkpoint(lines)
    call print_lines(lines, error)
  end subroutine print_schema

end module checkpoint_summary
