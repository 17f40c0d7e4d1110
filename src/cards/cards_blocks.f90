!> BLOCK and JOIN: a mesh made of blocks with four sides.
module cards_blocks
  use block_mesh, only: block_t, divisions_of, mesh_block, polygon_area, side_arc, side_parabola, side_straight
  use card_points, only: read_xy
  use cards_mesh, only: read_body_head
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: pi, wp
  use mesh, only: side_set_t
  use mesh_parts, only: body_t, merge_nodes, mesh_parts_t
  use plane_vectors, only: angle_between
  use scene_draft, only: close_card, draft_t, head_location, words_of
  use text, only: string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: read_blocks, join_blocks

  !> Both ends of an arc are equally far from its centre, to this share of the radius.
  real(wp), parameter :: radius_tolerance = 1.0e-9_wp
  !> A side shorter than this share of the block is none.
  real(wp), parameter :: least_side = 1.0e-9_wp
  !> Nodes of joined sides coincide, to this share of the side's length.
  real(wp), parameter :: join_tolerance = 1.0e-6_wp
  !> Half a turn: the sense of rotation is not given by the centre (round-off of the angle).
  real(wp), parameter :: half_turn_tolerance = 1.0e-9_wp
  !> More divisions of a side are an error of input.
  integer, parameter :: most_divisions = 2000
  !> Last over first element size.
  real(wp), parameter :: largest_ratio = 1.0e6_wp

contains

  !> All BLOCK cards: a body each, and the four sets of its sides; without elements where another mesh takes their place.
  subroutine read_blocks(deck, draft, parts, diagnostics, with_mesh)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    logical, intent(in) :: with_mesh
    type(cursor_t) :: cursor
    type(body_t) :: body
    type(block_t) :: block
    integer :: i

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'BLOCK') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_body_head(cursor, draft, diagnostics, 'BLOCK', size(draft%scene%mesh%sides) + 1, body)
      call read_corners(cursor, block)
      call read_divisions(cursor, block)
      call read_curves(cursor, block)
      call close_card(draft, cursor, deck%cards(i))
      parts%sound = parts%sound .and. .not. cursor%failed()
      parts%even = parts%even .and. all(mod(block%divisions, 2) == 0)
      if (cursor%failed()) block = unit_block()
      block%refinement = draft%mesh_factor
      call append_block(block, with_mesh, head_location(deck%cards(i)), body, draft, parts)
    end do
  end subroutine read_blocks

  !> Stands in for a block that could not be read: its sides exist.
  pure function unit_block() result(block)
    type(block_t) :: block

    block%corners = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp], [2, 4])
  end function unit_block

  subroutine read_corners(cursor, block)
    type(cursor_t), intent(inout) :: cursor
    type(block_t), intent(out) :: block
    real(wp) :: extent
    integer :: k

    call cursor%next_row('the four corners')
    do k = 1, 4
      call read_xy(cursor, 'corner '//to_text(k), block%corners(:, k))
    end do
    if (cursor%failed()) return
    extent = maxval(abs(block%corners))
    do k = 1, 4
      if (length_of(block%corners(:, k) - block%corners(:, mod(k, 4) + 1)) > least_side*extent) cycle
      call cursor%fail('corners '//to_text(k)//' and '//to_text(mod(k, 4) + 1)//' are the same point')
    end do
    if (.not. polygon_area(block%corners) > 0) &
      call cursor%fail('the corners must run counter-clockwise around an area; theirs is ' &
                       //to_text(polygon_area(block%corners)))
  end subroutine read_corners

  subroutine read_divisions(cursor, block)
    type(cursor_t), intent(inout) :: cursor
    type(block_t), intent(inout) :: block
    character(len=*), parameter :: along(2) = ['sides 1 and 3', 'sides 2 and 4']
    integer :: k

    call cursor%next_row('divisions and ratio along sides 1 and 3, divisions and ratio along sides 2 and 4')
    do k = 1, 2
      call cursor%integer('the divisions of '//along(k), block%divisions(k), lower=1, upper=most_divisions)
      call cursor%real('the ratio of last to first element along '//along(k), block%ratios(k), &
                       lower=1/largest_ratio, upper=largest_ratio)
      if (block%divisions(k) == 1 .and. abs(block%ratios(k) - 1) > 0) &
        call cursor%fail('one division has no ratio: expected 1, found '//to_text(block%ratios(k)))
    end do
    call cursor%end_row()
  end subroutine read_divisions

  !> Rows `SIDE k ARC x y` and `SIDE k MID x y`.
  subroutine read_curves(cursor, block)
    type(cursor_t), intent(inout) :: cursor
    type(block_t), intent(inout) :: block
    type(string_t), allocatable :: side_word(:), forms(:)
    integer :: i, k, form

    call words_of('SIDE', side_word)
    call words_of('ARC MID', forms)
    do while (cursor%more_rows())
      call cursor%next_row('SIDE, its number, ARC or MID, and a point')
      call cursor%name('SIDE', side_word, i)
      call cursor%integer('the number of a side', k, lower=1, upper=4)
      if (cursor%failed()) return
      if (block%form(k) /= side_straight) call cursor%fail('side '//to_text(k)//' is given twice')
      call cursor%name('a form of side', forms, form)
      call read_xy(cursor, 'the point', block%point(:, k))
      if (cursor%failed()) return
      block%form(k) = merge(side_arc, side_parabola, form == 1)
      call check_curve(cursor, block%corners(:, k), block%corners(:, mod(k, 4) + 1), block%form(k), block%point(:, k))
    end do
  end subroutine read_curves

  subroutine check_curve(cursor, first, last, form, point)
    type(cursor_t), intent(inout) :: cursor
    real(wp), intent(in) :: first(2), last(2), point(2)
    integer, intent(in) :: form
    real(wp) :: a(2), b(2), share

    a = first - point
    b = last - point
    if (form == side_arc) then
      if (abs(length_of(a) - length_of(b)) > radius_tolerance*max(length_of(a), length_of(b))) then
        call cursor%fail('both ends of an arc must be equally far from its centre: they are at '//to_text(length_of(a), 10) &
                         //' and '//to_text(length_of(b), 10))
      else if (pi - abs(angle_between(a, b)) < half_turn_tolerance) then
        call cursor%fail('an arc of a side must be shorter than half a circle')
      end if
    else
      share = dot_product(point - first, last - first)/dot_product(last - first, last - first)
      if (.not. (share > 0.25_wp .and. share < 0.75_wp)) &
        call cursor%fail('the middle point must lie over the middle half of the side, or the parabola folds; it lies at ' &
                         //to_text(100*share, 4)//' % of it')
    end if
  end subroutine check_curve

  !> Nodes, elements and sides of a block after those that are there.
  subroutine append_block(block, with_mesh, where, body, draft, parts)
    type(block_t), intent(in) :: block
    logical, intent(in) :: with_mesh
    type(location_t), intent(in) :: where
    type(body_t), intent(inout) :: body
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    real(wp), allocatable :: coordinates(:, :)
    integer, allocatable :: sides(:, :)
    type(location_t), allocatable :: places(:)
    type(side_set_t) :: set
    integer :: first(5), k, n, new

    n = size(parts%labels)
    if (with_mesh) then
      call mesh_block(block, coordinates, body%connectivity, first, sides)
    else
      first = 1
      if (allocated(body%connectivity)) deallocate (body%connectivity)
      allocate (body%connectivity(8, 0), coordinates(2, 0), sides(3, 0))
    end if
    new = size(coordinates, 2)
    body%connectivity = body%connectivity + n
    body%across = divisions_of(block, 1)
    if (allocated(body%labels)) deallocate (body%labels, body%location)
    allocate (body%labels(0), body%location(1))
    body%location = where
    parts%bodies = [parts%bodies, body]
    parts%coordinates = reshape([parts%coordinates, coordinates], [2, n + new])
    parts%labels = [parts%labels, spread(0, 1, new)]
    parts%parent = [parts%parent, (n + k, k=1, new)]
    allocate (places(new))
    places = where
    parts%location = [parts%location, places]
    do k = 1, 4
      set%name = body%name//'.'//to_text(k)
      set%nodes = sides(:, first(k):first(k + 1) - 1) + n
      draft%scene%mesh%sides = [draft%scene%mesh%sides, set]
      parts%joined = [parts%joined, location_t()]
    end do
  end subroutine append_block

  !> All JOIN cards: `a i b j` makes side i of block a and side j of block b one.
  subroutine join_blocks(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(inout) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    integer :: i, k, place, side, set(2)

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'JOIN') cycle
      call cursor%open(deck%cards(i), diagnostics)
      set = 0
      do k = 1, 2
        call draft%places%find(cursor, 'the name of a BLOCK', place, of='BLOCK')
        if (place > 0) then
          if (draft%places%keywords(place)%s /= 'BLOCK') &
            call cursor%fail(''''//draft%places%words(place)%s//''' is a '//draft%places%keywords(place)%s//', expected a BLOCK')
        end if
        call cursor%integer('one of its sides', side, lower=1, upper=4)
        if (cursor%failed()) exit
        set(k) = draft%places%item(place) + side - 1
        if (parts%joined(set(k))%line > 0) &
          call cursor%fail('side '//to_text(side)//' of '''//draft%places%words(place)%s//''' is already joined at ' &
                           //diagnostics%place(parts%joined(set(k))))
        parts%joined(set(k)) = cursor%where()
      end do
      call cursor%end_row()
      if (parts%sound) call join_sides(cursor, draft%scene%mesh%sides(max(set(1), 1))%nodes, &
                                       draft%scene%mesh%sides(max(set(2), 1))%nodes, parts)
      call close_card(draft, cursor, deck%cards(i))
      parts%sound = parts%sound .and. .not. cursor%failed()
    end do
  end subroutine join_blocks

  !> Merge the nodes of two sides, the second traversed backwards.
  subroutine join_sides(cursor, a, b, parts)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: a(:, :), b(:, :)
    type(mesh_parts_t), intent(inout) :: parts
    real(wp) :: length, distance, worst
    integer :: k, i, n

    if (cursor%failed()) return
    n = size(a, 2)
    if (size(b, 2) /= n) then
      call cursor%fail('the sides have '//to_text(n)//' and '//to_text(size(b, 2))//' divisions, they must have the same number')
      return
    end if
    length = 0
    worst = 0
    do k = 1, n
      length = length + length_of(parts%coordinates(:, a(3, k)) - parts%coordinates(:, a(1, k)))
      do i = 1, 3
        distance = length_of(parts%coordinates(:, a(i, k)) - parts%coordinates(:, b(4 - i, n + 1 - k)))
        worst = max(worst, distance)
      end do
    end do
    if (worst > join_tolerance*length) then
      call cursor%fail('the nodes of the two sides do not coincide: two of them are '//to_text(worst)//' apart')
      return
    end if
    do k = 1, n
      do i = 1, 3
        call merge_nodes(parts%parent, a(i, k), b(4 - i, n + 1 - k))
      end do
    end do
  end subroutine join_sides

end module cards_blocks
