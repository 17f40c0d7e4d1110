!> What can be said of the heat of steels whose phases become austenite again: whether LATENT and the heat capacities of the phases
!> close a cycle, or heat is made of nothing in each.
module cycle_heat_check
  use fields, only: find_field
  use kinds, only: wp
  use latent_heat, only: left_by_cycle
  use law_api, only: find_parameter, heat_law, law_t
  use loads, only: by_flux
  use phases_there, only: phases_that_form
  use scene, only: scene_t
  use state_variables, only: find_variable
  use steels, only: first_diffusive, kinetics_none, martensite, phase_count, phase_names, steel_t, tempered, &
                    unknown_temperature
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: judge_cycle_heat

  !> Heat capacities of steels are known to so much.
  real(wp), parameter :: known_share = 0.05_wp

contains

  !> A line for each steel that may be heated to Ac1, of the phase that leaves most heat.
  subroutine judge_cycle_heat(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: m

    do m = 1, size(scene%materials)
      if (.not. allocated(scene%materials(m)%steel)) cycle
      if (laws(scene%materials(m)%law_id)%kind /= heat_law .or. .not. scene%materials(m)%steel%tau1 > 0) cycle
      if (may_become_austenite(scene, laws, m)) call judge_steel(scene%materials(m)%steel, warnings)
    end do
  end subroutine judge_cycle_heat

  !> Something in the scene may heat a steel to Ac1: a source, heat that is stated, a temperature as high around it or imposed, or
  !> that of another body at the start where this one is no austenite. A quench has none.
  pure function may_become_austenite(scene, laws, m) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: m             !! material
    logical :: yes
    real(wp) :: ac1
    integer :: g, k, v

    ac1 = scene%materials(m)%steel%ac1 - scene%materials(m)%values(find_parameter(laws(scene%materials(m)%law_id), 'ZERO'))
    yes = size(scene%sources) > 0 .or. size(scene%histories) > 0
    do k = 1, size(scene%fixations)
      if (scene%fixations(k)%field == find_field(scene%fields, 'temperature')) &
        yes = yes .or. largest(scene, scene%fixations(k)%amplitude, scene%fixations(k)%multiplier) > ac1
    end do
    do k = 1, size(scene%die_heats)
      yes = yes .or. largest(scene, scene%die_heats(k)%temperature, scene%die_heats(k)%multiplier) > ac1
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), exchange => scene%groups(g)%exchange)
        if (exchange%kind == by_flux) then
          yes = yes .or. largest(scene, exchange%amplitude, exchange%multiplier) > 0
        else
          yes = yes .or. largest(scene, exchange%surroundings, exchange%surroundings_multiplier) > ac1
        end if
        if (group%material /= m) cycle
        v = find_variable(group%variables, 'austenite')
        if (v == 0) cycle
        if (.not. (group%variables(v)%initial < 1 .and. allocated(scene%starts))) cycle
        do k = 1, size(scene%starts)
          yes = yes .or. any(scene%starts(k)%values > ac1)
        end do
      end associate
    end do
  end function may_become_austenite

  !> The largest that an amplitude is with its multiplier, 0 for none.
  pure function largest(scene, amplitude, multiplier) result(value)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: amplitude   !! [any]
    integer, intent(in) :: multiplier
    real(wp) :: value

    value = amplitude
    if (multiplier > 0) value = maxval(amplitude*scene%multipliers(multiplier)%value)
  end function largest

  subroutine judge_steel(steel, warnings)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(inout) :: warnings(:)
    character(len=:), allocatable :: name
    real(wp) :: left, passed, most, over, share, forms
    logical :: there(phase_count)
    integer :: i, worst

    there = phases_that_form(steel)
    worst = 0
    share = known_share
    most = 0
    over = 0
    do i = first_diffusive, phase_count
      if (.not. there(i)) cycle
      forms = forms_at(steel, i)
      if (.not. (forms > unknown_temperature .and. forms < steel%ac1)) cycle
      call left_by_cycle(steel, i, forms, steel%ac1, left, passed)
      if (.not. abs(left) > share*passed) cycle
      worst = i
      share = abs(left)/passed
      most = left
      over = forms
    end do
    if (worst == 0) return
    name = trim(phase_names(worst))
    call add_text(warnings, 'steel '//steel%name//': '//name//' that forms at '//to_text(over, 4)//' degC and is austenite ' &
                  //'again at Ac1, '//to_text(steel%ac1, 4)//' degC, '//trim(merge('makes', 'takes', most > 0))//' ' &
                  //to_text(abs(most), 3)//' MJ/m3 of heat '//trim(merge('of nothing', 'to nowhere', most > 0)) &
                  //' in each cycle, '//to_text(100*share, 2)//' % of what austenite holds between: LATENT of '//name &
                  //' must grow with the temperature as RHOC (or H) of AUSTENITE less that of '//name)
  end subroutine judge_steel

  !> Where a phase forms: Ms, of what is tempered too, and the middle of what forms by diffusion.
  pure function forms_at(steel, phase) result(temperature)
    type(steel_t), intent(in) :: steel
    integer, intent(in) :: phase
    real(wp) :: temperature   !! [degC]

    if (phase == martensite .or. phase == tempered) then
      temperature = steel%ms
    else if (steel%kinetics(phase)%kind /= kinetics_none) then
      temperature = 0.5_wp*(steel%kinetics(phase)%low + steel%kinetics(phase)%high)
    else
      temperature = 0.5_wp*(steel%cct%coldest + steel%cct%hottest)
    end if
  end function forms_at

end module cycle_heat_check
