!> The numbers every contact law begins with: allowed penetration or penalties, and augmentation.
module contact_penalties
  use kinds, only: wp
  use law_api, only: parameter, parameter_t
  use materials, only: material_t
  implicit none
  private
  public :: penalty_parameters, borne_by_depth

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

  !> The depth alone bears the pressure, with a penalty that follows the length of the sides: no AKP, no AUGMENT.
  pure function borne_by_depth(material) result(yes)
    type(material_t), intent(in) :: material
    logical :: yes

    yes = .not. (material%values(2) > 0 .or. material%values(4) > 0)
  end function borne_by_depth

end module contact_penalties
