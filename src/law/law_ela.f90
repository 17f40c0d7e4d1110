!> ELA (1): isotropic linear elasticity, stress = K tr(eps) 1 + 2 G dev(eps), and
!> ELATH (200): the same with thermal expansion; both with numbers by temperature.
!>
!> Thermal strain of a step is the integral of ALPHA over its temperatures, exact for an ALPHA linear between those of the
!> card: ALPHA is the tangent coefficient d(strain)/d(temperature), as LAGAMINE's. E and NU of the end of the step act on
!> the whole elastic strain, so that a closed cycle of strain and temperature leaves no stress.
module law_ela
  use elastic_numbers, only: elastic_of_card, elastic_parameters, place_poisson, place_young
  use elasticity, only: hooke_stress, hooke_tangent, moduli
  use kinds, only: wp
  use law_api, only: driver_temperature, law_done, law_line, law_t, parameter
  use materials, only: integral_over_temperature, material_t, values_at
  implicit none
  private
  public :: law_ela_row, law_elath_row

  !> Number of ALPHA among a material's values.
  integer, parameter :: place_alpha = 3

contains

  function law_ela_row() result(row)
    type(law_t) :: row

    row%name = 'ELA'
    row%number = 1
    row%purpose = 'isotropic linear elasticity'
    row%source = 'Hooke'
    allocate (row%lines, source=[law_line(elastic_parameters())])
    allocate (row%history(0))
    row%effects = ''
    row%update => update
    row%elastic => elastic_of_card
  end function law_ela_row

  function law_elath_row() result(row)
    type(law_t) :: row

    row%name = 'ELATH'
    row%number = 200
    row%purpose = 'isotropic linear elasticity with thermal expansion'
    row%source = 'Hooke, Duhamel, Neumann'
    allocate (row%lines, source=[law_line([elastic_parameters(), &
                                           parameter('ALPHA', '1/temperature', 'tangent coefficient of expansion', &
                                                     lower=0.0_wp)])])
    allocate (row%history(0))
    row%effects = 'temperature'
    row%update => update
    row%elastic => elastic_of_card
  end function law_elath_row

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: bulk, shear, hooke(4, 4), values(size(material%values)), expansion
    logical :: by_temperature
    integer :: n

    by_temperature = allocated(material%temperatures)
    call moduli(material%values(place_young), material%values(place_poisson), bulk, shear)
    hooke = hooke_tangent(bulk, shear)
    do n = 1, size(trial_strain, 2)
      if (by_temperature) then
        call values_at(material, drivers(driver_temperature, 2, n), values)
        call moduli(values(place_young), values(place_poisson), bulk, shear)
        hooke = hooke_tangent(bulk, shear)
      end if
      elastic_strain(:, n) = trial_strain(:, n)
      if (size(material%values) >= place_alpha) then
        expansion = integral_over_temperature(material, place_alpha, drivers(driver_temperature, 1, n), &
                                              drivers(driver_temperature, 2, n))
        elastic_strain([1, 2, 4], n) = trial_strain([1, 2, 4], n) - expansion
      end if
      stress(:, n) = hooke_stress(bulk, shear, elastic_strain(:, n))
      history(:, n) = committed(:, n)
      tangent(:, :, n) = hooke
      status(n) = law_done
    end do
  end subroutine update

end module law_ela
