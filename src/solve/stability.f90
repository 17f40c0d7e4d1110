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
!> of the matrix or of one with viscous forces (pseudo_transient), K + s V, which has an odd number between two real ones. Penalties
!> of points that slip may make one too, at a die's bend, and so may a bad element at a sharp corner: the bodies are unstable where
!> the motion c of it does negative work c K c on their own matrices, and is of more unknowns, (sum c_i^2)^2/sum c_i^4, than one
!> element has (of a node in such a corner 1 to 3, of a billet that buckles 80 and more). Where temperatures are found with the
!> motion, it is judged at these temperatures.
module stability
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence
  use evaluation, only: add_diagonal
  use fields, only: displacement_field
  use kinds, only: wp
  use linear_solver, only: factorise, negative_pivots, solve_linear, use_working_precision
  use scene, only: role_contact, scene_t
  use solution, only: solution_t
  use volumes_of_unknowns, only: volumes_of_motion
  implicit none
  private
  public :: has_friction, ways_to_leave, work_of_bodies

  !> s is looked for by so many halvings at most of an interval (of its logarithm) that begins with this share of its end.
  integer, parameter :: most_halvings = 12, most_solves = 6
  real(wp), parameter :: least_share = 1.0e-9_wp
  !> Unknowns of the motion of one element.
  real(wp), parameter :: of_element = 16.0_wp
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

  !> Of so many pivots below 0 those of eigenvalues of the motion alone; under friction one must be proven.
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
      if (n > 0 .and. has_friction(scene, equations)) call prove(scene, equations, solution, n, error)
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

  !> Pivots below 0 under friction count, as 1, only where there is a real eigenvalue whose motion is of the bodies. The matrix is
  !> changed.
  subroutine prove(scene, equations, solution, n, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(inout) :: n
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: volume(equations%dofs%ndof), motion(equations%dofs%ndof)
    real(wp), dimension(0:equations%solves(equations%now)%pattern%neq) :: around, x
    real(wp), allocatable :: matrix(:)
    real(wp) :: low, high
    logical :: odd
    integer :: k, left

    volume = volumes_of_motion(scene, equations, solution)
    associate (solve => equations%solves(equations%now))
      around = 0
      around(solve%equation) = volume
      around(0) = 0
      matrix = solve%values
      associate (row => solve%pattern%row)
        high = maxval(abs(matrix)/merge(around(row), 1.0_wp, around(row) > 0), &
                      mask=row == solve%pattern%column .and. around(row) > 0)
      end associate
      low = least_share*high
      odd = mod(n, 2) == 1
      n = 0
      ! between low and high the number becomes even from an odd one, or 0 from an even one
      do k = 1, most_halvings
        call factorise_shifted(sqrt(low*high))
        if (allocated(error)) return
        left = negative_pivots(solve%solver)
        odd = odd .or. mod(left, 2) == 1
        if (mod(left, 2) == 1 .or. left > 0 .and. .not. odd) then
          low = sqrt(low*high)
        else
          high = sqrt(low*high)
        end if
      end do
      if (.not. odd) return
      call factorise_shifted(low)
      ! inverse iteration from any vector: G.H. Golub, C.F. Van Loan, Matrix Computations, 4th ed., 2013, sec. 7.6.1
      x = [(sin(real(k, wp)), k=0, size(x) - 1)]
      do k = 1, most_solves
        if (allocated(error)) return
        x(1:) = around(1:)*x(1:)
        x(1:) = x(1:)/maxval(abs(x(1:)))
        motion(:solve%neq) = x(1:)
        call solve_linear(solve%solver, solve%pattern, motion(:solve%neq), x(1:), error)
      end do
      if (allocated(error)) return
      x = x/maxval(abs(x(1:)))
      x(0) = 0
      if (sum(x(1:)**2)**2 > of_element*sum(x(1:)**4) .and. work_of_bodies(scene, equations, x(solve%equation)) < 0) n = 1
    end associate

  contains

    subroutine factorise_shifted(s)
      real(wp), intent(in) :: s

      associate (solve => equations%solves(equations%now))
        solve%values = matrix
        call add_diagonal(solve%pattern, solve%equation, s*volume, solve%values)
        call factorise(solve%solver, solve%values, error)
      end associate
    end subroutine factorise_shifted
  end subroutine prove

  !> c K c of a correction of the motion by the matrices of all elements but those of contact.
  pure function work_of_bodies(scene, equations, correction) result(work)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:)   !! (ndof) [unknown]
    real(wp) :: work
    real(wp) :: motion(size(correction))
    integer :: g, e, j, m, ndof

    motion = merge(correction, 0.0_wp, equations%dofs%quantity == 1)
    work = 0
    associate (solve => equations%solves(equations%now))
      do g = 1, size(scene%groups)
        if (.not. solve%active(g) .or. scene%groups(g)%role == role_contact) cycle
        associate (dof => equations%dofs%groups(g)%dof)
          ndof = size(dof, 1)
          do e = 1, size(dof, 2)
            do j = 1, ndof
              m = solve%pattern%matrix_start(g) + ((e - 1)*ndof + j - 1)*ndof
              work = work + motion(dof(j, e))*dot_product(equations%buffers%matrix(m + 1:m + ndof), motion(dof(:, e)))
            end do
          end do
        end associate
      end do
    end associate
  end function work_of_bodies

end module stability
