!> Which of two meshes of the same contours is taken: one by zones, or one without.
!>
!> Zones that the remesher derives by itself lie well in a part that is nearly a quadrilateral, with rows of elements along its
!> contacts; where it is none any more they become skewed, and cannot follow the requested sizes within the limit on elements.
module better_mesh
  use kinds, only: wp
  use mesh_prediction, only: prediction_t
  use new_mesh_check, only: mesh_check_t
  implicit none
  private
  public :: free_mesh_is_better

  !> A scaled Jacobian below this is poor: an angle of 24 degrees. By default another mesh is due at 15 degrees.
  real(wp), parameter :: good_shape = 0.4_wp
  !> An expected error is worse that is larger by this factor; below it the rows of zones along the contacts count for more.
  real(wp), parameter :: larger_error = 1.25_wp

contains

  !> Where a mesh is of poor shape: is the one without zones of better shape? Else: is that by zones expected to have the larger
  !> error, in the whole or in the windows? Errors below the limit the sizes were requested for are all good.
  pure function free_mesh_is_better(zones, zones_expected, free, free_expected) result(better)
    type(mesh_check_t), intent(in) :: zones, free
    type(prediction_t), intent(in) :: zones_expected, free_expected
    logical :: better

    if (min(zones%scaled_jacobian, free%scaled_jacobian) < good_shape) then
      better = free%scaled_jacobian > zones%scaled_jacobian
    else
      better = zones_expected%mean > larger_error*max(1.0_wp, free_expected%mean) &
               .or. zones_expected%in_windows > larger_error*max(1.0_wp, free_expected%in_windows)
    end if
  end function free_mesh_is_better

end module better_mesh
