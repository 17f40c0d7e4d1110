!> Parts of a body that are thin, and the direction along them.
!>
!> From points along the contours the thickness is measured inwards, across to where the contour comes back in about the opposite
!> direction: the distance between both, as a medial axis has it where they are parallel (H. Blum, in: Models for the Perception of
!> Speech and Visual Form, MIT Press, 1967, 362-380). A part of few elements across is thin; the direction along it is that of the
!> contour nearest by.
module thin_parts
  use arcs, only: arc_t
  use box_tree, only: box_tree_t, build_tree, items_meeting, nearest_items
  use boundary_curves, only: boundary_curve_t
  use kinds, only: wp
  use offset_parabolas, only: point_at
  use plane_vectors, only: cross
  implicit none
  private
  public :: thin_point_t, thin_field_t, find_thin_parts, set_up_thin, direction_along

  !> A point of a contour where the part is thin.
  type :: thin_point_t
    real(wp) :: x(2) = 0.0_wp           !! [length]
    real(wp) :: direction(2) = 0.0_wp   !! cosine and sine of twice the angle of the contour [-]
    real(wp) :: thickness = 0.0_wp      !! [length]
    real(wp) :: reach = huge(1.0_wp)    !! distance to where the part is not thin any more [length]
  end type thin_point_t

  type :: thin_field_t
    type(thin_point_t), allocatable :: points(:)
    type(box_tree_t) :: tree
    real(wp) :: width = 0.0_wp   !! of an element [length]
  end type thin_field_t

  !> Points of the contours an element's width apart at most, more of them on short arcs, up to a limit on long ones.
  integer, parameter :: per_width = 3, fewest = 2, most = 2000
  !> A thin part is so many elements of the largest size thick at most: four are wanted across a slender body (remesh_defaults), and
  !> half as many more for what is uneven.
  real(wp), parameter :: most_across = 6.0_wp
  !> Both sides of it are parallel within 30 degrees: the cosine.
  real(wp), parameter :: parallel = 0.866_wp
  !> Points of contours that count at a point inside: on both sides, and neighbours.
  integer, parameter :: asked = 4

contains

  !> Points of all contours where parts are thin for elements of a width.
  pure subroutine find_thin_parts(boundaries, width, thin)
    type(boundary_curve_t), intent(in) :: boundaries(:)        !! (nboundary)
    real(wp), intent(in) :: width                              !! [length]
    type(thin_point_t), allocatable, intent(out) :: thin(:)    !! (nthin)
    real(wp), allocatable :: x(:, :), way(:, :), boxes(:, :)
    type(box_tree_t) :: tree
    type(thin_point_t), allocatable :: all(:)
    real(wp) :: square(1)
    integer :: item(1), found, k

    call draw_chords(boundaries, width, x, way)
    allocate (all(size(x, 2)), boxes(4, size(x, 2)))
    boxes(1:2, :) = min(x, x + way)
    boxes(3:4, :) = max(x, x + way)
    call build_tree(boxes, [(k, k=1, size(all))], tree)
    do k = 1, size(all)
      call measure_across(x, way, tree, k, most_across*width, all(k)%thickness)
      if (.not. all(k)%thickness > 0) cycle
      all(k)%x = x(:, k) + 0.5_wp*way(:, k)
      all(k)%direction = [way(1, k)**2 - way(2, k)**2, 2*way(1, k)*way(2, k)]/sum(way(:, k)**2)
    end do
    call build_tree(boxes, pack([(k, k=1, size(all))],.not. all%thickness > 0), tree)
    do k = 1, size(all)
      if (.not. all(k)%thickness > 0) cycle
      call nearest_items(tree, all(k)%x, found, item, square)
      if (found > 0) all(k)%reach = sqrt(square(1))
    end do
    allocate (thin, source=pack(all, all%thickness > 0))
  end subroutine find_thin_parts

  !> Contours as short chords, the body on their left.
  pure subroutine draw_chords(boundaries, width, x, way)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    real(wp), intent(in) :: width
    real(wp), allocatable, intent(out) :: x(:, :), way(:, :)   !! beginnings of chords, and from there to their ends (2, n) [length]
    real(wp) :: length
    integer :: c, k, i, n, pass, number

    do pass = 1, 2
      n = 0
      do c = 1, size(boundaries)
        associate (boundary => boundaries(c))
          do k = 1, size(boundary%arcs)
            length = boundary%arc_length(k) - boundary%arc_length(k - 1)
            number = max(fewest, ceiling(min(per_width*length/width, real(most, wp))))
            do i = 1, number
              n = n + 1
              if (pass == 1) cycle
              x(:, n) = along_arc(boundary%arcs(k), real(i - 1, wp)/number)
              way(:, n) = along_arc(boundary%arcs(k), real(i, wp)/number) - x(:, n)
            end do
          end do
        end associate
      end do
      if (pass == 1) allocate (x(2, n), way(2, n))
    end do
  end subroutine draw_chords

  !> Point at a share of an arc's range.
  pure function along_arc(arc, share) result(x)
    type(arc_t), intent(in) :: arc
    real(wp), intent(in) :: share
    real(wp) :: x(2)

    x = point_at(arc, arc%range(1) + share*(arc%range(2) - arc%range(1)))
  end function along_arc

  !> Distance from the middle of a chord inwards to the next one; 0 where that is farther than `farthest` or not opposite.
  pure subroutine measure_across(x, way, tree, k, farthest, thickness)
    real(wp), intent(in) :: x(:, :), way(:, :)
    type(box_tree_t), intent(in) :: tree   !! of the chords
    integer, intent(in) :: k
    real(wp), intent(in) :: farthest
    real(wp), intent(out) :: thickness
    real(wp) :: start(2), inwards(2), at, share, turn, nearest, length
    integer :: items(size(x, 2)), found, i, opposite

    thickness = 0
    length = norm2(way(:, k))
    if (.not. length > 0) return
    start = x(:, k) + 0.5_wp*way(:, k)
    inwards = farthest/length*[-way(2, k), way(1, k)]
    call items_meeting(tree, [min(start, start + inwards), max(start, start + inwards)], found, items)
    nearest = 1
    opposite = 0
    do i = 1, found
      associate (from => x(:, items(i)), to => way(:, items(i)))
        turn = cross(inwards, to)
        if (items(i) == k .or. .not. abs(turn) > 0) cycle
        at = cross(from - start, to)/turn
        share = cross(from - start, inwards)/turn
        if (.not. (at > 0 .and. at < nearest .and. share >= 0 .and. share <= 1)) cycle
        nearest = at
        opposite = items(i)
      end associate
    end do
    if (opposite == 0) return
    if (dot_product(way(:, k), way(:, opposite)) > -parallel*length*norm2(way(:, opposite))) return
    thickness = nearest*farthest
  end subroutine measure_across

  !> Thin points, to be found from places near by.
  pure subroutine set_up_thin(points, width, field)
    type(thin_point_t), intent(in) :: points(:)   !! (nthin)
    real(wp), intent(in) :: width                 !! of an element [length]
    type(thin_field_t), intent(out) :: field
    real(wp) :: boxes(4, size(points))
    integer :: i

    allocate (field%points, source=points)
    field%width = width
    do i = 1, size(points)
      boxes(:, i) = points(i)%x([1, 2, 1, 2])
    end do
    call build_tree(boxes, [(i, i=1, size(points))], field%tree)
  end subroutine set_up_thin

  !> Direction along the thin part at a place: cosine and sine of twice its angle, of length 1 within it, less to its end and where
  !> directions near by differ, 0 elsewhere; and how far the part reaches from there.
  pure subroutine direction_along(field, x, direction, reach)
    type(thin_field_t), intent(in) :: field
    real(wp), intent(in) :: x(2)             !! [length]
    real(wp), intent(out) :: direction(2)    !! [-]
    real(wp), intent(out) :: reach           !! to where it is not thin any more [length]
    real(wp) :: squares(asked), share(asked), away
    integer :: items(asked), found, i

    direction = 0
    reach = huge(reach)
    if (field%tree%n == 0) return
    call nearest_items(field%tree, x, found, items, squares)
    do i = 1, found
      ! 1 as far as the middle of the part, or an element's width, and down to 0 at twice that
      ! (from the contour, which is nearer than its points by their distance at most)
      away = max(sqrt(squares(i)) - field%width/per_width, 0.0_wp)
      share(i) = min(max(2 - 2*away/max(field%points(items(i))%thickness, 2*field%width), 0.0_wp), 1.0_wp)
      direction = direction + share(i)*field%points(items(i))%direction
      if (share(i) > 0) reach = min(reach, field%points(items(i))%reach)
    end do
    if (any(share(:found) > 0)) direction = direction*(maxval(share(:found))/sum(share(:found)))
  end subroutine direction_along

end module thin_parts
