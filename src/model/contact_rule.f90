!> The points of a contact whose card does not say how many: from the lengths of sides, so anew for every mesh.
module contact_rule
  use kinds, only: wp
  use quadrature, only: rule_of_number, rule_t
  use scene, only: group_t, scene_t
  use vectors, only: length_of
  implicit none
  private
  public :: chosen_rule, choose_rules

contains

  !> Rules of all contacts that leave them to the lengths of sides, on a new mesh; heat between sides has that of its contact.
  pure subroutine choose_rules(scene)
    type(scene_t), intent(inout) :: scene
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. .not. scene%groups(g)%rule_is_chosen) cycle
      scene%groups(g)%rule = chosen_rule(scene, scene%groups(g))
    end do
    do g = 1, size(scene%groups)
      associate (host => scene%groups(g)%host)
        if (host > 0 .and. scene%groups(g)%die > 0) scene%groups(g)%rule = scene%groups(host)%rule
      end associate
    end do
  end subroutine choose_rules

  !> The points of a contact whose card does not say how many. Against a rigid die the nodes (-3). Against a body so many that its
  !> sides, where they are the shorter ones, have a dozen points each: the forces of these are shared among its nodes by functions
  !> with kinks at the ends of its sides.
  pure function chosen_rule(scene, group) result(rule)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(rule_t) :: rule
    real(wp) :: longest, shortest
    integer :: k
    integer, parameter :: numbers(3) = [-33, -65, -129], points_per_side = 12

    rule = rule_of_number(-3)
    if (group%pairs == 0) return
    longest = 0
    shortest = huge(shortest)
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
  end function chosen_rule

  !> Distance between the ends of a side [length].
  pure function chord(scene, nodes) result(length)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: nodes(3)
    real(wp) :: length

    length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
  end function chord

end module contact_rule
