!> DIE cards whose dies are sides of bodies: deformable dies.
module cards_side_dies
  use card_places, only: read_sides
  use cards_sides, only: refuse_inner_sides
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use dies, only: is_deformable, place_on_nodes
  use fields, only: displacement_field, find_field
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t
  implicit none
  private
  public :: read_side_dies, curve_of_sides

contains

  !> The rest of the cards `DIE name SIDES place ...`, now that there are sides; their dies have been numbered with the others.
  subroutine read_side_dies(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: words(:)
    character(len=:), allocatable :: name, label
    integer, allocatable :: sides(:, :), more(:, :)
    integer :: i, k, n, field

    n = 0
    field = displacement_field
    if (draft%groups_sound) then
      ! in a scene of heat alone
      if (.not. draft%scene%fields(field)%declared) field = find_field(draft%scene%fields, 'temperature')
    end if
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'DIE') cycle
      n = n + 1
      if (.not. is_deformable(draft%scene%dies(n))) cycle
      call cursor%open(deck%cards(i), diagnostics)
      call cursor%word('the name of the die', name)
      call words_of('SIDES', words)
      call cursor%name('SIDES', words, k)
      if (allocated(sides)) deallocate (sides)
      allocate (sides(3, 0))
      do
        call read_sides(cursor, draft, huge(k), label, more, field=field)
        call refuse_inner_sides(cursor, draft, more)
        sides = reshape([sides, more], [3, size(sides, 2) + size(more, 2)])
        if (cursor%failed() .or. .not. cursor%more()) exit
      end do
      associate (die => draft%scene%dies(n))
        call curve_of_sides(sides, die%nodes)
        if (size(die%nodes, 2) < size(sides, 2)) then
          call cursor%fail('the sides of a die follow one another in one curve; some of these touch no other, or three meet')
        end if
        if (allocated(die%pieces)) deallocate (die%pieces)
        allocate (die%pieces(2, 3, size(die%nodes, 2)))
        call place_on_nodes(draft%scene%mesh%coordinates, die)
      end associate
      call close_card(draft, cursor, deck%cards(i))
    end do
  end subroutine read_side_dies

  !> Sides end to end, each and all in the sense of a die: along it, its body is on the right. A closed curve begins
  !> with the first side given. Sides that do not follow are left out.
  pure subroutine curve_of_sides(sides, curve)
    integer, intent(in) :: sides(:, :)                  !! (3, n), traversed with their body on the left
    integer, allocatable, intent(out) :: curve(:, :)    !! (3, m)
    logical :: taken(size(sides, 2))
    integer :: order(size(sides, 2)), k, n

    n = 0
    taken = .false.
    ! an open curve begins where no side follows along the contour of the body
    do k = 1, size(sides, 2)
      if (.not. any(sides(1, :) == sides(3, k))) exit
    end do
    if (k > size(sides, 2)) k = min(1, size(sides, 2))
    do while (k > 0)
      n = n + 1
      order(n) = k
      taken(k) = .true.
      k = findloc(sides(3, :) == sides(1, k) .and. .not. taken, .true., dim=1)
    end do
    curve = sides([3, 2, 1], order(:n))
  end subroutine curve_of_sides

end module cards_side_dies
