!> FLUID: an elastic fluid at rest, stress = K tr(eps) 1.
module law_fluid
  use kinds, only: wp
  use law_api, only: law_done, law_line, law_t, parameter
  use materials, only: material_t
  implicit none
  private
  public :: law_fluid_row

contains

  function law_fluid_row() result(row)
    type(law_t) :: row

    row%name = 'FLUID'
    row%purpose = 'elastic fluid at rest'
    row%source = 'Hooke'
    allocate (row%lines, source=[law_line([parameter('K', 'stress', 'bulk modulus', above=0.0_wp)])])
    allocate (row%history(0))
    row%effects = ''
    row%update => update
  end function law_fluid_row

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    integer, parameter :: normal(3) = [1, 2, 4]
    integer :: n

    elastic_strain = trial_strain
    history = committed
    stress = 0
    tangent = 0
    do n = 1, size(trial_strain, 2)
      stress(normal, n) = material%values(1)*sum(trial_strain(normal, n))
      tangent(normal, normal, n) = material%values(1)
    end do
    status = law_done
  end subroutine update

end module law_fluid
