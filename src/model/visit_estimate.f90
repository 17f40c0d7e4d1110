!> The members of an estimate of errors and of the rules for a new mesh (visitors).
module visit_estimate
  use kinds, only: wp
  use remeshing, only: estimate_t, remesh_rules_t, trigger_t
  use visitors, only: kept, of_the_mesh, recomputed, visitor_t
  implicit none
  private
  public :: visit_estimate_members, visit_remesh_rules

  !> Reasons for a new mesh at most.
  integer, parameter :: most_triggers = 1000
  character(len=*), parameter :: of_the_deck = 'the solver reads it from the deck'

contains

  subroutine visit_estimate_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(estimate_t), intent(inout) :: self
    integer :: k, n

    call visitor%member('stress', self%stress, of_the_mesh, '-')
    call visitor%member('strain', self%strain, of_the_mesh, '-')
    call visitor%member('stress_of', self%stress_of, of_the_mesh, 'element', '-')
    call visitor%member('strain_of', self%strain_of, of_the_mesh, 'element', '-')
    call visitor%member('strain_sums', self%strain_sums, of_the_mesh, '2, element', '-', low=0.0_wp)
    call visitor%member('began', self%began, recomputed, low=0)
    call visitor%member('last_stop', self%last_stop, recomputed, low=0)
    call visitor%member('first_stress', self%first_stress, recomputed, '-', low=0.0_wp)
    call visitor%member('first_narrow', self%first_narrow, recomputed, '-', low=0.0_wp)
    call visitor%member('previous_stress', self%previous_stress, recomputed, '-', low=0.0_wp)
    call visitor%member('previous_open', self%previous_open, recomputed, '-', low=0.0_wp)
    call visitor%member('carried_stress', self%carried_stress, recomputed, '-', low=0.0_wp)
    call visitor%member('stress_left', self%stress_left, recomputed, '-', low=0.0_wp, high=1.0_wp)
    n = size(self%triggers)
    call visitor%list('triggers', n, most_triggers)
    if (n /= size(self%triggers)) then
      deallocate (self%triggers)
      allocate (self%triggers(n))
    end if
    do k = 1, n
      call visitor%enter_item('triggers', k)
      call visit_trigger(visitor, self%triggers(k))
      call visitor%leave('triggers')
    end do
  end subroutine visit_estimate_members

  subroutine visit_trigger(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(trigger_t), intent(inout) :: self

    call visitor%member('name', self%name, of_the_mesh)
    call visitor%member('value', self%value, of_the_mesh)
    call visitor%member('limit', self%limit, of_the_mesh)
    call visitor%member('group', self%group, of_the_mesh, low=0)
    call visitor%member('element', self%element, of_the_mesh, low=0)
  end subroutine visit_trigger

  subroutine visit_remesh_rules(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(remesh_rules_t), intent(inout) :: self

    call visitor%member('estimate', self%estimate, kept)
    call visitor%derived('on', of_the_deck)
    call visitor%derived('shape', of_the_deck)
    call visitor%derived('bad_share', of_the_deck)
    call visitor%derived('stress_error', of_the_deck)
    call visitor%derived('error_strain', of_the_deck)
    call visitor%derived('contact', of_the_deck)
    call visitor%derived('narrow', of_the_deck)
    call visitor%derived('corner', of_the_deck)
    call visitor%derived('distress', of_the_deck)
    call visitor%derived('least_steps', of_the_deck)
    call visitor%derived('times', of_the_deck)
    call visitor%derived('strokes', of_the_deck)
  end subroutine visit_remesh_rules

end module visit_estimate
