!> Characters that a deck cannot have outside of titles, quotes and comments, in words: what stands there, and what was meant.
!> Editors and pages of the web put them in place of blanks, signs and quotes. Source: RFC 3629 (UTF-8).
module foreign_characters
  use text, only: to_text
  implicit none
  private
  public :: foreign_words, is_letter, letter_length

contains

  !> What the message says of the character that begins at this place.
  pure function foreign_words(line, at) result(words)
    character(len=*), intent(in) :: line
    integer, intent(in) :: at
    character(len=:), allocatable :: words
    integer :: code
    character(len=8) :: hexadecimal

    code = code_point(line, at)
    if (code < 128) then
      words = 'byte '//to_text(ichar(line(at:at)))//' is not a printable ASCII character'
      return
    end if
    write (hexadecimal, '(z0)') code
    if (len_trim(hexadecimal) < 4) hexadecimal = repeat('0', 4 - len_trim(hexadecimal))//hexadecimal
    words = 'the character U+'//trim(hexadecimal)//' is not a printable ASCII character'
    select case (code)
    case (int(z'00A0'), int(z'2002'):int(z'200B'), int(z'202F'), int(z'3000'))
      words = words//': it looks like a blank, write one'
    case (int(z'00AD'), int(z'2010'):int(z'2015'), int(z'2212'))
      words = words//': it looks like a minus, write ''-'''
    case (int(z'2018'):int(z'201F'))
      words = words//': it looks like a quote, write '' or "'
    case (int(z'00D7'), int(z'00B7'), int(z'22C5'))
      words = words//': it looks like a sign of multiplication, write ''*'''
    end select
  end function foreign_words

  !> A letter of a script of two or three bytes begins at this place.
  pure function is_letter(line, at) result(yes)
    character(len=*), intent(in) :: line
    integer, intent(in) :: at
    logical :: yes

    select case (code_point(line, at))
    case (int(z'00C0'):int(z'00D6'), int(z'00D8'):int(z'00F6'), int(z'00F8'):int(z'1FFF'), int(z'3040'):int(z'D7A3'))
      yes = .true.
    case default
      yes = .false.
    end select
  end function is_letter

  !> Bytes of the character of UTF-8 beyond ASCII that begins at this place, 0 where these bytes are none.
  pure function letter_length(line, at) result(length)
    character(len=*), intent(in) :: line
    integer, intent(in) :: at
    integer :: length
    integer :: k

    select case (ichar(line(at:at)))
    case (194:223)
      length = 2
    case (224:239)
      length = 3
    case (240:244)
      length = 4
    case default
      length = 0
      return
    end select
    if (at + length - 1 > len(line)) length = 0
    do k = at + 1, at + length - 1
      ! bytes that go on with a character are 10xxxxxx
      if (iand(ichar(line(k:k)), 192) == 128) cycle
      length = 0
      return
    end do
  end function letter_length

  !> Number of a character of two or three bytes of UTF-8; 0 where these bytes are none.
  pure function code_point(line, at) result(code)
    character(len=*), intent(in) :: line
    integer, intent(in) :: at
    integer :: code
    integer :: first, more, k, byte

    code = 0
    first = ichar(line(at:at))
    select case (first)
    case (194:223)
      more = 1
      first = first - 192
    case (224:239)
      more = 2
      first = first - 224
    case default
      return
    end select
    if (at + more > len(line)) return
    do k = 1, more
      byte = ichar(line(at + k:at + k))
      if (byte < 128 .or. byte > 191) return
      first = 64*first + byte - 128
    end do
    code = first
  end function code_point

end module foreign_characters
