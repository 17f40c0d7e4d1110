!> A mesh of 8-node quadrilaterals from contours, zones and requested sizes.
!>
!> After annex 2, section 3: sides are divided, the nodes of sides along the contour put on the contour with their middle nodes;
!> then all inner lines follow (transfinite, elliptic), where the annex moves the nearest one and recommends all.
module zone_mesh
  use boundary_curves, only: boundary_curve_t, position_t
  use contour_divisions, only: divide_sides, order_along
  use curve_divisions, only: measure_density
  use errors, only: error_t
  use kinds, only: wp
  use side_curves, only: curve_point, curve_t, draw_side, snap_to_joints
  use side_middles, only: bend_lines, place_middle
  use size_field, only: size_field_t
  use untangle_elements, only: untangle
  use zone_divisions, only: choose_divisions, division_settings_t, division_t
  use zone_layout, only: lay_out
  use zone_lines, only: find_movable, interpolate_zones, smooth_zones
  use zone_node_numbers, only: divisions_of, ends_of_side, ends_of_zone, middles_of_side, middles_of_zone, node_numbers_t, &
                               number_nodes
  use zones, only: coordinates_of, follows_interface, runs_straight, zone_layout_t, zone_point_t, zone_t
  implicit none
  private
  public :: mesh_settings_t, contour_side_t, new_mesh_t, seam_side_t, mesh_zones

  !> Settings of a mesh, which are changed when one is refused.
  type :: mesh_settings_t
    type(division_settings_t) :: division
    !> Passes of smoothing, 0 for lines as they are interpolated.
    integer :: passes = 12
    !> Elements with a smaller sine between their lines are untangled, 0: none.
    real(wp) :: least_sine = 0.4_wp
  end type mesh_settings_t

  !> A side of an element on the contour, the part on its left.
  type :: contour_side_t
    integer :: nodes(3) = 0   !! first end, middle, second end
    integer :: element = 0
    integer :: boundary = 0
    type(position_t) :: from, to
  end type contour_side_t

  !> A side of two elements along a seam: first end, middle, second end, and the path of the layout that it follows.
  type :: seam_side_t
    integer :: nodes(3) = 0, path = 0
  end type seam_side_t

  type :: new_mesh_t
    real(wp), allocatable :: coordinates(:, :)   !! (2, nnode) [length]
    integer, allocatable :: connectivity(:, :)   !! (8, nelem) in the order of `quad8`
    integer, allocatable :: zone(:)              !! (nelem)
    !> Boundary curve and position of a node, 0 inside (nnode).
    integer, allocatable :: boundary(:)
    type(position_t), allocatable :: position(:)
    !> Contour sides, sorted by boundary curve and position.
    type(contour_side_t), allocatable :: sides(:)
    !> Sides along seams, of meshes without zones, the left part on their left.
    type(seam_side_t), allocatable :: seams(:)
    type(zone_layout_t) :: layout
    type(division_t) :: division
  end type new_mesh_t

contains

  !> The mesh, or the reason of the failure. `division%factor` of the mesh is the effect of a limited number of elements.
  pure subroutine mesh_zones(boundaries, points, zones, field, settings, mesh, error, paths)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(zone_point_t), intent(in) :: points(:)           !! (npoint)
    type(zone_t), intent(in) :: zones(:)                  !! (nzone)
    type(size_field_t), intent(in) :: field
    type(mesh_settings_t), intent(in) :: settings
    type(new_mesh_t), intent(out) :: mesh
    type(error_t), allocatable, intent(out) :: error
    type(boundary_curve_t), optional, intent(in) :: paths(:)   !! (npath) of sides along interfaces
    type(curve_t), allocatable :: curves(:)
    type(node_numbers_t) :: numbers
    type(zone_point_t) :: snapped(size(points))
    logical, allocatable :: may_move(:)
    integer, allocatable :: first(:)
    real(wp), allocatable :: ends(:)
    integer :: s

    call lay_out(boundaries, points, zones, mesh%layout, error, paths)
    if (allocated(error)) return
    snapped = points
    call snap_to_joints(boundaries, mesh%layout%zones, field, snapped)
    call lay_out(boundaries, snapped, zones, mesh%layout, error, paths)
    if (allocated(error)) return
    associate (layout => mesh%layout, division => mesh%division)
      allocate (curves(size(layout%sides)))
      do s = 1, size(curves)
        call draw_side(boundaries, layout, layout%sides(s), field, curves(s))
        associate (beside => layout%sides(s)%zones)
          if (layout%sides(s)%form == follows_interface) then
            call measure_density(boundaries, field, layout%zones(beside(1))%material, curves(s), layout%zones(beside(2))%material)
          else
            call measure_density(boundaries, field, layout%zones(beside(1))%material, curves(s))
          end if
        end associate
      end do
      call choose_divisions(boundaries, layout, field, curves, settings%division, division, error)
      if (allocated(error)) return
      numbers = number_nodes(layout, division)
      allocate (mesh%coordinates(2, numbers%nnode), mesh%boundary(numbers%nnode), mesh%position(numbers%nnode))
      mesh%boundary = 0
      call put_points(boundaries, layout, numbers, mesh)
      allocate (first(size(curves) + 1))
      call divide_sides(layout, curves, division, field%limits%gradation, first, ends)
      do s = 1, size(curves)
        call put_side(boundaries, layout, division, numbers, ends(first(s):first(s + 1) - 1), curves(s), s, mesh)
      end do
      call interpolate_zones(layout, division, numbers, mesh%coordinates)
      if (settings%passes > 0) call smooth_zones(layout, division, numbers, field, settings%passes, mesh%coordinates)
      call make_elements(layout, division, numbers, mesh)
      if (settings%least_sine > 0) then
        call find_movable(layout, division, numbers, may_move)
        call untangle(mesh%connectivity, may_move, settings%least_sine, mesh%coordinates)
      end if
      call list_sides(layout, division, numbers, curves, mesh)
    end associate
  end subroutine mesh_zones

  !> Nodes at the zone points.
  pure subroutine put_points(boundaries, layout, numbers, mesh)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(in) :: layout
    type(node_numbers_t), intent(in) :: numbers
    type(new_mesh_t), intent(inout) :: mesh
    integer :: p

    do p = 1, size(layout%points)
      associate (node => numbers%point(p))
        if (node == 0) cycle
        mesh%coordinates(:, node) = coordinates_of(boundaries, layout%points(p))
        mesh%boundary(node) = layout%points(p)%boundary
        mesh%position(node) = layout%points(p)%position
      end associate
    end do
  end subroutine put_points

  !> Nodes along a side: ends of elements; middles too where the side is a fixed curve.
  pure subroutine put_side(boundaries, layout, division, numbers, s, curve, side, mesh)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    real(wp), intent(in) :: s(0:)   !! lengths to the ends of elements [length]
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: side
    type(new_mesh_t), intent(inout) :: mesh
    integer :: nodes(0:division%count(side)), middles(division%count(side)), k, n

    n = division%count(side)
    nodes = ends_of_side(layout, division, numbers, side)
    middles = middles_of_side(division, numbers, side)
    do k = 1, n - 1
      call curve_point(boundaries, curve, s(k), mesh%coordinates(:, nodes(k)), mesh%position(nodes(k)))
    end do
    mesh%boundary(nodes(1:n - 1)) = curve%boundary
    if (layout%sides(side)%form == runs_straight) return
    do k = 1, n
      call place_middle(boundaries, curve, s(k - 1:k), mesh%coordinates(:, nodes(k - 1:k)), &
                        mesh%coordinates(:, middles(k)), mesh%position(middles(k)))
    end do
    mesh%boundary(middles) = curve%boundary
  end subroutine put_side

  !> Middle nodes inside and elements, zone by zone and row by row.
  pure subroutine make_elements(layout, division, numbers, mesh)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    type(new_mesh_t), intent(inout) :: mesh
    integer, allocatable :: grid(:, :), along(:, :), across(:, :)
    integer :: z, i, j, e

    allocate (mesh%connectivity(8, division%nelem), mesh%zone(division%nelem))
    e = 0
    do z = 1, size(layout%zones)
      call ends_of_zone(layout, division, numbers, z, grid)
      call middles_of_zone(layout, division, numbers, z, along, across)
      call bend_lines(grid, along, across, layout%sides(layout%zone_sides(:, z))%form == runs_straight, mesh%coordinates)
      do j = 1, ubound(grid, 2)
        do i = 1, ubound(grid, 1)
          e = e + 1
          mesh%zone(e) = z
          mesh%connectivity(:, e) = [grid(i - 1, j - 1), grid(i, j - 1), grid(i, j), grid(i - 1, j), &
                                     along(i, j - 1), across(i, j), along(i, j), across(i - 1, j)]
        end do
      end do
    end do
  end subroutine make_elements

  !> Sides of elements on the contour.
  pure subroutine list_sides(layout, division, numbers, curves, mesh)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    type(curve_t), intent(in) :: curves(:)
    type(new_mesh_t), intent(inout) :: mesh
    integer :: first(size(layout%zones) + 1), n, s, i, k, z
    integer, allocatable :: order(:), nodes(:), middles(:)

    first(1) = 0
    do z = 1, size(layout%zones)
      first(z + 1) = first(z) + product(division%count(layout%zone_sides(1:2, z)))
    end do
    call order_along(layout, curves, order)
    allocate (mesh%sides(sum(division%count(order))))
    n = 0
    do i = 1, size(order)
      s = order(i)
      nodes = ends_of_side(layout, division, numbers, s)
      middles = middles_of_side(division, numbers, s)
      associate (z => layout%sides(s)%zones(1), local => layout%sides(s)%local(1))
        do k = 1, size(middles)
          n = n + 1
          mesh%sides(n)%nodes = [nodes(k), middles(k), nodes(k + 1)]
          mesh%sides(n)%element = first(z) + number_beside(local, k, divisions_of(layout, division, z))
          mesh%sides(n)%boundary = layout%sides(s)%boundary
          mesh%sides(n)%from = mesh%position(nodes(k))
          mesh%sides(n)%to = mesh%position(nodes(k + 1))
        end do
      end associate
    end do
  end subroutine list_sides

  !> Element k of a zone along one of its sides, in the direction of the zone.
  pure function number_beside(side, k, n) result(element)
    integer, intent(in) :: side, k, n(2)
    integer :: element

    select case (side)
    case (1)
      element = k
    case (2)
      element = n(1)*k
    case (3)
      element = n(1)*n(2) - k + 1
    case default
      element = n(1)*(n(2) - k) + 1
    end select
  end function number_beside

end module zone_mesh
