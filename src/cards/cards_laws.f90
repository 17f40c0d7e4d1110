!> LAW cards: materials, with the numbers that their laws declare, once or at several temperatures.
module cards_laws
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use law_api, only: contact_law, kind_names, law_t, number_count
  use law_checks, only: check_alike, check_numbers, refuse_without_temperatures
  use law_numbers, only: read_lines
  use law_registry, only: law_names
  use materials, only: material_t
  use scene_draft, only: close_card, draft_t
  use steel_files, only: read_steel_of_law
  use text, only: string_t
  implicit none
  private
  public :: read_laws, read_material

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

end module cards_laws
