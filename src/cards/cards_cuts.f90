!> TRIM and PIERC: a body is cut along a line, or parts where a web under a die has become thin.
module cards_cuts
  use bodies, only: elements_at_middles
  use card_places, only: read_rigid_die
  use card_points, only: read_xy
  use cuts, only: cut_t
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use plane_vectors, only: cross
  use remesher_options, only: by_zones, has_zones
  use scene, only: is_solid
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  use vectors, only: length_of
  implicit none
  private
  public :: may_be_cut, read_cuts, trim_keyword

  character(len=*), parameter :: trim_keyword = 'TRIM', pierce_keyword = 'PIERC'
  !> A kept point closer to the line than this share of its length is on neither side of it.
  real(wp), parameter :: on_the_line = 1.0e-9_wp

contains

  !> All TRIM and PIERC cards, behind REMSH.
  subroutine read_cuts(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(cut_t), allocatable :: list(:)
    type(cut_t) :: cut
    integer :: i

    allocate (list(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= trim_keyword .and. deck%cards(i)%keyword /= pierce_keyword) cycle
      call cursor%open(deck%cards(i), diagnostics)
      cut = cut_t()
      call read_body(cursor, draft, cut%group)
      if (deck%cards(i)%keyword == trim_keyword) then
        call read_trim(cursor, cut)
      else
        call read_pierce(cursor, draft, cut)
      end if
      call refuse_without_free_mesh(cursor, draft)
      call refuse_shared_sides(cursor, draft, cut%group)
      call close_card(draft, cursor, deck%cards(i))
      list = [list, cut]
    end do
    call move_alloc(list, draft%scene%remesher%cuts)
  end subroutine read_cuts

  !> Does a card of the deck, perhaps of another operation, cut a body?
  pure function may_be_cut(deck) result(yes)
    type(deck_t), intent(in) :: deck
    logical :: yes
    integer :: i

    yes = .false.
    do i = 1, size(deck%cards)
      yes = yes .or. any(deck%cards(i)%keyword == [character(len=6) :: trim_keyword, '-'//trim_keyword, &
                                                   pierce_keyword, '-'//pierce_keyword])
    end do
  end function may_be_cut

  !> `body`: a BLOCK, BODY or card of elements.
  subroutine read_body(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(out) :: group   !! place among the groups, 0 where there is none
    type(string_t), allocatable :: names(:)
    integer :: bodies(size(draft%scene%groups)), g, n, k

    n = 0
    allocate (names(size(bodies)))
    do g = 1, size(bodies)
      if (.not. is_solid(draft%scene%groups(g))) cycle
      n = n + 1
      bodies(n) = g
      names(n)%s = draft%scene%groups(g)%name
    end do
    call cursor%name('the name of a body', names(:n), k)
    group = 0
    if (k > 0) group = bodies(k)
  end subroutine read_body

  !> `body x y x y KEEP x y`
  subroutine read_trim(cursor, cut)
    type(cursor_t), intent(inout) :: cursor
    type(cut_t), intent(inout) :: cut

    call read_xy(cursor, 'the point where the cut begins', cut%line(1:2))
    call read_xy(cursor, 'the point where the cut ends', cut%line(3:4))
    if (cursor%failed()) return
    associate (along => cut%line(3:4) - cut%line(1:2))
      if (.not. length_of(along) > 0) call cursor%fail('the cut ends where it begins: expected another point')
      call read_kept(cursor, .true., cut)
      if (cursor%failed()) return
      if (abs(cross(along, cut%kept - cut%line(1:2))) <= on_the_line*length_of(along)**2) &
        call cursor%fail('the point that is kept lies on the line of the cut: expected one beside it')
    end associate
  end subroutine read_trim

  !> `body die WEB thickness [KEEP x y]`
  subroutine read_pierce(cursor, draft, cut)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(cut_t), intent(inout) :: cut
    type(string_t), allocatable :: words(:)
    integer :: k

    call read_rigid_die(cursor, draft, cut%die)
    if (cut%die == 0) return
    call words_of('WEB', words)
    call cursor%name('WEB', words, k)
    call cursor%real('the thickness at which the web parts', cut%thickness, lower=0.0_wp, strict_lower=.true., unit='length')
    call read_kept(cursor, .false., cut)
  end subroutine read_pierce

  !> `KEEP x y`
  subroutine read_kept(cursor, required, cut)
    type(cursor_t), intent(inout) :: cursor
    logical, intent(in) :: required
    type(cut_t), intent(inout) :: cut
    type(string_t), allocatable :: words(:)
    integer :: k

    if (cursor%failed() .or. .not. (required .or. cursor%more())) return
    call words_of('KEEP', words)
    call cursor%name('KEEP', words, k)
    call read_xy(cursor, 'a point that is kept', cut%kept)
    cut%names_kept = .true.
  end subroutine read_kept

  !> The remesher cuts, and zones of the whole body are none of what is left.
  subroutine refuse_without_free_mesh(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft

    if (cursor%failed()) return
    associate (remesher => draft%scene%remesher)
      if (.not. draft%scene%remesh%on) then
        call cursor%fail('a body that is cut gets a new mesh: expected a REMSH card')
      else if (has_zones(remesher) .or. remesher%mesher == by_zones) then
        call cursor%fail('zones are those of the whole body: expected no ZONE card and no MESHER ZONES')
      end if
    end associate
  end subroutine refuse_without_free_mesh

  !> A cut would leave a part of the sides that a body shares with another one open.
  subroutine refuse_shared_sides(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: group   !! place among the groups
    integer :: own(size(draft%scene%mesh%coordinates, 2)), g

    if (cursor%failed() .or. .not. draft%mesh_sound) return
    own = elements_at_middles(draft%scene, only_of=group)
    do g = 1, size(draft%scene%groups)
      if (g == group .or. .not. is_solid(draft%scene%groups(g))) cycle
      if (.not. any(own([draft%scene%groups(g)%connectivity(5:8, :)]) > 0)) cycle
      call cursor%fail(''''//draft%scene%groups(group)%name//''' shares sides with '''//draft%scene%groups(g)%name &
                       //''': expected a body that stands alone')
      return
    end do
  end subroutine refuse_shared_sides

end module cards_cuts
