!> TITLE and KINEM.
module cards_head
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use scene_draft, only: close_card, draft_t, only_card
  use text, only: join, string_t, to_text
  implicit none
  private
  public :: read_title, read_kinematics

  !> Files and pictures have titles in one line.
  integer, parameter :: longest_title = 1000

contains

  subroutine read_title(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    integer :: k

    draft%scene%title = ''
    call only_card(deck, 'TITLE', diagnostics, k, 'a title')
    if (k == 0) return
    call cursor%open(deck%cards(k), diagnostics)
    call cursor%text('a title', draft%scene%title)
    if (len(draft%scene%title) > longest_title) then
      call cursor%fail('expected a title of at most '//to_text(longest_title)//' bytes, found '//to_text(len(draft%scene%title)))
      draft%scene%title = draft%scene%title(:longest_title)
    end if
    call close_card(draft, cursor, deck%cards(k))
  end subroutine read_title

  subroutine read_kinematics(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: names(:)
    integer :: k, i

    draft%scene%kinematics = ''
    allocate (names(size(draft%kinematics)))
    do i = 1, size(names)
      names(i)%s = draft%kinematics(i)%name
    end do
    call only_card(deck, 'KINEM', diagnostics, k, 'the name of kinematics, one of '''//join(names, ''' ''')//'''')
    if (k == 0) return
    call cursor%open(deck%cards(k), diagnostics)
    call cursor%name('the name of kinematics', names, i)
    if (i > 0) then
      draft%scene%kinematics = names(i)%s
      draft%scene%kinematics_id = i
      draft%scene%finite = draft%kinematics(i)%finite
    end if
    call close_card(draft, cursor, deck%cards(k))
  end subroutine read_kinematics

end module cards_head
