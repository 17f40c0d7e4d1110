!> Parameters of a deck: `PARAM name value` and what `-p NAME=VALUE` puts in their place.
module deck_parameters
  use kinds, only: wp
  use diagnostics, only: location_t
  use deck_field, only: digits, letters
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: parameter_t, parameters_t, valid_name

  !> One parameter, a number or a word.
  type :: parameter_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: text
    logical :: numeric = .false.
    real(wp) :: value = 0
    logical :: used = .false.
    !> Its value has a mistake which is recorded: fields that use it are faulty without another message.
    logical :: faulty = .false.
    type(location_t) :: where
  end type parameter_t

  !> The parameters defined so far.
  type :: parameters_t
    type(parameter_t), allocatable :: items(:)
    integer :: n = 0
    !> Names that some PARAM line of the deck declares, be it further down.
    type(string_t), allocatable :: declared(:)
    !> Which of the declared names are used before their PARAM line.
    logical, allocatable :: wanted(:)
    !> False when an included file is missing: then an unknown name is not reported.
    logical :: complete = .true.
  contains
    procedure :: find
    procedure :: append
    procedure :: mark_used
    procedure :: unknown
  end type parameters_t

contains

  !> A letter, then letters, digits and underscores.
  pure function valid_name(name) result(valid)
    character(len=*), intent(in) :: name
    logical :: valid

    valid = .false.
    if (len(name) == 0) return
    valid = verify(name(1:1), letters) == 0 .and. verify(name, letters//digits//'_') == 0
  end function valid_name

  !> Index of the parameter, 0 when it is not defined.
  pure function find(self, name) result(index)
    class(parameters_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer :: index

    do index = 1, self%n
      if (self%items(index)%name == name) return
    end do
    index = 0
  end function find

  pure subroutine append(self, item)
    class(parameters_t), intent(inout) :: self
    type(parameter_t), intent(in) :: item
    type(parameter_t), allocatable :: longer(:)
    integer :: i

    if (.not. allocated(self%items)) allocate (self%items(16))
    if (self%n == size(self%items)) then
      allocate (longer(2*self%n))
      longer(:self%n) = self%items
      call move_alloc(longer, self%items)
    end if
    self%n = self%n + 1
    self%items(self%n) = item
    do i = 1, size(self%declared)
      if (self%declared(i)%s == item%name .and. self%wanted(i)) self%items(self%n)%used = .true.
    end do
  end subroutine append

  !> Mark every `$name` of the text, whether the expression around it is right or wrong.
  pure subroutine mark_used(self, text)
    class(parameters_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer :: first, last, i

    first = 1
    do
      i = index(text(first:), '$')
      if (i == 0) return
      first = first + i
      last = first + verify(text(first:)//' ', letters//digits//'_') - 2
      i = self%find(text(first:last))
      if (i > 0) then
        self%items(i)%used = .true.
      else
        do i = 1, size(self%declared)
          if (self%declared(i)%s == text(first:last)) self%wanted(i) = .true.
        end do
      end if
      if (last >= len(text)) return
    end do
  end subroutine mark_used

  !> Message for a name that is not defined.
  pure subroutine unknown(self, name, message)
    class(parameters_t), intent(in) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(out) :: message
    character(len=:), allocatable :: nearest
    integer :: i

    message = ''
    if (.not. self%complete) return
    do i = 1, size(self%declared)
      if (self%declared(i)%s == name) then
        message = 'parameter ''$'//name//''' is used before the PARAM line which defines it'
        return
      end if
    end do
    message = 'unknown parameter ''$'//name//''''
    nearest = nearest_word(name, self%declared)
    if (nearest /= '') message = message//'; nearest: ''$'//nearest//''''
  end subroutine unknown

end module deck_parameters
