!> Small vectors in the plane.
module plane_vectors
  use kinds, only: wp
  use vectors, only: length_of
  implicit none
  private
  public :: cross, angle_between, left_of, right_of, turned

contains

  !> Component of a x b normal to the plane: positive when b is on the left of a.
  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(2)   !! [of any unit]
    real(wp), intent(in) :: b(2)   !! [of any unit]
    real(wp) :: c

    c = a(1)*b(2) - a(2)*b(1)
  end function cross

  !> Turn from a to b, between -pi and pi [radian].
  pure function angle_between(a, b) result(angle)
    real(wp), intent(in) :: a(2), b(2)   !! directions [of any unit]
    real(wp) :: angle

    angle = atan2(cross(a, b), dot_product(a, b))
  end function angle_between

  !> Unit vector to the left of a direction.
  pure function left_of(v) result(n)
    real(wp), intent(in) :: v(2)   !! not zero [of any unit]
    real(wp) :: n(2)

    n = [-v(2), v(1)]/length_of(v)
  end function left_of

  !> Unit vector to the right of a direction: the inner normal of a die.
  pure function right_of(v) result(n)
    real(wp), intent(in) :: v(2)   !! not zero [of any unit]
    real(wp) :: n(2)

    n = [v(2), -v(1)]/length_of(v)
  end function right_of

  !> A vector turned by an angle, counterclockwise.
  pure function turned(v, angle) result(w)
    real(wp), intent(in) :: v(2)    !! [of any unit]
    real(wp), intent(in) :: angle   !! [radian]
    real(wp) :: w(2)

    w = [cos(angle)*v(1) - sin(angle)*v(2), sin(angle)*v(1) + cos(angle)*v(2)]
  end function turned

end module plane_vectors
