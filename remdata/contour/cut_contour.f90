!> The contour of a piece of a body that was cut: with the tags of its sides, and with its contact intervals.
!>
!> The cut surface belongs to the sets of the sides at both its ends, but not of those that are held, are a die of another body or
!> lie on a wall: what a tool or a furnace does to the surface beside the cut it does to the cut surface too.
module cut_contour
  use arcs, only: arc_t
  use contour_contacts, only: contact_t
  use contour_volume, only: volume_inside
  use corrected_contours, only: contour_t
  use cut_pieces, only: piece_t
  use kinds, only: wp
  use loop_intervals, only: side_point_t
  use offset_parabolas, only: closest_xi, point_at
  use side_tags, only: side_tags_t
  use vectors, only: length_of
  implicit none
  private
  public :: contour_of_piece

contains

  pure function contour_of_piece(contours, piece, x, axisymmetric) result(contour)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour) before the cut
    type(piece_t), intent(in) :: piece
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) nodes now [length]
    logical, intent(in) :: axisymmetric
    type(contour_t) :: contour
    integer :: offset(size(contours)), main, c, k, n, nside

    main = outermost(contours, piece, axisymmetric)
    contour = contours(main)
    contour%boundary = piece%boundary
    ! sides of all contours it comes from, those of its own first
    offset = 0
    nside = size(contours(main)%tags%on_axis)
    do c = 1, size(contours)
      if (c == main .or. all(piece%contour /= c)) cycle
      offset(c) = nside
      nside = nside + size(contours(c)%tags%on_axis)
      call add_tags(contours(c)%tags, contour%tags)
    end do
    n = size(piece%arc)
    associate (arcs => contour%boundary%arcs)
      do k = 1, n
        if (piece%contour(k) == 0) cycle
        arcs(k)%side = arcs(k)%side + offset(piece%contour(k))
        if (piece%contour(k) /= main) arcs(k)%interval = 0
      end do
      do k = 1, n
        if (piece%contour(k) > 0) cycle
        call add_cut_tags([arcs(modulo(k - 2, n) + 1)%side, arcs(mod(k, n) + 1)%side], contour%tags)
        nside = nside + 1
        arcs(k)%side = nside
      end do
    end associate
    call keep_contacts(contours(main), piece, x, contour)
    contour%volume_after = volume_inside(contour%boundary, axisymmetric)
    contour%volume_before = contour%volume_after
  end function contour_of_piece

  !> The contour around the body, of those that a piece comes from; holes have negative volumes.
  pure function outermost(contours, piece, axisymmetric) result(main)
    type(contour_t), intent(in) :: contours(:)
    type(piece_t), intent(in) :: piece
    logical, intent(in) :: axisymmetric
    integer :: main
    real(wp) :: volume(size(contours))
    integer :: c

    do c = 1, size(contours)
      volume(c) = volume_inside(contours(c)%boundary, axisymmetric)
    end do
    main = maxloc(volume, 1, [(any(piece%contour == c), c=1, size(contours))])
  end function outermost

  pure subroutine add_tags(more, tags)
    type(side_tags_t), intent(in) :: more
    type(side_tags_t), intent(inout) :: tags

    call add_columns(more%on_set, tags%on_set)
    call add_columns(more%on_group, tags%on_group)
    call add_columns(more%on_fixation, tags%on_fixation)
    call add_columns(more%on_die, tags%on_die)
    tags%on_axis = [tags%on_axis, more%on_axis]
    tags%on_wall = [tags%on_wall, more%on_wall]
  end subroutine add_tags

  pure subroutine add_columns(more, flags)
    logical, intent(in) :: more(:, :)
    logical, allocatable, intent(inout) :: flags(:, :)
    logical, allocatable :: wider(:, :)
    integer :: n

    n = size(flags, 2)
    allocate (wider(size(flags, 1), n + size(more, 2)))
    wider(:, :n) = flags
    wider(:, n + 1:) = more
    call move_alloc(wider, flags)
  end subroutine add_columns

  !> Tags of a side along the cut, from those of the sides at both its ends.
  pure subroutine add_cut_tags(ends, tags)
    integer, intent(in) :: ends(2)
    type(side_tags_t), intent(inout) :: tags
    logical, allocatable :: on_set(:, :), on_group(:, :)
    integer :: k

    allocate (on_set(size(tags%on_set, 1), 1), on_group(size(tags%on_group, 1), 1), source=.false.)
    do k = 1, 2
      associate (side => ends(k))
        if (any(tags%on_fixation(:, side)) .or. any(tags%on_die(:, side)) .or. tags%on_wall(side)) cycle
        on_set(:, 1) = on_set(:, 1) .or. tags%on_set(:, side)
        on_group(:, 1) = on_group(:, 1) .or. tags%on_group(:, side)
      end associate
    end do
    call add_columns(on_set, tags%on_set)
    call add_columns(on_group, tags%on_group)
    call add_columns(reshape(spread(.false., 1, size(tags%on_fixation, 1)), [size(tags%on_fixation, 1), 1]), tags%on_fixation)
    call add_columns(reshape(spread(.false., 1, size(tags%on_die, 1)), [size(tags%on_die, 1), 1]), tags%on_die)
    tags%on_axis = [tags%on_axis, .false.]
    tags%on_wall = [tags%on_wall, .false.]
  end subroutine add_cut_tags

  !> Contact intervals of which one run of arcs is left; where the cut goes through one it begins or ends there. Others are dropped:
  !> the solver finds the contact again.
  pure subroutine keep_contacts(before, piece, x, contour)
    type(contour_t), intent(in) :: before
    type(piece_t), intent(in) :: piece
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(inout) :: contour
    type(contact_t), allocatable :: contacts(:)
    integer :: number(size(before%contacts)), k, i, n, first, last

    n = size(piece%arc)
    number = 0
    allocate (contacts(0))
    do k = 1, size(before%contacts)
      associate (of_interval => contour%boundary%arcs%interval == k)
        if (count(of_interval .and. .not. cshift(of_interval, -1)) /= 1) cycle
        first = findloc(of_interval .and. .not. cshift(of_interval, -1), .true., 1)
        last = findloc(of_interval .and. .not. cshift(of_interval, 1), .true., 1)
      end associate
      contacts = [contacts, before%contacts(k)]
      number(k) = size(contacts)
      associate (contact => contacts(size(contacts)), arcs => contour%boundary%arcs)
        contact%first = first
        contact%next = mod(last, n) + 1
        if (piece%arc(modulo(first - 2, n) + 1) == 0) then
          contact%interval%from = side_point_at(before, contact%interval%from, contact%interval%to, x, &
                                                point_at(arcs(first), arcs(first)%range(1)))
          contact%interval%found(1) = contact%interval%from
        end if
        if (piece%arc(mod(last, n) + 1) == 0) then
          contact%interval%to = side_point_at(before, contact%interval%from, contact%interval%to, x, &
                                              point_at(arcs(last), arcs(last)%range(2)))
          contact%interval%found(2) = contact%interval%to
        end if
      end associate
    end do
    do i = 1, n
      associate (arc => contour%boundary%arcs(i))
        if (arc%interval > 0) arc%interval = number(arc%interval)
      end associate
    end do
    call move_alloc(contacts, contour%contacts)
  end subroutine keep_contacts

  !> The point of the sides of an interval closest to a point.
  pure function side_point_at(contour, from, to, x, point) result(closest)
    type(contour_t), intent(in) :: contour
    type(side_point_t), intent(in) :: from, to
    real(wp), intent(in) :: x(:, :), point(2)
    type(side_point_t) :: closest
    type(arc_t) :: part
    real(wp) :: xi, distance, least
    integer :: side

    least = huge(least)
    do side = from%side, to%side
      part%points = x(:, contour%loop%sides(:, modulo(side - 1, size(contour%loop%sides, 2)) + 1))
      part%range = [-1.0_wp, 1.0_wp]
      if (side == from%side) part%range(1) = from%xi
      if (side == to%side) part%range(2) = to%xi
      xi = closest_xi(part, point)
      distance = length_of(point_at(part, xi) - point)
      if (.not. distance < least) cycle
      least = distance
      closest = side_point_t(side, xi)
    end do
  end function side_point_at

end module cut_contour
