!> What is known of a run when it ends, beside its state: for its summary.
module run_facts
  use closing_facts, only: closing_t
  use elem_api, only: totals_t
  use kinds, only: wp
  use run_warnings, only: warning_t
  use solution, only: solution_t
  use text, only: string_t
  implicit none
  private
  public :: run_facts_t, unloaded_drift

  !> Facts of the run.
  type :: run_facts_t
    character(len=:), allocatable :: version, deck, deck_text, status, stop_reason, blas
    !> Parameters set on the command line, NAME=VALUE.
    type(string_t), allocatable :: overrides(:)
    !> What is seldom meant of the deck (physics_check), and what speaks against the run or the operation at its end.
    type(string_t), allocatable :: warnings(:)
    !> All warnings that its summary tells: these, checks that do not hold, and at the end of the run those of earlier operations.
    type(warning_t), allocatable :: told(:)
    integer :: exit_code = 0, threads = 1
    !> Seconds by the clock, and of all processors.
    real(wp) :: wall = 0.0_wp, processor = 0.0_wp
    !> Errors that are estimated, and what half of them costs.
    type(closing_t) :: closing
  end type run_facts_t

contains

  !> Change of volume without elastic strain and thermal expansion, over the first one.
  pure function unloaded_drift(solution, totals) result(share)
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(in) :: totals
    real(wp) :: share

    share = (totals%unloaded_volume - solution%work%grown)/solution%initial_volume - 1
  end function unloaded_drift

end module run_facts
