!> A mesh of 8-node quadrilaterals from contours, zones and wanted sizes.
!>
!> After annex 2, section 3: sides are divided, the nodes of sides along the contour put on the contour with their middle nodes;
!> then the lines inside all follow (transfinite, elliptic), where the annex moves the nearest one and wishes for all.
module zone_mesh
  use contour_chain, only: chain_t, place_t
  use contour_divisions, only: divide_sides, order_along
  use errors, only: error_t
  use kinds, only: wp
  use mend_elements, only: mend
  use side_curves, only: curve_point, curve_t, draw_side, measure_density, snap_to_joints
  use side_middles, only: bend_lines, place_middle
  use size_field, only: size_field_t
  use zone_divisions, only: choose_divisions, division_t, division_wish_t
  use zone_lines, only: find_movable, interpolate_zones, smooth_zones
  use zone_numbers, only: divisions_of, ends_of_side, ends_of_zone, middles_of_side, middles_of_zone, &
                          number_nodes, numbers_t
  use zones, only: coordinates_of, follows_interface, layout_t, lay_out, runs_straight, zone_point_t, zone_t
  implicit none
  private
  public :: mesh_wish_t, contour_side_t, new_mesh_t, mesh_zones

  !> What may be asked of a mesh, and asked otherwise when one is refused.
  type :: mesh_wish_t
    type(division_wish_t) :: division
    !> Passes of smoothing, 0 for lines as they are interpolated.
    integer :: passes = 12
    !> Elements with a smaller sine between their lines are mended, 0: none.
    real(wp) :: least_sine = 0.3_wp
  end type mesh_wish_t

  !> A side of an element on the contour, the part on its left.
  type :: contour_side_t
    integer :: nodes(3) = 0        !! first end, middle, second end
    integer :: element = 0
    integer :: chain = 0
    type(place_t) :: from, to
  end type contour_side_t

  type :: new_mesh_t
    real(wp), allocatable :: coordinates(:, :)          !! (2, nnode) [length]
    integer, allocatable :: connectivity(:, :)          !! (8, nelem) in the order of `quad8`
    integer, allocatable :: zone(:)                     !! (nelem)
    !> Chain a node lies on, 0 inside, and where (nnode).
    integer, allocatable :: chain(:)
    type(place_t), allocatable :: place(:)
    !> Contour sides, chain by chain, in order along each.
    type(contour_side_t), allocatable :: sides(:)
    type(layout_t) :: layout
    type(division_t) :: division
  end type new_mesh_t

contains

  !> The mesh, or why there can be none. `division%factor` of the mesh says what a limited number of elements cost.
  pure subroutine mesh_zones(chains, points, zones, field, wish, mesh, error, paths)
    type(chain_t), intent(in) :: chains(:)
    type(zone_point_t), intent(in) :: points(:)
    type(zone_t), intent(in) :: zones(:)
    type(size_field_t), intent(in) :: field
    type(mesh_wish_t), intent(in) :: wish
    type(new_mesh_t), intent(out) :: mesh
    type(error_t), allocatable, intent(out) :: error
    type(chain_t), optional, intent(in) :: paths(:)   !! of sides along interfaces
    type(curve_t), allocatable :: curves(:)
    type(numbers_t) :: numbers
    type(zone_point_t) :: snapped(size(points))
    logical, allocatable :: may_move(:)
    integer, allocatable :: first(:)
    real(wp), allocatable :: ends(:)
    integer :: s

    call lay_out(chains, points, zones, mesh%layout, error, paths)
    if (allocated(error)) return
    snapped = points
    call snap_to_joints(chains, mesh%layout%zones, field, snapped)
    call lay_out(chains, snapped, zones, mesh%layout, error, paths)
    if (allocated(error)) return
    associate (layout => mesh%layout, division => mesh%division)
      allocate (curves(size(layout%sides)))
      do s = 1, size(curves)
        call draw_side(chains, layout, layout%sides(s), field, curves(s))
        associate (beside => layout%sides(s)%zones)
          if (layout%sides(s)%form == follows_interface) then
            call measure_density(chains, field, layout%zones(beside(1))%material, curves(s), layout%zones(beside(2))%material)
          else
            call measure_density(chains, field, layout%zones(beside(1))%material, curves(s))
          end if
        end associate
      end do
      call choose_divisions(chains, layout, field, curves, wish%division, division, error)
      if (allocated(error)) return
      numbers = number_nodes(layout, division)
      allocate (mesh%coordinates(2, numbers%nnode), mesh%chain(numbers%nnode), mesh%place(numbers%nnode))
      mesh%chain = 0
      call put_points(chains, layout, numbers, mesh)
      allocate (first(size(curves) + 1))
      call divide_sides(layout, curves, division, field%limits%gradation, first, ends)
      do s = 1, size(curves)
        call put_side(chains, layout, division, numbers, ends(first(s):first(s + 1) - 1), curves(s), s, mesh)
      end do
      call interpolate_zones(layout, division, numbers, mesh%coordinates)
      if (wish%passes > 0) call smooth_zones(layout, division, numbers, field, wish%passes, mesh%coordinates)
      call make_elements(layout, division, numbers, mesh)
      if (wish%least_sine > 0) then
        call find_movable(layout, division, numbers, may_move)
        call mend(mesh%connectivity, may_move, wish%least_sine, mesh%coordinates)
      end if
      call list_sides(layout, division, numbers, curves, mesh)
    end associate
  end subroutine mesh_zones

  !> Nodes at the zone points.
  pure subroutine put_points(chains, layout, numbers, mesh)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(numbers_t), intent(in) :: numbers
    type(new_mesh_t), intent(inout) :: mesh
    integer :: p

    do p = 1, size(layout%points)
      associate (node => numbers%point(p))
        if (node == 0) cycle
        mesh%coordinates(:, node) = coordinates_of(chains, layout%points(p))
        mesh%chain(node) = layout%points(p)%chain
        mesh%place(node) = layout%points(p)%place
      end associate
    end do
  end subroutine put_points

  !> Nodes along a side: ends of elements; middles too where the side is a curve that stays.
  pure subroutine put_side(chains, layout, division, numbers, s, curve, side, mesh)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(numbers_t), intent(in) :: numbers
    real(wp), intent(in) :: s(0:)               !! lengths to the ends of elements [length]
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: side
    type(new_mesh_t), intent(inout) :: mesh
    integer :: nodes(0:division%count(side)), middles(division%count(side)), k, n

    n = division%count(side)
    nodes = ends_of_side(layout, division, numbers, side)
    middles = middles_of_side(division, numbers, side)
    do k = 1, n - 1
      call curve_point(chains, curve, s(k), mesh%coordinates(:, nodes(k)), mesh%place(nodes(k)))
    end do
    mesh%chain(nodes(1:n - 1)) = curve%chain
    if (layout%sides(side)%form == runs_straight) return
    do k = 1, n
      call place_middle(chains, curve, s(k - 1:k), mesh%coordinates(:, nodes(k - 1:k)), &
                        mesh%coordinates(:, middles(k)), mesh%place(middles(k)))
    end do
    mesh%chain(middles) = curve%chain
  end subroutine put_side

  !> Middle nodes inside and elements, zone by zone and row by row.
  pure subroutine make_elements(layout, division, numbers, mesh)
    type(layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(numbers_t), intent(in) :: numbers
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
    type(layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(numbers_t), intent(in) :: numbers
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
          mesh%sides(n)%chain = layout%sides(s)%chain
          mesh%sides(n)%from = mesh%place(nodes(k))
          mesh%sides(n)%to = mesh%place(nodes(k + 1))
        end do
      end associate
    end do
  end subroutine list_sides

  !> Element k of a zone along one of its sides, counted as the zone walks it.
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
