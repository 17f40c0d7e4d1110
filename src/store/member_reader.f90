!> The visitor that reads members from a HDF5 file, each of which must be there and within its range.
!>
!> The file records the first error, which names the member, and does nothing after it. Values are then those that were there
!> before, arrays that were not allocated are empty, lists too.
module member_reader
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use exchange_rules, only: require, require_range
  use text, only: to_text
  use visitors, only: extents_of, visitor_t
  implicit none
  private
  public :: member_reader_t

  type, extends(visitor_t) :: member_reader_t
    !> Open for reading.
    type(hdf5_file_t) :: file
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
    procedure :: listed
  end type member_reader_t

contains

  subroutine visit_real(self, name, value, carried, unit, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp) :: found

    call self%file%read_attribute(self%place, name, found)
    call require_range(self%file, self%path(name), [found], low, high)
    if (.not. self%file%failed()) value = found
  end subroutine visit_real

  subroutine visit_reals(self, name, values, carried, extents, unit, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)   !! (extents) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: found(:)

    if (allocated(values)) then
      call self%file%require_shape(self%path(name), shape(values))
    else
      call self%file%require_shape(self%path(name), extents_of(extents))
    end if
    call self%file%read(self%path(name), found)
    call require_range(self%file, self%path(name), found, low, high)
    if (.not. (self%file%failed() .and. allocated(values))) call move_alloc(found, values)
  end subroutine visit_reals

  subroutine visit_reals_2(self, name, values, carried, extents, unit, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: found(:, :)

    if (allocated(values)) then
      call self%file%require_shape(self%path(name), shape(values))
    else
      call self%file%require_shape(self%path(name), extents_of(extents))
    end if
    call self%file%read(self%path(name), found)
    call require_range(self%file, self%path(name), pack(found, .true.), low, high)
    if (.not. (self%file%failed() .and. allocated(values))) call move_alloc(found, values)
  end subroutine visit_reals_2

  subroutine visit_reals_3(self, name, values, carried, extents, unit, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (n1, n2, n3) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: found(:, :, :)

    if (allocated(values)) then
      call self%file%require_shape(self%path(name), shape(values))
    else
      call self%file%require_shape(self%path(name), extents_of(extents))
    end if
    call self%file%read(self%path(name), found)
    call require_range(self%file, self%path(name), pack(found, .true.), low, high)
    if (.not. (self%file%failed() .and. allocated(values))) call move_alloc(found, values)
  end subroutine visit_reals_3

  subroutine visit_integer(self, name, value, carried, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high
    integer :: found

    call self%file%read_attribute(self%place, name, found)
    call require_range(self%file, self%path(name), [found], low, high)
    if (.not. self%file%failed()) value = found
  end subroutine visit_integer

  subroutine visit_integers(self, name, values, carried, extents, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)   !! (extents)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high
    integer, allocatable :: found(:)

    if (allocated(values)) then
      call self%file%require_shape(self%path(name), shape(values))
    else
      call self%file%require_shape(self%path(name), extents_of(extents))
    end if
    call self%file%read(self%path(name), found)
    call require_range(self%file, self%path(name), found, low, high)
    if (.not. (self%file%failed() .and. allocated(values))) call move_alloc(found, values)
  end subroutine visit_integers

  subroutine visit_integers_2(self, name, values, carried, extents, low, high)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high
    integer, allocatable :: found(:, :)

    if (allocated(values)) then
      call self%file%require_shape(self%path(name), shape(values))
    else
      call self%file%require_shape(self%path(name), extents_of(extents))
    end if
    call self%file%read(self%path(name), found)
    call require_range(self%file, self%path(name), pack(found, .true.), low, high)
    if (.not. (self%file%failed() .and. allocated(values))) call move_alloc(found, values)
  end subroutine visit_integers_2

  subroutine visit_text(self, name, value, carried)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%file%read_attribute(self%place, name, value)
  end subroutine visit_text

  subroutine long_text(self, name, value, carried)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%file%read(self%path(name), value)
  end subroutine long_text

  !> No memory is taken for a list that is not there.
  subroutine listed(self, name, n)
    class(member_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: n

    if (n > 0) call require(self%file, self%path(name)//'/'//to_text(n), self%file%has(self%path(name)//'/'//to_text(n)), &
                            'is missing')
  end subroutine listed

end module member_reader
