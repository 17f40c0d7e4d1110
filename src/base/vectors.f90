!> Length of a vector whose round-off does not depend on its unit.
!>
!> The intrinsic norm2 scales numbers above one and no others, so that metres and millimetres differ in the last bit even where
!> their ratio is a power of two.
module vectors
  use kinds, only: wp
  implicit none
  private
  public :: length_of

contains

  pure function length_of(v) result(length)
    real(wp), intent(in) :: v(:)   !! (n) [of any unit]
    real(wp) :: length

    length = sqrt(dot_product(v, v))
  end function length_of

end module vectors
