!> Smallest and largest elements of all bodies of a scene or of each by itself, and which contours are whose.
module limits_of_bodies
  use corrected_contours, only: contour_t
  use loop_group, only: group_of
  use remesher_options, only: bodies_have_sizes
  use scene, only: is_solid, scene_t
  use size_windows, only: size_limits_t
  implicit none
  private
  public :: bodies_have_sizes, limits_of_all, limits_of_body, materials_of_contours

contains

  !> Limits that hold for all bodies.
  pure function limits_of_all(scene) result(limits)
    type(scene_t), intent(in) :: scene
    type(size_limits_t) :: limits

    if (scene%remesher%smallest > 0) then
      limits%smallest = scene%remesher%smallest
      limits%at_bends = scene%remesher%smallest_at_bends
      limits%at_corners = scene%remesher%smallest_at_corners
    end if
    if (scene%remesher%largest > 0) limits%largest = scene%remesher%largest
  end function limits_of_all

  !> Limits of one of several bodies that are given by their contours.
  pure function limits_of_body(scene, body) result(limits)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: body   !! number of its material, which is that of its contour
    type(size_limits_t) :: limits

    limits%smallest = scene%remesher%contours(body)%smallest
    limits%at_bends = limits%smallest
    limits%at_corners = limits%smallest
    if (scene%remesher%smallest > 0) &
      limits%at_corners = limits%smallest*(scene%remesher%smallest_at_corners/scene%remesher%smallest)
    limits%largest = scene%remesher%contours(body)%largest
  end function limits_of_body

  !> Number of the material inside each contour, for bodies that share no nodes: their place among the bodies of the scene.
  pure function materials_of_contours(scene, contours) result(material)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    integer :: material(size(contours))
    integer :: c, g

    do c = 1, size(contours)
      material(c) = count([(is_solid(scene%groups(g)), g=1, group_of(scene, contours(c)%loop))])
    end do
  end function materials_of_contours

end module limits_of_bodies
