!> Stability of an equilibrium: the eigenvalues below 0 of its matrix.
!>
!> Past a bifurcation or a limit point Newton's method converges to an equilibrium that a body does not stay in, as well as to one
!> that it does: a heated column stays straight far above Euler's load. An equilibrium is stable where forces that are left drive
!> the body back to it: no eigenvalue of the matrix has a real part below 0, and none is below 0 under dead loads, where the matrix
!> is symmetric (R. Hill, J. Mech. Phys. Solids 6 (1958) 236-249). The factors have their number at no cost (dense_lu), as pivots
!> below 0; they are those of the last correction, so the matrix of the equilibrium is factorised where they say that it is not
!> stable.
!>
!> Of a matrix that is not symmetric the pivots tell whether their number is even or odd, by the sign of the determinant. Where
!> bodies alone make it so, by pressures that follow or the choice of strains, it is nearly symmetric, and all are counted. With
!> friction a pair may come from where points slip, with eigenvalues that are complex: one that is real is proven by an odd number,
!> of the matrix or of one with viscous forces (pseudo_transient), K + s V, which has an odd number between two real ones. Where
!> temperatures are found with the motion, it is judged at these temperatures.
module stability
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence
  use evaluation, only: add_diagonal
  use fields, only: displacement_field
  use kinds, only: wp
  use linear_solver, only: factorise, negative_pivots, use_working_precision
  use scene, only: role_contact, scene_t
  use solution, only: solution_t
  use volumes_of_unknowns, only: volumes_of_motion
  implicit none
  private
  public :: has_friction, ways_to_leave

  !> s is looked for by so many halvings at most of an interval (of its logarithm) that begins with this share of its end.
  integer, parameter :: most_halvings = 12
  real(wp), parameter :: least_share = 1.0e-9_wp
  !> What holds temperatures, over the largest number of the matrix.
  real(wp), parameter :: hold = 1.0e10_wp

contains

  !> Eigenvalues below 0 of the matrix of the equilibrium that the last correction has led to. With a load factor the path goes on
  !> through equilibria that are not stable.
  subroutine ways_to_leave(scene, equations, solution, shifted, n, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: shifted   !! the last correction was found by a matrix with viscous forces
    integer, intent(out) :: n
    type(error_t), allocatable, intent(out) :: error

    n = 0
    associate (solve => equations%solves(equations%now))
      if (.not. solve%own(displacement_field) .or. scene%load_factor%multiplier > 0) return
      if (.not. (shifted .or. negative_pivots(solve%solver) > 0)) return
      call use_working_precision(solve%solver, solve%pattern, error)
      if (.not. allocated(error)) call factorise(solve%solver, solve%values, error)
      if (.not. allocated(error)) n = negative_pivots(solve%solver)
      if (n > 0) call judge_motion(scene, equations, solution, n, error)
      if (.not. allocated(error)) return
      ! neither stable nor not
      if (error%code == exit_no_convergence) deallocate (error)
    end associate
  end subroutine ways_to_leave

  !> Of so many pivots below 0 those of eigenvalues of the motion alone; an even number under friction must be proven.
  subroutine judge_motion(scene, equations, solution, n, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(inout) :: n
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: matrix(:)
    logical :: is_heat(equations%dofs%ndof)

    associate (solve => equations%solves(equations%now))
      is_heat = equations%dofs%quantity /= 1 .and. solve%equation > 0
      matrix = solve%values
      if (any(is_heat)) then
        call add_diagonal(solve%pattern, solve%equation, merge(hold*maxval(abs(matrix)), 0.0_wp, is_heat), solve%values)
        call factorise(solve%solver, solve%values, error)
        n = 0
        if (.not. allocated(error)) n = negative_pivots(solve%solver)
      end if
      if (n > 0 .and. mod(n, 2) == 0 .and. has_friction(scene, equations)) call prove(scene, equations, solution, n, error)
      solve%values = matrix
    end associate
  end subroutine judge_motion

  !> Contact makes the matrix of the present solve one that is not symmetric.
  pure function has_friction(scene, equations) result(has)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: has

    associate (solve => equations%solves(equations%now))
      has = .not. solve%pattern%symmetric .and. any(solve%active .and. scene%groups%role == role_contact)
    end associate
  end function has_friction

  !> An even number of pivots below 0 stays only where some viscous forces leave an odd one. The matrix is changed.
  subroutine prove(scene, equations, solution, n, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(inout) :: n
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: volume(equations%dofs%ndof), around(0:equations%solves(equations%now)%pattern%neq)
    real(wp), allocatable :: matrix(:)
    real(wp) :: low, high, s
    integer :: k, left

    volume = volumes_of_motion(scene, equations, solution)
    associate (solve => equations%solves(equations%now))
      matrix = solve%values
      around = 0
      around(solve%equation) = volume
      associate (row => solve%pattern%row)
        high = maxval(abs(matrix)/merge(around(row), 1.0_wp, around(row) > 0), &
                      mask=row == solve%pattern%column .and. around(row) > 0)
      end associate
      low = least_share*high
      do k = 1, most_halvings
        s = sqrt(low*high)
        solve%values = matrix
        call add_diagonal(solve%pattern, solve%equation, s*volume, solve%values)
        call factorise(solve%solver, solve%values, error)
        left = 0
        if (.not. allocated(error)) left = negative_pivots(solve%solver)
        if (allocated(error) .or. mod(left, 2) == 1) exit
        if (left > 0) then
          low = s
        else
          high = s
        end if
      end do
      if (mod(left, 2) == 0) n = 0
    end associate
  end subroutine prove

end module stability
