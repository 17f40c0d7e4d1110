!> Scenes for the tests of estimates, from decks written in tests.
module scene_cases
  use deck_reader, only: deck_t, read_deck_text
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use scene, only: scene_t
  use scene_reader, only: read_scene
  use text, only: string_t
  implicit none
  private
  public :: scene_of

contains

  !> Read a deck without mistakes; `;` ends a line.
  subroutine scene_of(cards, scene)
    character(len=*), intent(in) :: cards
    type(scene_t), intent(out) :: scene
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    type(error_t), allocatable :: error
    type(string_t) :: none(0)
    character(len=len(cards)) :: lines
    integer :: i

    lines = cards
    do i = 1, len(lines)
      if (lines(i:i) == ';') lines(i:i) = new_line('a')
    end do
    call read_deck_text(lines//new_line('a'), 'test.lag', none, deck, diagnostics)
    call read_scene(deck, scene, diagnostics)
    call diagnostics%error(error)
    if (.not. allocated(error)) return
    print '(a)', error%message
    error stop 'scene_of: a mistake in a deck'
  end subroutine scene_of

end module scene_cases
