!> What is known of a die that few sides of elements have borne: of the step where it pressed most so (module `narrow_contacts`).
module narrow_record
  use kinds, only: wp
  implicit none
  private
  public :: narrow_record_t

  type :: narrow_record_t
    !> The die; 0 where there was none.
    integer :: die = 0
    !> Its force then [force], per radian when axisymmetric, and the last time at which one was borne so [time].
    real(wp) :: force = 0.0_wp, until = 0.0_wp
    !> Sides across the contact, and the error of the stress that the elements behind it made [-].
    real(wp) :: across = 0.0_wp, error = 0.0_wp
  end type narrow_record_t

end module narrow_record
