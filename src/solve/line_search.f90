!> How far to go along a correction: the whole of it, unless that is too far.
!>
!> The residual along the correction is that of the motion; where temperatures are solved for with it, at those at the end of the
!> correction: at a share s of it without what the rest of their correction does to the motion (forces_of_others).
!>
!> The whole is taken when the residual along the correction falls to `search_above` of what it was,
!> or the whole residual falls. Otherwise the zero of the residual along the correction is sought by
!> regula falsi in the bracket found (M.A. Crisfield, Non-linear Finite Element Analysis, vol. 1, sec. 9.2). Where
!> contact begins along the way, that zero is at a corner: any short way makes the residual a little
!> smaller, in proportion, and leaves the contact open. So a share is taken only for a real fall.
!>
!> Where points are about to turn from loading to unloading, or the other way, every short search
!> stays on this side of the turn, with the same matrix: the iteration would not end. Hence the
!> caller may ask for the whole correction, whatever the residual (the watchdog of R.M. Chamberlain
!> et al., Math. Programming Study 16 (1982) 1-17): beyond the turn the matrix is the right one. Not one longer than the motion of
!> the step: it comes of a matrix that hardly resists it, as where all points that hold a part are about to slip.
!>
!> Where points of contact change to and fro, the corrections from the states on both sides of the change go too far
!> in turns; the caller may ask for a closer search, which stops between them. So does one from where all points that hold
!> a part slip: nothing but friction resists its motion along the dies, the correction is longer than the motion of the step, and
!> each point turns from slip one way to slip the other at a place of its own on it.
!>
!> Past a limit point the residual grows along a way that leads downhill: the zero is sought further on, and no fall of the whole
!> residual will do.
!>
!> Where a load factor is found with the motion its equation makes the matrix regular, but not definite, and the residual along the
!> correction says nothing of where equilibrium is. The correction of Newton's method still leads down the whole residual, whatever
!> the matrix; it need not fall in each iteration: no more is asked than that it does not pass a ceiling (L. Grippo, F. Lampariello,
!> S. Lucidi, SIAM J. Numer. Anal. 23 (1986) 707-716), and the share is found by the parabola through the squares of the residual,
!> whose slope at the start is -2 (J.E. Dennis, R.B. Schnabel, Numerical Methods for Unconstrained Optimization (1983), sec. 6.3.2).
!>
!> Where no point touches a die that was touched at the start of the step, nothing may hold the part, and a slender one
!> springs back in a correction far longer than the gap. Then shares are tried, each a tenth of the one before, as long as they
!> touch the die again; the shortest that does is found within a factor of two between the last two of them, and is taken,
!> whatever the residual: with the die in its matrix the next correction is the right one.
module line_search
  use contact_changes, only: loses_a_die
  use convergence, only: forces_of_others, free_force, slope_along
  use elem_api, only: block_done, report_t
  use equations, only: equations_t
  use evaluation, only: evaluate
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: manner_t, real_fall, search_along, short_share

  !> How to search: take the whole whatever the residual, or find the zero along the correction more closely, and if need be by many
  !> trials; or, above 0, until the whole residual is no more than so many times what it was.
  type :: manner_t
    logical :: whole = .false., closely = .false., many = .false., exactly = .false., downhill = .false.
    real(wp) :: ceiling = 0.0_wp
  end type manner_t

  !> A search that ends below this share of the correction is short.
  real(wp), parameter :: short_share = 0.2_wp
  real(wp), parameter :: search_above = 0.8_wp, search_closely_above = 0.3_wp, search_exactly_above = 0.02_wp
  !> A share of the correction is taken when the whole residual falls to this part of what it was.
  real(wp), parameter :: real_fall = 0.5_wp
  !> A closer search on a body that friction holds has to find the one place where a point sticks that elsewhere slips one way or
  !> the other: it is as short as the elastic slip, a hundredth of the motion of a step or less.
  integer, parameter :: max_searches = 6, max_close_searches = 20, max_touches = 12, max_exact_searches = 30
  !> From one share to the next, where a die was lost; there are `max_touches` of them at most.
  real(wp), parameter :: tenth = 0.1_wp
  !> A share that touches the die is short enough when one that does not is longer than this part of it.
  real(wp), parameter :: near_touch = 0.5_wp

contains

  !> Move `du` along the correction by the share `s` and evaluate there. s = 0: every share tried fails, and `report` states why. A
  !> prescribed motion still missing is taken without search.
  subroutine search_along(scene, equations, solution, dt, external, residual, missing, correction, manner, du, s, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    real(wp), intent(in) :: missing(:)                 !! (ndof) prescribed motion still missing [unknown]
    real(wp), intent(in) :: correction(:)              !! (ndof) [unknown]
    type(manner_t), intent(in) :: manner
    real(wp), intent(inout) :: du(:)   !! (ndof) [unknown]
    real(wp), intent(out) :: s
    type(report_t), intent(out) :: report
    real(wp), dimension(size(du)) :: start, others
    real(wp) :: trial, slope0, slope, enough, best, norm, norm0, near(2), far(2), touching, missed
    logical :: accepted, lost
    integer :: k, most

    start = du
    trial = 1
    others = forces_of_others(equations, correction)
    slope0 = slope_along(equations, correction, residual - others)
    enough = merge(search_closely_above, search_above, manner%closely)
    if (manner%exactly) enough = search_exactly_above
    norm0 = free_force(equations, residual)
    near = [0.0_wp, slope0]
    far = 0
    best = huge(best)
    s = 0
    touching = 0
    missed = 0
    lost = loses_a_die(scene, solution)
    most = merge(max_close_searches, max_searches, manner%closely .and. manner%many)
    if (lost) most = max_touches
    if (manner%exactly .or. manner%downhill) most = max_exact_searches
    do k = 1, most
      du = start + trial*correction + missing
      call evaluate(scene, equations, solution, dt, du, .true., report, corrected_from=start)
      if (report%status /= block_done) then
        trial = 0.5_wp*(near(1) + trial)
        far = 0
        cycle
      end if
      slope = slope_along(equations, correction, external - equations%force - (1 - trial)*others)
      norm = free_force(equations, external - equations%force)
      if (merge(norm, abs(slope), manner%ceiling > 0) < best) then
        best = merge(norm, abs(slope), manner%ceiling > 0)
        s = trial
      end if
      if (manner%ceiling > 0 .and. .not. manner%whole) then
        if (norm <= manner%ceiling*norm0) return
        trial = trial*share_by_parabola(norm0, norm, trial)
        cycle
      end if
      accepted = manner%whole .or. any(abs(missing) > 0) .or. abs(slope) <= enough*slope0 &
                 .or. .not. (manner%exactly .or. manner%downhill) .and. (norm < real_fall*norm0 .or. k == 1 .and. norm < norm0)
      if (accepted) then
        s = trial
        return
      end if
      if (lost) then
        if (.not. loses_a_die(scene, solution)) touching = trial
        if (touching > trial) missed = trial
        if (touching > 0) then
          if (missed > near_touch*touching) exit
          trial = tenth*touching
          if (missed > 0) trial = sqrt(touching*missed)
          cycle
        end if
      end if
      call narrow(manner%downhill, trial, slope, near, far)
    end do
    if (touching > 0) s = touching
    if (.not. s > 0) return
    du = start + s*correction + missing
    call evaluate(scene, equations, solution, dt, du, .true., report, corrected_from=start)
  end subroutine search_along

  !> The next trial over this one, where the residual was `norm0`, and is `norm` after the share `trial` of a correction.
  pure function share_by_parabola(norm0, norm, trial) result(share)
    real(wp), intent(in) :: norm0, norm   !! [residual]
    real(wp), intent(in) :: trial
    real(wp) :: share

    share = trial/((norm/norm0)**2 - 1 + 2*trial)
    share = min(0.5_wp, max(0.1_wp, share))
  end function share_by_parabola

  !> The next share to try, after `trial` gave `slope`: `near` and `far` (share, slope) are the ends of the bracket of the zero;
  !> `far` is 0 while there is none.
  pure subroutine narrow(outwards, trial, slope, near, far)
    logical, intent(in) :: outwards   !! further on while there is no bracket
    real(wp), intent(inout) :: trial, near(2), far(2)
    real(wp), intent(in) :: slope

    if (near(2)*slope < 0) then
      ! the same end again: the other one weighs half (Illinois)
      if (far(1) > 0) near(2) = 0.5_wp*near(2)
      far = [trial, slope]
    else if (far(1) > 0) then
      far(2) = 0.5_wp*far(2)
      near = [trial, slope]
    else
      if (outwards) near = [trial, slope]
      trial = merge(2.0_wp, 0.5_wp, outwards)*trial
      return
    end if
    trial = near(1) + (far(1) - near(1))*min(0.9_wp, max(0.1_wp, near(2)/(near(2) - far(2))))
  end subroutine narrow

end module line_search
