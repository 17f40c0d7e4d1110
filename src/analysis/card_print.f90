!> `lagamine --cards`: the keywords of all cards, for editors and other programs that read decks.
module card_print
  use errors, only: error_t
  use scene_draft, only: words_of
  use scene_reader, only: known_cards
  use standard_streams, only: print_lines
  use text, only: string_t
  implicit none
  private
  public :: print_cards

contains

  !> A keyword a line: cards of a scene, those of the reader itself, and the card of one material point.
  subroutine print_cards(error)
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: of_scenes(:), others(:)

    call known_cards(of_scenes)
    call words_of('PARAM INCLU END PATH', others)
    call print_lines([of_scenes, others], error)
  end subroutine print_cards

end module card_print
