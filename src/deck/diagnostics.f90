!> Collector of the mistakes of a deck, so that all are reported together.
module diagnostics
  use errors, only: error_t, exit_input, fail
  use text, only: string_t, to_text
  implicit none
  private
  public :: location_t, diagnostics_t

  !> Largest number of lines; the rest is only counted.
  integer, parameter :: most_printed = 50

  !> A place in a deck. `file` is the number given by `register`; line 0 stands for the file as a whole.
  type :: location_t
    integer :: file = 0
    integer :: line = 0
    integer :: column = 0
  end type location_t

  type :: mistake_t
    type(location_t) :: where
    character(len=:), allocatable :: message
  end type mistake_t

  !> The mistakes found so far, and the names of the files they are in.
  type :: diagnostics_t
    private
    type(string_t), allocatable :: files(:)
    type(mistake_t), allocatable :: mistakes(:)
    integer :: nfile = 0
    integer :: nmistake = 0
  contains
    procedure :: register
    procedure :: add
    procedure :: count => number_of_mistakes
    procedure :: error => to_error
    procedure :: place
  end type diagnostics_t

contains

  !> Number of the file called `name`: a new one, or that of an earlier call.
  pure subroutine register(self, name, file)
    class(diagnostics_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(out) :: file
    type(string_t), allocatable :: longer(:)
    integer :: i

    do file = 1, self%nfile
      if (self%files(file)%s == name .and. len(self%files(file)%s) == len(name)) return
    end do
    if (.not. allocated(self%files)) allocate (self%files(8))
    if (self%nfile == size(self%files)) then
      allocate (longer(2*self%nfile))
      do i = 1, self%nfile
        call move_alloc(self%files(i)%s, longer(i)%s)
      end do
      call move_alloc(longer, self%files)
    end if
    self%nfile = self%nfile + 1
    self%files(self%nfile)%s = name
    file = self%nfile
  end subroutine register

  !> Record one mistake. `keyword` is the card it is on, or blank.
  pure subroutine add(self, where, keyword, message)
    class(diagnostics_t), intent(inout) :: self
    type(location_t), intent(in) :: where
    character(len=*), intent(in) :: keyword, message
    type(mistake_t), allocatable :: longer(:)
    integer :: i

    if (.not. allocated(self%mistakes)) allocate (self%mistakes(16))
    if (self%nmistake == size(self%mistakes)) then
      allocate (longer(2*self%nmistake))
      do i = 1, self%nmistake
        longer(i)%where = self%mistakes(i)%where
        call move_alloc(self%mistakes(i)%message, longer(i)%message)
      end do
      call move_alloc(longer, self%mistakes)
    end if
    self%nmistake = self%nmistake + 1
    self%mistakes(self%nmistake)%where = where
    if (keyword == '') then
      self%mistakes(self%nmistake)%message = message
    else
      self%mistakes(self%nmistake)%message = trim(keyword)//': '//message
    end if
  end subroutine add

  pure function number_of_mistakes(self) result(count)
    class(diagnostics_t), intent(in) :: self
    integer :: count

    count = self%nmistake
  end function number_of_mistakes

  !> All mistakes as one error, in the order of the files and lines; unallocated when there is none.
  !> The same mistake of a file included twice is reported once.
  pure subroutine to_error(self, error)
    class(diagnostics_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: all
    integer :: last, next, i, printed

    if (self%nmistake == 0) return
    last = 0
    all = ''
    do printed = 1, most_printed
      next = 0
      do i = 1, self%nmistake
        if (last > 0) then
          if (.not. precedes(self%mistakes(last), self%mistakes(i))) cycle
        end if
        if (next > 0) then
          if (.not. precedes(self%mistakes(i), self%mistakes(next))) cycle
        end if
        next = i
      end do
      if (next == 0) exit
      last = next
      if (printed > 1) all = all//new_line('a')
      all = all//self%place(self%mistakes(last)%where)//': '//self%mistakes(last)%message
    end do
    i = 0
    do next = 1, self%nmistake
      if (precedes(self%mistakes(last), self%mistakes(next))) i = i + 1
    end do
    if (i > 0) all = all//new_line('a')//'and '//to_text(i)//' more'
    call fail(error, exit_input, all)
  end subroutine to_error

  !> Strict order of appearance.
  pure function precedes(a, b) result(before)
    type(mistake_t), intent(in) :: a, b
    logical :: before

    if (a%where%file /= b%where%file) then
      before = a%where%file < b%where%file
    else if (a%where%line /= b%where%line) then
      before = a%where%line < b%where%line
    else if (a%where%column /= b%where%column) then
      before = a%where%column < b%where%column
    else
      before = a%message < b%message
    end if
  end function precedes

  !> `file:line:column`, as compilers write it, so that editors can follow it.
  pure function place(self, where) result(s)
    class(diagnostics_t), intent(in) :: self
    type(location_t), intent(in) :: where
    character(len=:), allocatable :: s

    s = 'deck'
    if (where%file >= 1 .and. where%file <= self%nfile) s = self%files(where%file)%s
    if (where%line > 0) s = s//':'//to_text(where%line)//':'//to_text(max(where%column, 1))
  end function place

end module diagnostics
