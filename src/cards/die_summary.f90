!> The line of a die in a scene's summary: its pieces, its motion, its temperature.
module die_summary
  use dies, only: is_deformable, radius_on
  use kinds, only: pi, wp
  use scene, only: axisymmetric, scene_t
  use summary_words, only: direction_names, times
  use text, only: padded, to_text
  implicit none
  private
  public :: die_text

contains

  !> Name, pieces, motion and temperature.
  pure function die_text(scene, die) result(s)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die   !! place in the scene's list
    character(len=:), allocatable :: s

    associate (n => size(scene%dies(die)%pieces, 3))
      s = padded(scene%dies(die)%name, 24)//to_text(n)//trim(merge(' piece  ', ' pieces ', n == 1))//beyond_axis(scene, die)//', '
    end associate
    if (is_deformable(scene%dies(die))) then
      s = s//'sides of bodies'
    else
      s = s//motion_of(scene, die)
    end if
    s = s//temperature_of(scene, die)
  end function die_text

  !> Pieces that are beyond the axis, as the mirror image of a die that ends there (cards_dies).
  pure function beyond_axis(scene, die) result(s)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    character(len=:), allocatable :: s
    integer :: n, k

    s = ''
    if (scene%plane_state /= axisymmetric .or. is_deformable(scene%dies(die))) return
    associate (d => scene%dies(die))
      n = count([(radius_on(d, maxval(d%pieces(1, :, k))) <= 0, k=1, size(d%pieces, 3))])
    end associate
    if (n > 0) s = ' ('//to_text(n)//' beyond the axis)'
  end function beyond_axis

  !> What moves a rigid die.
  pure function motion_of(scene, die) result(s)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    character(len=:), allocatable :: s
    integer :: i

    s = ''
    do i = 1, size(scene%die_motions)
      associate (motion => scene%die_motions(i))
        if (motion%die /= die) cycle
        if (s /= '') s = s//', '
        s = s//direction_names(motion%component)//' = '//to_text(motion%amplitude)//times(scene, motion%multiplier)
      end associate
    end do
    do i = 1, size(scene%die_forces)
      associate (load => scene%die_forces(i))
        if (load%die /= die) cycle
        if (s /= '') s = s//', '
        s = s//direction_names(load%component)//' free'
        if (load%multiplier > 0) s = s//' under a force by '//scene%multipliers(load%multiplier)%name
      end associate
    end do
    if (s == '') s = 'at rest'
  end function motion_of

  !> What TDIE gives of a die.
  pure function temperature_of(scene, die) result(s)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    character(len=:), allocatable :: s
    real(wp) :: around
    integer :: i

    s = ''
    around = merge(2*pi, 1.0_wp, scene%plane_state == axisymmetric)
    do i = 1, size(scene%die_heats)
      associate (heat => scene%die_heats(i))
        if (heat%die /= die) cycle
        s = ', T = '//to_text(heat%temperature)//times(scene, heat%multiplier)
        if (heat%capacity > 0) s = s//' at the start, heat capacity '//to_text(around*heat%capacity, 6)
      end associate
    end do
  end function temperature_of

end module die_summary
