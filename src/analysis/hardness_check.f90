!> What can be said of the hardness of steels before a run: probes of one that there is not, and compositions beyond those that
!> Maynier's formulas were found for.
module hardness_check
  use hardness, only: has_hardness
  use hardness_range, only: beyond_maynier
  use phase_state, only: at_hardness, state_names
  use scene, only: group_t, scene_t
  use state_variables, only: find_variable
  use steels, only: austenite, first_diffusive, kinetics_none, last_diffusive, martensite, phase_count, phase_names, &
                    prop_hardness, steel_t
  use temperature_curves, only: is_given
  use text, only: add_new_text, string_t
  implicit none
  private
  public :: judge_hardness, words_of_range

contains

  !> Warnings, one line each.
  subroutine judge_hardness(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)
    logical :: told(size(scene%materials))
    integer :: g, k

    told = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (.not. keeps_hardness(scene, group)) cycle
        if (told(group%material)) cycle
        told(group%material) = .true.
        call add_new_text(warnings, words_of_range(scene%materials(group%material)%steel))
      end associate
    end do
    told = .false.
    do k = 1, size(scene%probes)
      associate (probe => scene%probes(k))
        if (probe%group == 0) cycle
        associate (group => scene%groups(probe%group))
          if (.not. keeps_hardness(scene, group)) cycle
          if (told(group%material)) cycle
          if (probe%component /= group%variables(find_variable(group%variables, trim(state_names(at_hardness))))%first) cycle
          told(group%material) = .true.
          call add_new_text(warnings, words_of_probe(probe%name, group, scene%materials(group%material)%steel))
        end associate
      end associate
    end do
  end subroutine judge_hardness

  !> The state of a group of a steel has a hardness.
  pure function keeps_hardness(scene, group) result(yes)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    logical :: yes

    yes = group%material > 0 .and. allocated(group%variables)
    if (yes) yes = allocated(scene%materials(group%material)%steel)
    if (yes) yes = find_variable(group%variables, trim(state_names(at_hardness))) > 0
  end function keeps_hardness

  !> A composition beyond the range of Maynier's formulas; empty where it is none, or the phases that may form have HV.
  pure function words_of_range(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    character(len=:), allocatable :: beyond

    words = ''
    if (.not. steel%maynier .or. phases_without(steel) == '') return
    beyond = beyond_maynier(steel%composition)
    if (beyond == '') return
    words = 'the steel '//steel%name//':'//beyond//' is beyond the mass per cent that Maynier''s formulas of hardness (HARDN ' &
            //'MAYNIER) were found for: it may be far off, above 0.5 of C martensite comes out far too hard; rows HV of its ' &
            //'phases take their place'
  end function words_of_range

  !> A probe of the hardness of a steel that has none, none of a phase that may form, or none of what is there at the start.
  pure function words_of_probe(probe, group, steel) result(words)
    character(len=*), intent(in) :: probe   !! its name
    type(group_t), intent(in) :: group
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    character(len=:), allocatable :: without

    words = ''
    without = ''
    if (.not. has_hardness(steel)) then
      words = 'probe '//probe//': the steel '//steel%name//' has no hardness, it is 0 throughout: rows ' &
              //'HV of its phases, or HARDN MAYNIER with a composition (COMPO)'
      return
    end if
    if (.not. steel%maynier) without = phases_without(steel)
    if (without /= '') then
      words = 'probe '//probe//': the steel '//steel%name//' has no HV of'//without//': they count as 0'
      return
    end if
    without = phases_at_start(group, steel)
    if (without == '') return
    words = 'probe '//probe//': the steel '//steel%name//' has no HV of'//without//', which START PHASES gives: by HARDN MAYNIER ' &
            //'they count as 0, until a point has become austenite and cooled through 700 degC'
  end function words_of_probe

  !> Phases that may form and have no hardness of their own.
  pure function phases_without(steel) result(names)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: names
    logical :: may_form
    integer :: i

    names = ''
    do i = first_diffusive, last_diffusive
      may_form = steel%kinetics(i)%kind /= kinetics_none .or. steel%cct%n > 0
      if (may_form .and. .not. is_given(steel%properties(prop_hardness, i))) names = names//' '//trim(phase_names(i))
    end do
    if (steel%beta > 0 .and. .not. is_given(steel%properties(prop_hardness, martensite))) names = names//' MARTENSITE'
  end function phases_without

  !> Phases that are there at the start and have no hardness of their own.
  pure function phases_at_start(group, steel) result(names)
    type(group_t), intent(in) :: group
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: names
    integer :: i

    names = ''
    do i = 1, phase_count
      if (i == austenite .or. is_given(steel%properties(prop_hardness, i))) cycle
      associate (share => group%variables(find_variable(group%variables, trim(state_names(i)))))
        if (share%initial > 0) names = names//' '//trim(phase_names(i))
      end associate
    end do
  end function phases_at_start

end module hardness_check
