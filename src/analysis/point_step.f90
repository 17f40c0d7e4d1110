!> One step of a material point: Newton's method for the strains whose stresses are given.
module point_step
  use kinds, only: eps, wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_done, law_not_converged, law_t
  use materials, only: material_t
  use point_paths, only: gradient_of_strain, step_gradient
  implicit none
  private
  public :: point_t, advance_point

  !> Largest change of a strain in one iteration.
  real(wp), parameter :: largest_change = 0.2_wp
  !> A given stress is met to this share of the largest, or where its strain is round-off.
  real(wp), parameter :: share_of_stress = 1.0e-11_wp, round_off_strain = 8*eps
  integer, parameter :: max_iterations = 40
  !> Least share of a correction that is tried, and by how much the residual must fall (Armijo).
  real(wp), parameter :: least_share = 2.0_wp**(-30), decrease = 1.0e-4_wp

  !> A point of a body: its material and law, its strains (xx, yy, xy, zz; point_paths) and its state.
  type :: point_t
    type(law_t) :: law
    type(material_t) :: material
    type(kinematics_t) :: kinematics
    real(wp) :: strain(4) = 0.0_wp
    !> Strain per time of the last step: the first guess; zero where the path turns.
    real(wp) :: rate(4) = 0.0_wp
    real(wp), allocatable :: state(:)
  end type point_t

contains

  !> Bring the point to the values given at the end of a step; it stays as it was when `status` is not law_done.
  pure subroutine advance_point(point, dt, temperature, stress_given, values, iterations, status)
    type(point_t), intent(inout) :: point
    real(wp), intent(in) :: dt
    real(wp), intent(in) :: temperature(2)   !! at the start and at the end of the step [temperature]
    logical, intent(in) :: stress_given(4)   !! the Cauchy stress, not the strain
    real(wp), intent(in) :: values(4)        !! Cauchy stress where it is given [stress], strain elsewhere [-]
    integer, intent(out) :: iterations
    integer, intent(out) :: status
    real(wp) :: strain(4), residual(4), matrix(4, 4), change(4), state(size(point%state)), before, share
    logical :: singular

    iterations = 0
    strain = merge(point%strain + dt*point%rate, values, stress_given)
    call answer_to(point, dt, temperature, strain, state, matrix, status)
    do while (status == law_done .and. iterations < max_iterations)
      iterations = iterations + 1
      residual = merge(values - state(1:4), 0.0_wp, stress_given)
      if (all(abs(residual) <= allowed(state(1:4), matrix))) then
        point%rate = (strain - point%strain)/dt
        point%strain = strain
        point%state = state
        return
      end if
      call solve(of_unknowns(matrix), residual, change, singular)
      if (singular) exit
      ! at a corner of the response, such as yield, the step is too long by the ratio of the moduli
      before = norm2(residual)
      share = min(1.0_wp, largest_change/max(largest_change, maxval(abs(change))))
      do while (share > least_share)
        call answer_to(point, dt, temperature, strain + share*change, state, matrix, status)
        if (status == law_done .and. norm2(merge(values - state(1:4), 0.0_wp, stress_given)) < (1 - decrease*share)*before) exit
        share = 0.5_wp*share
      end do
      if (.not. share > least_share) exit
      strain = strain + share*change
    end do
    status = law_not_converged

  contains

    !> Stress that counts as zero.
    pure function allowed(stress, matrix) result(size)
      real(wp), intent(in) :: stress(4), matrix(4, 4)
      real(wp) :: size

      size = max(share_of_stress*max(maxval(abs(stress)), maxval(abs(values), mask=stress_given)), &
                 round_off_strain*maxval(abs(matrix)))
    end function allowed

    !> The matrix with strains that are given held.
    pure function of_unknowns(whole) result(matrix)
      real(wp), intent(in) :: whole(4, 4)
      real(wp) :: matrix(4, 4)
      integer :: j

      matrix = whole
      do j = 1, 4
        if (stress_given(j)) cycle
        matrix(j, :) = 0
        matrix(:, j) = 0
        matrix(j, j) = 1
      end do
    end function of_unknowns

  end subroutine advance_point

  !> State after a step to `strain`, and d stress / d strain.
  pure subroutine answer_to(point, dt, temperature, strain, state, matrix, status)
    type(point_t), intent(in) :: point
    real(wp), intent(in) :: dt, temperature(2), strain(4)
    real(wp), intent(out) :: state(:), matrix(4, 4)
    integer, intent(out) :: status
    real(wp) :: f(5, 1), committed(size(state), 1), trial(size(state), 1), tangent(4, 5, 1)
    integer :: answer(1)

    f(:, 1) = step_gradient(point%kinematics%finite, point%strain, strain)
    committed(:, 1) = point%state
    call point%kinematics%update(point%law, point%material, dt, 1, size(state), reshape(temperature, [1, 2, 1]), f, committed, &
                                 trial, tangent, answer)
    state = trial(:, 1)
    matrix = matmul(tangent(:, :, 1), gradient_of_strain(point%kinematics%finite, strain))
    status = answer(1)
  end subroutine answer_to

  !> Gauss's elimination with pivots of columns.
  pure subroutine solve(matrix, right, x, singular)
    real(wp), intent(in) :: matrix(4, 4), right(4)
    real(wp), intent(out) :: x(4)
    logical, intent(out) :: singular
    real(wp) :: a(4, 5), row(5)
    integer :: i, k, p

    a(:, 1:4) = matrix
    a(:, 5) = right
    x = 0
    singular = .false.
    do k = 1, 4
      p = k - 1 + maxloc(abs(a(k:, k)), 1)
      singular = .not. abs(a(p, k)) > 0
      if (singular) return
      row = a(p, :)
      a(p, :) = a(k, :)
      a(k, :) = row
      do i = k + 1, 4
        a(i, k:) = a(i, k:) - a(k, k:)*(a(i, k)/a(k, k))
      end do
    end do
    do k = 4, 1, -1
      x(k) = (a(k, 5) - dot_product(a(k, k + 1:4), x(k + 1:)))/a(k, k)
    end do
  end subroutine solve

end module point_step
