!> What is known of a part without room to flow: of the worst step so far (module `confinement`).
module confinement_record
  use kinds, only: wp
  implicit none
  private
  public :: confinement_record_t, no_room_words, no_room_advice

  !> How the end of a run in such a part is called, and what helps.
  character(len=*), parameter :: no_room_words = 'no convergence in a body that has hardly any room to flow', &
                                 no_room_advice = 'a cavity that is full wants less volume, a shorter stroke, or a gap for flash'

  type :: confinement_record_t
    !> Group of the body; 0 where there was none.
    integer :: group = 0
    !> Time at which the first such step began [time].
    real(wp) :: since = 0.0_wp
    !> Its elastic change of volume, over the volume, and its mean pressure over the mean of von Mises' stress, where that change
    !> was largest.
    real(wp) :: change = 0.0_wp, over_stress = 0.0_wp
    !> The last step was one.
    logical :: now = .false.
  end type confinement_record_t

end module confinement_record
