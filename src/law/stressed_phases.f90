!> A point of steel whose kinetics depend on its own stress (ISIG), found together.
!>
!> Of the stress the kinetics know x = (mean, von Mises), linear in time between both ends of the step. With S(e, x) the stress of
!> the return after the phases that form under x, x = m(S(e, x)): two equations, solved by Newton's method with differences. What
!> forms swells and so lowers the mean stress that lets it form: to repeat S would diverge.
!> Tangent: d sigma = C de + S_x dx and dx = B d sigma, B = dm/d sigma, give d sigma = C de + S_x (I - B S_x)^-1 B C de. It is not
!> symmetric. What forms changes the volume free of stress: tr(elastic strain) has derivatives of its own (row_of_volume).
module stressed_phases
  use kinds, only: eps, wp
  use law_api, only: law_done, law_not_converged, row_of_volume, row_of_work
  use materials, only: material_t
  use phase_point, only: first_phases, place_stress, place_time, return_of_point, row_work, stress_row
  use phase_state, only: state_size
  use phase_step, only: advance_phases
  use steels, only: phase_count
  use stress_measures, only: von_mises
  implicit none
  private
  public :: return_under_stress, measures_of

  !> Newton's method holds to this share of the stress; a correction is halved so often at most.
  real(wp), parameter :: tolerance = 1.0e-11_wp
  integer, parameter :: most_iterations = 40, most_halvings = 10

  !> What a point answers to a stress on its kinetics.
  type :: answer_t
    real(wp) :: stress(4), elastic(4), tangent(4, 4), work, by_work(4)
    integer :: status
  end type answer_t

contains

  !> Mean and von Mises' stress.
  pure function measures_of(stress) result(x)
    real(wp), intent(in) :: stress(4)   !! [stress]
    real(wp) :: x(2)                    !! [stress]

    x = [(stress(1) + stress(2) + stress(4))/3, von_mises(stress)]
  end function measures_of

  !> One point: phases and stress at the end of the step.
  pure subroutine return_under_stress(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, &
                                      tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt                  !! [time]
    real(wp), intent(in) :: temperature(2)      !! at both ends of the step [degC]
    real(wp), intent(in) :: trial_strain(4)     !! [-]
    real(wp), intent(in) :: committed(:)        !! (nhistory) [unit of each component]
    real(wp), intent(out) :: stress(4), elastic_strain(4)   !! [stress], [-]
    real(wp), intent(out) :: history(:)         !! (nhistory) [unit of each component]
    real(wp), intent(out) :: tangent(:, :)      !! (4, 4) [stress], or with row_of_volume [-] and row_of_work [stress]
    integer, intent(out) :: status
    type(answer_t) :: here
    real(wp) :: x(2), residual(2), by_x(row_of_work, 2), b(2, 4), correction(2), scale, by_strain(2, 4)
    integer :: iteration

    x = committed(stress_row(material):stress_row(material) + 1)
    call answer_to(material, dt, temperature, trial_strain, committed, x, here, history)
    do iteration = 1, most_iterations
      residual = measures_of(here%stress) - x
      scale = max(material%values(place_stress), maxval(abs(here%stress)), maxval(abs(x)))
      if (here%status /= law_done) exit
      if (maxval(abs(residual)) <= tolerance*scale) exit
      call slopes_of(material, dt, temperature, trial_strain, committed, x, scale, here, by_x, b)
      correction = solved(matmul(b, by_x(:4, :)), residual)
      call go_along(material, dt, temperature, trial_strain, committed, correction, norm2(residual), x, here, history)
    end do
    if (iteration > most_iterations) here%status = law_not_converged
    call slopes_of(material, dt, temperature, trial_strain, committed, x, scale, here, by_x, b)
    stress = here%stress
    elastic_strain = here%elastic
    history(stress_row(material):stress_row(material) + 1) = measures_of(here%stress)
    status = here%status
    by_strain = solved_each(matmul(b, by_x(:4, :)), matmul(b, here%tangent))
    tangent(:4, :) = here%tangent + matmul(by_x(:4, :), by_strain)
    if (size(tangent, 1) >= row_of_volume) tangent(row_of_volume, :) = [1, 1, 0, 1] + matmul(by_x(row_of_volume, :), by_strain)
    if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :) = here%by_work + matmul(by_x(row_of_work, :), by_strain)
  end subroutine return_under_stress

  !> The share of a correction after which the residual is less.
  pure subroutine go_along(material, dt, temperature, trial_strain, committed, correction, before, x, here, history)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), trial_strain(4), committed(:), correction(2), before
    real(wp), intent(inout) :: x(2)
    type(answer_t), intent(out) :: here
    real(wp), intent(out) :: history(:)
    real(wp) :: start(2)
    integer :: k

    start = x
    do k = 0, most_halvings
      x = start + 0.5_wp**k*correction
      call answer_to(material, dt, temperature, trial_strain, committed, x, here, history)
      if (here%status /= law_done) cycle
      if (norm2(measures_of(here%stress) - x) < before) return
    end do
  end subroutine go_along

  !> Phases and stress of a point under a stress on its kinetics.
  pure subroutine answer_to(material, dt, temperature, trial_strain, committed, x, answer, history)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), trial_strain(4), committed(:), x(2)
    type(answer_t), intent(out) :: answer
    real(wp), intent(out) :: history(:)
    real(wp) :: z(phase_count, 2)

    history = committed
    call follow_kinetics(material, dt, temperature, committed, history(first_phases:first_phases + state_size - 1), x)
    z(:, 1) = committed(first_phases:first_phases + phase_count - 1)
    z(:, 2) = history(first_phases:first_phases + phase_count - 1)
    call return_of_point(material, dt, temperature, z, trial_strain, answer%stress, answer%elastic, history, answer%tangent, &
                         answer%by_work, answer%status)
    answer%work = history(row_work) - committed(row_work)
  end subroutine answer_to

  !> Phases at the end of the step, at the temperature of the point and under x.
  pure subroutine follow_kinetics(material, dt, temperature, committed, state, x)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), committed(:), x(2)
    real(wp), intent(out) :: state(:)
    real(wp) :: slope(state_size), heat, heat_slope, stresses(2, 2)

    stresses(:, 1) = committed(stress_row(material):stress_row(material) + 1)
    stresses(:, 2) = x
    call advance_phases(material%steel, dt*material%values(place_time), temperature(1), temperature(2), &
                        committed(first_phases:first_phases + state_size - 1), state, slope, heat, heat_slope, &
                        stresses/material%values(place_stress))
  end subroutine follow_kinetics

  !> Derivative of the stress, of tr(elastic strain) and of the plastic work by x, central differences, and of the measures by the
  !> stress.
  pure subroutine slopes_of(material, dt, temperature, trial_strain, committed, x, scale, here, by_x, b)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(2), trial_strain(4), committed(:), x(2), scale
    type(answer_t), intent(in) :: here
    real(wp), intent(out) :: by_x(row_of_work, 2), b(2, 4)   !! of what the rows of a tangent are of; of the measures
    type(answer_t) :: high, low
    real(wp) :: other(2), mean, unused(size(committed))
    integer :: k

    do k = 1, 2
      other = x
      other(k) = x(k) + eps**(1.0_wp/3)*scale
      call answer_to(material, dt, temperature, trial_strain, committed, other, high, unused)
      other(k) = x(k) - eps**(1.0_wp/3)*scale
      call answer_to(material, dt, temperature, trial_strain, committed, other, low, unused)
      by_x(:4, k) = high%stress - low%stress
      by_x(row_of_volume, k) = sum(high%elastic([1, 2, 4]) - low%elastic([1, 2, 4]))
      by_x(row_of_work, k) = high%work - low%work
      by_x(:, k) = by_x(:, k)/(2*eps**(1.0_wp/3)*scale)
    end do
    mean = (here%stress(1) + here%stress(2) + here%stress(4))/3
    b(1, :) = [1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp]/3
    b(2, :) = 0
    if (von_mises(here%stress) > 0) &
      b(2, :) = 1.5_wp*(here%stress - mean*[1, 1, 0, 1])*[1, 1, 2, 1]/von_mises(here%stress)
  end subroutine slopes_of

  !> (I - m)^-1 r.
  pure function solved(m, r) result(y)
    real(wp), intent(in) :: m(2, 2), r(2)
    real(wp) :: y(2)
    real(wp) :: det

    det = (1 - m(1, 1))*(1 - m(2, 2)) - m(1, 2)*m(2, 1)
    y = r
    if (.not. abs(det) > 0) return
    y = [(1 - m(2, 2))*r(1) + m(1, 2)*r(2), m(2, 1)*r(1) + (1 - m(1, 1))*r(2)]/det
  end function solved

  !> The same of each column.
  pure function solved_each(m, r) result(y)
    real(wp), intent(in) :: m(2, 2), r(2, 4)
    real(wp) :: y(2, 4)
    integer :: j

    do j = 1, 4
      y(:, j) = solved(m, r(:, j))
    end do
  end function solved_each

end module stressed_phases
