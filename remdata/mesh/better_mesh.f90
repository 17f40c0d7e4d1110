!> Which of two meshes of the same contours is taken: one by zones, or one without.
!>
!> Zones that the remesher derives by itself lie well in a part that is nearly a quadrilateral, with rows of elements along its
!> contacts. Lines of a zone go through from side to side: where small elements are wanted in one place they are there all along
!> the lines, and where the part is no quadrilateral any more elements become skewed, and wear out within a few steps.
module better_mesh
  use kinds, only: wp
  use mesh_prediction, only: prediction_t
  use new_mesh_check, only: mesh_check_t
  implicit none
  private
  public :: free_mesh_is_better

  !> A scaled Jacobian below this is poor: an angle of 37 degrees. The free mesher has 0.6 to 0.85 as a rule. Meshes by zones with
  !> 0.4 to 0.6 were due again after 5 to 12 steps where free ones of the same place lasted for 10 to 80 (thirteen scenes).
  real(wp), parameter :: good_shape = 0.6_wp
  !> An expected error, or a number of elements, is worse that is larger by this factor; below it the rows of zones along the
  !> contacts count for more.
  real(wp), parameter :: larger = 1.25_wp

contains

  !> Where a mesh is of poor shape: is the one without zones of better shape? Else: is that by zones expected to have the larger
  !> error, in the whole or in the windows; or, where neither is and no other field would miss them, more elements? Errors below the
  !> limit the sizes were requested for are all good.
  pure function free_mesh_is_better(zones, zones_expected, free, free_expected, strains_only) result(better)
    type(mesh_check_t), intent(in) :: zones, free
    type(prediction_t), intent(in) :: zones_expected, free_expected
    logical, intent(in) :: strains_only   !! nothing is solved for but the motion: sizes by the error of the strains suit all
    logical :: better

    if (min(zones%scaled_jacobian, free%scaled_jacobian) < good_shape) then
      better = free%scaled_jacobian > zones%scaled_jacobian
    else
      better = is_worse(zones_expected, free_expected) &
               .or. (strains_only .and. zones_expected%elements > larger*free_expected%elements &
                     .and. .not. is_worse(free_expected, zones_expected))
    end if
  end function free_mesh_is_better

  !> One mesh is expected to have a clearly larger error than another, and one above the limit.
  pure function is_worse(one, other) result(worse)
    type(prediction_t), intent(in) :: one, other
    logical :: worse

    worse = one%mean > larger*max(1.0_wp, other%mean) .or. one%in_windows > larger*max(1.0_wp, other%in_windows)
  end function is_worse

end module better_mesh
