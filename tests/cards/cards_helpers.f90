!> Scenes from decks written in tests.
module cards_helpers
  use deck_reader, only: deck_t, read_deck_text
  use diagnostics, only: diagnostics_t
  use errors, only: error_t
  use scene, only: scene_t
  use scene_reader, only: read_scene
  use text, only: string_t
  implicit none
  private
  public :: scene_of, head, strategy, lines

contains

  !> Read a deck. `message` has all mistakes, and is empty when there is none.
  subroutine scene_of(deck_text, scene, message)
    character(len=*), intent(in) :: deck_text
    type(scene_t), intent(out) :: scene
    character(len=:), allocatable, intent(out) :: message
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    type(error_t), allocatable :: error
    type(string_t) :: none(0)

    call read_deck_text(deck_text, 'test.lag', none, deck, diagnostics)
    call read_scene(deck, scene, diagnostics)
    call diagnostics%error(error)
    message = ''
    if (allocated(error)) message = error%message
  end subroutine scene_of

  !> Lines in one text; `;` ends a line.
  pure function lines(words) result(s)
    character(len=*), intent(in) :: words
    character(len=:), allocatable :: s
    integer :: i

    s = words//new_line('a')
    do i = 1, len(s)
      if (s(i:i) == ';') s(i:i) = new_line('a')
    end do
  end function lines

  !> Cards that every deck needs, before and after the others.
  pure function head() result(s)
    character(len=:), allocatable :: s

    s = lines('TITLE test;STATE PLSTN;KINEM LOG')
  end function head

  pure function strategy() result(s)
    character(len=:), allocatable :: s

    s = lines('STRAT 0.1 0.001 0.2 4 3;STOP 1.;END')
  end function strategy

end module cards_helpers
