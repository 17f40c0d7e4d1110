!> The line of a group in a scene's summary: elements, points, and what acts on them.
module group_summary
  use elem_api, only: elem_t
  use kinds, only: wp
  use loads, only: by_flux, by_radiation, field_history_t
  use quadrature, only: rule_along, rule_control, rule_equidistant, rule_t
  use scene, only: group_t, role_load_factor, role_side_load, role_volume_load, scene_t
  use summary_words, only: direction_names, times
  use text, only: padded, to_text
  use weld_sources, only: weld_source_t
  implicit none
  private
  public :: group_text

contains

  !> Name, elements, points, option, law and loads.
  pure function group_text(scene, group, elem) result(s)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(elem_t), intent(in) :: elem   !! of the group
    character(len=:), allocatable :: s

    s = padded(group%name, 24)//padded(to_text(size(group%connectivity, 2))//' '//group%elem, 14) &
        //to_text(group%rule%n)//rule_of(group%rule)
    if (group%option > 0) s = s//', '//elem%options(group%option)%s
    s = s//driven_by(scene, group, elem)//temperature_of(scene, group)
  end function group_text

  !> Points of an integration rule, with its kind along a side where it is not Gauss's.
  pure function rule_of(rule) result(s)
    type(rule_t), intent(in) :: rule
    character(len=:), allocatable :: s

    s = ''
    if (rule%family == rule_along) s = ' Lobatto'
    if (rule%family == rule_control) s = ' Bezier'
    if (rule%family == rule_equidistant) s = trim(merge(' Lobatto    ', ' equidistant', rule%n == 3))
    s = s//' points'
    if (rule%family == rule_along) s = s//' and between them'
  end function rule_of

  !> The law of a group, or the load that it is.
  pure function driven_by(scene, group, elem) result(s)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(elem_t), intent(in) :: elem
    character(len=:), allocatable :: s

    s = ''
    if (group%material > 0) s = ', law '//scene%materials(group%material)%name
    if (group%multiplier > 0) s = ', '//to_text(group%amplitude)//times(scene, group%multiplier)
    if (elem%squares_multiplier) s = s//'^2'
    if (group%role == role_load_factor) s = found_by(scene)
    if (group%is_spring) s = ', '//to_text(group%stiffness, 3)//' per volume'
    if (group%source > 0) then
      s = torch_of(scene, scene%sources(group%source))
    else if (group%brings_heat .and. any(group%role == [role_side_load, role_volume_load])) then
      s = exchange_of(scene, group)
    end if
  end function driven_by

  !> The temperature given to a body.
  pure function temperature_of(scene, group) result(s)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    character(len=:), allocatable :: s

    s = ''
    if (group%temperature_history > 0) s = history_of(scene%histories(group%temperature_history))
    if (group%temperature_multiplier > 0) &
      s = s//', temperature '//to_text(group%temperature_amplitude)//times(scene, group%temperature_multiplier)
  end function temperature_of

  !> Temperatures of another run.
  pure function history_of(history) result(s)
    type(field_history_t), intent(in) :: history
    character(len=:), allocatable :: s

    s = ', temperature of '//history%source
    if (history%begins > 0) s = s//' from '//to_text(history%begins)//' on'
  end function history_of

  !> What the multiplier that is found makes follow what.
  pure function found_by(scene) result(s)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: s

    associate (factor => scene%load_factor)
      s = ', so that the work of its loads, at a multiplier of 1,'
      if (factor%node > 0) s = ', so that node '//to_text(scene%mesh%labels(factor%node))//' '//direction_names(factor%component)
      s = s//' follows '//to_text(factor%amplitude)//times(scene, factor%curve)
    end associate
  end function found_by

  !> Heat that passes sides or comes from a volume, in numbers.
  pure function exchange_of(scene, group) result(s)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    character(len=:), allocatable :: s

    associate (exchange => group%exchange)
      s = ', '//to_text(exchange%amplitude)//times(scene, exchange%multiplier)
      if (allocated(exchange%table)) s = s//' by temperature'
      if (exchange%kind == by_flux) return
      s = s//', surroundings '//to_text(exchange%surroundings)//times(scene, exchange%surroundings_multiplier)
      if (exchange%kind == by_radiation) s = s//', absolute zero '//to_text(-exchange%zero)
    end associate
  end function exchange_of

  !> Heat of a torch, in numbers.
  pure function torch_of(scene, source) result(s)
    type(scene_t), intent(in) :: scene
    type(weld_source_t), intent(in) :: source
    character(len=:), allocatable :: s

    s = ', '//to_text(source%efficiency)//' x '//to_text(source%power)//times(scene, source%multiplier)
    if (source%crosses) s = s//', crosses at '//to_text(source%crossing_time)//' with '//to_text(source%speed)
  end function torch_of

end module group_summary
