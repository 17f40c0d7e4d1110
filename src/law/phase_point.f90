!> The return of a point of steel whose fractions are known at both ends of a step.
!>
!> The deviator s and its von Mises measure q at the end obey s = s_trial - 2 G (3/2) (dp/q + dG) s, so that with A = 1 + 3 G dG,
!> A q = q_trial - 3 G dp: the return of a steel whose flow stress is A times as large, after which deviators are divided by A.
!> For a flow stress of slope R' that is dp = f A/(3 G + A R'), f = q_trial/A - R. The flow stress R is that of the mixture
!> (phase_flow): yield and hardening; times a factor of the rate with RATE0 and COWPER; with VISCO plus the stress by the rate
!> of each phase, the plastic rate being common to all. From MELT on the hardening is none, and stays so until it is colder.
!> Sources: J.-B. Leblond, Int. J. Plasticity 5 (1989) 573-591; code_aster R4.04.02; J.C. Simo, R.L. Taylor, CMAME 48 (1985)
!> 101-118.
module phase_point
  use elasticity, only: hooke_stress, hooke_tangent, moduli
  use hardening, only: most_numbers
  use kinds, only: wp
  use law_api, only: law_done, law_not_converged
  use materials, only: has_number, material_t
  use phase_flow, only: carry_hardening, has_yield, mixture_viscosity, mixture_yield
  use phase_mechanics, only: mixture_moduli, strain_of_phases
  use phase_state, only: state_size
  use radial_return, only: flow_stress_at, flow_t, return_point
  use rate_dependence, only: rate_cowper, rate_within
  use steels, only: phase_count
  use stress_measures, only: von_mises
  use transformation_plasticity, only: plasticity_of_transformation
  implicit none
  private
  public :: place_stress, place_time, place_zero, place_trip, place_rate, place_cowper, place_visco, place_isig, place_melt
  public :: row_plastic, row_work, row_trip, first_hardening, first_phases
  public :: return_of_point, flow_stress_of_point, flows, rate_row, stress_row

  !> Places among the values of a material.
  integer, parameter :: place_stress = 1, place_time = 2, place_zero = 3, place_trip = 4, place_rate = 5, place_cowper = 6, &
                        place_visco = 7, place_isig = 8, place_melt = 9
  !> Rows of the history: plastic strain, dissipated work, strain of transformation plasticity, hardening of the phases; then what
  !> follows where TIME is given, the plastic rate, and the stresses of ISIG.
  integer, parameter :: row_plastic = 1, row_work = 2, row_trip = 3, first_hardening = 4, &
                        first_phases = first_hardening + phase_count
  !> Rows of what the return knows of a point: plastic strain, work, rate.
  integer, parameter :: return_rows = 3
  !> Rows of the numbers of each phase: b and c of its saturation; factor, P4, P1, P3 of its stress by the rate, its hardening.
  integer, parameter :: curve_rows = 7
  !> Places among the numbers of the form: yield and modulus at rest, the step and the rate at its start.
  integer, parameter :: at_step = 3, at_start_rate = 4
  !> Normal components of a tensor (xx, yy, xy, zz).
  integer, parameter :: normal(3) = [1, 2, 4]

contains

  !> One point whose fractions are known at both ends of the step.
  pure subroutine return_of_point(material, dt, temperature, z, trial_strain, stress, elastic_strain, history, tangent, by_work, &
                                  status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt                  !! [time]
    real(wp), intent(in) :: temperature(2)      !! at both ends of the step [degC]
    real(wp), intent(in) :: z(phase_count, 2)   !! fractions at both ends of the step [-]
    real(wp), intent(in) :: trial_strain(4)     !! [-]
    real(wp), intent(out) :: stress(4), elastic_strain(4)   !! [stress], [-]
    real(wp), intent(inout) :: history(:)       !! (nhistory) [unit of each component]
    real(wp), intent(out) :: tangent(4, 4)      !! [stress]
    real(wp), intent(out) :: by_work(4)         !! d(work)/d(trial strain) [stress]
    integer, intent(out) :: status
    type(flow_t) :: flow
    real(wp) :: trial(4), curve(curve_rows, phase_count), known(return_rows), found(return_rows), deviator(4), dg, a, q

    associate (steel => material%steel, hardened => history(first_hardening:first_hardening + phase_count - 1))
      call elastic_flow(material, z(:, 2), temperature(2), flow)
      trial = trial_strain
      trial(normal) = trial(normal) - strain_of_phases(steel, z(:, 1), z(:, 2), temperature(1), temperature(2))
      dg = 0
      if (dt > 0) dg = material%values(place_trip)/material%values(place_stress) &
                       *plasticity_of_transformation(steel, z(:, 1), z(:, 2), temperature(1), temperature(2))
      a = 1 + 3*flow%shear*dg
      known = 0
      found = 0
      by_work = 0
      status = law_done
      if (flows(material)) then
        call carry_hardening(steel, z(:, 1), z(:, 2), temperature(2), hardened)
        if (is_molten(material, temperature(2))) hardened = 0
        if (rate_row(material) > 0) known(return_rows) = history(rate_row(material))
        call flow_of_mixture(material, z(:, 2), hardened, temperature(2), dt, known(return_rows), a, flow, curve)
        call return_point(flow, curve, curve, dt, trial, known, stress, elastic_strain, found, tangent, by_work, &
                          status)
        if (has_yield(steel) .and. .not. flow%below(1) > 0) status = law_not_converged
        if (.not. is_molten(material, temperature(2))) hardened = hardened + found(row_plastic)
        if (flow%rate_row > 0) history(rate_row(material)) = found(flow%rate_row)
      else
        stress = hooke_stress(flow%bulk, flow%shear, trial)
        elastic_strain = trial
        tangent = hooke_tangent(flow%bulk, flow%shear)
      end if
    end associate
    if (a > 1) then
      stress = with_deviator_over(a, stress)
      elastic_strain = with_deviator_over(a, elastic_strain)
      tangent = tangent/a
      tangent(normal, normal) = tangent(normal, normal) + flow%bulk*(1 - 1/a)
      ! the work of transformation plasticity is q^2 dG, q^2 = 3/2 s:s
      deviator = stress*[1, 1, 2, 1]
      deviator(normal) = deviator(normal) - sum(stress(normal))/3
      by_work = by_work/a + (3*dg)*matmul(deviator, tangent)
    end if
    q = von_mises(stress)
    history(row_plastic) = history(row_plastic) + found(row_plastic)
    history(row_work) = history(row_work) + found(row_work)/a + q*q*dg
    history(row_trip) = history(row_trip) + q*dg
  end subroutine return_of_point

  !> Stress to flow of a mixture at what has been reached; 0 for a steel that does not flow.
  pure function flow_stress_of_point(material, z, temperature, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: z(:)            !! (phase_count) [-]
    real(wp), intent(in) :: temperature     !! [degC]
    real(wp), intent(in) :: history(:)      !! (nhistory) [unit of each component]
    real(wp) :: stress                      !! [stress]
    type(flow_t) :: flow
    real(wp) :: curve(curve_rows, phase_count), rate

    stress = 0
    if (.not. flows(material)) return
    rate = 0
    if (rate_row(material) > 0) rate = history(rate_row(material))
    call flow_of_mixture(material, z, history(first_hardening:first_hardening + phase_count - 1), temperature, 0.0_wp, rate, &
                         1.0_wp, flow, curve)
    stress = flow_stress_at(flow, curve, curve, 0.0_wp, rate)
  end function flow_stress_of_point

  !> What is molten forgets its hardening.
  pure function is_molten(material, temperature) result(yes)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature   !! [degC]
    logical :: yes

    yes = has_number(material, place_melt)
    if (yes) yes = temperature >= material%values(place_melt) + material%values(place_zero)
  end function is_molten

  !> The steel flows: it has yield stresses, or stresses by the rate that VISCO asks for.
  pure function flows(material) result(yes)
    type(material_t), intent(in) :: material
    logical :: yes

    yes = has_yield(material%steel) .or. has_number(material, place_visco)
  end function flows

  !> Row of the plastic rate in the history, 0 where there is none.
  pure function rate_row(material) result(row)
    type(material_t), intent(in) :: material
    integer :: row

    row = 0
    if (has_number(material, place_rate) .or. has_number(material, place_visco)) &
      row = first_phases + merge(state_size, 0, material%values(place_time) > 0)
  end function rate_row

  !> Row of the first of the stresses of ISIG in the history, 0 where there is none.
  pure function stress_row(material) result(row)
    type(material_t), intent(in) :: material
    integer :: row

    row = 0
    if (has_number(material, place_isig)) row = first_phases + state_size + merge(1, 0, rate_row(material) > 0)
  end function stress_row

  !> Moduli of the mixture, in units of the deck.
  pure subroutine elastic_flow(material, z, temperature, flow)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: z(:), temperature
    type(flow_t), intent(out) :: flow
    real(wp) :: young, poisson

    call mixture_moduli(material%steel, z, temperature, young, poisson)
    call moduli(young*material%values(place_stress), poisson, flow%bulk, flow%shear)
  end subroutine elastic_flow

  !> Flow stress of the mixture times `a`, as a function of the plastic strain of a step of length dt.
  pure subroutine flow_of_mixture(material, z, hardened, temperature, dt, rate, a, flow, curve)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: z(:), hardened(:), temperature, dt, rate, a
    type(flow_t), intent(inout) :: flow
    real(wp), intent(out) :: curve(:, :)

    curve = 0
    call mixture_yield(material%steel, z, hardened, temperature, flow%below(:2), curve(:2, :))
    flow%below(:2) = flow%below(:2)*(a*material%values(place_stress))
    curve(2, :) = curve(2, :)*(a*material%values(place_stress))
    flow%yield => yield_mixture
    if (rate_row(material) == 0) return
    flow%rate_row = return_rows
    if (has_number(material, place_rate)) then
      flow%rate_form = rate_cowper
      flow%rate = material%values([place_rate, place_cowper])
      return
    end if
    flow%rate_form = rate_within
    flow%threshold = flow%below(1)
    call mixture_viscosity(material%steel, z, temperature, curve(3:6, :))
    curve(3, :) = curve(3, :)*(a*material%values(place_stress))
    ! a small share of an error of the state (path_stress) makes less than none of what has not flowed yet
    curve(7, :) = max(hardened, 0.0_wp)
    ! rates of the steel's file are per second
    flow%below(at_step) = dt*material%values(place_visco)
    flow%below(at_start_rate) = max(rate, 0.0_wp)/material%values(place_visco)
    flow%yield => yield_by_rate
  end subroutine flow_of_mixture

  !> a(1) + a(2) p + sum c_i (1 - exp(-b_i p)), b and c in `curve`.
  pure subroutine yield_mixture(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [stress]
    real(wp), intent(in) :: curve(:, :)       !! (curve_rows, phase_count): b [-], c [stress]
    real(wp), intent(in) :: p                 !! plastic strain of the step [-]
    real(wp), intent(out) :: sy, slope        !! [stress]
    real(wp) :: left(size(curve, 2))

    left = curve(2, :)*exp(-curve(1, :)*p)
    sy = a(1) + a(2)*p + sum(curve(2, :) - left)
    slope = a(2) + sum(curve(1, :)*left)
  end subroutine yield_mixture

  !> The same, and sum k_i (r_i + p)^n_i exp(-s_i (r_i + p)) rate^m_i: k, n, s, m, r in `curve`; rate = p/a(3), at p = 0 a(4). The
  !> slope is needed above p = 0 only.
  pure subroutine yield_by_rate(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [stress], [stress], [s], [1/s]
    real(wp), intent(in) :: curve(:, :)       !! (curve_rows, phase_count) [unit of each number]
    real(wp), intent(in) :: p                 !! plastic strain of the step [-]
    real(wp), intent(out) :: sy, slope        !! [stress]
    real(wp) :: rate, r, part
    integer :: i

    call yield_mixture(a, curve, p, sy, slope)
    rate = a(at_start_rate)
    if (p > 0) rate = p/a(at_step)
    do i = 1, size(curve, 2)
      if (.not. curve(3, i) > 0) cycle
      r = curve(7, i) + p
      part = curve(3, i)*r**curve(4, i)*exp(-curve(5, i)*r)*rate**curve(6, i)
      sy = sy + part
      if (p > 0) slope = slope + part*(curve(4, i)/r - curve(5, i) + curve(6, i)/p)
    end do
  end subroutine yield_by_rate

  !> A symmetric tensor (xx, yy, xy, zz) whose deviator is divided by a number.
  pure function with_deviator_over(a, tensor) result(divided)
    real(wp), intent(in) :: a
    real(wp), intent(in) :: tensor(4)   !! [of any unit]
    real(wp) :: divided(4)

    divided = tensor/a
    divided(normal) = divided(normal) + sum(tensor(normal))/3*(1 - 1/a)
  end function with_deviator_over

end module phase_point
