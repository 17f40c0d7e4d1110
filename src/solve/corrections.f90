!> Correction of the unknowns of the present solve by its factorised matrix.
module corrections
  use equation_set_up, only: analyse_pattern
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use linear_solver, only: factorise, has_factors, solve_linear
  use loose_bodies, only: hold_loose, motion_of_loose
  use resting_dies, only: hold_free_dies
  use solves, only: solve_t
  implicit none
  private
  public :: solve_correction

  !> A body that nothing holds may be carried off where a correction is above this share of the size of the scene.
  real(wp), parameter :: carried_off = 0.1_wp

contains

  !> Correction of the free unknowns for a residual; prescribed ones are not touched.
  subroutine solve_correction(equations, residual, correction, error, at_hand)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: residual(:)      !! (ndof) [residual]
    real(wp), intent(out) :: correction(:)   !! (ndof) [unknown]
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: at_hand   !! by the factors of the last matrix of the solve that was solved with
    logical :: factors
    real(wp) :: rhs(equations%solves(equations%now)%neq), x(equations%solves(equations%now)%neq)
    integer :: d, timer

    correction = 0
    if (size(rhs) == 0) return
    if (.not. equations%solves(equations%now)%analysed) call analyse_pattern(equations, error)
    if (allocated(error)) return
    associate (solve => equations%solves(equations%now))
      do d = 1, equations%dofs%ndof
        if (solve%equation(d) > 0) rhs(solve%equation(d)) = residual(d)
      end do
      factors = .false.
      ! contact that met other pieces in the last iteration has other unknowns: factors went with their pattern
      if (present(at_hand)) factors = at_hand .and. has_factors(solve%solver)
      if (.not. factors) then
        if (solve%own(pilot_field)) &
          call hold_free_dies(equations%dofs, residual, equations%seated, equations%size, solve, equations%slides)
        call equations%timers%add('factorisation', timer)
        call equations%timers%start(timer)
        call factorise(solve%solver, solve%values, error)
        call equations%timers%stop(timer)
      end if
      if (allocated(error)) return
      call equations%timers%add('solution', timer)
      call equations%timers%start(timer)
      call solve_linear(solve%solver, solve%pattern, rhs, x, error)
      if (size(equations%loose) > 0 .and. solve%own(displacement_field)) call solve_held(solve, rhs, x, error)
      call equations%timers%stop(timer)
      do d = 1, equations%dofs%ndof
        if (solve%equation(d) > 0) correction(d) = x(solve%equation(d))
      end do
    end associate

  contains

    !> Bodies that nothing holds have been carried off, or cannot be found: by a matrix that holds them.
    subroutine solve_held(solve, rhs, x, error)
      type(solve_t), intent(inout) :: solve
      real(wp), intent(in) :: rhs(:)
      real(wp), intent(inout) :: x(:)
      type(error_t), allocatable, intent(inout) :: error

      if (allocated(error)) then
        if (error%code /= exit_no_convergence) return
        deallocate (error)
      else if (motion_of_loose(equations%dofs, equations%loose, solve%equation, x) <= carried_off*equations%size) then
        return
      end if
      call hold_loose(equations%dofs, equations%loose, solve%pattern, solve%equation, solve%values)
      call factorise(solve%solver, solve%values, error)
      if (.not. allocated(error)) call solve_linear(solve%solver, solve%pattern, rhs, x, error)
    end subroutine solve_held
  end subroutine solve_correction

end module corrections
