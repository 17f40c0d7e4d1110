!> JSON text, built piece by piece, written in one step (RFC 8259).
!>
!>     call json%begin_object()
!>     call json%add('steps', 37)
!>     call json%begin_array('effects')
!>     call json%item('contact')
!>     call json%end_array()
!>     call json%end_object()
!>     call json%write_file('out/summary.json', error)
!>
!> Reals are the shortest text that reads back as the same number; NaN and infinity become `null`.
module json_writer
  use atomic, only: write_text
  use errors, only: error_t, exit_bug, fail
  use json_literals, only: json_literal
  use kinds, only: i8, wp
  use text, only: string_t, to_text
  implicit none
  private
  public :: json_t

  !> A JSON text while it is built. A misplaced call (a name in an array, an end
  !> without its beginning) is recorded, and delivered by `write_file` or `status`.
  type :: json_t
    private
    character(len=:), allocatable :: buffer
    integer :: length = 0                         !! of the text in `buffer`
    character(len=:), allocatable :: open_kinds   !! '{' or '[' for each level open
    logical :: empty = .true.                     !! nothing yet in the innermost level
    type(error_t), allocatable :: first_error
  contains
    procedure :: begin_object
    procedure :: end_object
    procedure :: begin_array
    procedure :: end_array
    procedure :: text => text_of
    procedure :: status
    procedure :: write_file
    !> `add(name, value)` in an object: text, integer, real, logical, or an array of them (not logical).
    generic :: add => add_text, add_integer, add_long, add_real, add_logical, add_integers, add_reals, add_words
    procedure, private :: add_text
    procedure, private :: add_integer
    procedure, private :: add_long
    procedure, private :: add_real
    procedure, private :: add_logical
    procedure, private :: add_integers
    procedure, private :: add_reals
    procedure, private :: add_words
    !> `item(value)` in an array.
    generic :: item => item_text, item_integer, item_real, item_logical, item_reals, item_integers
    procedure, private :: item_text
    procedure, private :: item_integer
    procedure, private :: item_real
    procedure, private :: item_logical
    procedure, private :: item_reals
    procedure, private :: item_integers
    procedure, private :: put
    procedure, private :: begin_level
    procedure, private :: end_level
    procedure, private :: append
    procedure, private :: misuse
  end type json_t

contains

  !> Open an object: at the root and in an array without, in an object with a name.
  subroutine begin_object(self, name)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in), optional :: name

    call self%begin_level('{', name)
  end subroutine begin_object

  !> Close the innermost level, an object.
  subroutine end_object(self)
    class(json_t), intent(inout) :: self

    call self%end_level('{', '}')
  end subroutine end_object

  !> Open an array: at the root and in an array without, in an object with a name.
  subroutine begin_array(self, name)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in), optional :: name

    call self%begin_level('[', name)
  end subroutine begin_array

  !> Close the innermost level, an array.
  subroutine end_array(self)
    class(json_t), intent(inout) :: self

    call self%end_level('[', ']')
  end subroutine end_array

  !> The text so far.
  pure function text_of(self) result(text)
    class(json_t), intent(in) :: self
    character(len=:), allocatable :: text

    text = ''
    if (allocated(self%buffer)) text = self%buffer(:self%length)
  end function text_of

  !> The first misuse; unallocated when there was none and all levels are closed.
  pure subroutine status(self, error)
    class(json_t), intent(in) :: self
    type(error_t), allocatable, intent(out) :: error

    if (allocated(self%first_error)) then
      allocate (error, source=self%first_error)
    else if (self%length == 0) then
      call fail(error, exit_bug, 'JSON: nothing was written')
    else if (self%open_kinds /= '') then
      call fail(error, exit_bug, 'JSON: '//to_text(len(self%open_kinds))//' levels are not closed')
    end if
  end subroutine status

  !> Write the whole text into the file `path`, in one step.
  subroutine write_file(self, path, error)
    class(json_t), intent(in) :: self
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error

    call self%status(error)
    if (.not. allocated(error)) call write_text(path, self%text()//new_line('a'), error)
  end subroutine write_file

  subroutine add_text(self, name, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name, value

    call self%put(json_literal(value), name)
  end subroutine add_text

  subroutine add_integer(self, name, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: value

    call self%put(json_literal(value), name)
  end subroutine add_integer

  subroutine add_long(self, name, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer(i8), intent(in) :: value

    call self%put(json_literal(value), name)
  end subroutine add_long

  subroutine add_real(self, name, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value

    call self%put(json_literal(value), name)
  end subroutine add_real

  subroutine add_logical(self, name, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    logical, intent(in) :: value

    call self%put(json_literal(value), name)
  end subroutine add_logical

  subroutine add_integers(self, name, values)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: values(:)   !! (n)

    call self%put(json_literal(values), name)
  end subroutine add_integers

  subroutine add_reals(self, name, values)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)   !! (n) [of any unit]

    call self%put(json_literal(values), name)
  end subroutine add_reals

  subroutine add_words(self, name, values)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(string_t), intent(in) :: values(:)   !! (n)

    call self%put(json_literal(values), name)
  end subroutine add_words

  subroutine item_text(self, value)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: value

    call self%put(json_literal(value))
  end subroutine item_text

  subroutine item_integer(self, value)
    class(json_t), intent(inout) :: self
    integer, intent(in) :: value

    call self%put(json_literal(value))
  end subroutine item_integer

  subroutine item_real(self, value)
    class(json_t), intent(inout) :: self
    real(wp), intent(in) :: value

    call self%put(json_literal(value))
  end subroutine item_real

  subroutine item_logical(self, value)
    class(json_t), intent(inout) :: self
    logical, intent(in) :: value

    call self%put(json_literal(value))
  end subroutine item_logical

  subroutine item_reals(self, values)
    class(json_t), intent(inout) :: self
    real(wp), intent(in) :: values(:)   !! (n) [of any unit]

    call self%put(json_literal(values))
  end subroutine item_reals

  subroutine item_integers(self, values)
    class(json_t), intent(inout) :: self
    integer, intent(in) :: values(:)   !! (n)

    call self%put(json_literal(values))
  end subroutine item_integers

  !> Put one value with the comma, the line, the margin and the name before it.
  subroutine put(self, literal, name)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: literal
    character(len=*), intent(in), optional :: name
    character(len=1) :: kind

    if (.not. allocated(self%open_kinds)) self%open_kinds = ''
    kind = ' '
    if (self%open_kinds /= '') kind = self%open_kinds(len(self%open_kinds):)
    if (kind == ' ' .and. self%length > 0) call self%misuse('a second value at the root')
    if (kind == '{' .neqv. present(name)) call self%misuse('a value in an object needs a name, elsewhere it has none')
    if (kind /= ' ') then
      if (.not. self%empty) call self%append(',')
      call self%append(new_line('a')//repeat('  ', len(self%open_kinds)))
    end if
    if (present(name)) call self%append(json_literal(name)//': ')
    call self%append(literal)
    self%empty = .false.
  end subroutine put

  !> Open a level of this kind, '{' or '['.
  subroutine begin_level(self, kind, name)
    class(json_t), intent(inout) :: self
    character(len=1), intent(in) :: kind
    character(len=*), intent(in), optional :: name

    call self%put(kind, name)
    self%open_kinds = self%open_kinds//kind
    self%empty = .true.
  end subroutine begin_level

  !> Close the innermost level, which must be of this kind.
  subroutine end_level(self, kind, closing)
    class(json_t), intent(inout) :: self
    character(len=1), intent(in) :: kind, closing
    integer :: level

    level = 0
    if (allocated(self%open_kinds)) level = len(self%open_kinds)
    if (level > 0) then
      if (self%open_kinds(level:) /= kind) level = 0
    end if
    if (level == 0) then
      call self%misuse("an end '"//closing//"' without its beginning")
      return
    end if
    self%open_kinds = self%open_kinds(:level - 1)
    if (.not. self%empty) call self%append(new_line('a')//repeat('  ', level - 1))
    call self%append(closing)
    self%empty = .false.
  end subroutine end_level

  !> Add to the text; the buffer doubles, so that long texts cost time in proportion.
  subroutine append(self, piece)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: piece
    character(len=:), allocatable :: larger

    if (.not. allocated(self%buffer)) allocate (character(len=4096) :: self%buffer)
    if (self%length + len(piece) > len(self%buffer)) then
      allocate (character(len=2*len(self%buffer) + len(piece)) :: larger)
      larger(:self%length) = self%buffer(:self%length)
      call move_alloc(larger, self%buffer)
    end if
    self%buffer(self%length + 1:self%length + len(piece)) = piece
    self%length = self%length + len(piece)
  end subroutine append

  !> Keep the first misuse.
  subroutine misuse(self, what)
    class(json_t), intent(inout) :: self
    character(len=*), intent(in) :: what

    if (.not. allocated(self%first_error)) call fail(self%first_error, exit_bug, 'JSON: '//what)
  end subroutine misuse

end module json_writer
