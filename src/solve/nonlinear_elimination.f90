!> Nonlinear elimination: a correction of Newton's method in which the elements of a patch are not linearised.
!>
!> Where a side folds onto a die, or points begin to flow, a few elements are far from what their matrices tell, and all of the
!> mesh is solved again and again until they have settled. Let P be the unknowns of such a patch and g(c) what a correction c leaves
!> of its linear equations (patch_equations). The correction of a residual r that leaves none where all other elements are linear is
!> that of
!>
!>   K c = r + g(c),
!>
!> and g depends on the unknowns of P alone. So these are found first,
!>
!>   c_P = (K^-1 r)_P + S g(c_P),   S = (K^-1)_PP,
!>
!> by Newton's method on few unknowns, and all others follow by one more solution, c = K^-1 r + K^-1 g. It is the elimination of
!> the strongly nonlinear unknowns of P.J. Lanzkron, D.J. Rose, J.T. Wilkes (SIAM J. Sci. Comput. 17 (1996) 538-559) and
!> X.-C. Cai, D.E. Keyes (SIAM J. Sci. Comput. 24 (2002) 183-200), where all else answers linearly. Equilibrium, and what is
!> asked of it, is that of Newton's method: the way there is another one.
module nonlinear_elimination
  use blas, only: dgemm, dgetrf, dgetrs
  use contact_changes, only: contact_states_t, recall_contact, remember_contact
  use convergence, only: free_force
  use drivers, only: with_slopes
  use elem_api, only: block_done, report_t
  use equations, only: equations_t
  use errors, only: error_t
  use evaluation, only: evaluate
  use fields, only: displacement_field
  use kinds, only: wp
  use linear_solver, only: invert_at, solve_unrefined
  use patch_equations, only: begin_patch, evaluate_patch, patch_equations_t
  use patches, only: choose_patch
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: take_eliminated

  !> A correction that leaves less than this share of the residual in the patch is good enough: nothing is eliminated.
  real(wp), parameter :: settled = 0.02_wp
  !> One with the patch eliminated is taken where it leaves no more than this share of the residual.
  real(wp), parameter :: taken_below = 0.3_wp
  !> Iterations of a step with patches: later ones do not get further by them.
  integer, parameter :: most_iterations = 8
  !> The unknowns of the patch are found when their error is below this share of their correction.
  real(wp), parameter :: found_below = 1.0e-2_wp
  !> A step of the inner iterations, or half of it, and so on, is taken where the residual along it falls to `search_above` of what
  !> it was, or the whole residual to `real_fall`.
  real(wp), parameter :: search_above = 0.8_wp, real_fall = 0.5_wp
  integer, parameter :: max_inner = 15, max_halvings = 6

contains

  !> Move `du` by the correction of a residual with a patch eliminated, where that is far better than none, and evaluate there.
  !> `inner`: iterations on the unknowns of the patch; 0 where all is as it was, and the correction is to be searched along.
  subroutine take_eliminated(scene, equations, solution, dt, external, residual, iteration, correction, du, inner, report, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt                         !! [time]
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    integer, intent(in) :: iteration                   !! of the step, from 0
    real(wp), intent(inout) :: correction(:)           !! (ndof) of the residual, by the factors at hand [unknown]
    real(wp), intent(inout) :: du(:)                   !! (ndof) motion of the step [unknown]
    integer, intent(out) :: inner
    type(report_t), intent(inout) :: report
    type(error_t), allocatable, intent(out) :: error
    real(wp), dimension(size(du)) :: start, eliminated
    type(contact_states_t) :: before
    type(report_t) :: trial
    integer :: timer

    inner = 0
    if (iteration >= most_iterations .or. equations%without_patches .or. .not. has_patches(scene, equations)) return
    call equations%timers%add('elimination', timer)
    call equations%timers%start(timer)
    eliminated = correction
    call eliminate(scene, equations, solution, dt, residual, du, eliminated, inner, error)
    call equations%timers%stop(timer)
    if (inner == 0 .or. allocated(error)) return
    call remember_contact(scene, solution, before)
    start = du
    du = start + eliminated
    call evaluate(scene, equations, solution, dt, du, .true., trial, corrected_from=start)
    if (trial%status == block_done) then
      if (free_force(equations, external - equations%force) <= taken_below*free_force(equations, residual)) then
        correction = eliminated
        report = trial
        return
      end if
    end if
    inner = 0
    du = start
    call recall_contact(scene, before, solution)
  end subroutine take_eliminated

  !> The present solve is of the motion, and elements can be evaluated apart: nothing that the others find in the same iteration
  !> drives them, and walls add nothing to them.
  pure function has_patches(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: g

    associate (solve => equations%solves(equations%now))
      yes = equations%patch_size > 0 .and. solve%own(displacement_field) .and. .not. any(equations%wall%held)
      do g = 1, size(scene%groups)
        if (solve%active(g)) yes = yes .and. .not. with_slopes(equations%drivers(g))
      end do
    end associate
  end function has_patches

  !> Replace a correction of a residual by the one that eliminates the patch around the largest residuals. `inner` is 0 where it
  !> stays as it was: it is good enough, or none is found.
  subroutine eliminate(scene, equations, solution, dt, residual, du, correction, inner, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt                 !! [time]
    real(wp), intent(in) :: residual(:)        !! (ndof) [residual]
    real(wp), intent(in) :: du(:)              !! (ndof) [unknown]
    real(wp), intent(inout) :: correction(:)   !! (ndof) [unknown]
    integer, intent(out) :: inner
    type(error_t), allocatable, intent(out) :: error
    type(patch_equations_t) :: own
    real(wp), allocatable :: left(:), x(:)
    integer :: d
    logical :: sound

    inner = 0
    associate (solve => equations%solves(equations%now))
      call choose_patch(equations%dofs, equations%patches, solve%active, solve%equation, residual, equations%patch_size, own%patch)
      if (size(own%patch%unknown) == 0) return
      call begin_patch(scene, equations, solution, dt, du, own)
      call find_patch_motion(scene, equations, solution, own, residual, correction(own%patch%unknown), left, inner)
      if (inner == 0) return
      allocate (x(solve%neq), source=0.0_wp)
      x(solve%equation(own%patch%unknown)) = left
      call solve_unrefined(solve%solver, x, sound, error)
      do d = 1, size(correction)
        if (solve%equation(d) > 0) correction(d) = correction(d) + x(solve%equation(d))
      end do
    end associate
  end subroutine eliminate

  !> What the correction of the unknowns of the patch leaves of their linear equations: from where the correction that eliminates
  !> nothing leads, and from where it begins if none is found from there.
  subroutine find_patch_motion(scene, equations, solution, own, residual, plain, left, inner)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    type(patch_equations_t), intent(in) :: own
    real(wp), intent(in) :: residual(:)   !! (ndof) [residual]
    real(wp), intent(in) :: plain(:)      !! (n) correction that eliminates nothing [unknown]
    real(wp), allocatable, intent(out) :: left(:)   !! (n) [residual]
    integer, intent(out) :: inner
    real(wp), dimension(size(plain), size(plain)) :: matrix, inverse
    real(wp) :: all_left(size(residual)), c(size(plain))
    integer :: start
    logical :: sound, found

    inner = 0
    allocate (left(size(plain)))
    c = plain
    call evaluate_patch(scene, equations, solution, own, c, left, matrix, sound)
    if (sound) then
      all_left = 0
      all_left(own%patch%unknown) = left
      if (free_force(equations, all_left) <= settled*free_force(equations, residual)) return
    end if
    associate (solve => equations%solves(equations%now))
      call invert_at(solve%solver, solve%equation(own%patch%unknown), inverse, found)
    end associate
    if (.not. found) return
    found = .false.
    do start = 1, 2
      if (start == 2) then
        c = 0
        call evaluate_patch(scene, equations, solution, own, c, left, matrix, sound)
      end if
      if (sound) call iterate(scene, equations, solution, own, plain, inverse, c, left, matrix, inner, found)
      if (found) return
    end do
    inner = 0
  end subroutine find_patch_motion

  !> Newton's method on the error of the unknowns, c - (K^-1 r)_P - S g(c), from a state that has been evaluated. Its steps are
  !> judged as those of all unknowns are (line_search), by the forces that belong to the error, S^-1 of it: where points begin to
  !> touch, or to flow, the error itself may grow on the way to none.
  subroutine iterate(scene, equations, solution, own, plain, inverse, c, left, matrix, inner, found)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(patch_equations_t), intent(in) :: own
    real(wp), intent(in) :: plain(:), inverse(:, :)   !! (n) [unknown], (n, n) [unknown/residual]
    real(wp), intent(inout) :: c(:), left(:)          !! (n) [unknown], (n) [residual]
    real(wp), intent(inout) :: matrix(:, :)           !! (n, n) of the patch at c [residual/unknown]
    integer, intent(inout) :: inner
    logical, intent(out) :: found
    real(wp), dimension(size(c)) :: error, force, step, start
    real(wp), dimension(size(c), size(c)) :: tangent, stiffness
    real(wp) :: slope, norm, share
    integer, dimension(size(c)) :: pivot, pivot_of_stiffness
    integer :: n, k, i, h, info
    logical :: sound, taken

    n = size(c)
    found = .false.
    stiffness = inverse
    call dgetrf(n, n, stiffness, n, pivot_of_stiffness, info)
    if (info /= 0) return
    call find_error()
    do k = 1, max_inner
      found = norm2(own%lever*error) <= found_below*norm2(own%lever*c)
      if (found) return
      inner = inner + 1
      matrix = own%matrix - matrix
      call dgemm('N', 'N', n, n, n, -1.0_wp, inverse, n, matrix, n, 0.0_wp, tangent, n)
      do i = 1, n
        tangent(i, i) = tangent(i, i) + 1
      end do
      call dgetrf(n, n, tangent, n, pivot, info)
      if (info /= 0) return
      step = -error
      call dgetrs('N', n, 1, tangent, n, pivot, step, n, info)
      start = c
      slope = dot_product(step, force)
      norm = norm2(force)
      share = 1
      do h = 0, max_halvings
        c = start + share*step
        call evaluate_patch(scene, equations, solution, own, c, left, matrix, sound)
        taken = .false.
        if (sound) then
          call find_error()
          taken = abs(dot_product(step, force)) <= search_above*abs(slope) .or. norm2(force) <= real_fall*norm
        end if
        if (taken) exit
        share = 0.5_wp*share
      end do
      if (.not. taken) return
    end do

  contains

    subroutine find_error()
      error = c - plain - matmul(inverse, left)
      force = error
      call dgetrs('N', n, 1, stiffness, n, pivot_of_stiffness, force, n, info)
    end subroutine find_error
  end subroutine iterate

end module nonlinear_elimination
