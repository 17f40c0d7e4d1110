!> A body that passes through itself in steps: what is known of the first of them, until its end (module `failed_step`).
module crossing_record
  use kinds, only: wp
  implicit none
  private
  public :: crossing_record_t

  type :: crossing_record_t
    !> Length of the step and its end [time]; 0 where there was none.
    real(wp) :: length = 0.0_wp, until = 0.0_wp
    !> The body was between its sides, and had thinned to nothing.
    logical :: thinned = .false.
    !> The mesh was made since such a step was found in the one before.
    logical :: remeshed = .false.
  end type crossing_record_t

end module crossing_record
