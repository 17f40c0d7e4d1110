!> Interfaces between the materials of a mesh: curves made of the parabolas of the element sides that two materials share.
!>
!> A curve is open or closed: it ends where it meets the contour, and where more than two such sides meet, as between three
!> materials. It is traversed with the material of the lower number on its left. An end on the contour follows the material onto the
!> corrected contour, together with the end of its side.
module material_interfaces
  use arcs, only: arc_t, cut
  use boundary_curves, only: boundary_curve_t, close_boundary, kind_end, position_t
  use contour_match, only: position_of_side_point
  use corrected_contours, only: contour_options_t, contour_t
  use kinds, only: wp
  use scene, only: scene_t
  use shape_functions, only: quad8_side
  use solution, only: solution_t
  use state_pieces, only: mesh_of, solid_pieces, state_pieces_t
  use transfer_mesh, only: transfer_mesh_t
  use zones, only: on_boundary
  implicit none
  private
  public :: group_interfaces, interface_t, interfaces_of, node_on_contour, path_between

  type :: interface_t
    !> Materials on its left and on its right.
    integer :: materials(2) = 0
    type(boundary_curve_t) :: curve
    !> It is closed: the last arc ends where the first one begins.
    logical :: closed = .false.
    !> Contours that its ends lie on, 0 inside, and positions on them.
    integer :: contour(2) = 0
    type(position_t) :: position(2)
    !> Node of the old mesh that it begins with.
    integer :: first_node = 0
  end type interface_t

  !> Coincidence tolerance: a shorter part of an arc, in half sides, is dropped.
  real(wp), parameter :: shortest_part = 1.0e-10_wp

contains

  !> Interfaces of the mesh of a scene, between materials as the state transfer distinguishes them; none where there is no mesh yet.
  subroutine interfaces_of(scene, solution, contours, interfaces)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)                     !! (ncontour)
    type(interface_t), allocatable, intent(out) :: interfaces(:)   !! (ninterface)
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh

    call solid_pieces(scene, pieces, solution)
    call mesh_of(pieces, mesh)
    call find_interfaces(mesh%connectivity, mesh%material, mesh%nodes, contours, interfaces)
  end subroutine interfaces_of

  !> The same between all groups of the scene, be their materials alike or not; `materials` are the numbers of the groups.
  subroutine group_interfaces(scene, solution, contours, interfaces)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)                     !! (ncontour)
    type(interface_t), allocatable, intent(out) :: interfaces(:)   !! (ninterface)
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh
    integer, allocatable :: group(:)
    integer :: k, n

    call solid_pieces(scene, pieces, solution)
    call mesh_of(pieces, mesh)
    allocate (group(size(mesh%material)))
    n = 0
    do k = 1, size(pieces%groups)
      group(n + 1:n + size(pieces%groups(k)%connectivity, 2)) = pieces%groups(k)%scene_group
      n = n + size(pieces%groups(k)%connectivity, 2)
    end do
    call find_interfaces(mesh%connectivity, group, mesh%nodes, contours, interfaces)
  end subroutine group_interfaces

  pure subroutine find_interfaces(connectivity, material, x, contours, interfaces)
    integer, intent(in) :: connectivity(:, :)                      !! nodes of all elements (8, nelem)
    integer, intent(in) :: material(:)                             !! (nelem)
    real(wp), intent(in) :: x(:, :)                                !! nodes now (2, nnode) [length]
    type(contour_t), intent(in) :: contours(:)                     !! (ncontour)
    type(interface_t), allocatable, intent(out) :: interfaces(:)   !! (ninterface)
    type(interface_t), allocatable :: list(:)
    integer, allocatable :: sides(:, :), pairs(:, :), walk(:)
    integer :: next(size(x, 2))
    logical :: is_end(size(x, 2))
    logical, allocatable :: walked(:)
    integer :: s, n, pass

    call list_sides(connectivity, material, size(x, 2), sides, pairs)
    call find_ends(sides, contours, next, is_end)
    allocate (list(size(sides, 2)), walked(size(sides, 2)))
    walked = .false.
    n = 0
    do pass = 1, 2
      do s = 1, size(sides, 2)
        ! closed ones begin anywhere, once all others are known
        if (walked(s) .or. (pass == 1 .and. .not. is_end(sides(1, s)))) cycle
        call walk_on(sides, next, is_end, s, walked, walk)
        n = n + 1
        list(n)%materials = pairs(:, s)
        list(n)%closed = pass == 2
        list(n)%first_node = sides(1, walk(1))
        call draw(x, contours, sides(:, walk), list(n))
      end do
    end do
    allocate (interfaces, source=list(:n))
  end subroutine find_interfaces

  !> Sides between two materials (3, n) in the direction of the element of the lower material, and their materials (2, n).
  pure subroutine list_sides(connectivity, material, nnode, sides, pairs)
    integer, intent(in) :: connectivity(:, :), material(:), nnode
    integer, allocatable, intent(out) :: sides(:, :), pairs(:, :)
    integer, allocatable :: first(:, :), list(:, :), both(:, :)
    integer :: e, k, n

    ! at most two shared sides per element
    allocate (first(2, nnode), list(3, 2*size(material)), both(2, 2*size(material)))
    first = 0
    n = 0
    do e = 1, size(material)
      do k = 1, 4
        associate (one => first(:, connectivity(quad8_side(2, k), e)))
          if (one(1) == 0) then
            one = [e, k]
          else if (material(one(1)) /= material(e)) then
            n = n + 1
            both(:, n) = [min(material(one(1)), material(e)), max(material(one(1)), material(e))]
            if (material(e) == both(1, n)) then
              list(:, n) = connectivity(quad8_side(:, k), e)
            else
              list(:, n) = connectivity(quad8_side(:, one(2)), one(1))
            end if
          end if
        end associate
      end do
    end do
    allocate (sides, source=list(:, :n))
    allocate (pairs, source=both(:, :n))
  end subroutine list_sides

  !> The side that begins at each node, and the nodes where curves end.
  pure subroutine find_ends(sides, contours, next, is_end)
    integer, intent(in) :: sides(:, :)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(out) :: next(:)
    logical, intent(out) :: is_end(:)
    integer :: valence(size(next)), s, c

    next = 0
    valence = 0
    do s = 1, size(sides, 2)
      next(sides(1, s)) = s
      valence(sides([1, 3], s)) = valence(sides([1, 3], s)) + 1
    end do
    is_end = valence /= 2
    do c = 1, size(contours)
      is_end(contours(c)%loop%sides(1, :)) = .true.
    end do
  end subroutine find_ends

  !> The sides from one on to the end of its curve, or all around.
  pure subroutine walk_on(sides, next, is_end, start, walked, walk)
    integer, intent(in) :: sides(:, :), next(:), start
    logical, intent(in) :: is_end(:)
    logical, intent(inout) :: walked(:)
    integer, allocatable, intent(out) :: walk(:)
    integer :: list(size(walked)), s, n

    n = 0
    s = start
    do
      n = n + 1
      list(n) = s
      walked(s) = .true.
      if (is_end(sides(3, s))) exit
      s = next(sides(3, s))
      if (walked(s)) exit
    end do
    allocate (walk, source=list(:n))
  end subroutine walk_on

  !> The curve through the nodes of sides, with its ends on the corrected contours.
  pure subroutine draw(x, contours, sides, one)
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: sides(:, :)
    type(interface_t), intent(inout) :: one
    type(arc_t) :: arcs(size(sides, 2))
    type(contour_options_t) :: options
    integer :: k, n

    n = size(arcs)
    do k = 1, n
      arcs(k)%points = x(:, sides(:, k))
      arcs(k)%middle = sides(2, k)
    end do
    if (.not. one%closed) then
      call node_on_contour(contours, x, sides(1, 1), one%contour(1), one%position(1))
      call node_on_contour(contours, x, sides(3, n), one%contour(2), one%position(2))
      if (one%contour(1) > 0) arcs(1)%points(:, 1) = on_boundary(contours(one%contour(1))%boundary, one%position(1))
      if (one%contour(2) > 0) arcs(n)%points(:, 3) = on_boundary(contours(one%contour(2))%boundary, one%position(2))
    end if
    one%curve = curve_through(arcs, options%corner_turn)
    if (.not. one%closed) one%curve%kinds(1) = kind_end
  end subroutine draw

  pure function curve_through(arcs, corner_turn) result(curve)
    type(arc_t), intent(in) :: arcs(:)
    real(wp), intent(in) :: corner_turn   !! [radian]
    type(boundary_curve_t) :: curve

    allocate (curve%arcs, source=arcs)
    allocate (curve%kinds(size(arcs)), source=kind_end)
    call close_boundary(corner_turn, curve)
  end function curve_through

  !> Present position of a node of the old contour on the corrected one; contour 0 for a node inside.
  pure subroutine node_on_contour(contours, x, node, contour, position)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    real(wp), intent(in) :: x(:, :)              !! (2, nnode) coordinates now [length]
    integer, intent(in) :: node
    integer, intent(out) :: contour
    type(position_t), intent(out) :: position
    integer :: c, side

    contour = 0
    do c = 1, size(contours)
      side = findloc(contours(c)%loop%sides(1, :), node, 1)
      if (side == 0) cycle
      contour = c
      position = position_of_side_point(contours(c)%loop, contours(c)%boundary, contours(c)%contacts, x, side, -1.0_wp)
      return
    end do
  end subroutine node_on_contour

  !> The part of an interface from one position to another, as an open curve; without arcs where there is none.
  pure function path_between(one, from, to) result(path)
    type(interface_t), intent(in) :: one
    type(position_t), intent(in) :: from, to
    type(boundary_curve_t) :: path
    type(arc_t) :: parts(size(one%curve%arcs) + 1)
    type(contour_options_t) :: options
    real(wp) :: range(2)
    integer :: k, n, steps, total

    total = size(one%curve%arcs)
    steps = to%arc - from%arc
    if (one%closed .and. (steps < 0 .or. (steps == 0 .and. to%xi < from%xi))) steps = steps + total
    n = 0
    do k = 0, steps
      associate (arc => one%curve%arcs(mod(from%arc + k - 1, total) + 1))
        range = arc%range
        if (k == 0) range(1) = from%xi
        if (k == steps) range(2) = to%xi
        if (range(2) - range(1) <= shortest_part) cycle
        n = n + 1
        parts(n) = cut(arc, range(1), range(2))
      end associate
    end do
    path = curve_through(parts(:n), options%corner_turn)
    if (n > 0) path%kinds(1) = kind_end
  end function path_between

end module material_interfaces
