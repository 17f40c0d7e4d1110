!> The card of a law: its lines, and the numbers on them with what is allowed for each.
module law_card
  use kinds, only: wp
  implicit none
  private
  public :: law_line_t, parameter_t, law_line, parameter
  public :: line_choice, line_pairs, line_values

  !> One number of a law's card.
  type :: parameter_t
    character(len=:), allocatable :: name, unit, meaning
    !> Allowed range, bounds included unless `strict` (then the lower bound itself is refused).
    real(wp) :: lower = -huge(1.0_wp), upper = huge(1.0_wp)
    logical :: strict = .false.
    !> May be left out (only on lines of name-value pairs); then this value is taken.
    logical :: optional = .false.
    real(wp) :: default = 0.0_wp
    !> Must be a whole number.
    logical :: whole = .false.
    !> Above 0 it turns a part of the law on: at all temperatures of a card, or at none.
    logical :: turns_on = .false.
    !> Grows from each temperature of a card to the next: the card needs temperatures.
    logical :: rises = .false.
    !> Name of another number whose default is 0 where this one is given.
    character(len=:), allocatable :: replaces
  end type parameter_t

  !> Kinds of line: values in order; one of several lines chosen by its first word; name-value pairs in any order.
  integer, parameter :: line_values = 1
  integer, parameter :: line_choice = 2
  integer, parameter :: line_pairs = 3

  !> One line of a law's card.
  type :: law_line_t
    integer :: kind = line_values
    !> The word that chooses this line among its neighbours of kind `line_choice`.
    character(len=:), allocatable :: word
    type(parameter_t), allocatable :: parameters(:)
    !> Rows of two numbers follow (a curve), and what these are.
    logical :: curve = .false.
    character(len=:), allocatable :: abscissa, ordinate
  end type law_line_t

contains

  !> A parameter in one line; `above` is a lower bound that is itself refused.
  pure function parameter(name, unit, meaning, lower, above, upper, default, whole, turns_on, rises, replaces) result(p)
    character(len=*), intent(in) :: name, unit, meaning
    real(wp), intent(in), optional :: lower, above, upper, default
    logical, intent(in), optional :: whole, turns_on, rises
    character(len=*), intent(in), optional :: replaces
    type(parameter_t) :: p

    p%name = name
    p%unit = unit
    p%meaning = meaning
    if (present(lower)) p%lower = lower
    if (present(above)) then
      p%lower = above
      p%strict = .true.
    end if
    if (present(upper)) p%upper = upper
    if (present(default)) then
      p%optional = .true.
      p%default = default
    end if
    if (present(whole)) p%whole = whole
    if (present(turns_on)) p%turns_on = turns_on
    if (present(rises)) p%rises = rises
    p%replaces = ''
    if (present(replaces)) p%replaces = replaces
  end function parameter

  !> A line of a card; with `word` it is one of several to choose from; with the two numbers of a curve its rows follow.
  pure function law_line(parameters, word, pairs, abscissa, ordinate) result(line)
    type(parameter_t), intent(in) :: parameters(:)   !! (nparameter)
    character(len=*), intent(in), optional :: word
    logical, intent(in), optional :: pairs
    character(len=*), intent(in), optional :: abscissa, ordinate
    type(law_line_t) :: line

    allocate (line%parameters, source=parameters)
    line%word = ''
    if (present(word)) then
      line%kind = line_choice
      line%word = word
    end if
    if (present(pairs)) then
      if (pairs) line%kind = line_pairs
    end if
    line%curve = present(abscissa) .and. present(ordinate)
    if (.not. line%curve) return
    line%abscissa = abscissa
    line%ordinate = ordinate
  end function law_line

end module law_card
