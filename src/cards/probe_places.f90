!> Places on PROBE cards: points of the mesh as it begins, the nodes and integration points nearest to them.
module probe_places
  use box_tree, only: box_tree_t, build_tree
  use card_points, only: read_xy
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use nearest_element, only: box_of_element, find_element
  use quadrature, only: line_rule, square_rule
  use scene, only: group_t, is_solid
  use scene_draft, only: draft_t
  use shape_functions, only: line3, quad8
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: is_off, nearest_of_body, nearest_point, read_point

  !> A point further out of the box around the mesh than this share of its size is a typing error.
  real(wp), parameter :: outside_tolerance = 1.0e-3_wp
  !> After a cut a place belongs to a body up to this share of its nearest element outside: where matter was in the deck's own mesh
  !> is carried from mesh to mesh, with errors beside corners that have folded.
  real(wp), parameter :: still_inside = 0.1_wp
  !> Of several that are as near, to round-off of their coordinates, the first is taken, in whatever units.
  real(wp), parameter :: nearer = 1.0_wp - 1.0e-9_wp

contains

  !> Coordinates, which must lie in the box around the mesh.
  subroutine read_point(cursor, draft, is_cut, x)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    logical, intent(in) :: is_cut   !! bodies may have been cut: the box says nothing
    real(wp), intent(out) :: x(2)
    real(wp) :: low(2), high(2)

    call read_xy(cursor, 'the point', x)
    if (cursor%failed() .or. is_cut .or. .not. draft%mesh_sound) return
    low = minval(draft%scene%mesh%origin, 2) - outside_tolerance*draft%mesh_size
    high = maxval(draft%scene%mesh%origin, 2) + outside_tolerance*draft%mesh_size
    if (any(x < low .or. x > high)) &
      call cursor%fail('the point '//to_text(x(1))//' '//to_text(x(2))//' lies outside of the mesh')
  end subroutine read_point

  !> The node of a body that is nearest to a point.
  pure function nearest_of_body(coordinates, body, x) result(node)
    real(wp), intent(in) :: coordinates(:, :)
    type(group_t), intent(in) :: body
    real(wp), intent(in) :: x(2)
    integer :: node
    integer :: n, e
    real(wp) :: distance, least

    node = 0
    least = huge(least)
    do e = 1, size(body%connectivity, 2)
      do n = 1, size(body%connectivity, 1)
        distance = length_of(coordinates(:, body%connectivity(n, e)) - x)
        if (.not. distance < nearer*least) cycle
        least = distance
        node = body%connectivity(n, e)
      end do
    end do
  end function nearest_of_body

  !> Integration point of a group nearest to x.
  subroutine nearest_point(coordinates, group, x, element, point, place, distance)
    real(wp), intent(in) :: coordinates(:, :)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: x(2)
    integer, intent(out) :: element, point
    real(wp), intent(out) :: place(2), distance
    real(wp), allocatable :: phi(:, :), dphi(:, :), xi(:, :), line(:), weight(:)
    real(wp) :: d, here(2)
    integer :: e, p, n

    n = size(group%connectivity, 1)
    allocate (phi(n, group%rule%n), dphi(2, n))
    if (n == 3) then
      call line_rule(group%rule, line, weight)
      do p = 1, size(line)
        call line3(line(p), phi(:, p), dphi(1, :))
      end do
    else
      call square_rule(group%rule%n, xi, weight)
      do p = 1, size(xi, 2)
        call quad8(xi(1, p), xi(2, p), phi(:, p), dphi)
      end do
    end if
    element = 0
    point = 0
    place = x
    distance = huge(distance)
    do e = 1, size(group%connectivity, 2)
      do p = 1, size(phi, 2)
        here = matmul(coordinates(:, group%connectivity(:, e)), phi(:, p))
        d = length_of(here - x)
        if (.not. d < nearer*distance) cycle
        distance = d
        place = here
        element = e
        point = p
      end do
    end do
  end subroutine nearest_point

  !> Is a point outside of all bodies, by more than the curves of its sides may be off on a new mesh? The matter there was cut off.
  pure function is_off(draft, x) result(off)
    type(draft_t), intent(in) :: draft
    real(wp), intent(in) :: x(2)   !! a place of the deck's own mesh [length]
    logical :: off
    type(box_tree_t) :: tree
    real(wp), allocatable :: boxes(:, :)
    real(wp) :: xi(2), distance
    integer :: g, e, k

    off = .true.
    do g = 1, size(draft%scene%groups)
      if (.not. is_solid(draft%scene%groups(g))) cycle
      associate (origin => draft%scene%mesh%origin, connectivity => draft%scene%groups(g)%connectivity)
        allocate (boxes(4, size(connectivity, 2)))
        do e = 1, size(boxes, 2)
          boxes(:, e) = box_of_element(origin(:, connectivity(:, e)))
        end do
        call build_tree(boxes, [(k, k=1, size(boxes, 2))], tree)
        call find_element(origin, connectivity, tree, x, e, xi, distance)
        off = off .and. distance > still_inside*maxval(boxes(3:4, e) - boxes(1:2, e))
        deallocate (boxes)
      end associate
    end do
  end function is_off

end module probe_places
