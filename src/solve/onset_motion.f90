!> Where the first step on a new mesh starts: at the motion of its onset.
!>
!> The last motion, interpolated from the old mesh, is none of the new one: at its points it changes volumes by a share of the
!> strain of the step, which the bulk modulus makes stresses far beyond yield, and its sides do not follow the die. Newton's method
!> finds its way back from there through other points of contact, in many iterations or not at all. So a small share of that motion
!> only shows which points flow; the matrix there, with contact kept as it was, then gives the motion of the whole step, the
!> solution of the rate problem on the new mesh (R. Hill, J. Mech. Phys. Solids 6 (1958) 236-249), from which the step goes on as
!> others do from the last motion.
module onset_motion
  use corrections, only: solve_correction
  use element_loop, only: add_prescribed
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence
  use kinds, only: wp
  implicit none
  private
  public :: add_missing, extend_onset

contains

  !> The forces of missing prescribed motions, by the matrix.
  subroutine add_missing(equations, missing, residual)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: missing(:)         !! (ndof) [unknown]
    real(wp), intent(inout) :: residual(:)     !! (ndof) [residual]
    real(wp) :: force(size(residual))

    if (.not. any(abs(missing) > 0)) return
    force = 0
    associate (solve => equations%solves(equations%now))
      call add_prescribed(equations%dofs, solve%active, solve%pattern, equations%buffers, missing, force)
    end associate
    residual = residual - force
  end subroutine add_missing

  !> From the onset of a motion, at which forces and matrix are, to the whole of it.
  subroutine extend_onset(equations, external, missing, du, found, error)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: external(:)   !! (ndof) [residual]
    real(wp), intent(in) :: missing(:)    !! (ndof) prescribed motion beyond the onset [unknown]
    real(wp), intent(inout) :: du(:)      !! (ndof) [unknown]
    logical, intent(out) :: found         !! the matrix could be factorised; otherwise `du` stays
    type(error_t), allocatable, intent(out) :: error   !! the machine has failed; a matrix without factors is no error
    real(wp), dimension(size(du)) :: residual, correction

    residual = external - equations%force
    call add_missing(equations, missing, residual)
    call solve_correction(equations, residual, correction, error)
    found = .not. allocated(error)
    if (found) then
      du = du + correction + missing
    else if (error%code == exit_no_convergence) then
      deallocate (error)
    end if
  end subroutine extend_onset

end module onset_motion
