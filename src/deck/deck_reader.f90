!> Lines -> cards. A line whose first column is not blank starts a card; lines that start with a blank are its
!> data rows. PARAM, INCLU and END are the reader's own; all other cards are for others to understand.
module deck_reader
  use deck_card, only: card_t, deck_t, fingerprint_text, of_point, of_scene, of_steels, refuse_other_kind, refuse_unknown, row_t
  use deck_definitions, only: define, interpret, merge_overrides, override_t, refuse_unused
  use deck_field, only: deck_field_t, first_word, is_title, scan_fields
  use deck_lines, only: classify, declared_names, is_card, is_param, is_row
  use deck_parameters, only: parameters_t
  use deck_source, only: load_file
  use diagnostics, only: diagnostics_t, location_t
  use source_lines, only: source_t
  use stored_deck, only: load_text, write_text
  use text, only: string_t, to_text, upper_case
  implicit none
  private
  public :: deck_field_t, row_t, card_t, deck_t, read_deck, read_deck_text, refuse_other_kind, refuse_unknown, fingerprint_text
  public :: of_point, of_scene, of_steels

contains

  !> Read the deck in the file `path`. `overrides` are texts `NAME=VALUE` which win over PARAM.
  !> All mistakes go to `diagnostics`; the cards that could be read are delivered all the same.
  subroutine read_deck(path, overrides, deck, diagnostics)
    character(len=*), intent(in) :: path
    type(string_t), intent(in) :: overrides(:)   !! (noverride)
    type(deck_t), intent(out) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(source_t) :: source

    deck%path = path
    call load_file(path, source, diagnostics)
    call read_source(source, overrides, deck, diagnostics)
  end subroutine read_deck

  !> Read a deck from `deck%text` of an earlier reading: the same cards, and no file is touched.
  !> Overrides of then hold still, unless `overrides` has one of the same name.
  !> `text` must not be a component of `deck` itself, which is emptied first.
  subroutine read_deck_text(text, path, overrides, deck, diagnostics)
    character(len=*), intent(in) :: text, path
    type(string_t), intent(in) :: overrides(:)   !! (noverride)
    type(deck_t), intent(out) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(source_t) :: source

    deck%path = path
    call load_text(text, path, source, diagnostics)
    call read_source(source, overrides, deck, diagnostics)
  end subroutine read_deck_text

  subroutine read_source(source, overrides, deck, diagnostics)
    type(source_t), intent(inout) :: source
    type(string_t), intent(in) :: overrides(:)
    type(deck_t), intent(inout) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(override_t), allocatable :: options(:)
    type(parameters_t) :: parameters
    integer, allocatable :: kinds(:)

    call merge_overrides(source%overrides, overrides, options, diagnostics)
    call write_text(source, source%overrides, diagnostics, deck%text)
    call classify(source, kinds, diagnostics)
    call declared_names(source, kinds, parameters%declared)
    allocate (parameters%wanted(size(parameters%declared)))
    parameters%wanted = .false.
    parameters%complete = source%complete
    deck%complete = source%complete
    call build_cards(source, kinds, options, parameters, deck%cards, diagnostics)
    if (source%complete) call refuse_unused(parameters, options, diagnostics)
  end subroutine read_source

  subroutine build_cards(source, kinds, options, parameters, cards, diagnostics)
    type(source_t), intent(in) :: source
    integer, intent(in) :: kinds(:)
    type(override_t), intent(inout) :: options(:)
    type(parameters_t), intent(inout) :: parameters
    type(card_t), allocatable, intent(out) :: cards(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: where
    character(len=:), allocatable :: keyword
    integer :: i, card, row

    allocate (cards(count(kinds == is_card)))
    card = 0
    row = 0
    keyword = ''
    do i = 1, source%nline
      where = location_t(source%lines(i)%file, source%lines(i)%line, 1)
      select case (kinds(i))
      case (is_card)
        card = card + 1
        row = 0
        keyword = upper_case(first_word(source%lines(i)%text))
        cards(card)%keyword = keyword
        allocate (cards(card)%rows(rows_after(kinds, i)))
        call build_row(source%lines(i)%text, len(keyword) + 1, where, keyword, parameters, cards(card)%head, diagnostics)
      case (is_row)
        row = row + 1
        call build_row(source%lines(i)%text, 1, where, keyword, parameters, cards(card)%rows(row), diagnostics)
      case (is_param)
        call define(source%lines(i)%text, where, options, parameters, diagnostics)
      case default
        call parameters%mark_used(source%lines(i)%text)
      end select
    end do
  end subroutine build_cards

  pure function rows_after(kinds, card) result(n)
    integer, intent(in) :: kinds(:), card
    integer :: n

    n = 0
    do while (card + n < size(kinds))
      if (kinds(card + n + 1) /= is_row) exit
      n = n + 1
    end do
  end function rows_after

  subroutine build_row(line, start, where, keyword, parameters, row, diagnostics)
    character(len=*), intent(in) :: line, keyword
    integer, intent(in) :: start
    type(location_t), intent(in) :: where
    type(parameters_t), intent(inout) :: parameters
    type(row_t), intent(out) :: row
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: i

    row%file = where%file
    row%line = where%line
    if (start > 1 .and. is_title(line)) then
      call title_field(line, where, row%fields, diagnostics)
      return
    end if
    call scan_fields(line, start, where, keyword, row%fields, diagnostics)
    do i = 1, size(row%fields)
      call interpret(row%fields(i), where, keyword, parameters, diagnostics)
    end do
  end subroutine build_row

  !> The rest of a TITLE line is one text, in any script; only control characters are refused.
  subroutine title_field(line, where, fields, diagnostics)
    character(len=*), intent(in) :: line
    type(location_t), intent(in) :: where
    type(deck_field_t), allocatable, intent(out) :: fields(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: first, i, code

    if (len(line) == 5) then
      allocate (fields(0))
      return
    end if
    allocate (fields(1))
    first = 5 + verify(line(6:), ' ')
    fields(1)%column = first
    fields(1)%text = line(first:)
    do i = first, len(line)
      code = ichar(line(i:i))
      if (code >= 32 .and. code /= 127) cycle
      fields(1)%faulty = .true.
      call diagnostics%add(location_t(where%file, where%line, i), 'TITLE', 'byte '//to_text(code)//' is a control character')
      return
    end do
  end subroutine title_field

end module deck_reader
