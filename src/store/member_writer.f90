!> The visitor that writes members into a HDF5 file: numbers and texts as attributes of the part they belong to, arrays as datasets
!> with their unit and how a remesh carries them beside them.
module member_writer
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use visitors, only: visitor_t
  implicit none
  private
  public :: member_writer_t

  type, extends(visitor_t) :: member_writer_t
    !> Open for writing.
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
    procedure :: entered
    procedure, private :: describe
  end type member_writer_t

contains

  subroutine visit_real(self, name, value, carried, unit, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%file%write_attribute(self%place, name, value)
  end subroutine visit_real

  subroutine visit_reals(self, name, values, carried, extents, unit, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)   !! (extents) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%file%write(self%path(name), values)
    call self%describe(name, carried, unit)
  end subroutine visit_reals

  subroutine visit_reals_2(self, name, values, carried, extents, unit, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    call self%file%write(self%path(name), values)
    call self%describe(name, carried, unit)
  end subroutine visit_reals_2

  subroutine visit_reals_3(self, name, values, carried, extents, unit, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (n1, n2, n3) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (.not. allocated(values)) allocate (values(0, 0, 0))
    call self%file%write(self%path(name), values)
    call self%describe(name, carried, unit)
  end subroutine visit_reals_3

  subroutine visit_integer(self, name, value, carried, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high

    call self%file%write_attribute(self%place, name, value)
  end subroutine visit_integer

  subroutine visit_integers(self, name, values, carried, extents, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)   !! (extents)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    call self%file%write(self%path(name), values)
    call self%describe(name, carried)
  end subroutine visit_integers

  subroutine visit_integers_2(self, name, values, carried, extents, low, high)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    call self%file%write(self%path(name), values)
    call self%describe(name, carried)
  end subroutine visit_integers_2

  subroutine visit_text(self, name, value, carried)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%file%write_attribute(self%place, name, value)
  end subroutine visit_text

  subroutine long_text(self, name, value, carried)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    call self%file%write(self%path(name), value)
  end subroutine long_text

  !> Attributes need the group they belong to.
  subroutine entered(self)
    class(member_writer_t), intent(inout) :: self

    call self%file%group(self%place)
  end subroutine entered

  subroutine describe(self, name, carried, unit)
    class(member_writer_t), intent(inout) :: self
    character(len=*), intent(in) :: name, carried
    character(len=*), intent(in), optional :: unit

    if (present(unit)) call self%file%write_attribute(self%path(name), 'unit', unit)
    call self%file%write_attribute(self%path(name), 'transfer', carried)
  end subroutine describe

end module member_writer
