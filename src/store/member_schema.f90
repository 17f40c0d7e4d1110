!> The visitor that describes members: a line each with path, type, extents, unit, how a remesh carries it, and its range.
!>
!> Lists are described by one entry, `<k>`; a part that is there only sometimes is described too.
module member_schema
  use kinds, only: wp
  use text, only: padded, string_t, to_text
  use visitors, only: visitor_t
  implicit none
  private
  public :: member_schema_t

  !> Widths of the columns.
  integer, parameter :: path_width = 40, type_width = 9, extents_width = 27, unit_width = 17, carried_width = 13

  type, extends(visitor_t) :: member_schema_t
    type(string_t), allocatable :: lines(:)
  contains
    procedure :: visit_real
    procedure :: visit_reals
    procedure :: visit_reals_2
    procedure :: visit_reals_3
    procedure :: visit_integer
    procedure :: visit_integers
    procedure :: visit_integers_2
    procedure :: visit_text
    procedure :: long_text
    procedure :: derived
    procedure :: listed
    procedure :: label
    procedure, private :: add
  end type member_schema_t

contains

  subroutine visit_real(self, name, value, carried, unit, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%add(name, 'real', '', carried, range_of_reals(low, high), unit)
  end subroutine visit_real

  subroutine visit_reals(self, name, values, carried, extents, unit, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)   !! (extents) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%add(name, 'real', extents, carried, range_of_reals(low, high), unit)
  end subroutine visit_reals

  subroutine visit_reals_2(self, name, values, carried, extents, unit, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%add(name, 'real', extents, carried, range_of_reals(low, high), unit)
  end subroutine visit_reals_2

  subroutine visit_reals_3(self, name, values, carried, extents, unit, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (n1, n2, n3) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%add(name, 'real', extents, carried, range_of_reals(low, high), unit)
  end subroutine visit_reals_3

  subroutine visit_integer(self, name, value, carried, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high

    ! a flag is set, so that the members it announces are described
    if (present(high)) value = high
    call self%add(name, 'integer', '', carried, range_of_integers(low, high))
  end subroutine visit_integer

  subroutine visit_integers(self, name, values, carried, extents, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)   !! (extents)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    call self%add(name, 'integer', extents, carried, range_of_integers(low, high))
  end subroutine visit_integers

  subroutine visit_integers_2(self, name, values, carried, extents, low, high)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    call self%add(name, 'integer', extents, carried, range_of_integers(low, high))
  end subroutine visit_integers_2

  subroutine visit_text(self, name, value, carried)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%add(name, 'text', '', carried, '')
  end subroutine visit_text

  subroutine long_text(self, name, value, carried)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%add(name, 'long text', '', carried, '')
  end subroutine long_text

  subroutine derived(self, name, reason)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name, reason

    self%lines = [self%lines, string_t(padded('# '//self%path(name), path_width)//'not kept: '//reason)]
  end subroutine derived

  !> One entry stands for all.
  subroutine listed(self, name, n)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: n

    n = 1
  end subroutine listed

  pure function label(self, k)
    class(member_schema_t), intent(in) :: self
    integer, intent(in) :: k
    character(len=:), allocatable :: label

    label = '<k>'
  end function label

  !> A line. Numbers and texts are attributes of the part they belong to, arrays and long texts are datasets.
  subroutine add(self, name, type, extents, carried, range, unit)
    class(member_schema_t), intent(inout) :: self
    character(len=*), intent(in) :: name, type, extents, carried, range
    character(len=*), intent(in), optional :: unit
    character(len=:), allocatable :: line

    line = padded(self%path(name), path_width)//padded(type, type_width)
    if (len(extents) > 0) line = line//' ('//extents//')'
    line = padded(line, path_width + type_width + extents_width)
    if (present(unit)) line = line//' ['//unit//']'
    line = padded(line, path_width + type_width + extents_width + unit_width)//' '//padded(carried, carried_width)//range
    self%lines = [self%lines, string_t(trim(line))]
  end subroutine add

  pure function range_of_reals(low, high) result(range)
    real(wp), intent(in), optional :: low, high
    character(len=:), allocatable :: range

    range = ''
    if (.not. present(low)) return
    range = to_text(low)//' or more'
    if (low > 0 .and. .not. low > tiny(low)) range = 'above 0'
    if (present(high)) range = range(:index(range//' or', ' or') - 1)//' to '//to_text(high)
  end function range_of_reals

  pure function range_of_integers(low, high) result(range)
    integer, intent(in), optional :: low, high
    character(len=:), allocatable :: range

    range = ''
    if (.not. present(low)) return
    range = to_text(low)//' or more'
    if (present(high)) range = to_text(low)//' to '//to_text(high)
  end function range_of_integers

end module member_schema
