!> The members of cuts and of what came of them (visitors).
module visit_cuts
  use cuts, only: cut_record_t, cut_t
  use kinds, only: wp
  use visitors, only: kept, visitor_t
  implicit none
  private
  public :: visit_cut_list, visit_cut_records

  !> Cuts of one operation at most.
  integer, parameter :: most_cuts = 100000

contains

  subroutine visit_cut_list(visitor, list)
    class(visitor_t), intent(inout) :: visitor
    type(cut_t), allocatable, intent(inout) :: list(:)   !! (ncut)
    integer :: k, n

    n = 0
    if (allocated(list)) n = size(list)
    call visitor%list('cuts', n, most_cuts)
    if (.not. allocated(list)) allocate (list(n))
    do k = 1, n
      call visitor%enter_item('cuts', k)
      call visit_cut(visitor, list(k))
      call visitor%leave('cuts')
    end do
  end subroutine visit_cut_list

  subroutine visit_cut(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(cut_t), intent(inout) :: self

    call visitor%member('group', self%group, kept, low=1)
    call visitor%fixed('line', self%line, kept, 'length')
    call visitor%member('die', self%die, kept, low=0)
    call visitor%member('thickness', self%thickness, kept, 'length', low=0.0_wp)
    call visitor%member('names_kept', self%names_kept, kept)
    call visitor%fixed('kept', self%kept, kept, 'length')
  end subroutine visit_cut

  !> As many as the scene has cuts.
  subroutine visit_cut_records(visitor, records)
    class(visitor_t), intent(inout) :: visitor
    type(cut_record_t), intent(inout) :: records(:)   !! (ncut)
    integer :: k, n

    n = size(records)
    call visitor%list('cuts', n)
    do k = 1, size(records)
      call visitor%enter_item('cuts', k)
      call visit_cut_record(visitor, records(k))
      call visitor%leave('cuts')
    end do
  end subroutine visit_cut_records

  subroutine visit_cut_record(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(cut_record_t), intent(inout) :: self

    call visitor%member('generation', self%generation, kept, low=0)
    call visitor%member('time', self%time, kept, 'time', low=0.0_wp)
    call visitor%member('volume', self%volume, kept, 'volume', low=0.0_wp)
    call visitor%member('thickness', self%thickness, kept, 'length', low=0.0_wp)
    call visitor%member('force', self%force, kept, 'force', low=0.0_wp)
  end subroutine visit_cut_record

end module visit_cuts
