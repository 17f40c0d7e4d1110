!> Steels that the LAW cards of a deck name: `STEEL file name` as the first row; and what all files say that a deck names.
module steel_files
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_field_t, deck_t, fingerprint_text, read_deck
  use diagnostics, only: diagnostics_t
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use element_fields, only: list_body_elems
  use errors, only: error_t
  use hash, only: sha256_length
  use run_temperatures, only: read_run_temperatures, run_temperatures_t, temperatures_digest
  use steel_reader, only: read_steels
  use steels, only: steel_t
  use system, only: path_beside
  use text, only: string_t, upper_case
  implicit none
  private
  public :: read_steel_of_law, fingerprint_with_files

contains

  !> The row STEEL of a LAW card. The file's place is relative to the deck. Its mistakes are reported with those of the deck.
  subroutine read_steel_of_law(cursor, deck_path, steel, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    character(len=*), intent(in) :: deck_path
    type(steel_t), allocatable, intent(inout) :: steel   !! not allocated after a mistake
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(steel_t), allocatable :: steels(:)
    type(string_t) :: word(1), overrides(0)
    type(string_t), allocatable :: names(:)
    character(len=:), allocatable :: file
    integer :: k, mistakes

    word(1)%s = 'STEEL'
    call cursor%next_row('STEEL, the file and the name of a steel')
    call cursor%name('STEEL', word, k)
    call cursor%word('the file of the steel', file)
    if (cursor%failed()) return
    mistakes = diagnostics%count()
    call read_steels(path_beside(deck_path, file), overrides, steels, diagnostics)
    if (diagnostics%count() > mistakes) then
      call cursor%fail('the file of the steel has mistakes')
      return
    end if
    allocate (names(size(steels)))
    do k = 1, size(steels)
      names(k)%s = steels(k)%name
    end do
    call cursor%name('the name of a steel of this file', names, k)
    call cursor%end_row()
    if (k > 0 .and. .not. cursor%failed()) allocate (steel, source=steels(k))
  end subroutine read_steel_of_law

  !> What the deck says, and what the files say that its rows STEEL and its words FROM name: a run goes on from a checkpoint only
  !> where all are the same.
  subroutine fingerprint_with_files(deck, text)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable, intent(out) :: text
    type(deck_t), target :: file
    type(diagnostics_t), target :: ignored
    type(string_t) :: overrides(0)
    character(len=:), allocatable :: more
    integer :: i, j

    call fingerprint_text(deck, text)
    do i = 1, size(deck%cards)
      if (any(deck%cards(i)%keyword == ['TEMPE', 'START'])) call add_run(deck, deck%cards(i)%head%fields, text)
      if (deck%cards(i)%keyword /= 'LAW') cycle
      do j = 1, size(deck%cards(i)%rows)
        associate (fields => deck%cards(i)%rows(j)%fields)
          if (size(fields) < 2) cycle
          if (fields(1)%numeric .or. fields(2)%numeric .or. fields(1)%text /= 'STEEL') cycle
          call read_deck(path_beside(deck%path, fields(2)%text), overrides, file, ignored)
          call fingerprint_text(file, more)
          text = text//more
        end associate
      end do
    end do
  end subroutine fingerprint_with_files

  !> The temperatures of another run that a card names.
  subroutine add_run(deck, fields, text)
    type(deck_t), intent(in) :: deck
    type(deck_field_t), intent(in) :: fields(:)   !! (nfield) of the card
    character(len=:), allocatable, intent(inout) :: text
    type(run_temperatures_t) :: run
    type(elem_t), allocatable :: elems(:)
    type(string_t), allocatable :: conducting(:)
    type(error_t), allocatable :: error
    character(len=sha256_length) :: digest

    if (size(fields) < 3) return
    if (fields(2)%numeric .or. fields(3)%numeric .or. upper_case(fields(2)%text) /= 'FROM') return
    call list_elems(elems)
    call list_body_elems(elems, conducting, 'temperature')
    call read_run_temperatures(path_beside(deck%path, fields(3)%text), conducting, run, error)
    if (allocated(error)) return
    call temperatures_digest(run, digest)
    text = text//fields(3)%text//' '//digest
  end subroutine add_run

end module steel_files
