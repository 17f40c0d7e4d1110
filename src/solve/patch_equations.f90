!> The equations of a patch of elements within a correction of Newton's method: what the patch leaves of its linear equations.
!>
!> With forces f_P and matrix K_P of the elements of the patch P, at the motion u of the step and a correction c of its unknowns:
!> g(c) = K_P c - [f_P(u + c) - f_P(u)].
module patch_equations
  use elem_api, only: block_done, instant_t, report_t
  use element_loop, only: run_few
  use equations, only: equations_t
  use kinds, only: wp
  use patches, only: patch_t
  use scene, only: scene_t
  use solution, only: solution_t
  use step_instants, only: make_instant, note_correction
  implicit none
  private
  public :: patch_equations_t, begin_patch, evaluate_patch

  type :: patch_equations_t
    type(patch_t) :: patch
    type(instant_t) :: instant
    !> Motion of the step before the correction, of all unknowns (ndof) [unknown].
    real(wp), allocatable :: motion(:)
    !> Place of every unknown in the patch, 0 where it is not of it (ndof).
    integer, allocatable :: place(:)
    !> Forces and matrix of the patch there (n), (n, n) [residual], [residual/unknown].
    real(wp), allocatable :: force(:), matrix(:, :)
    !> By which an unknown of the patch counts in norms: an angle by the size of the mesh (n).
    real(wp), allocatable :: lever(:)
  end type patch_equations_t

contains

  !> The patch at the motion that was evaluated last, whose forces and matrix made the correction.
  subroutine begin_patch(scene, equations, solution, dt, du, own)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    type(patch_equations_t), intent(inout) :: own   !! with its patch
    integer :: k, e, i, n, f, m

    n = size(own%patch%unknown)
    call make_instant(scene, equations, solution, dt, du, .true., own%instant)
    call note_correction(scene, equations%dofs, du, own%instant)
    own%motion = du
    own%lever = merge(equations%size, 1.0_wp, equations%dofs%is_angle(own%patch%unknown))
    allocate (own%place(size(du)), own%force(n), own%matrix(n, n))
    own%place = 0
    own%place(own%patch%unknown) = [(i, i=1, n)]
    own%force = 0
    own%matrix = 0
    associate (pattern => equations%solves(equations%now)%pattern, buffers => equations%buffers)
      do k = 1, size(own%patch%group)
        associate (g => own%patch%group(k), dof => equations%dofs%groups(own%patch%group(k))%dof)
          n = size(dof, 1)
          do e = own%patch%first(k), own%patch%last(k)
            f = pattern%force_start(g) + (e - 1)*n
            m = pattern%matrix_start(g) + (e - 1)*n*n
            call add_element(own%place(dof(:, e)), buffers%force(f + 1), buffers%matrix(m + 1), own%force, own%matrix)
          end do
        end associate
      end do
    end associate
  end subroutine begin_patch

  !> What a correction of the unknowns of the patch leaves of its linear equations, and the matrix of the patch there. `sound` is
  !> false where an element cannot be evaluated.
  subroutine evaluate_patch(scene, equations, solution, own, c, left, matrix, sound)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(patch_equations_t), intent(in) :: own
    real(wp), intent(in) :: c(:)               !! (n) [unknown]
    real(wp), intent(out) :: left(:)           !! (n) [residual]
    real(wp), intent(out) :: matrix(:, :)      !! (n, n) [residual/unknown]
    logical, intent(out) :: sound
    real(wp) :: motion(size(own%motion))
    real(wp), allocatable :: forces(:, :), matrices(:, :, :)
    type(report_t) :: report
    integer :: k, e, n

    left = 0
    matrix = 0
    motion = own%motion
    motion(own%patch%unknown) = motion(own%patch%unknown) + c
    sound = .false.
    do k = 1, size(own%patch%group)
      associate (g => own%patch%group(k), first => own%patch%first(k), last => own%patch%last(k))
        n = size(equations%dofs%groups(g)%dof, 1)
        allocate (forces(n, first:last), matrices(n, n, first:last))
        call run_few(scene, equations%elems(scene%groups(g)%elem_id), equations%kinematics, equations%laws, equations%dofs, &
                     own%instant, g, first, last, motion, solution, equations%drivers(g), forces, matrices, report)
        if (report%status /= block_done) return
        do e = first, last
          call add_element(own%place(equations%dofs%groups(g)%dof(:, e)), forces(1, e), matrices(1, 1, e), left, matrix)
        end do
        deallocate (forces, matrices)
      end associate
    end do
    left = own%force - left + matmul(own%matrix, c)
    sound = all(abs(left) <= huge(left))
  end subroutine evaluate_patch

  !> Add forces and matrix of an element to those of the patch.
  pure subroutine add_element(place, force, matrix, forces, matrices)
    integer, intent(in) :: place(:)   !! of its unknowns in the patch, 0 where they are prescribed
    real(wp), intent(in) :: force(size(place)), matrix(size(place), size(place))
    real(wp), intent(inout) :: forces(:), matrices(:, :)
    integer :: i, j

    do j = 1, size(place)
      if (place(j) == 0) cycle
      forces(place(j)) = forces(place(j)) + force(j)
      do i = 1, size(place)
        if (place(i) > 0) matrices(place(i), place(j)) = matrices(place(i), place(j)) + matrix(i, j)
      end do
    end do
  end subroutine add_element

end module patch_equations
