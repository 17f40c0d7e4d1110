!> Heat through contact on which the motion and the temperatures of a step do not agree, where each is found once (SOLVE ONCE).
module unsettled_contact
  use heat_contacts, only: jumps_at_opening
  use kinds, only: wp
  use listing, only: list_note
  use run_record, only: run_t
  use scene, only: role_heat_contact, scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: loses_touch, note_unsettled_contact, touch_advice, warn_of_unsettled_contact

  character(len=*), parameter :: touch_advice = 'let PRESS begin, at pressure 0, with what GAP and HO give at gap 0, and grow ' &
                                                //'over a pressure of 1e-5 of Young''s modulus or more'

contains

  !> What the step just accepted adds; the first one of an operation with a note.
  subroutine note_unsettled_contact(scene, solution, outcome, run)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(outcome_t), intent(in) :: outcome   !! of the step just accepted
    type(run_t), intent(inout) :: run

    if (.not. outcome%contact_lag > 0) return
    if (solution%unsettled_steps == 0) call list_note(run%listing, 'note: step '//to_text(solution%step)//': '// &
                                                      unsettled_words(scene, outcome%contact_lag))
    solution%unsettled_steps = solution%unsettled_steps + 1
    solution%unsettled_share = max(solution%unsettled_share, outcome%contact_lag)
  end subroutine note_unsettled_contact

  !> A line for all such steps, added to the warnings of a run or an operation at its end.
  subroutine warn_of_unsettled_contact(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines

    if (solution%unsettled_steps > 0) call add_text(warnings, 'in '//to_text(solution%unsettled_steps)//' of ' &
                                                    //to_text(solution%step)//' steps ' &
                                                    //unsettled_words(scene, solution%unsettled_share))
  end subroutine warn_of_unsettled_contact

  !> What it is, and what to do.
  function unsettled_words(scene, share) result(words)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: share   !! of the heat through contact
    character(len=:), allocatable :: words
    character(len=:), allocatable :: advice

    advice = 'shorter steps, or SOLVE CONVERGE'
    if (loses_touch(scene)) advice = touch_advice
    words = 'heat and contact do not agree: '//to_text(100*share, 3)//' % of the heat at contact is another by the pressures ' &
            //'and gaps that it leads to (COU2DC), as where a part shrinks off the die that cools it; temperatures go to and fro ' &
            //'from step to step there, by as much as the errors in time say; '//advice
  end function unsettled_words

  !> Heat at a contact that moves jumps where points open, or all but jumps: over a pressure by which the body is strained as by
  !> some hundredths of a degree.
  pure function loses_touch(scene)
    type(scene_t), intent(in) :: scene
    logical :: loses_touch
    real(wp), parameter :: little = 1.0e-6_wp   ! of Young's modulus
    integer :: g

    loses_touch = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_heat_contact .or. scene%groups(g)%host == 0) cycle
      loses_touch = loses_touch .or. jumps_at_opening(scene%groups(g)%heat_contact, &
                                                     little*scene%groups(scene%groups(g)%host)%modulus)
    end do
  end function loses_touch

end module unsettled_contact
