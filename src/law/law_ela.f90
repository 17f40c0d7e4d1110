!> ELA (1): isotropic linear elasticity, stress = K tr(eps) 1 + 2 G dev(eps).
module law_ela
  use elasticity, only: hooke_stress, hooke_tangent, moduli
  use kinds, only: wp
  use law_api, only: law_done, law_line, law_t, parameter
  use materials, only: material_t
  implicit none
  private
  public :: law_ela_row

contains

  function law_ela_row() result(row)
    type(law_t) :: row

    row%name = 'ELA'
    row%number = 1
    row%purpose = 'isotropic linear elasticity'
    row%source = 'Hooke'
    allocate (row%lines, source=[law_line([parameter('E', 'stress', 'Young''s modulus', above=0.0_wp), &
                           parameter('NU', '-', 'Poisson''s ratio', lower=0.0_wp, upper=0.499999_wp)])])
    allocate (row%history(0))
    row%effects = ''
    row%update => update
  end function law_ela_row

  pure subroutine update(material, dt, temperature, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, temperature(:, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp) :: bulk, shear, hooke(4, 4)
    integer :: n

    call moduli(material%values(1), material%values(2), bulk, shear)
    hooke = hooke_tangent(bulk, shear)
    do n = 1, size(trial_strain, 2)
      stress(:, n) = hooke_stress(bulk, shear, trial_strain(:, n))
      elastic_strain(:, n) = trial_strain(:, n)
      history(:, n) = committed(:, n)
      tangent(:, :, n) = hooke
      status(n) = law_done
    end do
  end subroutine update

end module law_ela
