!> The numbers that the card of every contact law begins with: allowed penetration or penalties, and augmentation.
module contact_penalties
  use kinds, only: wp
  use law_api, only: law_t, parameter, parameter_t
  use materials, only: material_t
  implicit none
  private
  public :: penalties_t, penalty_parameters, penalties_of_card, penalty_problems, allowed_by_side, allowed_penetration, &
            scale_penalties, tangential_share

  !> Numbers among the values of a material.
  integer, parameter :: place_allowed = 1, place_normal = 2, place_tangential = 3, place_augmentations = 4

  !> Tangential penalty over the normal one, where it is not given: an elastic slip of ten times the coefficient of friction times
  !> the penetration, so that sticking and slipping points do not chatter; error of friction at PHI = 0.5 about half a percent of
  !> a side, as in common use. Below the least coefficient the elastic slip stays half of the penetration: with less, what slides
  !> forwards in one iteration slides backwards in the next, and no correction ends between, where points stick.
  real(wp), parameter :: share_of_normal = 0.1_wp, least_coefficient = 0.05_wp

  type :: penalties_t
    !> Allowed penetration over the side of the element; 0 where the penalty is given instead.
    real(wp) :: allowed = 0.0_wp
    !> Penalties as given, 0 where they follow from others [stress/length].
    real(wp) :: normal = 0.0_wp, tangential = 0.0_wp
    !> Most augmentations in a step.
    integer :: augmentations = 0
  end type penalties_t

contains

  !> PENETR, AKP, AKTAU, AUGMENT.
  function penalty_parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(4))
    list(place_allowed) = parameter('PENETR', '-', 'allowed penetration, share of the element side (0: AKP is given)', &
                                    lower=0.0_wp, upper=0.1_wp, default=1.0e-3_wp)
    list(place_normal) = parameter('AKP', 'stress/length', 'normal penalty (0: from PENETR)', lower=0.0_wp, default=0.0_wp, &
                                   replaces='PENETR')
    list(place_tangential) = parameter('AKTAU', 'stress/length', 'tangential penalty (0: from AKP and PHI)', lower=0.0_wp, &
                                       default=0.0_wp)
    list(place_augmentations) = parameter('AUGMENT', '-', 'largest number of augmentations in a step', &
                                          lower=0.0_wp, upper=50.0_wp, default=0.0_wp, whole=.true.)
  end function penalty_parameters

  !> They, from the card of a contact law.
  pure function penalties_of_card(material) result(penalties)
    type(material_t), intent(in) :: material
    type(penalties_t) :: penalties

    penalties%allowed = material%values(place_allowed)
    penalties%normal = material%values(place_normal)
    penalties%tangential = material%values(place_tangential)
    penalties%augmentations = nint(material%values(place_augmentations))
  end function penalties_of_card

  !> Both penalties follow from a penetration over the side of the element: it falls with the side.
  pure logical function allowed_by_side(material)
    type(material_t), intent(in) :: material

    allowed_by_side = material%values(place_allowed) > 0 .and. .not. any(material%values([place_normal, place_tangential]) > 0)
  end function allowed_by_side

  !> Allowed penetration over the side of the element, 0 where a penalty is given instead.
  pure function allowed_penetration(material) result(share)
    type(material_t), intent(in) :: material
    real(wp) :: share

    share = material%values(place_allowed)
  end function allowed_penetration

  !> Tangential penalty over the normal one of a law of contact, where its card gives none.
  pure function tangential_share(law, material) result(share)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp) :: share   !! [-]

    share = share_of_normal
    if (associated(law%friction_coefficient)) &
      share = share*(min(law%friction_coefficient(material), least_coefficient)/least_coefficient)
  end function tangential_share

  !> Contact that is stiffer: penetrations of so many times their depth.
  pure subroutine scale_penalties(depth, material)
    real(wp), intent(in) :: depth   !! factor
    type(material_t), intent(inout) :: material

    associate (values => material%values)
      values(place_allowed) = depth*values(place_allowed)
      values(place_normal:place_tangential) = values(place_normal:place_tangential)/depth
    end associate
  end subroutine scale_penalties

  !> Message on a wrong combination of them, '' when there is none.
  pure function penalty_problems(material) result(problem)
    type(material_t), intent(in) :: material
    character(len=:), allocatable :: problem
    type(penalties_t) :: penalties

    problem = ''
    penalties = penalties_of_card(material)
    if (.not. (penalties%allowed > 0 .or. penalties%normal > 0)) &
      problem = 'PENETR and AKP are both zero: one of them must be above 0'
  end function penalty_problems

end module contact_penalties
