!> The scene on the new mesh: groups, sets of sides, elements on sides and dies made of sides as the deck has them.
module new_scene
  use boundary_curves, only: arc_length_at, boundary_length, position_at_arc_length, position_t
  use cards_side_dies, only: curve_of_sides
  use corrected_contours, only: contour_t
  use dies, only: is_deformable, place_on_nodes
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use mesh, only: side_set_t
  use scene, only: is_solid, scene_t
  use zone_mesh, only: contour_side_t, new_mesh_t
  use zone_node_numbers, only: ends_of_side, middles_of_side, node_numbers_t, number_nodes
  use zones, only: follows_contour, plan_t
  implicit none
  private
  public :: set_up_new_scene, middle_position

contains

  !> Everything of the old scene that does not depend on nodes, with the new mesh. `origin` is set by the transfer.
  subroutine set_up_new_scene(old, contours, plan, mesh, new, error)
    type(scene_t), intent(in) :: old
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(plan_t), intent(in) :: plan
    type(new_mesh_t), intent(in) :: mesh
    type(scene_t), intent(out) :: new
    type(error_t), allocatable, intent(out) :: error
    logical :: selected(size(mesh%zone))
    integer :: g, k, n

    new = old
    new%generation = old%generation + 1
    ! supports are placed anew by the cards of the deck
    deallocate (new%fixations)
    allocate (new%fixations(0))
    new%mesh%coordinates = mesh%coordinates
    new%mesh%labels = [(k, k=1, size(mesh%coordinates, 2))]
    do k = 1, size(old%mesh%sides)
      new%mesh%sides(k)%nodes = new_set(contours, plan, mesh, k)
    end do
    do g = 1, size(old%groups)
      associate (group => new%groups(g))
        if (is_solid(group)) then
          selected = plan%group(mesh%zone) == g
          n = count(selected)
          group%connectivity = reshape(pack(mesh%connectivity, spread(selected, 1, 8)), [8, n])
        else if (size(group%connectivity, 1) == 3) then
          call gather_sides(old%mesh%sides, old%groups(g)%connectivity(2, :), new%mesh%sides, group%connectivity)
        end if
      end associate
    end do
    call remake_dies(old, new, error)
    ! further formulations and loads on the volume have the elements of their body
    do g = 1, size(new%groups)
      if (new%groups(g)%host > 0) new%groups(g)%connectivity = new%groups(new%groups(g)%host)%connectivity
    end do
  end subroutine set_up_new_scene

  !> Sides of a set: those between zones, or the contour sides that replace sides of the old set: sets follow the material.
  pure function new_set(contours, plan, mesh, set) result(sides)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: set
    integer, allocatable :: sides(:, :)
    logical :: selected(size(mesh%sides))
    type(position_t) :: position
    integer :: k, z

    allocate (sides(3, 0))
    do z = 1, size(plan%zones)
      do k = 1, 4
        if (plan%sets(k, z) /= set .or. plan%zones(z)%form(k) == follows_contour) cycle
        sides = reshape([sides, zone_side(mesh, z, k)], [3, size(sides, 2) + divisions(z, k)])
      end do
    end do
    if (allocated(plan%on_seam) .and. allocated(mesh%seams)) then
      do k = 1, size(mesh%seams)
        associate (nodes => mesh%seams(k)%nodes)
          select case (plan%on_seam(mesh%seams(k)%path, set))
          case (1)
            sides = reshape([sides, nodes], [3, size(sides, 2) + 1])
          case (-1)
            sides = reshape([sides, nodes([3, 2, 1])], [3, size(sides, 2) + 1])
          end select
        end associate
      end do
    end if
    sides = in_order(sides)
    if (size(sides) > 0) return
    do k = 1, size(mesh%sides)
      position = middle_position(contours, mesh%sides(k))
      associate (contour => contours(mesh%sides(k)%boundary))
        selected(k) = contour%tags%on_set(set, contour%boundary%arcs(position%arc)%side)
      end associate
    end do
    sides = all_nodes(from_its_start(pack([(k, k=1, size(selected))], selected)))

  contains

    pure function divisions(z, k) result(n)
      integer, intent(in) :: z, k
      integer :: n

      n = mesh%division%count(mesh%layout%zone_sides(k, z))
    end function divisions

    !> Parts of a divided zone side in sequence: from the node at which none ends.
    pure function in_order(list) result(ordered)
      integer, intent(in) :: list(:, :)
      integer :: ordered(3, size(list, 2)), i, next

      ! a closed one begins anywhere
      next = max(1, findloc([(any(list(3, :) == list(1, i)), i=1, size(list, 2))], .false., 1))
      do i = 1, size(list, 2)
        ordered(:, i) = list(:, next)
        next = findloc(list(1, :), list(3, next), 1)
      end do
    end function in_order

    !> The list rotated so that it begins where the set does, for a set across the start of its contour.
    pure function from_its_start(list) result(turned)
      integer, intent(in) :: list(:)
      integer :: turned(size(list)), i

      turned = list
      if (size(list) < 2) return
      if (mesh%sides(list(size(list)))%nodes(3) /= mesh%sides(list(1))%nodes(1)) return
      do i = 2, size(list)
        if (mesh%sides(list(i - 1))%nodes(3) == mesh%sides(list(i))%nodes(1)) cycle
        turned = cshift(list, i - 1)
        return
      end do
    end function from_its_start

    pure function all_nodes(list) result(nodes)
      integer, intent(in) :: list(:)
      integer :: nodes(3, size(list)), i

      do i = 1, size(list)
        nodes(:, i) = mesh%sides(list(i))%nodes
      end do
    end function all_nodes

  end function new_set

  !> Sides of elements along side k of a zone, the zone on their left.
  pure function zone_side(mesh, z, k) result(sides)
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: z, k
    integer, allocatable :: sides(:, :)
    type(node_numbers_t) :: numbers
    integer, allocatable :: ends(:), middles(:)
    integer :: s, n

    s = mesh%layout%zone_sides(k, z)
    n = mesh%division%count(s)
    numbers = number_nodes(mesh%layout, mesh%division)
    ends = ends_of_side(mesh%layout, mesh%division, numbers, s)
    middles = middles_of_side(mesh%division, numbers, s)
    if (mesh%layout%sides(s)%zones(1) /= z .or. mesh%layout%sides(s)%local(1) /= k) then
      ends = ends(n + 1:1:-1)
      middles = middles(n:1:-1)
    end if
    allocate (sides(3, n))
    sides(1, :) = ends(:n)
    sides(2, :) = middles
    sides(3, :) = ends(2:)
  end function zone_side

  !> Position at half the length of a contour side.
  pure function middle_position(contours, side) result(position)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(contour_side_t), intent(in) :: side
    type(position_t) :: position
    real(wp) :: from, to

    associate (boundary => contours(side%boundary)%boundary)
      from = arc_length_at(boundary, side%from)
      to = arc_length_at(boundary, side%to)
      if (.not. to > from) to = to + boundary_length(boundary)
      position = position_at_arc_length(boundary, 0.5_wp*(from + to))
    end associate
  end function middle_position

  !> Dies made of sides of bodies, on the new sides.
  subroutine remake_dies(old, new, error)
    type(scene_t), intent(in) :: old
    type(scene_t), intent(inout) :: new
    type(error_t), allocatable, intent(inout) :: error
    integer, allocatable :: sides(:, :)
    integer :: k

    do k = 1, size(new%dies)
      associate (die => new%dies(k))
        if (.not. is_deformable(die)) cycle
        ! a scene without a mesh has no sides: its deck finds them on the first one
        if (size(die%nodes, 2) == 0) cycle
        call gather_sides(old%mesh%sides, old%dies(k)%nodes(2, :), new%mesh%sides, sides)
        call curve_of_sides(sides, die%nodes)
        if (size(die%nodes, 2) == 0 .or. size(die%nodes, 2) < size(sides, 2)) then
          call fail(error, exit_no_convergence, 'remdata: the sides of DIE '//die%name//' do not form one curve on the new mesh')
          return
        end if
        if (allocated(die%pieces)) deallocate (die%pieces)
        allocate (die%pieces(2, 3, size(die%nodes, 2)))
        call place_on_nodes(new%mesh%coordinates, die)
      end associate
    end do
  end subroutine remake_dies

  !> Sides that replace old ones: those of all sets that the old ones belong to, each side once.
  pure subroutine gather_sides(old, middles, sets, sides)
    type(side_set_t), intent(in) :: old(:)             !! sets of the old mesh
    integer, intent(in) :: middles(:)                  !! middle nodes of the old sides
    type(side_set_t), intent(in) :: sets(:)            !! the same of the new one
    integer, allocatable, intent(out) :: sides(:, :)   !! (3, n)
    integer :: k, i, n
    logical :: part

    n = 0
    allocate (sides(3, sum([(size(sets(k)%nodes, 2), k=1, size(sets))])))
    do k = 1, size(sets)
      part = size(old(k)%nodes, 2) > 0
      do i = 1, size(old(k)%nodes, 2)
        part = part .and. any(middles == old(k)%nodes(2, i))
      end do
      if (.not. part) cycle
      do i = 1, size(sets(k)%nodes, 2)
        if (any(sides(2, :n) == sets(k)%nodes(2, i))) cycle
        n = n + 1
        sides(:, n) = sets(k)%nodes(:, i)
      end do
    end do
    sides = sides(:, :n)
  end subroutine gather_sides

end module new_scene
