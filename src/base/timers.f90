!> Time by tasks: a table of named entries, each with its calls and its seconds on the wall.
!> Entries may overlap and nest, an entry in itself included (then the outermost counts the time).
!> Not for use inside parallel regions.
module timers
  use kinds, only: i8, wp
  implicit none
  private
  public :: ledger_t

  !> One line of the ledger.
  type :: entry_t
    character(len=:), allocatable :: name
    integer(i8) :: calls = 0
    integer(i8) :: ticks = 0    !! of finished calls
    integer(i8) :: started = 0  !! clock at the outermost start
    integer :: depth = 0        !! starts not yet stopped
  end type entry_t

  !> The ledger. `add` gives the number by which `start` and `stop` know an entry.
  type :: ledger_t
    private
    type(entry_t), allocatable :: entries(:)
  contains
    procedure :: add
    procedure :: start
    procedure :: stop => stop_entry
    procedure :: size => number_of_entries
    procedure :: name
    procedure :: calls
    procedure :: seconds
  end type ledger_t

contains

  !> The number `id` of the entry `name`, made when there is none of this name yet.
  subroutine add(self, name, id)
    class(ledger_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(out) :: id
    type(entry_t) :: new

    if (.not. allocated(self%entries)) allocate (self%entries(0))
    do id = 1, size(self%entries)
      if (self%entries(id)%name == name) return
    end do
    new%name = name
    self%entries = [self%entries, new]
  end subroutine add

  !> The entry's clock starts.
  subroutine start(self, id)
    class(ledger_t), intent(inout) :: self
    integer, intent(in) :: id

    associate (entry => self%entries(id))
      if (entry%depth == 0) call system_clock(entry%started)
      entry%depth = entry%depth + 1
    end associate
  end subroutine start

  !> The entry's clock stops, one more call is counted; a stop without a start does nothing.
  subroutine stop_entry(self, id)
    class(ledger_t), intent(inout) :: self
    integer, intent(in) :: id
    integer(i8) :: now

    associate (entry => self%entries(id))
      if (entry%depth == 0) return
      entry%depth = entry%depth - 1
      entry%calls = entry%calls + 1
      if (entry%depth > 0) return
      call system_clock(now)
      entry%ticks = entry%ticks + (now - entry%started)
    end associate
  end subroutine stop_entry

  !> How many entries there are; they are numbered from 1 in the order of their making.
  pure function number_of_entries(self) result(n)
    class(ledger_t), intent(in) :: self
    integer :: n

    n = 0
    if (allocated(self%entries)) n = size(self%entries)
  end function number_of_entries

  !> The name of an entry.
  pure function name(self, id)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: id
    character(len=:), allocatable :: name

    name = self%entries(id)%name
  end function name

  !> Finished calls of an entry.
  pure function calls(self, id)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: id
    integer(i8) :: calls

    calls = self%entries(id)%calls
  end function calls

  !> Seconds on the wall of the finished calls of an entry.
  function seconds(self, id)
    class(ledger_t), intent(in) :: self
    integer, intent(in) :: id
    real(wp) :: seconds
    integer(i8) :: rate

    call system_clock(count_rate=rate)
    seconds = real(self%entries(id)%ticks, wp)/real(rate, wp)
  end function seconds

end module timers
