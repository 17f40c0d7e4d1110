!> Numbers of a law, in the lines that it declares.
module law_numbers
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use law_api, only: law_line_t, law_t, line_choice, line_pairs, parameter_t
  use materials, only: material_t
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: read_lines

  !> A table longer than this is an error of input.
  integer, parameter :: most_points = 100000

contains

  !> All lines of a law, laid out as `find_parameter` answers.
  subroutine read_lines(cursor, law, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(inout) :: material
    integer :: first, last

    first = 1
    do while (first <= size(law%lines))
      last = first
      if (law%lines(first)%kind == line_choice) then
        do while (last < size(law%lines))
          if (law%lines(last + 1)%kind /= line_choice) exit
          last = last + 1
        end do
        call read_choice(cursor, law%lines(first:last), material)
      else if (law%lines(first)%kind == line_pairs) then
        call read_pairs(cursor, law%lines(first)%parameters, material)
      else
        call cursor%next_row(names_in(law%lines(first)%parameters))
        call read_row(cursor, law%lines(first), material)
      end if
      first = last + 1
    end do
  end subroutine read_lines

  !> One line of several: its word, its numbers; the numbers of the others are zero.
  subroutine read_choice(cursor, lines, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_line_t), intent(in) :: lines(:)
    type(material_t), intent(inout) :: material
    type(string_t), allocatable :: words(:)
    integer :: i, chosen

    allocate (words(size(lines)))
    do i = 1, size(lines)
      words(i)%s = lines(i)%word
    end do
    call cursor%next_row('one of '//join(words, ' '))
    call cursor%name('one of '//join(words, ' '), words, chosen)
    material%values = [material%values, real(chosen, wp)]
    do i = 1, size(lines)
      if (i == chosen) then
        call read_row(cursor, lines(i), material)
      else
        material%values = [material%values, spread(0.0_wp, 1, size(lines(i)%parameters))]
      end if
    end do
  end subroutine read_choice

  !> Numbers in order on one row, and the rows of the curve after it.
  subroutine read_row(cursor, line, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_line_t), intent(in) :: line
    type(material_t), intent(inout) :: material
    real(wp) :: value
    integer :: i, n

    n = 0
    do i = 1, size(line%parameters)
      if (line%curve .and. line%parameters(i)%name == 'NPOINT') then
        call cursor%integer('NPOINT (number of rows that follow)', n, lower=1, upper=most_points)
        value = real(n, wp)
      else
        call read_number(cursor, line%parameters(i), value)
      end if
      material%values = [material%values, value]
    end do
    if (line%curve) call read_curve(cursor, line, n, material%curve)
  end subroutine read_row

  !> Rows of two numbers, the first of them ascending.
  subroutine read_curve(cursor, line, n, curve)
    type(cursor_t), intent(inout) :: cursor
    type(law_line_t), intent(in) :: line
    integer, intent(in) :: n
    real(wp), allocatable, intent(out) :: curve(:, :)
    integer :: i

    allocate (curve(2, n), source=0.0_wp)
    do i = 1, n
      if (cursor%failed()) return
      call cursor%next_row(line%abscissa//' and '//line%ordinate//' of point '//to_text(i)//' of '//to_text(n))
      if (i == 1) then
        call cursor%real(line%abscissa, curve(1, i))
      else
        call cursor%real(line%abscissa, curve(1, i), lower=curve(1, i - 1), strict_lower=.true.)
      end if
      call cursor%real(line%ordinate, curve(2, i))
    end do
  end subroutine read_curve

  !> `NAME value` in any order, on as many rows as one likes.
  subroutine read_pairs(cursor, parameters, material)
    type(cursor_t), intent(inout) :: cursor
    type(parameter_t), intent(in) :: parameters(:)
    type(material_t), intent(inout) :: material
    type(string_t), allocatable :: names(:)
    logical :: given(size(parameters))
    real(wp) :: values(size(parameters))
    integer :: i, k

    allocate (names(size(parameters)))
    do i = 1, size(parameters)
      names(i)%s = parameters(i)%name
    end do
    values = parameters%default
    given = .false.
    do while (cursor%more_rows())
      if (cursor%peek_row() == 'TEMP') exit
      if (cursor%peek_row() == '' .and. all(parameters%optional)) exit
      call cursor%next_row('pairs of a name and a number')
      do while (cursor%more())
        call cursor%name('the name of a number', names, k)
        if (k == 0) return
        if (given(k)) call cursor%fail(''''//names(k)%s//''' is given twice')
        given(k) = .true.
        call read_number(cursor, parameters(k), values(k))
      end do
    end do
    do i = 1, size(parameters)
      if (given(i) .or. parameters(i)%optional) cycle
      call cursor%fail('expected a value of '//described(parameters(i))//', found none')
    end do
    do i = 1, size(parameters)
      if (.not. given(i) .or. parameters(i)%replaces == '') cycle
      where (names_are(names, parameters(i)%replaces) .and. .not. given) values = 0
    end do
    material%values = [material%values, values]
  end subroutine read_pairs

  pure function names_are(names, name) result(same)
    type(string_t), intent(in) :: names(:)
    character(len=*), intent(in) :: name
    logical :: same(size(names))
    integer :: i

    do i = 1, size(names)
      same(i) = names(i)%s == name
    end do
  end function names_are

  !> One number within the range its law declares.
  subroutine read_number(cursor, parameter, value)
    type(cursor_t), intent(inout) :: cursor
    type(parameter_t), intent(in) :: parameter
    real(wp), intent(out) :: value

    call cursor%real(described(parameter), value, lower=parameter%lower, upper=parameter%upper, strict_lower=parameter%strict)
    if (parameter%whole .and. abs(value - anint(value)) > 0) call cursor%fail(parameter%name//' must be a whole number')
  end subroutine read_number

  pure function described(parameter) result(s)
    type(parameter_t), intent(in) :: parameter
    character(len=:), allocatable :: s

    s = parameter%name//' ('//parameter%meaning//') ['//parameter%unit//']'
  end function described

  pure function names_in(parameters) result(s)
    type(parameter_t), intent(in) :: parameters(:)
    character(len=:), allocatable :: s
    integer :: i

    s = ''
    do i = 1, size(parameters)
      s = s//' '//parameters(i)%name
    end do
    s = s(min(2, len(s) + 1):)
  end function names_in

end module law_numbers
