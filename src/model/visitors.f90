!> Visitors: operations on the members of a type, one after the other.
!>
!> Every type that a checkpoint holds has one routine `visit_...` that names its members: with unit, shape, range, and how a remesh
!> carries them over. Writing, reading, the description of the file and the carry over a remesh are visitors, so that no member is
!> listed a second time. A component that is not kept is named by `derived`, with the reason.
!>
!> Members of one number or text are handed over by `member`, arrays that are allocated too; arrays of constant size by `fixed`. A
!> type within a type stands between `enter` and `leave`. Lists of a type begin with `list`.
module visitors
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: visitor_t, extents_of
  public :: kept, recomputed, of_the_mesh, nodal, by_variable, not_carried

  !> How a remesh carries a member over: unchanged; set by the remesher or the restart; with the new mesh; by the shape functions of
  !> the old mesh; each variable of the state in its own way (state_variables). Contact ends are not for the new mesh at all.
  character(len=*), parameter :: kept = 'kept', recomputed = 'recomputed', of_the_mesh = 'of the mesh', nodal = 'nodal', &
                                 by_variable = 'by variable', not_carried = 'not carried'

  type, abstract :: visitor_t
    !> Where the members visited stand: `groups/2`; empty or not allocated at the root.
    character(len=:), allocatable :: place
  contains
    generic :: member => visit_real, visit_reals, visit_reals_2, visit_reals_3, visit_integer, visit_integers, visit_integers_2, &
      visit_flag, visit_text
    procedure(visit_real_i), deferred :: visit_real
    procedure(visit_reals_i), deferred :: visit_reals
    procedure(visit_reals_2_i), deferred :: visit_reals_2
    procedure(visit_reals_3_i), deferred :: visit_reals_3
    procedure(visit_integer_i), deferred :: visit_integer
    procedure(visit_integers_i), deferred :: visit_integers
    procedure(visit_integers_2_i), deferred :: visit_integers_2
    procedure(visit_text_i), deferred :: visit_text
    procedure :: visit_flag
    generic :: fixed => visit_fixed_reals, visit_fixed_integers
    procedure :: visit_fixed_reals
    procedure :: visit_fixed_integers
    !> A text that may be long: a whole deck.
    procedure(visit_text_i), deferred :: long_text
    procedure :: enter
    procedure :: enter_item
    procedure :: leave
    procedure :: list
    procedure :: derived
    procedure :: path
    procedure :: entered
    procedure :: listed
    procedure :: label
  end type visitor_t

  abstract interface
    subroutine visit_real_i(self, name, value, carried, unit, low, high)
      import :: visitor_t, wp
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      real(wp), intent(inout) :: value
      character(len=*), intent(in) :: carried         !! how a remesh carries it over
      character(len=*), intent(in), optional :: unit
      real(wp), intent(in), optional :: low, high     !! it is from `low` to `high`
    end subroutine visit_real_i

    !> An array is given with its extents, `2, nnode`: a number is the exact extent, a word stands for any. One that is
    !> allocated keeps its extents.
    subroutine visit_reals_i(self, name, values, carried, extents, unit, low, high)
      import :: visitor_t, wp
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      real(wp), allocatable, intent(inout) :: values(:)         !! (extents) [unit]
      character(len=*), intent(in) :: carried, extents
      character(len=*), intent(in), optional :: unit
      real(wp), intent(in), optional :: low, high
    end subroutine visit_reals_i

    subroutine visit_reals_2_i(self, name, values, carried, extents, unit, low, high)
      import :: visitor_t, wp
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      real(wp), allocatable, intent(inout) :: values(:, :)      !! (extents) [unit]
      character(len=*), intent(in) :: carried, extents
      character(len=*), intent(in), optional :: unit
      real(wp), intent(in), optional :: low, high
    end subroutine visit_reals_2_i

    subroutine visit_reals_3_i(self, name, values, carried, extents, unit, low, high)
      import :: visitor_t, wp
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (extents) [unit]
      character(len=*), intent(in) :: carried, extents
      character(len=*), intent(in), optional :: unit
      real(wp), intent(in), optional :: low, high
    end subroutine visit_reals_3_i

    subroutine visit_integer_i(self, name, value, carried, low, high)
      import :: visitor_t
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      integer, intent(inout) :: value
      character(len=*), intent(in) :: carried
      integer, intent(in), optional :: low, high
    end subroutine visit_integer_i

    subroutine visit_integers_i(self, name, values, carried, extents, low, high)
      import :: visitor_t
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      integer, allocatable, intent(inout) :: values(:)      !! (extents)
      character(len=*), intent(in) :: carried, extents
      integer, intent(in), optional :: low, high
    end subroutine visit_integers_i

    subroutine visit_integers_2_i(self, name, values, carried, extents, low, high)
      import :: visitor_t
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      integer, allocatable, intent(inout) :: values(:, :)   !! (extents)
      character(len=*), intent(in) :: carried, extents
      integer, intent(in), optional :: low, high
    end subroutine visit_integers_2_i

    subroutine visit_text_i(self, name, value, carried)
      import :: visitor_t
      class(visitor_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      character(len=:), allocatable, intent(inout) :: value
      character(len=*), intent(in) :: carried
    end subroutine visit_text_i
  end interface

contains

  !> Yes (1) or no (0).
  subroutine visit_flag(self, name, value, carried)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    logical, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer :: number

    number = merge(1, 0, value)
    call self%member(name, number, carried, low=0, high=1)
    value = number == 1
  end subroutine visit_flag

  subroutine visit_fixed_reals(self, name, values, carried, unit, low, high)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: values(:)             !! (n) [unit]
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: copy(:)

    allocate (copy, source=values)
    call self%member(name, copy, carried, to_text(size(values)), unit, low, high)
    if (size(copy) == size(values)) values = copy
  end subroutine visit_fixed_reals

  subroutine visit_fixed_integers(self, name, values, carried, low, high)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: values(:)              !! (n)
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high
    integer, allocatable :: copy(:)

    allocate (copy, source=values)
    call self%member(name, copy, carried, to_text(size(values)), low, high)
    if (size(copy) == size(values)) values = copy
  end subroutine visit_fixed_integers

  !> What follows belongs to the part `name`, until `leave`.
  subroutine enter(self, name)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name

    self%place = self%path(name)
    call self%entered()
  end subroutine enter

  !> What follows belongs to entry k of a list, until `leave`.
  subroutine enter_item(self, name, k)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: k

    call self%enter(name//'/'//self%label(k))
  end subroutine enter_item

  !> Back to where `enter` or `enter_item` of the same name were called.
  subroutine leave(self, name)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer :: last

    last = index('/'//self%place, '/'//name, back=.true.) - 2
    self%place = self%place(:max(last, 0))
  end subroutine leave

  !> A list begins: how many entries it has. A visitor that fills an empty list says how many there shall be, `most` at most; where
  !> a list is there already, `most` is absent and the number may not change.
  subroutine list(self, name, n, most, carried)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: n
    integer, intent(in), optional :: most
    character(len=*), intent(in), optional :: carried   !! how a remesh carries the length over
    character(len=:), allocatable :: way
    integer :: low, high

    low = n
    high = n
    if (present(most)) then
      low = 0
      high = most
    end if
    way = not_carried
    if (present(carried)) way = carried
    call self%enter(name)
    call self%member('count', n, way, low=low, high=high)
    call self%leave(name)
    call self%listed(name, n)
  end subroutine list

  !> A component that is not kept, and why it need not be.
  subroutine derived(self, name, reason)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name, reason
  end subroutine derived

  !> Path of a member of what is visited.
  pure function path(self, name)
    class(visitor_t), intent(in) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: path

    path = name
    if (.not. allocated(self%place)) return
    if (len(self%place) > 0) path = self%place//'/'//name
  end function path

  !> Called at every new place.
  subroutine entered(self)
    class(visitor_t), intent(inout) :: self
  end subroutine entered

  !> Called before the entries of a list.
  subroutine listed(self, name, n)
    class(visitor_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: n
  end subroutine listed

  !> How entry k of a list is called.
  pure function label(self, k)
    class(visitor_t), intent(in) :: self
    integer, intent(in) :: k
    character(len=:), allocatable :: label

    label = to_text(k)
  end function label

  !> Extents from words: `2, nnode` -> 2, -1.
  pure function extents_of(words) result(extents)
    character(len=*), intent(in) :: words
    integer, allocatable :: extents(:)
    integer :: first, last, value, status

    allocate (extents(0))
    first = 1
    do while (first <= len(words))
      last = first + index(words(first:)//',', ',') - 2
      read (words(first:last), *, iostat=status) value
      if (status /= 0) value = -1
      extents = [extents, value]
      first = last + 2
    end do
  end function extents_of

end module visitors
