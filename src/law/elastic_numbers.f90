!> The numbers that the card of every isotropic elastic law begins with: Young's modulus and Poisson's ratio.
module elastic_numbers
  use kinds, only: wp
  use law_api, only: parameter, parameter_t
  use materials, only: material_t, values_at
  implicit none
  private
  public :: elastic_parameters, elastic_of_card, place_young, place_poisson

  !> Numbers among the values of a material.
  integer, parameter :: place_young = 1, place_poisson = 2

contains

  !> E and NU.
  function elastic_parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(2))
    list(place_young) = parameter('E', 'stress', 'Young''s modulus', above=0.0_wp)
    list(place_poisson) = parameter('NU', '-', 'Poisson''s ratio', lower=0.0_wp, upper=0.499999_wp)
  end function elastic_parameters

  !> E and NU at a temperature.
  pure subroutine elastic_of_card(material, temperature, young, poisson)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    real(wp), intent(out) :: young, poisson   !! [stress], [-]
    real(wp) :: values(size(material%values))

    call values_at(material, temperature, values)
    young = values(place_young)
    poisson = values(place_poisson)
  end subroutine elastic_of_card

end module elastic_numbers
