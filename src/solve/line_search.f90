!> How far to go along a correction: the whole of it, unless that is too far.
!>
!> The whole is taken when the residual along the correction falls to `search_above` of what it was,
!> or the whole residual falls. Otherwise the zero of the residual along the correction is sought by
!> secants (M.A. Crisfield, Non-linear Finite Element Analysis, vol. 1, sec. 9.2).
!>
!> Where points are about to turn from loading to unloading, or the other way, every short search
!> stays on this side of the turn, with the same matrix: it would go on so for ever. Hence the
!> caller may ask for the whole correction, whatever the residual (the watchdog of R.M. Chamberlain
!> et al., Math. Programming Study 16 (1982) 1-17): beyond the turn the matrix is the right one.
module line_search
  use convergence, only: free_force
  use elem_api, only: block_done, report_t
  use equations, only: equations_t, evaluate
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: search_along, short_share

  !> A search that ends below this share of the correction is short.
  real(wp), parameter :: short_share = 0.2_wp
  real(wp), parameter :: search_above = 0.8_wp
  integer, parameter :: max_searches = 4

contains

  !> Move `du` along the correction by the share `s` and evaluate there. s = 0: every share tried
  !> fails, and `report` says why. A prescribed motion still missing, or `whole`, is taken without search.
  subroutine search_along(scene, equations, solution, dt, external, residual, missing, correction, whole, du, s, report)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt
    real(wp), intent(in) :: external(:), residual(:), missing(:), correction(:)
    logical, intent(in) :: whole
    real(wp), intent(inout) :: du(:)
    real(wp), intent(out) :: s
    type(report_t), intent(out) :: report
    real(wp) :: start(size(du)), trial, slope0, slope, best
    integer :: k

    start = du
    trial = 1
    slope0 = dot_product(correction, residual)
    best = huge(best)
    s = 0
    do k = 1, max_searches
      du = start + trial*correction + missing
      call evaluate(scene, equations, solution, dt, du, .true., report)
      if (report%status /= block_done) then
        trial = 0.5_wp*trial
        cycle
      end if
      slope = dot_product(correction, external - equations%force)
      if (abs(slope) < best) then
        best = abs(slope)
        s = trial
      end if
      if (whole .or. abs(slope) <= search_above*abs(slope0) .or. any(abs(missing) > 0) .or. &
          free_force(equations, external - equations%force) < free_force(equations, residual)) then
        s = trial
        return
      end if
      if (slope0*slope < 0) then
        trial = trial*min(0.9_wp, max(0.1_wp, slope0/(slope0 - slope)))
      else
        trial = 0.5_wp*trial
      end if
    end do
    if (s <= 0) return
    du = start + s*correction + missing
    call evaluate(scene, equations, solution, dt, du, .true., report)
  end subroutine search_along

end module line_search
