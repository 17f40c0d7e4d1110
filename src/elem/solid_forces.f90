!> Forces and matrix of a solid element (elem_pl8ls has the formulas): of its nodes, of the section where that moves, and with mean
!> dilatation.
module solid_forces
  use elem_api, only: instant_t, layout_t
  use kinds, only: wp
  use linear_pressure, only: has_linear_pressure, replace_pressure
  use mean_dilatation, only: dilatation_t, mean_option
  use scene, only: generalised_plane_strain, group_t, plane_stress, scene_t
  use solid_block, only: sections_of_step, solid_block_t
  use solid_kernels, only: internal_force, tangent_matrix
  use solid_terms, only: add_section, first_element, mean_element
  implicit none
  private
  public :: element_forces

contains

  !> Forces of the stresses at the points of an element on its mechanical unknowns, and the matrix where it is wanted.
  subroutine element_forces(scene, group, finite, instant, layout, block, element, x, du, committed, wanted, stress, &
                            volume, force, stiffness)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    logical, intent(in) :: finite
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    type(solid_block_t), intent(in) :: block
    integer, intent(in) :: element                  !! place in the block
    real(wp), intent(in) :: x(:, :)                 !! (2, 8) nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)                   !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(in) :: committed(:, :)         !! (4, npoint) at the start of the step [stress]
    logical, intent(in) :: wanted                   !! the matrix
    real(wp), intent(in) :: stress(:, :)            !! (4, npoint) [stress]
    real(wp), intent(in), contiguous :: volume(:)   !! (npoint) [volume]
    real(wp), intent(out) :: force(:)               !! (block%n) [force]
    real(wp), intent(inout) :: stiffness(:, :)      !! (block%n, block%n) [force/unknown]
    real(wp) :: section(3, 2)
    type(dilatation_t), allocatable :: own
    real(wp) :: counted(4, group%rule%n)
    logical :: mean

    mean = group%option == mean_option
    if (mean .or. scene%plane_state == generalised_plane_strain .or. (wanted .and. has_linear_pressure(instant))) &
      call sections_of_step(scene, finite, instant, layout, du, section)
    associate (rule => block%rule, nodes => group%connectivity(:, block%first + element - 1), &
               nx => block%nx(:, :, element), ny => block%ny(:, :, element), zx => block%zx(:, :, element), &
               moduli => block%tangent(:, :, :, element))
      if (mean) then
        allocate (own)
        call first_element(scene, rule, nodes, own)
      end if
      counted = stress
      if (wanted .and. finite .and. scene%plane_state /= plane_stress .and. has_linear_pressure(instant)) then
        ! without mean dilatation there is no `own`
        call replace_pressure(instant, rule, nodes, section, x, du, volume, committed, moduli, counted, own)
      end if
      if (mean) then
        call mean_element(finite, wanted, rule, section, own, x, du, nx, ny, volume, stress, counted, moduli, force, stiffness)
        return
      end if
      call internal_force(nx, ny, zx, volume, stress, force(1:16))
      if (wanted) call tangent_matrix(scene%plane_state == plane_stress, finite, nx, ny, zx, volume, counted, moduli, &
                                      stiffness(1:16, 1:16))
      if (scene%plane_state /= generalised_plane_strain) return
      call add_section(finite, wanted, rule, section, x, du, nx, ny, volume, stress, counted, moduli, force, stiffness)
    end associate
  end subroutine element_forces

end module solid_forces
