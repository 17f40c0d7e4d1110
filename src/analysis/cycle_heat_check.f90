!> What can be said of the heat of steels whose phases become austenite again: whether LATENT and the heat capacities of the phases
!> close a cycle, or heat is made of nothing in each.
module cycle_heat_check
  use kinds, only: wp
  use latent_heat, only: left_by_cycle
  use law_api, only: heat_law, law_t
  use phases_there, only: phases_that_form
  use scene, only: scene_t
  use steels, only: first_diffusive, kinetics_none, martensite, phase_count, phase_names, steel_t, tempered, &
                    unknown_temperature
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: judge_cycle_heat

  !> Heat capacities of steels are known to so much.
  real(wp), parameter :: known_share = 0.05_wp

contains

  !> A line for each steel, of the phase that leaves most heat.
  subroutine judge_cycle_heat(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: m

    do m = 1, size(scene%materials)
      if (.not. allocated(scene%materials(m)%steel)) cycle
      if (laws(scene%materials(m)%law_id)%kind /= heat_law .or. .not. scene%materials(m)%steel%tau1 > 0) cycle
      call judge_steel(scene%materials(m)%steel, warnings)
    end do
  end subroutine judge_cycle_heat

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
