!> Zones of a scene on its corrected contours: where their corners go.
!>
!> The blocks of a deck are its zones: four sets of sides each, `name.1` to `name.4`, which every remesh creates again. A corner of
!> a single zone is located by shape: at the corner of the contour, or the beginning or end of contact, nearest to it. When a side
!> folds onto a die the old corner lies flat there, and the new one is where contact ends. A corner that several zones share on the
!> contour follows the material point; one inside moves with it, and smoothing may move it further.
!>
!> ZONE cards replace the blocks: their points are defined by ZPNT cards (marked_points), and all zones that name a point share it.
!> Sets of sides are kept along the contour only.
!>
!> Zones with a corner that has become flat are divided (flat_corners). Sides between two materials follow their interface, and its
!> ends on the contour are the corners of zones there (interface_sides).
module zone_plan
  use block_mesh, only: polygon_area
  use body_outlines, only: refuse_inner_sets
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, kind_corner, kind_entry, kind_exit, position_t, &
                             turn_at
  use derived_zones, only: one_zone
  use errors, only: error_t, exit_input, fail
  use flat_corners, only: divide_flat_zones
  use interface_sides, only: follow_interfaces
  use kinds, only: wp
  use marked_points, only: find_points
  use material_interfaces, only: interface_t, node_on_contour
  use mesh, only: find_side_set
  use part_contour, only: contour_t
  use remesher_options, only: has_contours, has_zones
  use scene, only: is_solid, lacks_mesh, scene_t
  use text, only: to_text
  use zones, only: follows_contour, plan_t, zone_point_t, zone_t
  implicit none
  private
  public :: plan_zones

  !> A point coincides with a corner that is nearer than this share of the contour.
  real(wp), parameter :: coincidence_tolerance = 1.0e-6_wp
  !> Share of the contour that must be free beside an end of contact for a corner of a zone to be located there.
  real(wp), parameter :: free_share = 0.1_wp

contains

  !> Zones of all solid groups.
  pure subroutine plan_zones(scene, x, pilots, material, contours, interfaces, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)                  !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilots(:, :)             !! (3, ndie) x, y, angle of the dies now [length and radian]
    integer, intent(in) :: material(:)               !! of each group of the scene, as for the sizes (ngroup)
    type(contour_t), intent(in) :: contours(:)       !! (ncontour)
    type(interface_t), intent(in) :: interfaces(:)   !! (ninterface) between materials of the old mesh
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error

    if (has_zones(scene%remesher)) then
      call zones_of_cards(scene, x, pilots, material, contours, plan, error)
    else if (are_blocks(scene)) then
      call zones_of_blocks(scene, x, material, contours, plan, error)
    else
      call zone_of_corners(scene, material, contours, plan, error)
    end if
    if (.not. allocated(error)) call refuse_coincident_points(contours, plan, error)
    if (allocated(error)) return
    call divide_flat_zones(contours, plan)
    if (.not. lacks_mesh(scene)) call follow_interfaces(scene, material, contours, interfaces, plan, error)
  end subroutine plan_zones

  !> Zones as the cards give them.
  pure subroutine zones_of_cards(scene, x, pilots, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :), pilots(:, :)
    integer, intent(in) :: material(:)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error
    integer :: corners(4), z, k

    call find_points(scene, x, pilots, contours, plan%points, error)
    if (allocated(error)) return
    associate (cards => scene%remesher%zones)
      allocate (plan%zones(size(cards)), plan%group(size(cards)))
      allocate (plan%sets(4, size(cards)), source=0)
      do z = 1, size(cards)
        plan%group(z) = cards(z)%group
        plan%zones(z)%name = cards(z)%name
        plan%zones(z)%corners = cards(z)%marks
        plan%zones(z)%material = material(cards(z)%group)
        corners = cards(z)%marks
        if (polygon_area(reshape([(plan%points(corners(k))%x, k=1, 4)], [2, 4])) < 0) plan%zones(z)%corners = corners([1, 4, 3, 2])
      end do
    end associate
  end subroutine zones_of_cards

  !> Are all bodies blocks, with their four sides still?
  pure function are_blocks(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: g, k, set

    yes = .not. has_contours(scene%remesher)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do k = 1, 4
        set = find_side_set(scene%mesh, scene%groups(g)%name//'.'//to_text(k))
        yes = yes .and. set > 0
        ! a side that was cut off
        if (yes) yes = size(scene%mesh%sides(set)%nodes, 2) > 0
      end do
    end do
  end function are_blocks

  !> The zone of a body that has four corners and is no block. They are marked by the sets of sides that meet there, if these are
  !> four too.
  pure subroutine zone_of_corners(scene, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error
    type(position_t), allocatable :: marked(:)
    integer :: c, k, n

    call refuse_inner_sets(scene, contours, error)
    if (allocated(error)) return
    allocate (marked(0))
    if (size(contours) == 1) then
      associate (boundary => contours(1)%boundary, tags => contours(1)%tags)
        n = size(boundary%arcs)
        do k = 1, n
          associate (one => boundary%arcs(modulo(k - 2, n) + 1)%side, other => boundary%arcs(k)%side)
            if (all(tags%on_set(:, one) .eqv. tags%on_set(:, other))) cycle
          end associate
          marked = [marked, position_t(k, boundary%arcs(k)%range(1))]
        end do
      end associate
    end if
    if (size(marked) /= 4) marked = [position_t ::]
    call one_zone([(contours(c)%boundary, c=1, size(contours))], marked, plan%points, plan%zones, error)
    if (allocated(error)) return
    allocate (plan%group(1), source=findloc([(is_solid(scene%groups(k)), k=1, size(scene%groups))], .true., 1))
    plan%zones%material = material(plan%group(1))
    plan%zones(1)%form = follows_contour
    allocate (plan%sets(4, 1), source=0)
  end subroutine zone_of_corners

  !> Zones as blocks had them.
  pure subroutine zones_of_blocks(scene, x, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)
    integer, intent(in) :: material(:)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error
    integer :: point_of(size(x, 2)), sharing(size(x, 2)), corners(4), g, k, n, z

    n = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) n = n + 1
    end do
    allocate (plan%zones(n), plan%group(n), plan%sets(4, n), plan%points(0))
    sharing = 0
    z = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      z = z + 1
      plan%group(z) = g
      plan%zones(z)%material = material(g)
      do k = 1, 4
        plan%sets(k, z) = find_side_set(scene%mesh, scene%groups(g)%name//'.'//to_text(k))
      end do
      corners = corners_of(scene, plan%sets(:, z))
      sharing(corners) = sharing(corners) + 1
    end do
    point_of = 0
    do z = 1, n
      corners = corners_of(scene, plan%sets(:, z))
      do k = 1, 4
        if (point_of(corners(k)) == 0) then
          plan%points = [plan%points, point_at_node(contours, x, corners(k))]
          associate (new => plan%points(size(plan%points)))
            new%by_shape = sharing(corners(k)) == 1 .and. new%boundary > 0
          end associate
          point_of(corners(k)) = size(plan%points)
        end if
        plan%zones(z)%corners(k) = point_of(corners(k))
      end do
    end do
    call assign_by_shape(contours, plan%points)
    do z = 1, n
      call follow_contours(scene, contours, plan%sets(:, z), plan%zones(z))
    end do
  end subroutine zones_of_blocks

  !> First nodes of the four sides of a block.
  pure function corners_of(scene, sets) result(nodes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: sets(4)
    integer :: nodes(4), k

    do k = 1, 4
      nodes(k) = scene%mesh%sides(sets(k))%nodes(1, 1)
    end do
  end function corners_of

  !> Present position of a corner of a zone that follows the material.
  pure function point_at_node(contours, x, node) result(point)
    type(contour_t), intent(in) :: contours(:)
    real(wp), intent(in) :: x(:, :)
    integer, intent(in) :: node
    type(zone_point_t) :: point

    point%x = x(:, node)
    call node_on_contour(contours, x, node, point%boundary, point%position)
  end function point_at_node

  !> Points in a corner of the contour stay there; the others are moved to the nearest corner, beginning or end of contact that is
  !> not taken.
  pure subroutine assign_by_shape(contours, points)
    type(contour_t), intent(in) :: contours(:)
    type(zone_point_t), intent(inout) :: points(:)
    logical :: assigned(size(points))
    integer :: p, pass, joint(size(points))
    real(wp) :: distance

    assigned = .not. points%by_shape
    joint = 0
    do pass = 1, 2
      do p = 1, size(points)
        if (assigned(p)) cycle
        call free_joint(contours(points(p)%boundary)%boundary, points(p)%position, &
                           pack(joint, points%boundary == points(p)%boundary .and. joint > 0), joint(p), distance)
        if (joint(p) == 0 .or. (pass == 1 &
                                .and. distance > coincidence_tolerance*boundary_length(contours(points(p)%boundary)%boundary))) then
          joint(p) = 0
          cycle
        end if
        points(p)%position = position_t(joint(p), contours(points(p)%boundary)%boundary%arcs(joint(p))%range(1))
        assigned(p) = .true.
      end do
    end do
  end subroutine assign_by_shape

  !> The nearest corner, beginning or end of contact along the boundary curve that is not taken; 0 when there is none.
  pure subroutine free_joint(boundary, from, taken, joint, least)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: from
    integer, intent(in) :: taken(:)
    integer, intent(out) :: joint
    real(wp), intent(out) :: least
    real(wp) :: here, distance
    integer :: k

    joint = 0
    here = arc_length_at(boundary, from)
    least = huge(least)
    do k = 1, size(boundary%arcs)
      distance = abs(boundary%arc_length(k - 1) - here)
      distance = min(distance, boundary_length(boundary) - distance)
      if (any(taken == k) .or. .not. distance < least) cycle
      ! where contact ends in a corner the corner is used
      if (.not. (boundary%kinds(k) == kind_corner .or. is_outer_end(boundary, k) .or. &
                 (distance <= coincidence_tolerance*boundary_length(boundary) &
                  .and. abs(turn_at(boundary, k)) > boundary%corner_turn))) cycle
      least = distance
      joint = k
    end do
  end subroutine free_joint

  !> Does contact begin or end there for a large part of the contour? Gaps within contact are not considered.
  pure function is_outer_end(boundary, joint) result(outer)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: joint
    logical :: outer
    real(wp) :: distance
    integer :: k, i, n

    outer = .false.
    if (all(boundary%kinds(joint) /= [kind_entry, kind_exit])) return
    n = size(boundary%arcs)
    distance = 0
    do i = 1, n
      k = merge(modulo(joint + i - 2, n) + 1, modulo(joint - i - 1, n) + 1, boundary%kinds(joint) == kind_exit)
      if (boundary%arcs(k)%interval > 0) exit
      distance = distance + boundary%arc_length(k) - boundary%arc_length(k - 1)
    end do
    outer = distance > free_share*boundary_length(boundary)
  end function is_outer_end

  !> Sides of a zone that the contour forms: those whose old sides are on it.
  pure subroutine follow_contours(scene, contours, sets, zone)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: sets(4)
    type(zone_t), intent(inout) :: zone
    integer :: c, k

    do k = 1, 4
      do c = 1, size(contours)
        if (any(contours(c)%loop%sides(2, :) == scene%mesh%sides(sets(k))%nodes(2, 1))) zone%form(k) = follows_contour
      end do
    end do
  end subroutine follow_contours

  !> Two corners of zones may not coincide.
  pure subroutine refuse_coincident_points(contours, plan, error)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    type(error_t), allocatable, intent(out) :: error
    integer :: i, k

    do k = 2, size(plan%points)
      do i = 1, k - 1
        associate (a => plan%points(i), b => plan%points(k))
          if (a%boundary == 0 .or. a%boundary /= b%boundary) cycle
          if (abs(arc_length_at(contours(a%boundary)%boundary, a%position) &
                  - arc_length_at(contours(b%boundary)%boundary, b%position)) > 0) cycle
          call fail(error, exit_input, 'two corners of zones'//names_of(a, b)//' coincide at x = '//to_text(a%x(1)) &
                    //', y = '//to_text(a%x(2))//': the contour has lost a corner there', &
                    'give zones that fit the new shape, or remesh earlier')
          return
        end associate
      end do
    end do

  contains

    pure function names_of(a, b) result(names)
      type(zone_point_t), intent(in) :: a, b
      character(len=:), allocatable :: names

      names = ''
      if (a%name /= '') names = ' ('//trim(a%name)//', '//trim(b%name)//')'
    end function names_of

  end subroutine refuse_coincident_points

end module zone_plan
