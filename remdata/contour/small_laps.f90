!> Small laps of a free contour: loops no longer than an element or two, where a crevice has closed over its ground or a short side
!> has turned over.
!>
!> Such a contour crosses itself, and no mesh resolves what is in the loop, nor does the old mesh what is between two sides of it
!> with no more than one between them, where the body lies upon itself. It is cut off where the contour crosses itself: the matter
!> has met there, and the contour goes on from one flank to the other. Where one set of sides ends in the loop and another begins,
!> as at the corner of a billet that has folded, both end there. The volume is restored with that of the contacts.
module small_laps
  use arc_crossings, only: crossings_between, extent, most_crossings, touching
  use boundary_curves, only: boundary_curve_t
  use contour_contacts, only: contact_t
  use folded_sides, only: fold_t
  use kinds, only: wp
  use offset_parabolas, only: length_between, point_at
  use plane_vectors, only: cross
  use short_free_sides, only: is_free, redrawn, remove_arcs
  use side_tags, only: same_supports, same_tags, side_tags_t
  use vectors, only: length_of
  implicit none
  private
  public :: cut_small_laps

  !> A loop from arc `first` at xi(1) to arc `last` at xi(2).
  type :: loop_of_lap_t
    integer :: first = 0, last = 0
    real(wp) :: xi(2) = 0.0_wp, length = 0.0_wp
    real(wp) :: point(2) = 0.0_wp   !! where the contour crosses itself [length]
  end type loop_of_lap_t

  !> Loops of so many sides of the old mesh between the two that cross are cut off, however long they are, where the body lies upon
  !> itself: not where it has thinned to nothing before a tip.
  integer, parameter :: most_between = 1

contains

  !> Cut off all loops up to a length; each is added to the list as a fold from where the contour crosses itself to its ground.
  pure subroutine cut_small_laps(longest, tags, contacts, boundary, laps)
    real(wp), intent(in) :: longest   !! [length]
    type(side_tags_t), intent(in) :: tags
    type(contact_t), intent(inout) :: contacts(:)   !! (ncontact) their arcs are renumbered
    type(boundary_curve_t), intent(inout) :: boundary
    type(fold_t), allocatable, intent(inout) :: laps(:)   !! (nlap)
    type(loop_of_lap_t) :: lap
    integer :: pass

    ! each takes an arc away, or a part of two
    do pass = 1, size(boundary%arcs)
      call find_loop(longest, tags, boundary, lap)
      if (lap%first == 0) return
      call cut_off(lap, contacts, boundary, laps)
    end do
  end subroutine cut_small_laps

  !> The first loop of free arcs of one set of tags, or of one and then another with the same supports; its `first` is 0 where
  !> there is none.
  pure subroutine find_loop(longest, tags, boundary, lap)
    real(wp), intent(in) :: longest
    type(side_tags_t), intent(in) :: tags
    type(boundary_curve_t), intent(in) :: boundary
    type(loop_of_lap_t), intent(out) :: lap
    real(wp) :: xi(2, most_crossings), between, length, point(2)
    integer :: i, k, n, c, other

    do i = 1, size(boundary%arcs)
      if (.not. is_free(boundary%arcs(i))) cycle
      between = 0
      other = boundary%arcs(i)%side
      k = mod(i, size(boundary%arcs)) + 1
      do while (k /= i .and. (between <= longest .or. sides_between(i, k) <= most_between))
        if (.not. is_free(boundary%arcs(k))) exit
        if (.not. same_supports(tags, boundary%arcs(i)%side, boundary%arcs(k)%side)) exit
        if (.not. same_tags(tags, other, boundary%arcs(k)%side)) then
          if (.not. same_tags(tags, other, boundary%arcs(i)%side)) exit
          other = boundary%arcs(k)%side
        end if
        associate (one => boundary%arcs(i), two => boundary%arcs(k))
          call crossings_between(one, two, n, xi, at_ends=.true.)
          do c = 1, n
            point = point_at(one, xi(1, c))
            ! the joint of two arcs that follow each other is no crossing
            if (max(length_of(point_at(one, one%range(2)) - point), length_of(point_at(two, two%range(1)) - point)) &
                <= touching*max(extent(one), extent(two))) cycle
            length = length_between(one, xi(1, c), one%range(2)) + between + length_between(two, two%range(1), xi(2, c))
            ! the outermost of loops within each other
            if (length < lap%length) cycle
            if (length > longest) then
              if (sides_between(i, k) > most_between .or. .not. area_within(boundary, i, k, xi(:, c)) > 0) cycle
            end if
            lap = loop_of_lap_t(i, k, xi(:, c), length, point)
          end do
          between = between + length_between(two, two%range(1), two%range(2))
        end associate
        k = mod(k, size(boundary%arcs)) + 1
      end do
      if (lap%first > 0) return
    end do

  contains

    !> Sides of the old mesh between that of an arc and that of another one behind it; -1 where they are one side.
    pure function sides_between(from, to) result(number)
      integer, intent(in) :: from, to
      integer :: number

      number = modulo(boundary%arcs(to)%side - boundary%arcs(from)%side, size(tags%on_wall)) - 1
    end function sides_between

  end subroutine find_loop

  !> Area within a loop, positive where the contour walks around it counter-clockwise, as around the body: there the body lies upon
  !> itself.
  pure function area_within(boundary, first, last, xi) result(area)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: first, last   !! arcs that cross
    real(wp), intent(in) :: xi(2)        !! where they do
    real(wp) :: area                     !! [length**2]
    integer, parameter :: parts = 8
    real(wp) :: origin(2), from(2), to(2), range(2)
    integer :: k, i

    area = 0
    origin = point_at(boundary%arcs(first), xi(1))
    from = origin
    k = first
    do
      range = boundary%arcs(k)%range
      if (k == first) range(1) = xi(1)
      if (k == last) range(2) = xi(2)
      do i = 1, parts
        to = point_at(boundary%arcs(k), range(1) + (range(2) - range(1))*i/parts)
        area = area + 0.5_wp*cross(from - origin, to - origin)
        from = to
      end do
      if (k == last) return
      k = mod(k, size(boundary%arcs)) + 1
    end do
  end function area_within

  pure subroutine cut_off(lap, contacts, boundary, laps)
    type(loop_of_lap_t), intent(in) :: lap
    type(contact_t), intent(inout) :: contacts(:)
    type(boundary_curve_t), intent(inout) :: boundary
    type(fold_t), allocatable, intent(inout) :: laps(:)
    logical :: dropped(size(boundary%arcs))
    type(fold_t) :: fold
    integer :: k

    fold%from = lap%point
    fold%length = 0.5_wp*lap%length
    associate (one => boundary%arcs(lap%first))
      fold%to = point_at(one, one%range(2))
      one%range(2) = lap%xi(1)
      one = redrawn(one, lap%point, 2)
    end associate
    associate (one => boundary%arcs(lap%last))
      one%range(1) = lap%xi(2)
      one = redrawn(one, lap%point, 1)
    end associate
    laps = [laps, fold]
    dropped = .false.
    k = mod(lap%first, size(dropped)) + 1
    do while (k /= lap%last)
      dropped(k) = .true.
      k = mod(k, size(dropped)) + 1
    end do
    call remove_arcs(dropped, contacts, boundary)
  end subroutine cut_off

end module small_laps
