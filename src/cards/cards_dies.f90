!> DIE cards: segments, parabolas and arcs, end to end. Those of sides of bodies are read when there is a mesh.
module cards_dies
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use dies, only: die_t, finish_die
  use kinds, only: pi, wp
  use scene_draft, only: close_card, draft_t, words_of
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_dies, arc_pieces

  !> A piece begins where the last one ended, to this share of the die's size.
  real(wp), parameter :: gap_tolerance = 1.0e-9_wp
  !> More parabolas for one arc are a slip of the finger.
  integer, parameter :: most_parabolas = 10000
  !> The middle point of a parabola lies over the middle half of its chord, or the parabola folds.
  real(wp), parameter :: middle_half(2) = [0.25_wp, 0.75_wp]

contains

  !> All DIE cards, in the order of the deck.
  subroutine read_dies(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: forms(:)
    type(die_t), allocatable :: dies(:)
    type(die_t) :: die
    integer :: i, n

    call words_of('SEGM PARAB ARC', forms)
    allocate (dies(size(deck%cards)))
    n = 0
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'DIE') cycle
      n = n + 1
      call cursor%open(deck%cards(i), diagnostics)
      call draft%places%define(cursor, 'the name of the die', 'DIE', n, diagnostics, die%name)
      if (cursor%peek_word() == 'SIDES') then
        ! its sides are looked up when there is a mesh (cards_side_dies)
        dies(n)%name = die%name
        allocate (dies(n)%nodes(3, 0))
        cycle
      end if
      call read_pilot(cursor, die%pilot)
      if (allocated(die%pieces)) deallocate (die%pieces)
      allocate (die%pieces(2, 3, 0))
      call cursor%next_row('SEGM, PARAB or ARC and its points')
      do while (.not. cursor%failed())
        call read_piece(cursor, forms, die)
        if (.not. cursor%more_rows()) exit
        call cursor%next_row('a piece')
      end do
      call close_card(draft, cursor, deck%cards(i))
      call finish_die(die)
      dies(n) = die
    end do
    draft%scene%dies = dies(:n)
  end subroutine read_dies

  subroutine read_pilot(cursor, pilot)
    type(cursor_t), intent(inout) :: cursor
    real(wp), intent(out) :: pilot(3)
    type(string_t), allocatable :: words(:)
    integer :: k

    pilot = 0
    if (.not. cursor%more()) return
    call words_of('PILOT', words)
    call cursor%name('PILOT, SIDES or the end of the line', words, k)
    call read_xy(cursor, 'the pilot', pilot(1:2))
  end subroutine read_pilot

  !> One row: a form, its points, for an arc its tolerance.
  subroutine read_piece(cursor, forms, die)
    type(cursor_t), intent(inout) :: cursor
    type(string_t), intent(in) :: forms(:)
    type(die_t), intent(inout) :: die
    real(wp) :: first(2), middle(2), last(2), tolerance, gap, size_of_die, share
    real(wp), allocatable :: pieces(:, :, :)
    character(len=:), allocatable :: message
    integer :: form, n

    call cursor%name('a form of piece', forms, form)
    call read_xy(cursor, 'the first point', first)
    n = size(die%pieces, 3)
    if (n > 0 .and. .not. cursor%failed()) then
      gap = norm2(first - die%pieces(:, 3, n))
      size_of_die = max(maxval(abs(die%pieces)), maxval(abs(first)))
      if (gap > gap_tolerance*size_of_die) &
        call cursor%fail('the piece must begin where the last one ended, at '//to_text(die%pieces(1, 3, n), 10)//' ' &
                         //to_text(die%pieces(2, 3, n), 10)//'; it begins '//to_text(gap)//' away from there')
      first = die%pieces(:, 3, n)
    end if
    middle = 0
    if (form > 1) call read_xy(cursor, 'the middle point', middle)
    call read_xy(cursor, 'the last point', last)
    if (form == 3) call cursor%real('the tolerance of the arc', tolerance, lower=0.0_wp, strict_lower=.true., unit='length')
    if (cursor%failed()) return
    if (.not. norm2(last - first) > gap_tolerance*max(maxval(abs(first)), maxval(abs(last)))) then
      call cursor%fail('the piece ends where it begins')
      return
    end if
    select case (form)
    case (1)
      pieces = reshape([first, 0.5_wp*(first + last), last], [2, 3, 1])
    case (2)
      share = dot_product(middle - first, last - first)/dot_product(last - first, last - first)
      if (.not. (share > middle_half(1) .and. share < middle_half(2))) &
        call cursor%fail('the middle point must lie over the middle half of the chord, or the parabola folds; it lies at ' &
                         //to_text(100*share, 4)//' % of it')
      pieces = reshape([first, middle, last], [2, 3, 1])
    case default
      call arc_pieces(first, middle, last, tolerance, pieces, message)
      if (message /= '') call cursor%fail(message)
    end select
    if (cursor%failed()) return
    die%pieces = reshape([die%pieces, pieces], [2, 3, n + size(pieces, 3)])
  end subroutine read_piece

  !> Equal parabolas along the arc through three points, as few as stay within `tolerance` of the circle.
  !>
  !> With its ends at angles -a, a and its middle at 0 the isoparametric parabola has
  !> r(xi)^2/R^2 = 1 - (1 - cos a)^2 xi^2 (1 - xi^2): it is inside the circle, by most at xi^2 = 1/2.
  pure subroutine arc_pieces(first, middle, last, tolerance, pieces, message)
    real(wp), intent(in) :: first(2), middle(2), last(2)   !! [length]
    real(wp), intent(in) :: tolerance                       !! > 0 [length]
    real(wp), allocatable, intent(out) :: pieces(:, :, :)   !! (2, 3, npiece)
    character(len=:), allocatable, intent(out) :: message   !! empty when all is well
    real(wp) :: a(2), b(2), area, centre(2), radius, turn, start
    integer :: n, k

    message = ''
    a = middle - first
    b = last - first
    area = a(1)*b(2) - a(2)*b(1)
    if (norm2(a) > 0) then
      if (abs(area) > gap_tolerance*norm2(a)*norm2(b)) then
        centre = first + [b(2)*dot_product(a, a) - a(2)*dot_product(b, b), &
                          a(1)*dot_product(b, b) - b(1)*dot_product(a, a)]/(2*area)
        radius = norm2(first - centre)
        ! The way round that passes through the middle point.
        turn = angle_between(first - centre, last - centre)
        if (area > 0 .and. turn < 0) turn = turn + 2*pi
        if (area < 0 .and. turn > 0) turn = turn - 2*pi
        n = 1
        do while (n <= most_parabolas)
          if (abs(turn)/n <= pi .and. deviation(abs(turn)/(2*n))*radius <= tolerance) exit
          n = n + 1
        end do
        if (n > most_parabolas) then
          message = 'the arc would take more than '//to_text(most_parabolas)//' parabolas: the tolerance is too small'
          return
        end if
        start = atan2(first(2) - centre(2), first(1) - centre(1))
        allocate (pieces(2, 3, n))
        do k = 1, n
          pieces(:, 1, k) = on_circle(start + (k - 1)*turn/n)
          pieces(:, 2, k) = on_circle(start + (k - 0.5_wp)*turn/n)
          pieces(:, 3, k) = on_circle(start + k*turn/n)
        end do
        pieces(:, 1, 1) = first
        pieces(:, 3, n) = last
        return
      end if
    end if
    message = 'the three points of the arc lie on a line'

  contains

    pure function on_circle(angle) result(x)
      real(wp), intent(in) :: angle
      real(wp) :: x(2)

      x = centre + radius*[cos(angle), sin(angle)]
    end function on_circle

  end subroutine arc_pieces

  !> Largest distance from the circle, over the radius, of a parabola over twice the angle a.
  pure function deviation(a) result(d)
    real(wp), intent(in) :: a
    real(wp) :: d
    real(wp) :: q

    q = 0.25_wp*(2*sin(0.5_wp*a)**2)**2
    d = q/(1 + sqrt(1 - q))
  end function deviation

  !> Turn from a to b, between -pi and pi.
  pure function angle_between(a, b) result(angle)
    real(wp), intent(in) :: a(2), b(2)
    real(wp) :: angle

    angle = atan2(a(1)*b(2) - a(2)*b(1), dot_product(a, b))
  end function angle_between

end module cards_dies
