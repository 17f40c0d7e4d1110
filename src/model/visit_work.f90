!> The members of the books of work, for writing, reading, describing or carrying them (visitors).
module visit_work
  use kinds, only: wp
  use visitors, only: kept, visitor_t
  use work_books, only: work_t
  implicit none
  private
  public :: visit_work_members

contains

  subroutine visit_work_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(work_t), intent(inout) :: self

    call visitor%member('supports', self%supports, kept, 'energy')
    call visitor%member('dies', self%dies, kept, 'energy')
    call visitor%member('loads', self%loads, kept, 'energy')
    call visitor%member('section', self%section, kept, 'energy')
    call visitor%member('heat', self%heat, kept, 'energy')
    call visitor%member('flow', self%flow, kept, 'energy')
    call visitor%member('contact', self%contact, kept, 'energy')
    call visitor%member('damping', self%damping, kept, 'energy', low=0.0_wp)
    call visitor%member('drag', self%drag, kept, 'energy', low=0.0_wp)
    call visitor%member('overlap', self%overlap, kept, 'energy')
    call visitor%member('elastic', self%elastic, kept, 'energy')
    call visitor%member('remeshing', self%remeshing, kept, 'energy')
    call visitor%member('passed', self%passed, kept, 'energy', low=0.0_wp)
    call visitor%member('round_off', self%round_off, kept, 'energy', low=0.0_wp)
    call visitor%derived('from_outside', 'every step makes it anew')
    call visitor%member('grown', self%grown, kept, 'volume')
  end subroutine visit_work_members

end module visit_work
