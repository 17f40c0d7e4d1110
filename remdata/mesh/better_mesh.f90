!> Which of two meshes of the same contours is taken: one by zones, or one without.
!>
!> Zones that the remesher derives by itself follow the contour well while the part is nearly a quadrilateral, and become slender or
!> skewed where it is none any more. Both meshes are measured by their shape and by the elements they would need to have the error
!> that the sizes were requested for.
module better_mesh
  use kinds, only: wp
  use mesh_prediction, only: prediction_t
  use new_mesh_check, only: mesh_check_t
  implicit none
  private
  public :: elements_at_limit, free_mesh_is_better

  !> A scaled Jacobian below this is poor: about what the free mesher reaches on contours with corners of 30 degrees.
  real(wp), parameter :: good_shape = 0.5_wp

contains

  !> Elements of a mesh with the same distribution of sizes whose mean error is at its limit: in the plane errors of order p go with
  !> the number of elements to the power -p/2.
  pure function elements_at_limit(nelem, expected, order) result(number)
    integer, intent(in) :: nelem
    type(prediction_t), intent(in) :: expected
    real(wp), intent(in) :: order   !! p
    real(wp) :: number

    number = nelem*expected%mean**(2/order)
  end function elements_at_limit

  !> Where the mesh by zones is of poor shape: is the one without of better shape? Else: does it need fewer elements for the same
  !> error?
  pure function free_mesh_is_better(zones, zones_elements, free, free_elements) result(better)
    type(mesh_check_t), intent(in) :: zones, free
    real(wp), intent(in) :: zones_elements, free_elements   !! at the limit of the error
    logical :: better

    if (min(zones%scaled_jacobian, free%scaled_jacobian) < good_shape) then
      better = free%scaled_jacobian > zones%scaled_jacobian
    else
      better = free_elements < zones_elements
    end if
  end function free_mesh_is_better

end module better_mesh
