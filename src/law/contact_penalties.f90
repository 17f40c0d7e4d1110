!> The numbers every contact law begins with: allowed penetration or penalties, and augmentation.
module contact_penalties
  use kinds, only: wp
  use law_api, only: parameter, parameter_t
  implicit none
  private
  public :: penalty_parameters

contains

  !> PENETR, AKP, AKTAU, AUGMENT: places 1 to 4 of a contact material's values.
  function penalty_parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(4))
    list(1) = parameter('PENETR', '-', 'allowed penetration, share of the element side (0: AKP is given)', &
                        lower=0.0_wp, upper=0.1_wp, default=1.0e-3_wp)
    list(2) = parameter('AKP', 'stress/length', 'normal penalty (0: from PENETR)', lower=0.0_wp, default=0.0_wp)
    list(3) = parameter('AKTAU', 'stress/length', 'tangential penalty (0: a tenth of AKP)', lower=0.0_wp, default=0.0_wp)
    list(4) = parameter('AUGMENT', '-', 'largest number of augmentations in a step', &
                        lower=0.0_wp, upper=50.0_wp, default=0.0_wp)
  end function penalty_parameters

end module contact_penalties
