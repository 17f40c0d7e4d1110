!> The visitor that stores members and gives them to another object of the same type: members that do not depend on the mesh are
!> carried over a remesh in this way.
!>
!>     call visit_solution_members(memory, before)
!>     memory%gives = .true.
!>     call visit_solution_members(memory, after)
module kept_members
  use kinds, only: wp
  use visitors, only: kept, visitor_t
  implicit none
  private
  public :: kept_member_t, member_memory_t

  !> A member: its path and its values, of which only those of its own type are there.
  type :: kept_member_t
    character(len=:), allocatable :: path
    real(wp), allocatable :: reals(:)
    integer, allocatable :: integers(:)
    character(len=:), allocatable :: text
  end type kept_member_t

  type, extends(visitor_t) :: member_memory_t
    !> Members are given back, no longer stored.
    logical :: gives = .false.
    !> All members, not only those that a remesh keeps.
    logical :: all = .false.
    !> Stored members, in the order of the visit.
    type(kept_member_t), allocatable :: members(:)
    integer :: n = 0
  contains
    procedure :: visit_real
    procedure :: visit_reals
    procedure :: visit_reals_2
    procedure :: visit_reals_3
    procedure :: visit_integer
    procedure :: visit_integers
    procedure :: visit_integers_2
    procedure :: visit_text
    procedure :: long_text => visit_text
    procedure :: find
    procedure, private :: is_meant
    procedure, private :: add
  end type member_memory_t

contains

  subroutine visit_real(self, name, value, carried, unit, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: values(:)

    allocate (values, source=[value])
    call self%visit_reals(name, values, carried, '1')
    value = values(1)
  end subroutine visit_real

  subroutine visit_reals(self, name, values, carried, extents, unit, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)   !! (extents) [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    integer :: k

    if (.not. self%is_meant(carried)) return
    if (self%gives) then
      k = self%find(self%path(name))
      if (k > 0) values = self%members(k)%reals
    else
      call self%add(name, k)
      if (allocated(values)) allocate (self%members(k)%reals, source=values)
    end if
  end subroutine visit_reals

  subroutine visit_reals_2(self, name, values, carried, extents, unit, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: flat(:)

    if (.not. self%is_meant(carried)) return
    if (allocated(values)) allocate (flat, source=reshape(values, [size(values)]))
    call self%visit_reals(name, flat, carried, extents)
    if (allocated(values)) values = reshape(flat, shape(values))
  end subroutine visit_reals_2

  subroutine visit_reals_3(self, name, values, carried, extents, unit, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:, :, :)   !! (n1, n2, n3) as `extents` names them [unit]
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    real(wp), allocatable :: flat(:)

    if (.not. self%is_meant(carried)) return
    if (allocated(values)) allocate (flat, source=reshape(values, [size(values)]))
    call self%visit_reals(name, flat, carried, extents)
    if (allocated(values)) values = reshape(flat, shape(values))
  end subroutine visit_reals_3

  subroutine visit_integer(self, name, value, carried, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high
    integer, allocatable :: values(:)

    allocate (values, source=[value])
    call self%visit_integers(name, values, carried, '1')
    value = values(1)
  end subroutine visit_integer

  subroutine visit_integers(self, name, values, carried, extents, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)   !! (extents)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high
    integer :: k

    if (.not. self%is_meant(carried)) return
    if (self%gives) then
      k = self%find(self%path(name))
      if (k > 0) values = self%members(k)%integers
    else
      call self%add(name, k)
      if (allocated(values)) allocate (self%members(k)%integers, source=values)
    end if
  end subroutine visit_integers

  subroutine visit_integers_2(self, name, values, carried, extents, low, high)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:, :)   !! (n1, n2) as `extents` names them
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high
    integer, allocatable :: flat(:)

    if (.not. self%is_meant(carried)) return
    if (allocated(values)) allocate (flat, source=reshape(values, [size(values)]))
    call self%visit_integers(name, flat, carried, extents)
    if (allocated(values)) values = reshape(flat, shape(values))
  end subroutine visit_integers_2

  subroutine visit_text(self, name, value, carried)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer :: k

    if (.not. self%is_meant(carried)) return
    if (self%gives) then
      k = self%find(self%path(name))
      if (k > 0) value = self%members(k)%text
    else
      call self%add(name, k)
      if (allocated(value)) self%members(k)%text = value
    end if
  end subroutine visit_text

  !> Index of a path among the members, 0 where it is not stored.
  pure function find(self, path) result(k)
    class(member_memory_t), intent(in) :: self
    character(len=*), intent(in) :: path
    integer :: k

    do k = self%n, 1, -1
      if (self%members(k)%path == path) return
    end do
  end function find

  pure function is_meant(self, carried) result(yes)
    class(member_memory_t), intent(in) :: self
    character(len=*), intent(in) :: carried
    logical :: yes

    yes = self%all .or. carried == kept
  end function is_meant

  !> Room for one more member.
  subroutine add(self, name, k)
    class(member_memory_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(out) :: k
    type(kept_member_t), allocatable :: more(:)

    if (.not. allocated(self%members)) allocate (self%members(64))
    if (self%n == size(self%members)) then
      allocate (more(2*self%n))
      more(:self%n) = self%members
      call move_alloc(more, self%members)
    end if
    self%n = self%n + 1
    k = self%n
    self%members(k)%path = self%path(name)
  end subroutine add

end module kept_members
