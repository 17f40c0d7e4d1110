!> Values as JSON spells them (RFC 8259): texts, numbers, `true` and `false`, arrays of these.
!> Reals are the shortest text that reads back as the same number; NaN and infinity become `null`.
module json_literals
  use exact_numbers, only: exact_text, is_finite
  use kinds, only: i8, wp
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: json_literal

  !> A value as JSON spells it.
  interface json_literal
    module procedure :: text_literal
    module procedure :: integer_literal
    module procedure :: long_literal
    module procedure :: real_literal
    module procedure :: logical_literal
    module procedure :: integers_literal
    module procedure :: reals_literal
    module procedure :: words_literal
  end interface json_literal

contains

  !> Text in quotes. What is not UTF-8 is taken for Latin-1, the usual other case in old decks.
  pure function text_literal(value) result(s)
    character(len=*), intent(in) :: value
    character(len=:), allocatable :: s
    character(len=6) :: code
    logical :: utf8
    integer :: i, c

    utf8 = is_utf8(value)
    s = '"'
    do i = 1, len(value)
      c = ichar(value(i:i))
      if (c == iachar('"') .or. c == iachar('\')) then
        s = s//'\'//value(i:i)
      else if (c == 10) then
        s = s//'\n'
      else if (c == 9) then
        s = s//'\t'
      else if (c < 32 .or. (c > 127 .and. .not. utf8)) then
        write (code, '(a,z4.4)') '\u', c
        s = s//code
      else
        s = s//value(i:i)
      end if
    end do
    s = s//'"'
  end function text_literal

  !> Is every byte beyond ASCII part of a well-formed sequence (RFC 3629, its syntax in short)?
  pure function is_utf8(value)
    character(len=*), intent(in) :: value
    logical :: is_utf8
    integer :: i, c, following

    is_utf8 = .false.
    following = 0
    do i = 1, len(value)
      c = ichar(value(i:i))
      if ((following > 0) .neqv. (c >= 128 .and. c < 192)) return
      if (following > 0) then
        following = following - 1
      else if (c >= 128) then
        if (c < 194 .or. c > 244) return
        following = merge(3, merge(2, 1, c >= 224), c >= 240)
      end if
    end do
    is_utf8 = following == 0
  end function is_utf8

  pure function integer_literal(value) result(s)
    integer, intent(in) :: value
    character(len=:), allocatable :: s

    s = to_text(value)
  end function integer_literal

  pure function long_literal(value) result(s)
    integer(i8), intent(in) :: value
    character(len=:), allocatable :: s

    s = to_text(value)
  end function long_literal

  function real_literal(value) result(s)
    real(wp), intent(in) :: value
    character(len=:), allocatable :: s

    s = 'null'
    if (is_finite(value)) s = exact_text(value)
  end function real_literal

  pure function logical_literal(value) result(s)
    logical, intent(in) :: value
    character(len=:), allocatable :: s

    s = trim(merge('true ', 'false', value))
  end function logical_literal

  pure function integers_literal(values) result(s)
    integer, intent(in) :: values(:)   !! (n)
    character(len=:), allocatable :: s
    type(string_t) :: items(size(values))
    integer :: i

    do i = 1, size(values)
      items(i)%s = json_literal(values(i))
    end do
    s = '['//join(items, ', ')//']'
  end function integers_literal

  function reals_literal(values) result(s)
    real(wp), intent(in) :: values(:)   !! (n) [of any unit]
    character(len=:), allocatable :: s
    type(string_t) :: items(size(values))
    integer :: i

    do i = 1, size(values)
      items(i)%s = json_literal(values(i))
    end do
    s = '['//join(items, ', ')//']'
  end function reals_literal

  pure function words_literal(values) result(s)
    type(string_t), intent(in) :: values(:)   !! (n)
    character(len=:), allocatable :: s
    type(string_t) :: items(size(values))
    integer :: i

    do i = 1, size(values)
      items(i)%s = json_literal(values(i)%s)
    end do
    s = '['//join(items, ', ')//']'
  end function words_literal

end module json_literals
