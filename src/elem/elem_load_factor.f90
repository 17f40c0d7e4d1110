!> LOADF: a multiplier that is found, so that a measure of the motion follows what the deck gives.
!>
!> The multiplier m is an unknown beside the displacements. Its equation gives, in each step, the displacement of a node, or the
!> displacement conjugate to the loads over m, f.du with f their forces at m = 1 (for a pressure of 1 the volume that its sides
!> sweep). The matrix stays regular past a limit point of the load, where that of the displacements alone is not.
!> Source: J.-L. Batoz, G. Dhatt, Int. J. Num. Meth. Eng. 14 (1979) 1262-1267 (control by a displacement); E. Riks, J. Appl. Mech.
!> 39 (1972) 1060-1065 (the equation among the others); the displacement conjugate to the loads: M.A. Crisfield, Non-linear Finite
!> Element Analysis, vol. 1 (1991), ch. 9.
!>
!> The group has an element for each force on a node over m, in the order of `load_factor%forces`, then one for what the measure
!> shall be, and where it is a displacement one for what it is.
module elem_load_factor
  use elem_api, only: elem_t, instant_t, layout_t, mode_advance, no_variables, of_displacement, report_t, unknown_t
  use fields, only: load_factor_field
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use scene, only: group_t, role_load_factor, scene_t
  implicit none
  private
  public :: elem_loadf_row, load_factor_place, of_load_factor

contains

  function elem_loadf_row() result(row)
    type(elem_t) :: row

    row%name = 'LOADF'
    row%purpose = 'load found from a motion'
    row%nnode = 1
    row%role = role_load_factor
    allocate (row%unknowns, source=[of_displacement(), of_load_factor()])
    row%symmetric = .false.
    row%effect = 'load factor'
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_loadf_row

  pure function of_load_factor() result(unknown)
    type(unknown_t) :: unknown

    unknown%field = load_factor_field()
  end function of_load_factor

  !> Local place of the load factor among the unknowns of an element that it multiplies, 0 for others.
  pure function load_factor_place(scene, group, layout) result(place)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(layout_t), intent(in) :: layout
    integer :: place
    integer :: k

    place = 0
    if (scene%load_factor%multiplier == 0 .or. group%multiplier /= scene%load_factor%multiplier) return
    do k = 1, layout%nfield
      if (scene%fields(layout%field(k))%name == 'load_factor') place = layout%first(1, k)
    end do
  end function load_factor_place

  subroutine compute(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                     force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :), start(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report  !! a load never fails
    logical :: advances
    integer :: e, nforce

    ! x, y of the node, and the load factor
    associate (factor => scene%load_factor, m => 3)
      advances = instant%mode == mode_advance
      nforce = size(factor%forces)
      force = 0
      if (instant%tangent) stiffness = 0
      do e = 1, size(du, 2)
        select case (first + e - 1 - nforce)
        case (:0)
          associate (load => scene%forces(factor%forces(first + e - 1)))
            force(load%component, e) = -load%amplitude*instant%multipliers(factor%multiplier)
            if (instant%tangent) stiffness(load%component, m, e) = -load%amplitude
            if (factor%node > 0 .or. .not. advances) cycle
            force(m, e) = -load%amplitude*du(load%component, e)
            if (instant%tangent) stiffness(m, load%component, e) = -load%amplitude
          end associate
        case (1)
          if (advances) then
            force(m, e) = factor%amplitude*(instant%multipliers(factor%curve) - instant%multipliers_before(factor%curve))
          else if (instant%tangent) then
            ! at fixed time the load stays
            stiffness(m, m, e) = 1
          end if
        case default
          if (.not. advances) cycle
          force(m, e) = -du(factor%component, e)
          if (instant%tangent) stiffness(m, factor%component, e) = -1
        end select
      end do
    end associate
  end subroutine compute

end module elem_load_factor
