!> Small tools on text: numbers to text, upper case, the nearest known word.
module text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use kinds, only: i8, wp
  implicit none
  private
  public :: string_t, to_text, upper_case, nearest_word, edit_distance, join, padded, percent, two_digits, add_text, add_new_text

  !> A text of its own length, so that arrays of words need no padding.
  type :: string_t
    character(len=:), allocatable :: s
  end type string_t

  !> Shortest plain text of an integer or a real.
  interface to_text
    module procedure :: integer_to_text
    module procedure :: long_to_text
    module procedure :: real_to_text
  end interface to_text

contains

  !> A number of a file: 07.
  pure function two_digits(n) result(s)
    integer, intent(in) :: n
    character(len=:), allocatable :: s

    s = to_text(n)
    if (len(s) < 2) s = '0'//s
  end function two_digits

  pure function integer_to_text(value) result(s)
    integer, intent(in) :: value
    character(len=:), allocatable :: s
    character(len=24) :: buffer

    write (buffer, '(i0)') value
    s = trim(buffer)
  end function integer_to_text

  pure function long_to_text(value) result(s)
    integer(i8), intent(in) :: value
    character(len=:), allocatable :: s
    character(len=24) :: buffer

    write (buffer, '(i0)') value
    s = trim(buffer)
  end function long_to_text

  !> At most `digits` significant digits (default 6), no trailing zeros: `0.25`, `1.2e-5`.
  pure function real_to_text(value, digits) result(s)
    real(wp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(len=:), allocatable :: s
    character(len=40) :: buffer, form
    integer :: n, e

    n = 6
    if (present(digits)) n = digits
    if (.not. ieee_is_finite(value)) then
      write (buffer, '(g0)') value
      s = trim(adjustl(buffer))
      return
    end if
    write (form, '(a,i0,a)') '(es40.', n - 1, 'e3)'
    write (buffer, form) value
    read (buffer(37:40), '(i4)') e
    if (e >= -3 .and. e < 7) then
      write (form, '(a,i0,a)') '(f40.', max(n - 1 - e, 0), ')'
      write (buffer, form) value
      s = trim(adjustl(buffer))
      if (index(s, '.') > 0) s = s(1:verify(s, '0', back=.true.))
      if (s(len(s):) == '.') s = s(:len(s) - 1)
      if (s(1:1) == '.') s = '0'//s
      if (s == '-0') s = '0'
    else
      s = trim(adjustl(buffer(:35)))
      s = s(1:verify(s, '0', back=.true.))
      if (s(len(s):) == '.') s = s(:len(s) - 1)
      s = s//'e'//integer_to_text(e)
    end if
  end function real_to_text

  !> A share in percent, three digits of it: `1.25 %`.
  pure function percent(share) result(s)
    real(wp), intent(in) :: share
    character(len=:), allocatable :: s

    s = to_text(100*share, 3)//' %'
  end function percent

  pure function upper_case(s) result(u)
    character(len=*), intent(in) :: s
    character(len=len(s)) :: u
    integer :: i, c

    do i = 1, len(s)
      c = iachar(s(i:i))
      if (c >= iachar('a') .and. c <= iachar('z')) c = c - 32
      u(i:i) = achar(c)
    end do
  end function upper_case

  !> Words in one line, `separator` between them.
  pure function join(words, separator) result(s)
    type(string_t), intent(in) :: words(:)   !! (nword)
    character(len=*), intent(in) :: separator
    character(len=:), allocatable :: s
    integer :: i

    s = ''
    do i = 1, size(words)
      if (i > 1) s = s//separator
      s = s//words(i)%s
    end do
  end function join

  !> One more text at the end of a list.
  pure subroutine add_text(list, s)
    type(string_t), allocatable, intent(inout) :: list(:)   !! (n)
    character(len=*), intent(in) :: s
    type(string_t) :: item

    item%s = s
    list = [list, item]
  end subroutine add_text

  !> The same of a text that is not empty and not in the list yet.
  pure subroutine add_new_text(list, s)
    type(string_t), allocatable, intent(inout) :: list(:)   !! (n)
    character(len=*), intent(in) :: s
    integer :: k

    if (s == '') return
    do k = 1, size(list)
      if (list(k)%s == s) return
    end do
    call add_text(list, s)
  end subroutine add_new_text

  !> The known word closest to `word`, or '' when none is close enough to be a typing error; of words equally close the one that
  !> begins as it does.
  pure function nearest_word(word, known) result(nearest)
    character(len=*), intent(in) :: word
    type(string_t), intent(in) :: known(:)   !! (nknown)
    character(len=:), allocatable :: nearest
    integer :: i, d, best
    logical :: closer

    nearest = ''
    best = max(2, len(word)/2) + 1
    do i = 1, size(known)
      d = edit_distance(upper_case(word), upper_case(known(i)%s))
      ! not a letter in common
      if (d >= max(len(word), len(known(i)%s))) cycle
      closer = d < best
      if (d == best .and. nearest /= '') closer = goes_on(known(i)%s) .and. .not. goes_on(nearest)
      if (closer) then
        best = d
        nearest = known(i)%s
      end if
    end do

  contains

    !> It begins with the word.
    pure function goes_on(longer) result(yes)
      character(len=*), intent(in) :: longer
      logical :: yes

      yes = index(upper_case(longer), upper_case(word)) == 1
    end function goes_on

  end function nearest_word

  !> Levenshtein's distance: the least number of letters inserted, removed or changed.
  pure function edit_distance(a, b) result(d)
    character(len=*), intent(in) :: a, b
    integer :: d
    integer :: row(0:len(b)), i, j, corner, above

    do j = 0, len(b)
      row(j) = j
    end do
    do i = 1, len(a)
      corner = row(0)
      row(0) = i
      do j = 1, len(b)
        above = row(j)
        row(j) = min(row(j - 1) + 1, above + 1, corner + merge(0, 1, a(i:i) == b(j:j)))
        corner = above
      end do
    end do
    d = row(len(b))
  end function edit_distance

  !> Text with blanks up to a width, and at least one.
  pure function padded(s, width) result(t)
    character(len=*), intent(in) :: s
    integer, intent(in) :: width
    character(len=:), allocatable :: t

    t = s//repeat(' ', max(1, width - len(s)))
  end function padded

end module text
