!> Forces on nodes, pilots and the section at a time.
module external_loads
  use dofs, only: dofs_t
  use fields, only: pilot_field, section_field
  use kinds, only: wp
  use loads, only: multiplier_at
  use scene, only: scene_t
  use sections, only: section_forced
  implicit none
  private
  public :: external_forces

contains

  !> Forces on nodes and pilots, and loads of the section, at a time.
  pure subroutine external_forces(scene, dofs, time, force)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: time
    real(wp), intent(out) :: force(:)   !! (ndof) [residual]
    integer :: k, d

    force = 0
    do k = 1, size(scene%forces)
      associate (load => scene%forces(k))
        ! those over a multiplier that is found are elements (LOADF)
        if (load%multiplier == scene%load_factor%multiplier) cycle
        d = dofs%fields(load%field)%number(load%component, load%node)
        force(d) = force(d) + load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        d = dofs%fields(pilot_field)%number(load%component, load%die)
        if (d == 0 .or. load%multiplier == 0) cycle
        force(d) = load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
      end associate
    end do
    do k = 1, 3
      d = dofs%fields(section_field)%number(k, 1)
      if (d == 0) cycle
      associate (drive => scene%section_drives(k))
        if (drive%kind /= section_forced .or. drive%multiplier == 0) cycle
        force(d) = drive%amplitude*multiplier_at(scene%multipliers(drive%multiplier), time)
      end associate
    end do
  end subroutine external_forces

end module external_loads
