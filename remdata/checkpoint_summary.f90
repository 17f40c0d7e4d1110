!> `remdata --about`: the contents of a checkpoint, for scripts: a key and its value on each line. `remdata --schema`: what is in a
!> checkpoint, for people.
module checkpoint_summary
  use cycle_situation, only: due_reason
  use errors, only: error_t
  use exact_numbers, only: exact_text
  use exchange, only: checkpoint_facts_t, describe_checkpoint, read_facts
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
    call say('generation', to_text(facts%generation))
    call say('step', to_text(facts%step))
    call say('time', exact_text(facts%time))
    call say('unbalanced', to_text(merge(1, 0, facts%unbalanced)))
    call say('elements', to_text(facts%elements))
    call say('transfer', to_text(facts%transfer))
    call say('probation', to_text(facts%probation))
    call say('tries', to_text(facts%tries))
    if (facts%error_stress >= 0) call say('error_stress_pct', to_text(100*facts%error_stress, 4))
    if (facts%error_strain >= 0) call say('error_strain_pct', to_text(100*facts%error_strain, 4))
    why = due_reason(facts)
    if (len(why) > 0) call say('due', why)
  end subroutine print_about

  subroutine print_schema()
    type(string_t), allocatable :: lines(:)
    integer :: k

    call describe_checkpoint(lines)
    do k = 1, size(lines)
      write (*, '(a)') lines(k)%s
    end do
  end subroutine print_schema

  subroutine say(word, its_value)
    character(len=*), intent(in) :: word, its_value

    write (*, '(a)') word//' '//its_value
  end subroutine say

end module checkpoint_summary
