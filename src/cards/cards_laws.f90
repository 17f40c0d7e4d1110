!> LAW cards: numbers of a material, in the lines its law declares, once or at several temperatures.
module cards_laws
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use law_api, only: contact_law, kind_names, law_line_t, law_t, line_choice, line_pairs, number_count, parameter_t
  use law_checks, only: check_alike, check_numbers, refuse_without_temperatures
  use law_registry, only: law_names
  use materials, only: material_t
  use scene_draft, only: close_card, draft_t
  use steel_files, only: read_steel_of_law
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: read_laws, read_material

  !> A table longer than this is an error of input.
  integer, parameter :: most_points = 100000

contains

  !> All LAW cards: materials of the scene, in the order of the deck.
  subroutine read_laws(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: known(:)
    integer :: i, n

    call law_names(draft%laws, known)
    allocate (draft%scene%materials(count_cards(deck, 'LAW')))
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'LAW') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      associate (material => draft%scene%materials(n))
        allocate (material%values(0), material%curve(2, 0))
        call draft%materials%define(cursor, 'the name of the material', 'LAW', n, diagnostics, material%name)
        material%where_defined = diagnostics%place(cursor%where())
        call cursor%name('a type of law', known, material%law_id)
        material%law = ''
        if (material%law_id > 0) then
          material%law = draft%laws(material%law_id)%name
          if (draft%laws(material%law_id)%of_steel) then
            call read_steel_of_law(cursor, deck%path, material%steel, diagnostics)
            if (cursor%peek_row() == 'TEMP') call cursor%fail('the steel has the temperatures: expected no rows TEMP')
          end if
          if (cursor%peek_row() == 'TEMP') then
            call read_temperatures(cursor, draft%laws(material%law_id), material)
          else
            call read_lines(cursor, draft%laws(material%law_id), material)
            call check_numbers(cursor, draft%laws(material%law_id), material)
            call refuse_without_temperatures(cursor, draft%laws(material%law_id))
          end if
        end if
      end associate
      call close_card(draft, cursor, deck%cards(i))
      call leave_without_numbers(draft%laws, draft%scene%materials(n))
    end do
  end subroutine read_laws

  !> A law whose card is wrong may lack numbers: no other card goes by it then.
  pure subroutine leave_without_numbers(laws, material)
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(material_t), intent(inout) :: material

    if (material%law_id == 0) return
    if (size(material%values) /= number_count(laws(material%law_id))) material%law_id = 0
  end subroutine leave_without_numbers

  pure function count_cards(deck, keyword) result(n)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: keyword
    integer :: n, i

    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == keyword) n = n + 1
    end do
  end function count_cards

  !> `TEMP value` and all lines of the law, at ascending temperatures.
  subroutine read_temperatures(cursor, law, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(inout) :: material
    type(material_t) :: first, last, part
    character(len=:), allocatable :: word
    real(wp), allocatable :: temperatures(:), values(:), curves(:)
    real(wp) :: temperature
    integer :: n

    allocate (temperatures(0), values(0), curves(0))
    do while (cursor%peek_row() == 'TEMP')
      call cursor%next_row('TEMP and a temperature')
      call cursor%word('TEMP', word)
      if (law%kind == contact_law) call cursor%fail('a law for '//trim(kind_names(law%kind))//' has no temperatures')
      n = size(temperatures)
      if (n == 0) then
        call cursor%real('the temperature of the numbers that follow', temperature)
      else
        call cursor%real('the temperature of the numbers that follow', temperature, lower=temperatures(n), strict_lower=.true.)
      end if
      call cursor%end_row()
      if (allocated(part%values)) deallocate (part%values, part%curve)
      allocate (part%values(0), part%curve(2, 0))
      call read_lines(cursor, law, part)
      call check_numbers(cursor, law, part)
      if (n > 0) call check_alike(cursor, law, first, last, part)
      if (cursor%failed()) return
      if (n == 0) first = part
      last = part
      temperatures = [temperatures, temperature]
      values = [values, part%values]
      curves = [curves, part%curve]
    end do
    n = size(temperatures)
    if (n == 1) then
      call cursor%fail('the numbers are given at one temperature only: leave out TEMP, or give a second one')
      return
    end if
    material%values = first%values
    material%curve = first%curve
    allocate (material%temperatures, source=temperatures)
    allocate (material%values_by_temperature, source=reshape(values, [size(material%values), n]))
    allocate (material%curves, source=reshape(curves, [2, size(material%curve, 2), n]))
  end subroutine read_temperatures

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

  !> Read the name of a LAW of a kind (solid or contact): place of the material, 0 after a mistake.
  subroutine read_material(cursor, draft, kind, material)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: kind
    integer, intent(out) :: material
    integer :: k, id

    material = 0
    call draft%materials%find(cursor, 'the name of a LAW', k)
    if (k == 0) return
    material = draft%materials%item(k)
    id = draft%scene%materials(material)%law_id
    if (id == 0) return
    if (draft%laws(id)%kind == kind) return
    call cursor%fail('LAW '''//draft%materials%words(k)%s//''' is of type '//draft%laws(id)%name//', a law for ' &
                     //trim(kind_names(draft%laws(id)%kind))//'; expected one for '//trim(kind_names(kind)))
  end subroutine read_material

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

end module cards_laws
