!> Files -> lines: included files come in where they are named (source_lines has the rest).
module deck_source
  use deck_field, only: deck_field_t, first_word, scan_fields
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: i8
  use source_lines, only: append_line, end_of_line, source_t
  use system, only: path_beside, plain_path
  use text, only: string_t, to_text, upper_case
  implicit none
  private
  public :: load_file

  !> Depth of included files: more is a cycle which the names did not show.
  integer, parameter :: deepest_include = 16

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

  !> Lines of one file; INCLU is followed at once.
  recursive subroutine take_lines(content, file, open_files, depth, source, diagnostics)
    character(len=*), intent(in) :: content
    integer, intent(in) :: file, depth
    type(string_t), intent(inout) :: open_files(:)
    type(source_t), intent(inout) :: source
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
    character(len=*), parameter :: carriage_return = char(13)
    !> Both orders of the bytes of UTF-16.
    character(len=2), parameter :: wide_mark(2) = [char(255)//char(254), char(254)//char(255)]
    integer :: first, past, line, n
    logical :: file_ended

    if (any(index(content, wide_mark) == 1)) then
      source%complete = .false.
      call diagnostics%add(location_t(file, 1, 1), '', 'the file is written in UTF-16: save it as plain text (UTF-8)')
      return
    end if
    if (is_binary(content)) then
      source%complete = .false.
      call diagnostics%add(location_t(file, 1, 1), '', 'the file is no text: expected a deck, or a file that one includes')
      return
    end if
    if (index(content, carriage_return) > 0 .and. index(content, new_line('a')) == 0) then
      source%complete = .false.
      call diagnostics%add(location_t(file, 1, index(content, carriage_return)), '', 'lines of the file end with carriage ' &
                           //'returns alone: save it with the line ends of Unix or Windows')
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
      call append_line(source, content(first:past - 1), file, line)
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

  !> Results, archives and documents of word processors have many bytes 0, a text none.
  pure function is_binary(content) result(binary)
    character(len=*), intent(in) :: content
    logical :: binary
    integer, parameter :: few = 3
    integer :: k, n

    n = 0
    do k = 1, len(content)
      if (content(k:k) == char(0)) n = n + 1
      if (n > few) exit
    end do
    binary = n > few
  end function is_binary

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

end module deck_source
