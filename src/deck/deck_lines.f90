!> What each line of a deck is: a card, a data row, a PARAM line, or nothing that can be taken.
module deck_lines
  use deck_field, only: first_word, keyword_letters
  use diagnostics, only: diagnostics_t, location_t
  use foreign_characters, only: foreign_words
  use source_lines, only: source_t
  use text, only: string_t, to_text, upper_case
  implicit none
  private
  public :: is_card, is_row, is_param, classify, declared_names

  integer, parameter :: is_card = 1, is_row = 2, is_param = 3, is_refused = 4
  integer, parameter :: longest_keyword = 6
  !> The one keyword that is longer.
  character(len=*), parameter :: long_keyword = 'ACCURACY'

contains

  !> What each line is, up to END; after it there must be nothing.
  subroutine classify(source, kinds, diagnostics)
    type(source_t), intent(in) :: source
    integer, allocatable, intent(out) :: kinds(:)   !! (nline)
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable :: word, hint
    type(location_t) :: where
    integer :: i, last_kind
    logical :: ended, refused

    allocate (kinds(source%nline))
    kinds = is_refused
    last_kind = 0
    ended = .false.
    hint = ''
    do i = 1, source%nline
      where = location_t(source%lines(i)%file, source%lines(i)%line, 1)
      word = first_word(source%lines(i)%text)
      if (ended) then
        where%column = verify(source%lines(i)%text, ' ')
        call diagnostics%add(where, '', 'nothing may follow END')
        exit
      end if
      if (word == '') then
        kinds(i) = is_row
        if (last_kind /= is_card .and. last_kind /= is_refused) then
          where%column = verify(source%lines(i)%text, ' ')
          call refuse_row(last_kind)
          kinds(i) = is_refused
          last_kind = is_refused
        else if (last_kind == is_refused) then
          kinds(i) = is_refused
        end if
        if (adjustl(source%lines(i)%text) == 'END') hint = '; the END of line '//to_text(where%line)//' is not in column 1'
        cycle
      end if
      call check_keyword(word, where, refused, diagnostics)
      kinds(i) = is_card
      if (refused) kinds(i) = is_refused
      select case (upper_case(word))
      case ('PARAM')
        kinds(i) = is_param
      case ('END')
        ended = .true.
        kinds(i) = is_refused
        call refuse_after_end(source%lines(i)%text)
      case ('INCLU')
        kinds(i) = is_refused
        if (word == 'INCLU') call diagnostics%add(where, word, 'a deck that is read from a text cannot include files')
      end select
      last_kind = kinds(i)
    end do
    if (.not. ended .and. source%last%line > 0) then
      where = source%last
      where%column = 1
      call diagnostics%add(where, 'END', 'expected END, found the end of the file'//hint)
    else if (.not. ended .and. source%complete) then
      call diagnostics%add(source%last, '', 'the deck is empty')
    end if

  contains

    subroutine refuse_row(before)
      integer, intent(in) :: before

      if (before == is_param) then
        call diagnostics%add(where, 'PARAM', 'takes no data rows')
      else
        call diagnostics%add(where, '', 'expected a keyword in column 1, found a data row before any card')
      end if
    end subroutine refuse_row

    subroutine refuse_after_end(line)
      character(len=*), intent(in) :: line

      if (len(line) == 3) return
      where%column = 3 + verify(line(4:), ' ')
      call diagnostics%add(where, 'END', 'expected the end of the line, found '''//line(where%column:)//'''')
    end subroutine refuse_after_end

  end subroutine classify

  !> Keywords are 1 to 6 capital letters or digits, and ACCURACY. One in small letters is reported and then taken.
  subroutine check_keyword(word, where, refused, diagnostics)
    character(len=*), intent(in) :: word
    type(location_t), intent(in) :: where
    logical, intent(out) :: refused
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: there
    integer :: bad

    there = where
    refused = .true.
    bad = verify(upper_case(word), keyword_letters)
    there%column = max(bad, 1)
    if (bad > 0) then
      if (ichar(word(bad:bad)) < 32 .or. ichar(word(bad:bad)) > 126) then
        call diagnostics%add(there, '', foreign_words(word, bad))
      else
        call diagnostics%add(there, '', 'a keyword in column 1 has capital letters and digits, found '''//word// &
                             '''; a data row starts with a blank')
      end if
    else if (len(word) > longest_keyword .and. upper_case(word) /= long_keyword) then
      call diagnostics%add(there, '', 'a keyword has at most '//to_text(longest_keyword)//' letters, found '''//word//'''')
    else
      refused = .false.
      if (verify(word, keyword_letters) > 0) &
        call diagnostics%add(there, '', 'a keyword is written in capital letters: '''//upper_case(word)//''', not '''//word//'''')
    end if
  end subroutine check_keyword

  !> Names on PARAM lines, for the messages about names that are not defined (yet).
  subroutine declared_names(source, kinds, names)
    type(source_t), intent(in) :: source
    integer, intent(in) :: kinds(:)                        !! (nline)
    type(string_t), allocatable, intent(out) :: names(:)   !! (nname)
    character(len=:), allocatable :: rest
    integer :: i, n

    allocate (names(count(kinds == is_param)))
    n = 0
    do i = 1, source%nline
      if (kinds(i) /= is_param) cycle
      n = n + 1
      rest = adjustl(source%lines(i)%text(6:))
      names(n)%s = first_word(rest)
    end do
  end subroutine declared_names

end module deck_lines
