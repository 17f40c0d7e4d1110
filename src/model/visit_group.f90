!> The members of a group of elements and of the declared state of its points (visitors).
module visit_group
  use quadrature, only: rule_control, rule_gauss, rule_t
  use scene, only: group_t, role_body, role_load_factor
  use state_variables, only: state_variable_t
  use visitors, only: kept, of_the_mesh, visitor_t
  implicit none
  private
  public :: visit_group_members

  !> Points of an element, and variables of a point, at most.
  integer, parameter :: most_points = 129, most_variables = 10000
  character(len=*), parameter :: of_the_deck = 'the solver reads it from the deck'

contains

  subroutine visit_group_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(group_t), intent(inout) :: self
    integer :: k, n

    call visitor%member('name', self%name, kept)
    call visitor%member('role', self%role, kept, low=role_body, high=role_load_factor)
    call visitor%member('host', self%host, kept, low=0)
    call visitor%member('elem', self%elem, kept)
    call visitor%member('material', self%material, kept, low=0)
    call visit_rule(visitor, self%rule)
    call visitor%member('rule_is_chosen', self%rule_is_chosen, kept)
    call visitor%member('connectivity', self%connectivity, of_the_mesh, 'node, element', low=1)
    call visitor%member('die', self%die, kept, low=0)
    call visitor%derived('pairs', 'counted: groups that face deformable dies, in their order')
    call visitor%derived('elem_id', of_the_deck)
    call visitor%derived('brings_heat', of_the_deck)
    call visitor%derived('is_spring', of_the_deck)
    call visitor%derived('option', of_the_deck)
    call visitor%derived('modulus', 'the solver finds it from the bodies behind the sides')
    call visitor%derived('most_share', 'the solver finds it from the bodies behind the sides')
    call visitor%derived('tangential_share', 'the solver finds it from the law')
    call visitor%derived('component', of_the_deck)
    call visitor%derived('stiffness', of_the_deck)
    call visitor%derived('multiplier', of_the_deck)
    call visitor%derived('amplitude', of_the_deck)
    call visitor%derived('exchange', of_the_deck)
    call visitor%derived('heat_contact', of_the_deck)
    call visitor%derived('source', of_the_deck)
    call visitor%derived('direction', of_the_deck)
    call visitor%derived('temperature_multiplier', of_the_deck)
    call visitor%derived('temperature_amplitude', of_the_deck)
    call visitor%derived('temperature_history', of_the_deck)
    n = 0
    if (allocated(self%variables)) n = size(self%variables)
    call visitor%list('variables', n, most_variables)
    if (.not. allocated(self%variables)) allocate (self%variables(n))
    do k = 1, n
      call visitor%enter_item('variables', k)
      call visit_state_variable(visitor, self%variables(k))
      call visitor%leave('variables')
    end do
  end subroutine visit_group_members

  subroutine visit_rule(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(rule_t), intent(inout) :: self

    call visitor%member('rule', self%family, kept, low=rule_gauss, high=rule_control)
    call visitor%member('npoint', self%n, kept, low=0, high=most_points)
  end subroutine visit_rule

  subroutine visit_state_variable(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(state_variable_t), intent(inout) :: self

    call visitor%member('name', self%name, kept)
    call visitor%member('unit', self%unit, kept)
    call visitor%member('transfer', self%transfer, kept)
    call visitor%member('components', self%ncomp, kept, low=1, high=4)
    call visitor%member('initial', self%initial, kept)
    call visitor%derived('first', 'counted: variables stand one after the other')
    call visitor%derived('needs', 'the law declares only what its material asks for')
    call visitor%derived('or_needs', 'the law declares only what its material asks for')
  end subroutine visit_state_variable

end module visit_group
