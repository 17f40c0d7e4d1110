!> Scalar measures of a stress (xx, yy, xy, zz): von Mises' equivalent stress, mean stress, principal stresses.
module stress_measures
  use kinds, only: wp
  implicit none
  private
  public :: measure_names, stress_measure, von_mises
  public :: nmeasure

  integer, parameter :: nmeasure = 5
  !> Principal stresses fall from the first to the third; one of them is that across the plane.
  character(len=11), parameter :: measure_names(nmeasure) = &
                                  ['mises      ', 'mean_stress', 'principal_1', 'principal_2', 'principal_3']

contains

  !> A measure by its place among the names, of one stress.
  pure function stress_measure(measure, stress) result(value)
    integer, intent(in) :: measure
    real(wp), intent(in) :: stress(4)   !! [stress]
    real(wp) :: value                   !! [stress]
    real(wp) :: middle, radius, high, low

    select case (measure)
    case (1)
      value = von_mises(stress)
    case (2)
      value = (stress(1) + stress(2) + stress(4))/3
    case default
      ! Mohr's circle in the plane
      middle = 0.5_wp*(stress(1) + stress(2))
      radius = hypot(0.5_wp*(stress(1) - stress(2)), stress(3))
      high = middle + radius
      low = middle - radius
      value = min(low, stress(4))
      if (measure == 3) value = max(high, stress(4))
      if (measure == 4) value = max(low, min(high, stress(4)))
    end select
  end function stress_measure

  !> von Mises' equivalent stress.
  pure function von_mises(stress) result(q)
    real(wp), intent(in) :: stress(4)   !! [stress]
    real(wp) :: q                       !! [stress]

    q = sqrt(0.5_wp*((stress(1) - stress(2))**2 + (stress(2) - stress(4))**2 + (stress(4) - stress(1))**2) + 3*stress(3)**2)
  end function von_mises

end module stress_measures
