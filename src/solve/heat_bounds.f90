!> Temperatures that can be there after a step without sources: between the lowest and the highest of those at its start, of those
!> imposed, and of the surroundings that heat is exchanged with (the maximum principle of the equation of heat).
module heat_bounds
  use equations, only: equations_t
  use fields, only: find_field
  use heat_record, only: heat_step_t
  use kinds, only: wp
  use loads, only: by_flux, multiplier_at
  use scene, only: role_body, role_die_heat, role_heat_contact, role_second, role_side_load, role_volume_load, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: find_excess, has_bounds, has_rough_bounds, on_corners_alone

  !> Excess below this share of the range is the tolerance of the iteration, and below this share of the temperatures round-off.
  real(wp), parameter :: slack = 1.0e-5_wp, round_off = 1.0e-9_wp

contains

  !> No heat flows but by temperature, none is released, and nothing moves: temperatures are bounded.
  pure function has_bounds(scene, equations) result(bounded)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: bounded
    integer :: f, g

    f = find_field(scene%fields, 'temperature')
    bounded = count(scene%fields%declared) == 1 .and. .not. any(scene%forces%field == f)
    do g = 1, size(scene%groups)
      select case (scene%groups(g)%role)
      case (role_side_load, role_volume_load)
        bounded = bounded .and. scene%groups(g)%exchange%kind /= by_flux
      case (role_body, role_second)
        ! points that keep a state release heat
        bounded = bounded .and. size(scene%groups(g)%variables) == 0
      case default
        bounded = .false.
      end select
    end do
    bounded = bounded .and. size(equations%solves) == 1
  end function has_bounds

  !> All temperatures stand on corners, with lumped capacity.
  pure function on_corners_alone(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes

    associate (f => find_field(scene%fields, 'temperature'))
      yes = scene%fields(f)%at_corners
    end associate
  end function on_corners_alone

  !> No heat flows but by temperature and through sides whose surroundings are known, and temperatures stand on 8 nodes: they may
  !> leave their bounds after a shock. What bodies release themselves, latent heat and work, is small beside that.
  pure function has_rough_bounds(scene) result(bounded)
    type(scene_t), intent(in) :: scene
    logical :: bounded
    integer :: g

    bounded = .not. (on_corners_alone(scene) .or. any(scene%forces%field == find_field(scene%fields, 'temperature')))
    do g = 1, size(scene%groups)
      select case (scene%groups(g)%role)
      case (role_side_load, role_volume_load)
        bounded = bounded .and. .not. (scene%groups(g)%brings_heat .and. scene%groups(g)%exchange%kind == by_flux)
      case (role_heat_contact, role_die_heat)
        bounded = .false.
      end select
    end do
  end function has_rough_bounds

  !> How far a free temperature at the end of a step of length dt is beyond the bounds; 0 where none is. Of temperatures on 8 nodes
  !> the bounds are those of the operation so far.
  pure subroutine find_excess(scene, equations, solution, dt, du, step)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    type(heat_step_t), intent(inout) :: step
    real(wp) :: low, high, now, surroundings, excess
    integer :: f, g, k, d, at
    logical :: goes_on

    f = find_field(scene%fields, 'temperature')
    low = huge(low)
    high = -huge(high)
    ! what a mesh of 8 nodes has left its bounds by before is no bound
    goes_on = .not. on_corners_alone(scene) .and. solution%last_step > 0 .and. solution%heat%hottest > solution%heat%coldest
    if (goes_on) then
      low = solution%heat%coldest
      high = solution%heat%hottest
    end if
    associate (number => equations%dofs%fields(f)%number(1, :), value => solution%fields(f)%value(1, :))
      do k = 1, size(number)
        d = number(k)
        if (d == 0) cycle
        if (.not. goes_on) call widen(value(k), low, high)
        if (.not. equations%dofs%is_free(d)) call widen(value(k) + du(d), low, high)
      end do
      do g = 1, size(scene%groups)
        if (all(scene%groups(g)%role /= [role_side_load, role_volume_load]) .or. .not. scene%groups(g)%brings_heat) cycle
        associate (exchange => scene%groups(g)%exchange)
          if (exchange%kind == by_flux) cycle
          do at = 0, 1
            surroundings = exchange%surroundings
            if (exchange%surroundings_multiplier > 0) surroundings = surroundings &
              *multiplier_at(scene%multipliers(exchange%surroundings_multiplier), solution%time + at*dt)
            call widen(surroundings, low, high)
          end do
        end associate
      end do
      excess = 0
      do k = 1, size(number)
        d = number(k)
        if (d == 0) cycle
        if (.not. equations%dofs%is_free(d)) cycle
        now = value(k) + du(d)
        excess = max(excess, low - now, now - high)
      end do
    end associate
    if (excess <= max(slack*(high - low), round_off*max(abs(low), abs(high)))) excess = 0
    step%excess = excess
    if (on_corners_alone(scene)) return
    step%low = low
    step%high = high

  contains

    pure subroutine widen(temperature, low, high)
      real(wp), intent(in) :: temperature
      real(wp), intent(inout) :: low, high

      low = min(low, temperature)
      high = max(high, temperature)
    end subroutine widen

  end subroutine find_excess

end module heat_bounds
