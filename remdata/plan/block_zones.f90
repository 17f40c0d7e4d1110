!> The blocks of a deck as zones: four sets of sides each, `name.1` to `name.4`, which every remesh creates again.
!>
!> A corner of a single zone is located by shape (corners_by_shape). A corner that several zones share on the contour follows the
!> material point; one inside moves with it, and smoothing may move it further.
module block_zones
  use corners_by_shape, only: assign_by_shape
  use corrected_contours, only: contour_t
  use errors, only: error_t
  use kinds, only: wp
  use material_interfaces, only: node_on_contour
  use mesh, only: find_side_set
  use remesher_options, only: has_contours
  use scene, only: is_solid, scene_t
  use text, only: to_text
  use zones, only: follows_contour, plan_t, zone_point_t, zone_t
  implicit none
  private
  public :: are_blocks, zones_of_blocks

contains

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

  !> Zones as blocks had them.
  pure subroutine zones_of_blocks(scene, x, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)              !! nodes now (2, nnode) [length]
    integer, intent(in) :: material(:)           !! (ngroup) of each group of the scene
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
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

end module block_zones
