!> Files -> lines: comments and line ends go, included files come in, every line keeps its place.
!>
!> The lines can be written as one text and read back without touching a file. In such a text
!> `!@file "name" line` gives the place of the line that follows, and `!@param NAME=VALUE` is an override.
module deck_source
  use diagnostics, only: diagnostics_t, location_t
  use deck_field, only: comment_column, digits, deck_field_t, first_word, scan_fields
  use kinds, only: i8
  use text, only: string_t, to_text, upper_case
  implicit none
  private
  public :: line_t, source_t, load_file, load_text, path_beside, write_text

  !> Depth of included files: more is a cycle which the names did not show.
  integer, parameter :: deepest_include = 16
  character(len=*), parameter :: file_mark = '!@file "', param_mark = '!@param '
  character(len=1), parameter :: tab = achar(9), line_feed = achar(10), carriage_return = achar(13)

  !> A line that is not blank, without comment and trailing blanks.
  type :: line_t
    character(len=:), allocatable :: text
    integer :: file = 0
    integer :: line = 0
  end type line_t

  !> A deck with its included files in place.
  type :: source_t
    type(line_t), allocatable :: lines(:)
    integer :: nline = 0
    !> Overrides found in a stored text.
    type(string_t), allocatable :: overrides(:)
    !> False when a file could not be read.
    logical :: complete = .true.
    !> Last line of the deck's own file.
    type(location_t) :: last
    !> END is passed.
    logical :: ended = .false.
  end type source_t

contains

  !> Read the file `path` and all it includes.
  subroutine load_file(path, source, diagnostics)
    character(len=*), intent(in) :: path
    type(source_t), intent(out) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    type(string_t) :: open_files(deepest_include)
    type(location_t) :: where
    character(len=:), allocatable :: content, failure

    allocate (source%lines(64), source%overrides(0))
    call diagnostics%register(path, where%file)
    source%last = where
    call read_whole(path, content, failure)
    if (allocated(failure)) then
      source%complete = .false.
      call diagnostics%add(where, '', failure)
      return
    end if
    open_files(1)%s = path
    call take_lines(content, where%file, open_files, 1, source, diagnostics)
  end subroutine load_file

  !> Lines of a text that `write_text` made, or of a deck without INCLU held in memory.
  subroutine load_text(content, path, source, diagnostics)
    character(len=*), intent(in) :: content, path
    type(source_t), intent(out) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: first, past, line, file

    allocate (source%lines(64))
    call take_overrides(content, source%overrides)
    call diagnostics%register(path, file)
    source%last%file = file
    line = 0
    first = 1
    do while (first <= len(content))
      past = end_of_line(content, first)
      if (index(content(first:past - 1), file_mark) == 1) then
        call read_place(content(first:past - 1), file, line, diagnostics)
      else if (index(content(first:past - 1), param_mark) /= 1) then
        line = line + 1
        call append(source, content(first:past - 1), file, line)
        if (file == source%last%file) source%last%line = line
      end if
      first = past + 1
    end do
  end subroutine load_text

  !> The canonical text of a source and the overrides in force.
  subroutine write_text(source, overrides, diagnostics, content)
    type(source_t), intent(in) :: source
    type(string_t), intent(in) :: overrides(:)   !! (noverride)
    type(diagnostics_t), intent(in) :: diagnostics
    character(len=:), allocatable, intent(out) :: content
    integer :: pass, length, i, file, line

    ! First the length is counted, then the text is filled in.
    do pass = 1, 2
      length = 0
      do i = 1, size(overrides)
        call put(param_mark//trim(overrides(i)%s))
      end do
      file = 0
      line = 0
      do i = 1, source%nline
        if (source%lines(i)%file /= file .or. source%lines(i)%line /= line + 1) &
          call put(file_mark//diagnostics%place(location_t(source%lines(i)%file))//'" '//to_text(source%lines(i)%line))
        file = source%lines(i)%file
        line = source%lines(i)%line
        call put(source%lines(i)%text)
      end do
      if (pass == 1) allocate (character(len=length) :: content)
    end do

  contains

    subroutine put(one)
      character(len=*), intent(in) :: one

      if (pass == 2) content(length + 1:length + len(one) + 1) = one//line_feed
      length = length + len(one) + 1
    end subroutine put

  end subroutine write_text

  !> Column of the line feed of the line which begins at `first`, or one past the end.
  pure function end_of_line(content, first) result(past)
    character(len=*), intent(in) :: content
    integer, intent(in) :: first
    integer :: past

    past = index(content(first:), line_feed) + first - 1
    if (past < first) past = len(content) + 1
  end function end_of_line

  !> The `!@param` lines, which stand at the head of a stored text.
  subroutine take_overrides(content, overrides)
    character(len=*), intent(in) :: content
    type(string_t), allocatable, intent(out) :: overrides(:)
    integer :: pass, first, past, n

    do pass = 1, 2
      n = 0
      first = 1
      do while (first <= len(content))
        past = end_of_line(content, first)
        if (index(content(first:past - 1), param_mark) /= 1) exit
        n = n + 1
        if (pass == 2) overrides(n)%s = content(first + len(param_mark):past - 1)
        first = past + 1
      end do
      if (pass == 1) allocate (overrides(n))
    end do
  end subroutine take_overrides

  !> Place from `!@file "name" line`: that of the line which follows. Any other mark is a comment.
  subroutine read_place(mark, file, line, diagnostics)
    character(len=*), intent(in) :: mark
    integer, intent(inout) :: file, line
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: closing, last, number, status

    closing = index(mark, '" ', back=.true.)
    if (closing <= len(file_mark)) return
    last = len_trim(mark)
    if (verify(mark(closing + 2:last), digits) > 0 .or. last < closing + 2 .or. last > closing + 10) return
    read (mark(closing + 2:last), *, iostat=status) number
    if (status /= 0 .or. number < 1) return
    line = number - 1
    call diagnostics%register(mark(len(file_mark) + 1:closing - 1), file)
  end subroutine read_place

  !> Lines of one file; INCLU is followed at once.
  recursive subroutine take_lines(content, file, open_files, depth, source, diagnostics)
    character(len=*), intent(in) :: content
    integer, intent(in) :: file, depth
    type(string_t), intent(inout) :: open_files(:)
    type(source_t), intent(inout) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
    !> Both orders of the bytes of UTF-16.
    character(len=2), parameter :: wide_mark(2) = [char(255)//char(254), char(254)//char(255)]
    integer :: first, past, line, n
    logical :: file_ended

    if (any(index(content, wide_mark) == 1)) then
      source%complete = .false.
      call diagnostics%add(location_t(file, 1, 1), '', 'the file is written in UTF-16: save it as plain text (UTF-8)')
      return
    end if
    first = 1
    if (index(content, byte_order_mark) == 1) then
      first = 4
      call diagnostics%add(location_t(file, 1, 1), '', 'the file begins with a byte-order mark: save it as plain text')
    end if
    line = 0
    file_ended = .false.
    do while (first <= len(content))
      past = end_of_line(content, first)
      line = line + 1
      n = source%nline
      call append(source, content(first:past - 1), file, line)
      first = past + 1
      if (depth == 1) source%last%line = line
      if (source%nline == n .or. source%ended) cycle
      if (file_ended) then
        call diagnostics%add(location_t(file, line, verify(source%lines(n + 1)%text, ' ')), '', 'nothing may follow END')
        source%nline = n
        return
      end if
      select case (upper_case(first_word(source%lines(n + 1)%text)))
      case ('END')
        file_ended = depth > 1
        source%ended = .not. file_ended
        if (.not. file_ended) cycle
        ! That of an included file ends the file, and is no line of the deck.
        call judge_end(source%lines(n + 1)%text, location_t(file, line, 1), diagnostics)
        source%nline = n
      case ('INCLU')
        ! In small letters it is a mistake, which the reader of cards reports.
        source%complete = source%complete .and. index(source%lines(n + 1)%text, 'INCLU') == 1
        if (index(source%lines(n + 1)%text, 'INCLU') /= 1) cycle
        source%nline = n
        call include_file(source%lines(n + 1)%text, location_t(file, line, 1), open_files, depth, source, diagnostics)
      end select
    end do
  end subroutine take_lines

  !> The END of an included file is in capital letters and alone on its line, as that of a deck.
  subroutine judge_end(text, where, diagnostics)
    character(len=*), intent(in) :: text
    type(location_t), intent(in) :: where
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: there

    if (text(:3) /= 'END') &
      call diagnostics%add(where, '', 'a keyword is written in capital letters: ''END'', not '''//text(:3)//'''')
    if (len(text) == 3) return
    there = where
    there%column = 3 + verify(text(4:), ' ')
    call diagnostics%add(there, 'END', 'expected the end of the line, found '''//text(there%column:)//'''')
  end subroutine judge_end

  !> `INCLU file`, the path relative to the file it stands in.
  recursive subroutine include_file(card, where, open_files, depth, source, diagnostics)
    character(len=*), intent(in) :: card
    type(location_t), intent(in) :: where
    type(string_t), intent(inout) :: open_files(:)
    integer, intent(in) :: depth
    type(source_t), intent(inout) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    type(deck_field_t), allocatable :: fields(:)
    character(len=:), allocatable :: path, content, failure
    integer :: i, file, column

    column = 1
    path = ''
    call scan_fields(card, 6, where, 'INCLU', fields, diagnostics)
    if (size(fields) == 0) then
      failure = 'expected the name of a file, found the end of the line'
    else if (any(fields%faulty)) then
      source%complete = .false.
      return
    else if (size(fields) > 1) then
      column = fields(2)%column
      failure = 'expected the end of the line, found '''//fields(2)%text//''''
    else
      column = fields(1)%column
      path = fields(1)%text
      if (index(path, '$') > 0) failure = 'the name of an included file takes no parameter'
      path = path_beside(open_files(depth)%s, path)
      do i = 1, depth
        if (plain_path(open_files(i)%s) == plain_path(path)) failure = ''''//path//''' includes itself'
      end do
      if (depth == size(open_files)) failure = 'more than '//to_text(size(open_files))//' files are included in one another'
      if (.not. allocated(failure)) call read_whole(path, content, failure)
    end if
    if (allocated(failure)) then
      source%complete = .false.
      call diagnostics%add(location_t(where%file, where%line, column), 'INCLU', failure)
      return
    end if
    open_files(depth + 1)%s = path
    call diagnostics%register(path, file)
    call take_lines(content, file, open_files, depth + 1, source, diagnostics)
  end subroutine include_file

  !> A line in its plain form, unless there is nothing on it.
  subroutine append(source, raw, file, line)
    type(source_t), intent(inout) :: source
    character(len=*), intent(in) :: raw
    integer, intent(in) :: file, line
    type(line_t), allocatable :: longer(:)
    character(len=len(raw)) :: text
    integer :: i, n

    text = raw
    n = len(raw)
    if (n > 0) then
      if (text(n:n) == carriage_return) n = n - 1
    end if
    do i = 1, n
      if (text(i:i) == tab) text(i:i) = ' '
    end do
    n = len_trim(text(:comment_column(text(:n)) - 1))
    if (n == 0) return
    if (source%nline == size(source%lines)) then
      allocate (longer(2*source%nline))
      do i = 1, source%nline
        call move_alloc(source%lines(i)%text, longer(i)%text)
        longer(i)%file = source%lines(i)%file
        longer(i)%line = source%lines(i)%line
      end do
      call move_alloc(longer, source%lines)
    end if
    source%nline = source%nline + 1
    source%lines(source%nline)%text = text(:n)
    source%lines(source%nline)%file = file
    source%lines(source%nline)%line = line
  end subroutine append

  !> All bytes of a file; `failure` is allocated when that did not work.
  subroutine read_whole(path, content, failure)
    character(len=*), intent(in) :: path
    character(len=:), allocatable, intent(out) :: content, failure
    integer(i8) :: length
    integer :: unit, status

    if (path == '') then
      failure = 'the name of the file is empty'
      return
    end if
    open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
    if (status /= 0) then
      failure = 'cannot open the file '''//path//''''
      return
    end if
    inquire (unit=unit, size=length)
    if (length < 0 .or. length >= huge(status)) then
      failure = ''''//path//''' is not a file of a length that can be read'
    else
      allocate (character(len=length) :: content)
      if (length > 0) read (unit, iostat=status) content
      if (status /= 0) failure = 'cannot read the file '''//path//''''
    end if
    close (unit)
  end subroutine read_whole

  !> `a/./b/../c` -> `a/c`, so that a cycle is seen whatever way it is written.
  pure function plain_path(path) result(plain)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: plain
    integer :: first, past, cut

    plain = ''
    first = 1
    do while (first <= len(path))
      past = first + index(path(first:)//'/', '/') - 1
      select case (path(first:past - 1))
      case ('.')
      case ('..')
        cut = index(plain, '/', back=.true.)
        if (cut == 0 .or. plain(cut + 1:) == '..') then
          plain = plain//'/..'
        else
          plain = plain(:cut - 1)
        end if
      case default
        plain = plain//'/'//path(first:past - 1)
      end select
      first = past + 1
    end do
  end function plain_path

  !> The path of a file that a deck names: relative to the folder of the deck, where it is not absolute.
  pure function path_beside(deck_path, file) result(path)
    character(len=*), intent(in) :: deck_path, file
    character(len=:), allocatable :: path

    path = file
    if (index(file, '/') /= 1) path = deck_path(:index(deck_path, '/', back=.true.))//file
  end function path_beside

end module deck_source
