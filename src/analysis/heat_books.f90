!> Books of heat: what is taken up is what came in through sides and imposed temperatures, and what sources released.
module heat_books
  use equations, only: equations_t
  use fields, only: find_field, has_corners_only
  use kinds, only: wp
  use scene, only: role_heat_contact, role_side_load, role_volume_load, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: book_heat, has_heat, heat_from_die, heat_imbalance, heat_through

contains

  !> The scene has temperatures among its unknowns.
  pure function has_heat(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: f

    f = find_field(scene%fields, 'temperature')
    yes = f > 0
    if (yes) yes = scene%fields(f)%declared .and. .not. scene%fields(f)%given
  end function has_heat

  !> Add the heat of a step that was just found; reactions are booked already.
  subroutine book_heat(scene, equations, dt, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: dt                      !! [time]
    type(solution_t), intent(inout) :: solution
    real(wp) :: through, imposed, gross
    integer :: g

    if (.not. has_heat(scene)) return
    imposed = 0
    gross = 0
    do g = 1, size(scene%fields)
      if (scene%fields(g)%quantity /= 'temperature') cycle
      imposed = imposed + sum(solution%fields(g)%reaction)*dt
      gross = gross + sum(abs(solution%fields(g)%reaction))*dt
    end do
    through = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role == role_heat_contact) gross = gross + abs(heat_from_die(scene, equations, g))*dt
      through = through + heat_through(scene, equations, g)*dt
      gross = gross + abs(heat_through(scene, equations, g))*dt
    end do
    solution%heat_stored = solution%heat_stored + equations%heat_stored
    solution%heat_released = solution%heat_released + equations%heat_released
    solution%heat_in = solution%heat_in + imposed + through
    solution%heat_passed = solution%heat_passed + gross + abs(equations%heat_released)
  end subroutine book_heat

  !> Heat that comes in through the sides of a group, or from a source in its volume; 0 for other groups.
  pure function heat_through(scene, equations, g) result(power)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g   !! place of the group
    real(wp) :: power          !! in the step just found [power, per radian when axisymmetric]
    integer :: f, u, e, m, first, last

    power = 0
    if (all(scene%groups(g)%role /= [role_side_load, role_volume_load])) return
    f = find_field(scene%fields, 'temperature')
    associate (layout => equations%dofs%groups(g)%layout, dof => equations%dofs%groups(g)%dof)
      do u = 1, layout%nfield
        if (layout%field(u) /= f .or. .not. layout%acts(u)) cycle
        first = layout%first(1, u)
        last = first + layout%count(u) - 1
        do e = 1, size(dof, 2)
          m = equations%solves(1)%pattern%force_start(g) + (e - 1)*size(dof, 1)
          power = power - sum(equations%buffers%force(m + first:m + last))
        end do
      end do
    end associate
  end function heat_through

  !> Heat that comes into the sides of a contact, from the die and by friction.
  pure function heat_from_die(scene, equations, g) result(power)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g   !! place of the group
    real(wp) :: power          !! in the step just found [power, per radian when axisymmetric]
    integer :: e, m, n

    power = 0
    n = merge(2, 3, has_corners_only(scene%fields(find_field(scene%fields, 'temperature'))))
    associate (dof => equations%dofs%groups(g)%dof)
      do e = 1, size(dof, 2)
        m = equations%solves(1)%pattern%force_start(g) + (e - 1)*size(dof, 1)
        power = power - sum(equations%buffers%force(m + 1:m + n))
      end do
    end associate
  end function heat_from_die

  !> What the books do not account for, over all that passed.
  pure function heat_imbalance(solution) result(share)
    type(solution_t), intent(in) :: solution
    real(wp) :: share

    share = 0
    if (solution%heat_passed > 0) &
      share = (solution%heat_stored - solution%heat_in - solution%heat_released)/solution%heat_passed
  end function heat_imbalance

end module heat_books
