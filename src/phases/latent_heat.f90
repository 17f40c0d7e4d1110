!> Latent heats of the phases of a steel as what sets their enthalpies apart: the enthalpy of a phase is that of austenite less its
!> LATENT at the same temperature, so that what one phase releases when it becomes another is the difference of both.
!>
!> Over a closed cycle (formed from austenite at one temperature, austenite again at another) no heat is left where
!> dL/dT = c_A - c_i, the capacities of austenite and of the phase (G. Kirchhoff, Ann. Phys. Chem. 179 (1858) 177): numbers of
!> a file need not be so.
module latent_heat
  use dual_numbers, only: dual_t, operator(*), operator(+), operator(-)
  use heat_of_phases, only: heat_taken
  use kinds, only: wp
  use steels, only: austenite, bainite, martensite, prop_content, prop_latent, prop_rhoc, steel_t, tempered
  use temperature_curves, only: curve_at, dual_curve_at, is_given, same_curve
  implicit none
  private
  public :: complete_latent, lacks_latent, heat_of_tempering, left_by_cycle, release_latent

contains

  !> What is tempered and has no LATENT of its own has that of what it was: tempering then releases nothing, and what becomes
  !> austenite takes up what had been released. It stays unknown where martensite and bainite are tempered whose
  !> LATENT are not the same.
  pure subroutine complete_latent(steel)
    type(steel_t), intent(inout) :: steel

    associate (latent => steel%properties(prop_latent, :), rate => steel%temper_rate)
      if (is_given(latent(tempered)) .or. .not. any(rate > 0)) return
      if (all(rate > 0) .and. .not. same_curve(latent(martensite), latent(bainite))) return
      latent(tempered) = latent(merge(martensite, bainite, rate(1) > 0))
    end associate
  end subroutine complete_latent

  !> What is tempered becomes austenite again, and what it then takes up is neither given nor that of one phase.
  pure function lacks_latent(steel) result(yes)
    type(steel_t), intent(in) :: steel   !! after `complete_latent`
    logical :: yes

    yes = steel%tau1 > 0 .and. all(steel%temper_rate > 0) .and. .not. is_given(steel%properties(prop_latent, tempered)) &
          .and. any(is_given(steel%properties(prop_latent, [martensite, bainite])))
  end function lacks_latent

  !> LATENT of a phase, 0 where it is not given.
  pure function latent_of(steel, phase, temperature) result(latent)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: latent                    !! [MJ/m3]

    latent = dual_t()
    if (is_given(steel%properties(prop_latent, phase))) latent = dual_curve_at(steel%properties(prop_latent, phase), temperature)
  end function latent_of

  !> Latent heat of a phase that forms from austenite.
  pure subroutine release_latent(steel, phase, temperature, formed, heat)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(in) :: formed        !! fraction
    type(dual_t), intent(inout) :: heat       !! [MJ/m3]

    heat = heat + latent_of(steel, phase, temperature)*formed
  end subroutine release_latent

  !> Heat that martensite or bainite releases when it is tempered, per fraction: none where that of what is tempered is unknown.
  pure function heat_of_tempering(steel, phase, temperature) result(heat)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: heat                      !! [MJ/m3]

    heat = dual_t()
    if (is_given(steel%properties(prop_latent, tempered))) &
      heat = latent_of(steel, tempered, temperature) - latent_of(steel, phase, temperature)
  end function heat_of_tempering

  !> Heat that is left of nothing where a phase forms from austenite at one temperature, is heated, becomes austenite at another and
  !> cools again, and the heat that austenite gives off on the way between both. 0 for a steel without heat of both.
  pure subroutine left_by_cycle(steel, phase, forms, dissolves, left, passed)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp), intent(in) :: forms, dissolves   !! temperatures [degC]
    real(wp), intent(out) :: left, passed      !! [MJ/m3]
    type(dual_t) :: cold, hot
    real(wp) :: own, capacity

    left = 0
    passed = 0
    if (.not. (has_heat(austenite) .and. has_heat(phase))) return
    call heat_taken(steel, austenite, forms, dissolves, passed, capacity)
    call heat_taken(steel, phase, forms, dissolves, own, capacity)
    cold = latent_of(steel, phase, dual_t(forms))
    hot = latent_of(steel, phase, dual_t(dissolves))
    left = cold%value - hot%value + passed - own

  contains

    pure function has_heat(of)
      integer, intent(in) :: of
      logical :: has_heat

      has_heat = is_given(steel%properties(prop_content, of)) .or. is_given(steel%properties(prop_rhoc, of))
    end function has_heat

  end subroutine left_by_cycle

end module latent_heat
