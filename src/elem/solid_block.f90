!> A block of solid elements in a step: the motion of their points, what drives these, and their state at its end.
module solid_block
  use elem_api, only: group_temperature, instant_t, layout_t, section_motion
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: driver_count, driver_temperature, law_t
  use plane_stress_points, only: update_plane_stress
  use point_temperatures, only: point_temperatures_of, projected_functions, temperature_place
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: group_t, plane_stress, scene_t
  implicit none
  private
  public :: solid_block_t, drive_points, follows_temperature, sections_of_step, start_block, update_points

  !> What is computed of a block in one evaluation.
  type :: solid_block_t
    !> Place of its first element in the group.
    integer :: first = 0
    !> Unknowns of the mechanics: those of an element but the temperatures.
    integer :: n = 0
    type(quad8_rule_t) :: rule
    !> (8, npoint, nelem) d(shape functions)/dx and /dy [1/length], and d h_zz/d(ux of the nodes) [1/length].
    real(wp), allocatable :: nx(:, :, :), ny(:, :, :), zx(:, :, :)
    real(wp), allocatable :: dv(:, :)             !! (npoint, nelem) [volume]
    real(wp), allocatable :: f(:, :, :)           !! (5, npoint, nelem) gradient of the step: xx, xy, yx, yy, zz [-]
    real(wp), allocatable :: given(:, :, :)       !! (ndriver, 2, npoint*nelem) drivers at both ends of the step [unit of each]
    real(wp), allocatable :: tangent(:, :, :, :)  !! (4, 5, npoint, nelem) d(stress)/dh [stress]
    !> (5, npoint, nelem) d(plastic work)/dh, where it heats in the solve under way [stress].
    real(wp), allocatable :: by_work(:, :, :)
  end type solid_block_t

contains

  !> Room for a block of elements.
  subroutine start_block(group, law, layout, first, ndof, nelem, block)
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first, ndof, nelem   !! its first element in the group, unknowns of an element, elements
    type(solid_block_t), intent(out) :: block

    block%first = first
    block%n = ndof
    if (temperature_place(layout) > 0) block%n = layout%first(1, temperature_place(layout)) - 1
    call quad8_rule(group%rule%n, block%rule)
    associate (npoint => group%rule%n)
      allocate (block%nx(8, npoint, nelem), block%ny(8, npoint, nelem), block%zx(8, npoint, nelem))
      allocate (block%dv(npoint, nelem), block%f(5, npoint, nelem), block%tangent(4, 5, npoint, nelem))
      allocate (block%given(driver_count(law), 2, npoint*nelem))
    end associate
  end subroutine start_block

  !> The temperature is an unknown of the scene. A body with a TEMPE card has that temperature also where others have a field.
  pure function follows_temperature(group, layout) result(follows)
    type(group_t), intent(in) :: group
    type(layout_t), intent(in) :: layout
    logical :: follows

    follows = temperature_place(layout) > 0 .and. group%temperature_multiplier == 0
  end function follows_temperature

  !> What drives the points, at both ends of the step: the temperature, and what else the law asks for.
  subroutine drive_points(group, instant, layout, du, start, drivers, block)
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:, :), start(:, :)    !! (ndof, nelem) motion, and values at the start of the step [unknown]
    real(wp), intent(in) :: drivers(:, :, :, :)      !! (ndriver, :, npoint, nelem) as the interface has them [unit of each driver]
    type(solid_block_t), intent(inout) :: block
    real(wp) :: functions(8, group%rule%n)
    integer :: i, k, n, p

    n = group%rule%n
    if (follows_temperature(group, layout)) then
      functions = projected_functions(block%rule)
      do i = 1, size(du, 2)
        p = (i - 1)*n
        call point_temperatures_of(layout, functions, du(:, i), start(:, i), &
                                   block%given(driver_temperature, :, p + 1:p + n))
      end do
    else
      block%given(driver_temperature, :, :) = spread(group_temperature(group, instant), 2, n*size(du, 2))
    end if
    do k = 2, size(block%given, 1)
      block%given(k, :, :) = reshape(drivers(k, :2, :, :), [2, n*size(du, 2)])
    end do
  end subroutine drive_points

  !> State at the end of a step from the state `before`; in plane stress the motion across the plane is found.
  subroutine update_points(scene, group, kinematics, law, instant, before, driven, g, after, moduli, answers, along)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    real(wp), intent(in), contiguous :: before(:, :, :)       !! (nstate, npoint, nelem) [unit of each component]
    real(wp), intent(in), contiguous :: driven(:, :, :)       !! (ndriver, 2, npoint*nelem) [unit of each driver]
    real(wp), intent(inout), contiguous :: g(:, :, :)         !! (5, npoint, nelem) gradient of the step [-]
    real(wp), intent(inout), contiguous :: after(:, :, :)     !! (nstate, npoint, nelem) [unit of each component]
    real(wp), intent(out), contiguous :: moduli(:, :, :, :)   !! (4, 5, npoint, nelem) d(stress)/dh [stress]
    integer, intent(out), contiguous :: answers(:, :)         !! (npoint, nelem) of the law
    real(wp), intent(out), contiguous, optional :: along(:, :, :)   !! (5, npoint, nelem) d(plastic work)/dh [stress]
    integer :: npoint, nstate

    npoint = size(answers)
    nstate = size(before, 1)
    if (scene%plane_state == plane_stress) then
      call update_plane_stress(kinematics, law, scene%materials(group%material), instant%dt, npoint, nstate, driven, &
                               g, before, after, moduli, answers, along)
      after(nstate, :, :) = before(nstate, :, :)*g(5, :, :)
    else
      call kinematics%update(law, scene%materials(group%material), instant%dt, npoint, nstate, driven, &
                             g, before, after, moduli, answers, along)
    end if
  end subroutine update_points

  !> Section (:, 1) the geometry is at, and its motion (:, 2) in the step.
  pure subroutine sections_of_step(scene, finite, instant, layout, du, section)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: finite
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:)            !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(out) :: section(3, 2)   !! thickness [length] and slopes [-]: of the geometry, and their motion

    section(:, 2) = section_motion(layout, du)
    section(:, 1) = scene%section
    if (finite) section(:, 1) = instant%section + section(:, 2)
  end subroutine sections_of_step

end module solid_block
