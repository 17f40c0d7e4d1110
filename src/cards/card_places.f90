!> Places on cards: sides of a block, a set of sides, `NODE label`, `POINT x y`, a die.
module card_places
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t
  use dies, only: is_deformable
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use kinds, only: wp
  use mesh, only: nearest_node, nodes_of_sides
  use mesh_parts, only: find_label
  use remesher_options, only: has_zones
  use scene_draft, only: draft_t, words_of
  use text, only: string_t, to_text
  implicit none
  private
  public :: place_t, read_sides, read_place, read_rigid_die, numbers_after_name, node_text

  !> `POINT x y` means the node there; one further off than this share of the mesh's size is a typing error.
  real(wp), parameter :: point_tolerance = 1.0e-3_wp

  type :: place_t
    !> As listings name it: `billet.2+3`.
    character(len=:), allocatable :: label
    !> The die, 0 when the place is on the mesh.
    integer :: die = 0
    !> Nodes of the place, each once.
    integer, allocatable :: nodes(:)
  end type place_t

contains

  !> Numbers that follow the first field of a card.
  pure function numbers_after_name(card) result(n)
    type(card_t), intent(in) :: card
    integer :: n

    n = 0
    do while (n + 2 <= size(card%head%fields))
      if (.not. card%head%fields(n + 2)%numeric) exit
      n = n + 1
    end do
  end function numbers_after_name

  !> A set of sides that move, or have another field: the name of a SIDES card, or that of a block and its sides.
  subroutine read_sides(cursor, draft, most, label, sides, field)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: most                          !! so many numbers at most belong to the place
    character(len=:), allocatable, intent(out) :: label
    integer, allocatable, intent(out) :: sides(:, :)     !! (3, n), empty while the mesh has mistakes
    integer, intent(in), optional :: field               !! that they must have; without it the displacement
    integer, allocatable :: nodes(:)
    integer :: k, f

    label = ''
    f = displacement_field
    if (present(field)) f = field
    allocate (sides(3, 0))
    call draft%places%find(cursor, 'a BLOCK or a set of sides', k)
    if (k == 0) return
    call read_sides_of(cursor, draft, k, most, label, sides)
    call nodes_of_sides(sides, size(draft%scene%mesh%labels), nodes)
    if (f > 0) call refuse_without_field(cursor, draft, f, nodes, label, own=.true.)
  end subroutine read_sides

  !> What follows the name of a place made of sides.
  subroutine read_sides_of(cursor, draft, place, most, label, sides)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: place
    integer, intent(in) :: most   !! so many numbers at most belong to the place
    character(len=:), allocatable, intent(inout) :: label
    integer, allocatable, intent(inout) :: sides(:, :)
    character(len=:), allocatable :: rest
    logical, allocatable :: given(:)
    integer :: side, n, most_sides

    label = draft%places%words(place)%s
    select case (draft%places%keywords(place)%s)
    case ('SIDES')
      call add_sides(draft%places%item(place))
      if (most > 0 .and. cursor%next_is_number()) &
        call cursor%fail(''''//label//''' is a set of sides, no numbers of sides may follow it')
    case ('BLOCK', 'BODY')
      most_sides = number_of_sides(draft, place)
      allocate (given(most_sides), source=.false.)
      n = 0
      do while (cursor%next_is_number() .and. n < most)
        call cursor%integer('a side of the '//trim(merge('block', 'body ', draft%places%keywords(place)%s == 'BLOCK')), &
                            side, lower=1, upper=most_sides)
        if (cursor%failed()) return
        if (given(side)) call cursor%fail('side '//to_text(side)//' is given twice')
        given(side) = .true.
        n = n + 1
        label = label//trim(merge('.', '+', n == 1))//to_text(side)
        call add_sides(draft%places%item(place) + side - 1)
      end do
      if (n > 0) return
      rest = ''
      if (cursor%next_is_number()) rest = '; the two numbers before the multiplier are npoint and the amplitude'
      call cursor%fail(''''//label//''' is a '//draft%places%keywords(place)%s &
                       //': expected the numbers of its sides (1 to '//to_text(most_sides)//') after it'//rest)
    case default
      call cursor%fail(''''//label//''' is a '//draft%places%keywords(place)%s//', expected a BLOCK or a set of sides')
    end select

  contains

    !> The sides of a set but those that are there: a cut (TRIM, PIERC) that leads from one set to another belongs to both.
    subroutine add_sides(set)
      integer, intent(in) :: set
      integer :: there, i

      associate (more => draft%scene%mesh%sides(set)%nodes)
        if (.not. draft%mesh_sound) return
        there = size(sides, 2)
        do i = 1, merge(size(more, 2), 0, there > 0)
          if (any(sides(1, :there) == more(1, i) .and. sides(2, :there) == more(2, i))) cycle
          sides = reshape([sides, more(:, i)], [3, size(sides, 2) + 1])
        end do
        if (there == 0) sides = more
        if (has_zones(draft%scene%remesher) .and. any(draft%sharing(more(2, :)) > 1)) &
          call cursor%fail('with ZONE cards a new mesh has other sides inside the part: expected sides on its boundary')
      end associate
    end subroutine add_sides

  end subroutine read_sides_of

  !> Sides of a block or body: sets that follow one another, NAME.1, NAME.2 ...
  pure function number_of_sides(draft, place) result(n)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: place
    integer :: n

    n = 0
    associate (sets => draft%scene%mesh%sides, first => draft%places%item(place))
      do while (first + n <= size(sets))
        if (sets(first + n)%name /= draft%places%words(place)%s//'.'//to_text(n + 1)) exit
        n = n + 1
      end do
    end associate
  end function number_of_sides

  !> Any place; a die only where `dies` allows it. Nodes are empty while the mesh has mistakes.
  subroutine read_place(cursor, draft, dies, place)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    logical, intent(in) :: dies
    type(place_t), intent(out) :: place
    type(string_t), allocatable :: forms(:)
    integer, allocatable :: sides(:, :)
    integer :: k

    place%label = ''
    allocate (place%nodes(0), sides(3, 0))
    select case (cursor%peek_word())
    case ('NODE', 'POINT')
      call words_of('NODE POINT', forms)
      call cursor%name('a place', forms, k)
      if (k == 1) call read_labelled_node(cursor, draft, place)
      if (k == 2) call read_point(cursor, draft, place)
    case default
      if (dies) then
        call draft%places%find(cursor, 'a place', k)
      else
        call draft%places%find(cursor, 'a place', k, not_of='DIE')
      end if
      if (k == 0) return
      if (dies .and. draft%places%keywords(k)%s == 'DIE') then
        place%label = draft%places%words(k)%s
        place%die = draft%places%item(k)
      else
        call read_sides_of(cursor, draft, k, huge(k), place%label, sides)
        call nodes_of_sides(sides, size(draft%scene%mesh%labels), place%nodes)
      end if
    end select
  end subroutine read_place

  subroutine read_labelled_node(cursor, draft, place)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(place_t), intent(inout) :: place
    integer :: label, k

    call cursor%integer('the label of a node', label, lower=1)
    if (cursor%failed()) return
    place%label = 'node '//to_text(label)
    k = find_label(draft%sorted_labels, label)
    if (k == 0) then
      call cursor%fail('no NODES card has node '//to_text(label)//' (nodes of blocks are named by POINT x y)')
    else if (draft%mesh_sound) then
      place%nodes = [draft%labelled_nodes(k)]
    end if
  end subroutine read_labelled_node

  subroutine read_point(cursor, draft, place)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(place_t), intent(inout) :: place
    real(wp) :: x(2), distance
    integer :: node

    call read_xy(cursor, 'the point', x)
    if (cursor%failed() .or. .not. draft%mesh_sound) return
    call nearest_node(draft%scene%mesh%origin, x, node, distance)
    if (node == 0) return
    place%nodes = [node]
    place%label = 'point '//to_text(x(1))//' '//to_text(x(2))
    if (distance > point_tolerance*draft%mesh_size .and. draft%scene%generation == 1) &
      call cursor%fail('there is no node at this point; the nearest is '//node_text(draft, node)//', '//to_text(distance)//' away')
  end subroutine read_point

  !> A die that is not made of sides, by its name; 0 where it is none.
  subroutine read_rigid_die(cursor, draft, die, instead)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    integer, intent(out) :: die
    character(len=*), intent(in), optional :: instead   !! what to write where it is made of sides
    character(len=:), allocatable :: advice
    integer :: k

    die = 0
    advice = ''
    if (present(instead)) advice = ': use '//instead
    call draft%places%find(cursor, 'the name of a die', k, of='DIE')
    if (k == 0) return
    if (draft%places%keywords(k)%s /= 'DIE') then
      call cursor%fail(''''//draft%places%words(k)%s//''' is no DIE')
    else if (is_deformable(draft%scene%dies(draft%places%item(k)))) then
      call cursor%fail('the DIE '''//draft%places%words(k)%s//''' is deformable'//advice)
    else
      die = draft%places%item(k)
    end if
  end subroutine read_rigid_die

  !> A node for messages: label and coordinates.
  pure function node_text(draft, node) result(s)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: node
    character(len=:), allocatable :: s

    associate (mesh => draft%scene%mesh)
      s = 'node '//to_text(mesh%labels(node))//' at '//to_text(mesh%coordinates(1, node))//' ' &
          //to_text(mesh%coordinates(2, node))
    end associate
  end function node_text

end module card_places
