!> The visitor that reads of a checkpoint what `checkpoint_facts_t` is made of, and passes over everything else: arrays that it
!> passes over are empty, lists too, numbers as they were.
module facts_reader
  use kinds, only: wp
  use member_reader, only: member_reader_t
  implicit none
  private
  public :: facts_reader_t

  !> Parts whose numbers and lists are read, and members of groups.
  character(len=*), parameter :: parts(6) = [character(len=9) :: 'scene', 'remesher', 'remesh', 'progress', 'probation', 'estimate']
  character(len=*), parameter :: of_groups(2) = [character(len=12) :: 'role', 'connectivity']

  type, extends(member_reader_t) :: facts_reader_t
  contains
    procedure :: visit_real => read_real
    procedure :: visit_reals => skip_reals
    procedure :: visit_reals_2 => skip_reals_2
    procedure :: visit_reals_3 => skip_reals_3
    procedure :: visit_integer => read_integer
    procedure :: visit_integers => skip_integers
    procedure :: visit_integers_2 => read_integers_2
    procedure :: visit_text => read_text
    procedure :: long_text => skip_long_text
    procedure, private :: wants
  end type facts_reader_t

contains

  !> Does a member here go into the facts?
  pure function wants(self, name)
    class(facts_reader_t), intent(in) :: self
    character(len=*), intent(in) :: name
    logical :: wants
    character(len=:), allocatable :: part

    part = self%place(:index(self%place//'/', '/') - 1)
    wants = any(part == parts)
    if (part /= 'groups' .or. wants) return
    if (self%place == part) then
      wants = .true.   ! how many there are
    else
      wants = any(name == of_groups) .and. index(self%place, '/') == index(self%place, '/', back=.true.)
    end if
  end function wants

  subroutine read_real(self, name, value, carried, unit, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (self%wants(name)) call self%member_reader_t%visit_real(name, value, carried, unit, low, high)
  end subroutine read_real

  subroutine skip_reals(self, name, values, carried, extents, unit, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)   !! (0) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (.not. allocated(values)) allocate (values(0))
  end subroutine skip_reals

  subroutine skip_reals_2(self, name, values, carried, extents, unit, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :)   !! (0, 0) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (.not. allocated(values)) allocate (values(0, 0))
  end subroutine skip_reals_2

  subroutine skip_reals_3(self, name, values, carried, extents, unit, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (0, 0, 0) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (.not. allocated(values)) allocate (values(0, 0, 0))
  end subroutine skip_reals_3

  subroutine read_integer(self, name, value, carried, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high

    if (self%wants(name)) call self%member_reader_t%visit_integer(name, value, carried, low, high)
  end subroutine read_integer

  subroutine skip_integers(self, name, values, carried, extents, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)   !! (0)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    if (.not. allocated(values)) allocate (values(0))
  end subroutine skip_integers

  subroutine read_integers_2(self, name, values, carried, extents, low, high)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    if (self%wants(name)) then
      call self%member_reader_t%visit_integers_2(name, values, carried, extents, low, high)
    else if (.not. allocated(values)) then
      allocate (values(0, 0))
    end if
  end subroutine read_integers_2

  subroutine read_text(self, name, value, carried)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    if (self%wants(name)) then
      call self%member_reader_t%visit_text(name, value, carried)
    else if (.not. allocated(value)) then
      value = ''
    end if
  end subroutine read_text

  subroutine skip_long_text(self, name, value, carried)
    class(facts_reader_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried

    if (.not. allocated(value)) value = ''
  end subroutine skip_long_text

end module facts_reader
