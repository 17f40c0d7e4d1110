!> Unknowns whose motion, or whose value, is known.
module prescribed_unknowns
  use dofs, only: dofs_t, prescribed_t
  use fields, only: field_t, find_field, pilot_field, section_field
  use kinds, only: wp
  use loads, only: instants_around, multiplier_at
  use scene, only: is_later_operation, scene_t
  use sections, only: section_forced, section_moved
  implicit none
  private
  public :: list_prescribed, prescribed_motion

contains

  !> Fixations, imposed displacements and pilots; an unknown held twice is listed once.
  subroutine list_prescribed(scene, dofs)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(inout) :: dofs
    type(prescribed_t) :: by_dof(dofs%ndof)
    integer :: k, i, d

    associate (pilot => dofs%fields(pilot_field)%number, section => dofs%fields(section_field)%number(:, 1))
      do k = 1, size(pilot, 2)
        if (pilot(1, k) > 0) by_dof(pilot(:, k))%dof = pilot(:, k)
      end do
      do k = 1, size(scene%die_forces)
        d = pilot(scene%die_forces(k)%component, scene%die_forces(k)%die)
        if (d > 0) by_dof(d)%dof = 0
      end do
      do k = 1, 3
        if (section(k) == 0 .or. scene%section_drives(k)%kind == section_forced) cycle
        by_dof(section(k))%dof = section(k)
        if (scene%section_drives(k)%kind /= section_moved) cycle
        by_dof(section(k)) = prescribed_t(section(k), scene%section(1)*scene%section_drives(k)%amplitude, &
                                          scene%section_drives(k)%multiplier)
      end do
      do k = 1, size(scene%die_motions)
        associate (motion => scene%die_motions(k))
          if (pilot(1, motion%die) == 0) cycle
          d = pilot(motion%component, motion%die)
          by_dof(d) = prescribed_t(d, motion%amplitude, motion%multiplier, moved=is_later_operation(scene))
        end associate
      end do
      if (allocated(scene%die_heats)) call list_die_temperatures()
      if (allocated(scene%histories)) call list_given_values()
      do k = 1, size(scene%fixations)
        associate (fixation => scene%fixations(k))
          do i = 1, size(fixation%nodes)
            d = dofs%fields(fixation%field)%number(fixation%component, fixation%nodes(i))
            ! a field of corners has nothing to impose in the middle of sides
            if (d == 0) cycle
            by_dof(d) = prescribed_t(d, fixation%amplitude, fixation%multiplier)
            if (scene%fields(fixation%field)%imposed_as_value) &
              by_dof(d) = prescribed_t(d, fixation%amplitude, fixation%multiplier, fixation%field, fixation%component, &
                                       fixation%nodes(i))
          end do
        end associate
      end do
    end associate
    dofs%prescribed = pack(by_dof, by_dof%dof > 0)

  contains

    !> Fields whose values are known beforehand.
    subroutine list_given_values()
      do k = 1, size(scene%histories)
        associate (history => scene%histories(k))
          do i = 1, size(history%nodes)
            d = dofs%fields(history%field)%number(1, history%nodes(i))
            if (d > 0) by_dof(d) = prescribed_t(d, field=history%field, component=1, place=history%nodes(i), history=k, row=i)
          end do
        end associate
      end do
    end subroutine list_given_values

    !> Dies whose temperature is given: without a multiplier it stays as it began.
    subroutine list_die_temperatures()
      integer :: f

      f = find_field(scene%fields, 'die_temperature')
      if (f == 0) return
      do k = 1, size(scene%die_heats)
        associate (heat => scene%die_heats(k))
          d = dofs%fields(f)%number(1, heat%die)
          if (d == 0 .or. heat%capacity > 0) cycle
          by_dof(d) = prescribed_t(d, heat%temperature, heat%multiplier, f, 1, heat%die)
        end associate
      end do
    end subroutine list_die_temperatures

  end subroutine list_prescribed

  !> Motion of the prescribed unknowns from time t0 (or from rest) to t1, in the order of the list.
  pure subroutine prescribed_motion(scene, dofs, fields, from_rest, t0, t1, motion)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(field_t), intent(in) :: fields(:)   !! (nfield) with their values at t0
    logical, intent(in) :: from_rest
    real(wp), intent(in) :: t0, t1       !! [time]
    real(wp), intent(out) :: motion(:)   !! (nprescribed) [unknown]
    integer :: k, before, last
    real(wp) :: share

    last = 0
    before = 0
    share = 0
    do k = 1, size(dofs%prescribed)
      motion(k) = 0
      associate (p => dofs%prescribed(k))
        if (p%history > 0) then
          associate (history => scene%histories(p%history))
            if (p%history /= last) call instants_around(history%time, t1, before, share)
            last = p%history
            motion(k) = history%values(p%row, before)
            if (share > 0) motion(k) = (1 - share)*motion(k) + share*history%values(p%row, before + 1)
          end associate
          motion(k) = motion(k) - fields(p%field)%value(p%component, p%place)
        end if
        if (p%multiplier == 0) cycle
        motion(k) = multiplier_at(scene%multipliers(p%multiplier), t1)
        if (p%field > 0) then
          motion(k) = p%amplitude*motion(k) - fields(p%field)%value(p%component, p%place)
          cycle
        end if
        if (p%moved .or. .not. from_rest) motion(k) = motion(k) - multiplier_at(scene%multipliers(p%multiplier), t0)
        motion(k) = p%amplitude*motion(k)
      end associate
    end do
  end subroutine prescribed_motion

end module prescribed_unknowns
