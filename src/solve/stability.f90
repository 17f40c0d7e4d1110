!> Stability of an equilibrium: the eigenvalues below 0 of its matrix.
!>
!> Past a bifurcation or a limit point Newton's method converges to an equilibrium that a body does not stay in, as well as to one
!> that it does: a heated column stays straight far above Euler's load. An equilibrium is stable under dead loads where the matrix
!> has no negative eigenvalue (R. Hill, J. Mech. Phys. Solids 6 (1958) 236-249). Of a matrix that is not symmetric, as with
!> friction, pivots do not tell, and none is looked for. The factors have their number at no cost (dense_lu); they are those of the
!> last correction, so the matrix of the equilibrium is factorised where they say that it is not stable.
module stability
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence
  use fields, only: displacement_field
  use kinds, only: wp
  use linear_solver, only: factorise, negative_eigenvalues, use_working_precision
  use scene, only: scene_t
  implicit none
  private
  public :: ways_to_leave

contains

  !> Eigenvalues below 0 of the matrix of the equilibrium that the last correction has led to. With a load factor the path goes on
  !> through equilibria that are not stable.
  subroutine ways_to_leave(scene, equations, shifted, n, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    logical, intent(in) :: shifted   !! the last correction was found by a matrix with viscous forces
    integer, intent(out) :: n
    type(error_t), allocatable, intent(out) :: error

    n = 0
    associate (solve => equations%solves(equations%now))
      if (.not. (solve%pattern%symmetric .and. solve%own(displacement_field)) .or. scene%load_factor%multiplier > 0) return
      if (.not. (shifted .or. negative_eigenvalues(solve%solver) > 0)) return
      call use_working_precision(solve%solver, solve%pattern, error)
      if (.not. allocated(error)) call factorise(solve%solver, solve%values, error)
      if (.not. allocated(error)) n = negative_eigenvalues(solve%solver)
      if (.not. allocated(error)) return
      ! neither stable nor not
      if (error%code == exit_no_convergence) deallocate (error)
    end associate
  end subroutine ways_to_leave

end module stability
