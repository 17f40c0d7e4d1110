!> Interfaces between the materials of a mesh: chains of the parabolas of those sides of elements that two materials share.
!>
!> A chain goes from one end to the other, or around: it ends where it meets the contour, and where more than two such sides meet,
!> as between three materials. It is walked with the material of the lower number on its left. An end on the contour goes with
!> the matter, onto the corrected contour, and takes the end of its side along.
module material_interfaces
  use contour_chain, only: chain_t, close_chain, kind_end, place_t
  use contour_match, only: place_of_old
  use kinds, only: wp
  use part_contour, only: contour_options_t, contour_t
  use scene, only: scene_t
  use shape_functions, only: quad8_side
  use solution, only: solution_t
  use state_pieces, only: mesh_of, solid_pieces, state_pieces_t
  use stretches, only: cut, stretch_t
  use transfer_mesh, only: transfer_mesh_t
  use zones, only: on_chain
  implicit none
  private
  public :: interface_t, interfaces_of, find_interfaces, node_on_contour, path_between

  type :: interface_t
    !> Materials on its left and on its right.
    integer :: materials(2) = 0
    type(chain_t) :: chain
    !> It goes around: the last stretch ends where the first one begins.
    logical :: closed = .false.
    !> Contours its ends lie on, 0 inside, and where.
    integer :: contour(2) = 0
    type(place_t) :: place(2)
  end type interface_t

  !> What is left of a stretch, in half sides, when it is nothing.
  real(wp), parameter :: nothing = 1.0e-10_wp

contains

  !> Interfaces of the mesh of a scene, as materials are told apart by the state transfer; none where there is no mesh yet.
  subroutine interfaces_of(scene, solution, contours, interfaces)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), allocatable, intent(out) :: interfaces(:)
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh

    call solid_pieces(scene, pieces, solution)
    call mesh_of(pieces, mesh)
    call find_interfaces(mesh%connectivity, mesh%material, mesh%nodes, contours, interfaces)
  end subroutine interfaces_of

  pure subroutine find_interfaces(connectivity, material, x, contours, interfaces)
    integer, intent(in) :: connectivity(:, :)            !! nodes of all elements (8, nelem)
    integer, intent(in) :: material(:)                   !! (nelem)
    real(wp), intent(in) :: x(:, :)                      !! nodes now (2, nnode) [length]
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), allocatable, intent(out) :: interfaces(:)
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
        ! those that go around begin anywhere, once all others are known
        if (walked(s) .or. (pass == 1 .and. .not. is_end(sides(1, s)))) cycle
        call walk_on(sides, next, is_end, s, walked, walk)
        n = n + 1
        list(n)%materials = pairs(:, s)
        list(n)%closed = pass == 2
        call draw(x, contours, sides(:, walk), list(n))
      end do
    end do
    allocate (interfaces, source=list(:n))
  end subroutine find_interfaces

  !> Sides between two materials (3, n) as the element of the lower material walks them, and their materials (2, n).
  pure subroutine list_sides(connectivity, material, nnode, sides, pairs)
    integer, intent(in) :: connectivity(:, :), material(:), nnode
    integer, allocatable, intent(out) :: sides(:, :), pairs(:, :)
    integer, allocatable :: first(:, :), list(:, :), both(:, :)
    integer :: e, k, n

    ! no more sides than two an element are shared
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

  !> The side that begins at each node, and the nodes where chains end.
  pure subroutine find_ends(sides, contours, next, is_end)
    integer, intent(in) :: sides(:, :)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(out) :: next(:)
    logical, intent(out) :: is_end(:)
    integer :: meeting(size(next)), s, c

    next = 0
    meeting = 0
    do s = 1, size(sides, 2)
      next(sides(1, s)) = s
      meeting(sides([1, 3], s)) = meeting(sides([1, 3], s)) + 1
    end do
    is_end = meeting /= 2
    do c = 1, size(contours)
      is_end(contours(c)%loop%sides(1, :)) = .true.
    end do
  end subroutine find_ends

  !> The sides from one on to the end of its chain, or around.
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

  !> The chain through the nodes of sides, its ends on the corrected contours.
  pure subroutine draw(x, contours, sides, one)
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: sides(:, :)
    type(interface_t), intent(inout) :: one
    type(stretch_t) :: stretches(size(sides, 2))
    type(contour_options_t) :: options
    integer :: k, n

    n = size(stretches)
    do k = 1, n
      stretches(k)%points = x(:, sides(:, k))
      stretches(k)%middle = sides(2, k)
    end do
    if (.not. one%closed) then
      call node_on_contour(contours, x, sides(1, 1), one%contour(1), one%place(1))
      call node_on_contour(contours, x, sides(3, n), one%contour(2), one%place(2))
      if (one%contour(1) > 0) stretches(1)%points(:, 1) = on_chain(contours(one%contour(1))%chain, one%place(1))
      if (one%contour(2) > 0) stretches(n)%points(:, 3) = on_chain(contours(one%contour(2))%chain, one%place(2))
    end if
    one%chain = chain_of(stretches, options%corner_turn)
    if (.not. one%closed) one%chain%kinds(1) = kind_end
  end subroutine draw

  pure function chain_of(stretches, corner_turn) result(chain)
    type(stretch_t), intent(in) :: stretches(:)
    real(wp), intent(in) :: corner_turn   !! [radian]
    type(chain_t) :: chain

    allocate (chain%stretches, source=stretches)
    allocate (chain%kinds(size(stretches)), source=kind_end)
    call close_chain(corner_turn, chain)
  end function chain_of

  !> Where a node of the old contour has gone with the matter; contour 0 for a node inside.
  pure subroutine node_on_contour(contours, x, node, contour, place)
    type(contour_t), intent(in) :: contours(:)
    real(wp), intent(in) :: x(:, :)
    integer, intent(in) :: node
    integer, intent(out) :: contour
    type(place_t), intent(out) :: place
    integer :: c, side

    contour = 0
    do c = 1, size(contours)
      side = findloc(contours(c)%loop%sides(1, :), node, 1)
      if (side == 0) cycle
      contour = c
      place = place_of_old(contours(c)%loop, contours(c)%chain, contours(c)%contacts, x, side, -1.0_wp)
      return
    end do
  end subroutine node_on_contour

  !> The part of an interface from one place on to another, as an open chain of its own; without stretches where there is none.
  pure function path_between(one, from, to) result(path)
    type(interface_t), intent(in) :: one
    type(place_t), intent(in) :: from, to
    type(chain_t) :: path
    type(stretch_t) :: parts(size(one%chain%stretches) + 1)
    type(contour_options_t) :: options
    real(wp) :: range(2)
    integer :: k, n, steps, total

    total = size(one%chain%stretches)
    steps = to%stretch - from%stretch
    if (one%closed .and. (steps < 0 .or. (steps == 0 .and. to%xi < from%xi))) steps = steps + total
    n = 0
    do k = 0, steps
      associate (stretch => one%chain%stretches(mod(from%stretch + k - 1, total) + 1))
        range = stretch%range
        if (k == 0) range(1) = from%xi
        if (k == steps) range(2) = to%xi
        if (range(2) - range(1) <= nothing) cycle
        n = n + 1
        parts(n) = cut(stretch, range(1), range(2))
      end associate
    end do
    path = chain_of(parts(:n), options%corner_turn)
    if (n > 0) path%kinds(1) = kind_end
  end function path_between

end module material_interfaces
