!> The points of a contact whose card does not say how many: by the shape of a rigid die; against a body by the lengths of sides, so
!> anew for every mesh.
module contact_rule
  use dies, only: die_t, is_straight
  use kinds, only: wp
  use quadrature, only: rule_control, rule_of_number, rule_t
  use scene, only: axisymmetric, group_t, scene_t
  use vectors, only: length_of
  implicit none
  private
  public :: choose_rules, rule_on_body, rule_on_die

  !> A radius below this share of a die's length is the axis [-].
  real(wp), parameter :: no_radius = 1.0e-9_wp

contains

  !> Rules of all contacts that leave them to the lengths of sides, on a new mesh; heat between sides has that of its contact.
  pure subroutine choose_rules(scene)
    type(scene_t), intent(inout) :: scene
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. .not. scene%groups(g)%rule_is_chosen) cycle
      scene%groups(g)%rule = rule_on_body(scene, scene%groups(g))
    end do
    do g = 1, size(scene%groups)
      associate (host => scene%groups(g)%host)
        if (host > 0 .and. scene%groups(g)%die > 0) scene%groups(g)%rule = scene%groups(host)%rule
      end associate
    end do
  end subroutine choose_rules

  !> The points of a contact with a rigid die whose card does not say how many: ends and control point where the die is straight
  !> and contact opens, so that sides fold onto it without going into it; else the nodes (-3), as on a die along the axis, where
  !> what is in contact has no area.
  pure function rule_on_die(scene, die, lasts) result(rule)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    logical, intent(in) :: lasts   !! contact of the law (law_t)
    type(rule_t) :: rule

    rule = rule_of_number(-3)
    if (lasts .or. .not. is_straight(scene%dies(die))) return
    if (scene%plane_state == axisymmetric .and. lies_on_axis(scene%dies(die))) return
    rule = rule_t(rule_control, 3)
  end function rule_on_die

  !> The points of a contact with a body whose card does not say how many: so many that its sides, where they are the shorter
  !> ones, have a dozen points each: the forces of these are shared among its nodes by functions with kinks at the ends of its
  !> sides.
  pure function rule_on_body(scene, group) result(rule)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(rule_t) :: rule
    real(wp) :: longest, shortest
    integer :: k
    integer, parameter :: numbers(3) = [-33, -65, -129], points_per_side = 12

    longest = 0
    shortest = huge(shortest)
    ! a die whose card is wrong has no sides
    if (size(scene%dies(group%die)%nodes, 2) == 0) shortest = 0
    do k = 1, size(group%connectivity, 2)
      longest = max(longest, chord(scene, group%connectivity(:, k)))
    end do
    do k = 1, size(scene%dies(group%die)%nodes, 2)
      shortest = min(shortest, chord(scene, scene%dies(group%die)%nodes(:, k)))
    end do
    do k = 1, size(numbers)
      rule = rule_of_number(numbers(k))
      if (.not. points_per_side*longest > (rule%n - 1)*shortest) exit
    end do
  end function rule_on_body

  !> A straight die along the line r = 0.
  pure function lies_on_axis(die) result(yes)
    type(die_t), intent(in) :: die
    logical :: yes

    yes = maxval(abs(die%pilot(1) + die%pieces(1, :, :))) <= no_radius*(maxval(die%pieces(2, :, :)) - minval(die%pieces(2, :, :)))
  end function lies_on_axis

  !> Distance between the ends of a side [length].
  pure function chord(scene, nodes) result(length)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: nodes(3)
    real(wp) :: length

    length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function chord

end module contact_rule
