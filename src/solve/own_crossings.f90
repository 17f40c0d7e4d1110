!> Bodies that pass through themselves: free sides of one body that cross at the end of a step, and holes that have turned inside
!> out in it, where all sides of a small one have gone past one another.
!>
!> Nothing but contact keeps the sides of a body apart, so a body without it may fold through itself in equilibrium. Sides that
!> face each other in contact overlap by the depth of contact: where a point of either is in contact, they do not count. Nor does a
!> loop of few sides that encloses hardly anything, where a fold has used up a side; nor do neighbours, whose parabolas may cross
!> beside their common node in a distorted mesh: the shape of elements is judged elsewhere.
module own_crossings
  use arc_crossings, only: crossings_between, find_meeting_arcs, most_crossings
  use bodies, only: bodies_of_nodes, elements_at_middles
  use closed_parabolas, only: area_beside
  use contact_state, only: at_piece, at_status
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: contact_open
  use offset_parabolas, only: offset_parabola_t, point_at
  use plane_vectors, only: cross
  use scene, only: is_solid, role_contact, scene_t
  use shape_functions, only: quad8_side
  use solution, only: solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: free_sides_t, list_free_sides, find_own_crossing, own_crossing_t

  !> A loop of at most so many sides counts when its area is above this share of the product of the lengths of the sides that cross.
  integer, parameter :: few_sides = 4
  real(wp), parameter :: small_area = 1.0e-2_wp
  !> A hole has turned inside out when the body lies upon itself in it on more than this share of the square of its length.
  real(wp), parameter :: turned_area = 1.0e-6_wp

  !> Free sides of all bodies.
  type :: free_sides_t
    !> Nodes, walked with the body on the left (3, nside); the body of each side, the group of its element, and its contour, 0 where
    !> contours meet in a node (nside).
    integer, allocatable :: nodes(:, :), body(:), group(:), contour(:)
  end type free_sides_t

  !> The first crossing found.
  type :: own_crossing_t
    logical :: found = .false.
    !> The group of elements of one of the sides.
    integer :: group = 0
    real(wp) :: point(2) = 0.0_wp   !! [length]
    !> The body was between the sides, not a gap.
    logical :: thinned = .false.
  end type own_crossing_t

contains

  !> Sides of bodies that belong to one element alone; none where nothing moves, or the geometry does not follow.
  subroutine list_free_sides(scene, sides)
    type(scene_t), intent(in) :: scene
    type(free_sides_t), intent(out) :: sides
    integer :: sharing(size(scene%mesh%coordinates, 2)), body(size(sharing)), g, e, k, n, most
    logical :: wanted

    wanted = scene%finite .and. scene%fields(displacement_field)%declared
    most = 0
    if (wanted) most = 4*sum([(size(scene%groups(g)%connectivity, 2), g=1, size(scene%groups))], mask=is_solid(scene%groups))
    sharing = elements_at_middles(scene)
    allocate (sides%nodes(3, most), sides%group(most))
    n = 0
    do g = 1, size(scene%groups)
      if (.not. (wanted .and. is_solid(scene%groups(g)))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          associate (nodes => scene%groups(g)%connectivity(quad8_side(:, k), e))
            if (sharing(nodes(2)) /= 1) cycle
            n = n + 1
            sides%nodes(:, n) = nodes
            sides%group(n) = g
          end associate
        end do
      end do
    end do
    sides%nodes = sides%nodes(:, :n)
    sides%group = sides%group(:n)
    allocate (sides%body(n))
    if (n == 0) return
    body = bodies_of_nodes(scene)
    sides%body = body(sides%nodes(1, :))
    call number_contours(sides%nodes, size(sharing), sides%contour)
  end subroutine list_free_sides

  !> Closed contours by their numbers: each side goes on with the one that begins where it ends.
  pure subroutine number_contours(nodes, nnode, contour)
    integer, intent(in) :: nodes(:, :)                !! (3, nside)
    integer, intent(in) :: nnode
    integer, allocatable, intent(out) :: contour(:)   !! (nside)
    integer :: begins(nnode), i, n, side
    integer, parameter :: of_none = -1

    begins = 0
    do i = 1, size(nodes, 2)
      begins(nodes(1, i)) = i
    end do
    allocate (contour(size(nodes, 2)), source=0)
    n = 0
    do i = 1, size(contour)
      if (contour(i) /= 0) cycle
      n = n + 1
      side = i
      do while (side /= 0)
        if (contour(side) /= 0) exit
        contour(side) = n
        side = begins(nodes(3, side))
      end do
      if (side == i) cycle
      where (contour == n) contour = of_none
      n = n - 1
    end do
    where (contour == of_none) contour = 0
  end subroutine number_contours

  !> A place where two sides of a body cross at the end of a step: the first one in the order of sides.
  subroutine find_own_crossing(scene, dofs, solution, du, sides, crossing)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    type(free_sides_t), intent(in) :: sides
    type(own_crossing_t), intent(out) :: crossing
    type(offset_parabola_t) :: arcs(size(sides%nodes, 2)), at_start(2)
    real(wp) :: xi(2, most_crossings)
    logical, allocatable :: held(:)
    integer, allocatable :: pairs(:, :)
    integer :: number, i, m, r, s

    if (size(arcs) == 0) return
    do i = 1, size(arcs)
      arcs(i)%points = present_nodes(scene, dofs, solution, du, sides%nodes(:, i))
    end do
    call find_turned_hole(scene, dofs, solution, sides, arcs, crossing)
    if (crossing%found) return
    call find_meeting_arcs(arcs, pairs)
    do m = 1, size(pairs, 2)
      associate (i => pairs(1, m), k => pairs(2, m))
        if (sides%body(k) /= sides%body(i)) cycle
        if (are_neighbours(sides%nodes(:, i), sides%nodes(:, k))) cycle
        call crossings_between(arcs(i), arcs(k), number, xi, at_ends=.true.)
        do r = 1, number
          if (.not. allocated(held)) held = nodes_in_contact(scene, solution)
          if (any(held(sides%nodes(:, i))) .or. any(held(sides%nodes(:, k)))) cycle
          if (is_small(sides%nodes, arcs, [i, k], xi(:, r)) .or. is_small(sides%nodes, arcs, [k, i], xi([2, 1], r))) cycle
          crossing%found = .true.
          crossing%group = sides%group(i)
          crossing%point = point_at(arcs(i), xi(1, r))
          do s = 1, 2
            at_start(s)%points = present_nodes(scene, dofs, solution, [real(wp) ::], sides%nodes(:, pairs(s, m)))
          end do
          crossing%thinned = is_behind(at_start, xi(:, r))
          return
        end do
      end associate
    end do
  end subroutine find_own_crossing

  !> The first hole that has turned inside out in the step, where none of its nodes is in contact: the area on the left of its
  !> sides, which is negative, or nothing where it is a crack, is positive at the end. The contour around a body has the largest.
  subroutine find_turned_hole(scene, dofs, solution, sides, arcs, crossing)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    type(free_sides_t), intent(in) :: sides
    type(offset_parabola_t), intent(in) :: arcs(:)   !! of the sides at the end of the step
    type(own_crossing_t), intent(inout) :: crossing
    real(wp), dimension(maxval(sides%contour)) :: before, after, length, least
    integer :: first(maxval(sides%contour)), c, i
    logical :: held(size(scene%mesh%coordinates, 2)), turned(maxval(sides%contour))

    before = 0
    after = 0
    length = 0
    first = 0
    do i = 1, size(arcs)
      c = sides%contour(i)
      if (c == 0) cycle
      if (first(c) == 0) first(c) = i
      associate (origin => arcs(first(c))%points(:, 1))
        before(c) = before(c) + area_beside(present_nodes(scene, dofs, solution, [real(wp) ::], sides%nodes(:, i)), origin)
        after(c) = after(c) + area_beside(arcs(i)%points, origin)
      end associate
      length(c) = length(c) + length_of(arcs(i)%points(:, 3) - arcs(i)%points(:, 1))
    end do
    least = turned_area*length**2
    turned = before <= least .and. after > least
    do c = 1, size(first)
      if (turned(c)) turned(c) = before(c) < maxval(before, mask=sides%body(first) == sides%body(first(c)))
    end do
    if (.not. any(turned)) return
    held = nodes_in_contact(scene, solution)
    do c = 1, size(first)
      if (.not. turned(c)) cycle
      if (any([(sides%contour(i) == c .and. any(held(sides%nodes(:, i))), i=1, size(arcs))])) cycle
      crossing%found = .true.
      crossing%group = sides%group(first(c))
      crossing%point = arcs(first(c))%points(:, 2)
      return
    end do
  end subroutine find_turned_hole

  !> The place on the second side is behind the one on the first, on the side of the body.
  pure function is_behind(arcs, xi) result(yes)
    type(offset_parabola_t), intent(in) :: arcs(2)   !! walked with the body on the left
    real(wp), intent(in) :: xi(2)
    logical :: yes

    associate (along => arcs(1)%points(:, 3) - arcs(1)%points(:, 1))
      yes = cross(along, point_at(arcs(2), xi(2)) - point_at(arcs(1), xi(1))) > 0
    end associate
  end function is_behind

  !> Nodes of a side at the end of the step, or at its start where no motion is given [length].
  pure function present_nodes(scene, dofs, solution, du, nodes) result(x)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)   !! (ndof) or none [unknown]
    integer, intent(in) :: nodes(3)
    real(wp) :: x(2, 3)
    integer :: i, c

    x = scene%mesh%coordinates(:, nodes) + solution%fields(displacement_field)%value(:, nodes)
    if (size(du) == 0) return
    associate (number => dofs%fields(displacement_field)%number)
      do i = 1, 3
        do c = 1, 2
          if (number(c, nodes(i)) > 0) x(c, i) = x(c, i) + du(number(c, nodes(i)))
        end do
      end do
    end associate
  end function present_nodes

  !> Sides with a node in common.
  pure function are_neighbours(one, two) result(yes)
    integer, intent(in) :: one(3), two(3)   !! nodes
    logical :: yes

    yes = any(one(1) == two([1, 3])) .or. any(one(3) == two([1, 3]))
  end function are_neighbours

  !> The contour goes from a place on one side to one on another within few sides, and the loop that closes there is small.
  pure function is_small(nodes, arcs, pair, xi) result(small)
    integer, intent(in) :: nodes(:, :)   !! (3, nside), walked with the body on the left
    type(offset_parabola_t), intent(in) :: arcs(:)
    integer, intent(in) :: pair(2)    !! sides
    real(wp), intent(in) :: xi(2)     !! places on them
    logical :: small
    integer, parameter :: parts = 8
    real(wp) :: area, origin(2), from(2), to(2), start
    integer :: side, step, i

    small = .false.
    area = 0
    side = pair(1)
    start = xi(1)
    origin = point_at(arcs(side), start)
    do step = 1, few_sides
      from = point_at(arcs(side), start)
      do i = 1, parts
        to = point_at(arcs(side), start + (merge(xi(2), 1.0_wp, side == pair(2)) - start)*i/parts)
        area = area + 0.5_wp*cross(from - origin, to - origin)
        from = to
      end do
      if (side == pair(2)) then
        small = abs(area) <= small_area*length_of(chord(pair(1)))*length_of(chord(pair(2)))
        return
      end if
      i = nodes(3, side)
      side = findloc(nodes(1, :), i, dim=1)
      if (side == 0) return
      start = -1
    end do

  contains

    pure function chord(side)
      integer, intent(in) :: side
      real(wp) :: chord(2)

      chord = arcs(side)%points(:, 3) - arcs(side)%points(:, 1)
    end function chord

  end function is_small

  !> Nodes of sides that are in contact with sides of bodies now, of both (nnode).
  pure function nodes_in_contact(scene, solution) result(held)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: held(size(scene%mesh%coordinates, 2))
    integer :: g, e, p

    held = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g)%trial)
        if (group%pairs == 0 .or. group%role /= role_contact) cycle
        do e = 1, size(group%connectivity, 2)
          do p = 1, size(state, 2)
            if (nint(state(at_status, p, e)) == contact_open) cycle
            held(group%connectivity(:, e)) = .true.
            held(scene%dies(group%die)%nodes(:, nint(state(at_piece, p, e)))) = .true.
          end do
        end do
      end associate
    end do
  end function nodes_in_contact

end module own_crossings
