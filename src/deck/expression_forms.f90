!> What a field that is not quoted is meant as: a word, a number, an expression in x and y.
module expression_forms
  use deck_field, only: digits, letters
  implicit none
  private
  public :: is_formula, looks_numeric
  public :: name_letters

  character(len=*), parameter :: name_letters = letters//digits//'_'
  character(len=*), parameter :: operators = '+-*/^'

contains

  !> Whether a field that is not quoted is meant as a number. `pi` is one, `./file` is none;
  !> a lone `$name` is for the caller to decide.
  pure function looks_numeric(s) result(numeric)
    character(len=*), intent(in) :: s
    logical :: numeric
    integer :: n

    numeric = .false.
    if (len(s) == 0) return
    if (scan(s(1:1), digits//'+-.($') == 1) then
      numeric = index(s, './') /= 1 .and. index(s, '../') /= 1
      return
    end if
    n = verify(s//' ', name_letters) - 1
    if (n == 0) return
    if (n == len(s)) then
      numeric = s == 'pi'
    else
      numeric = s(n + 1:n + 1) == '(' .or. (s(:n) == 'pi' .and. scan(s(n + 1:n + 1), operators) == 1)
    end if
  end function looks_numeric

  !> Whether a field that is not quoted is an expression in x and y.
  pure function is_formula(s) result(yes)
    character(len=*), intent(in) :: s
    logical :: yes
    integer :: first, n

    yes = looks_numeric(s)
    if (.not. yes .and. len(s) > 0) then
      ! x or y alone, or before an operator
      yes = scan(s(1:1), 'xy') == 1
      if (yes .and. len(s) > 1) yes = scan(s(2:2), operators) == 1
    end if
    if (.not. yes) return
    first = 1
    do while (first <= len(s))
      n = verify(s(first:)//' ', name_letters//'.$') - 1
      if (n == 1) then
        if (scan(s(first:first), 'xy') == 1) return
      end if
      first = first + max(n, 1)
    end do
    yes = .false.
  end function is_formula

end module expression_forms
