!> STEEL5: von Mises elastoplasticity, hardening by two saturations, softened by the hydrogen in it.
!>
!> yield = (RE + Q1 (1 - exp(-B1 p)) + Q2 (1 - exp(-B2 p))) (1 - WEAK c): five numbers of hardening, a driver c, and the relation
!> B2 > B1 between two numbers.
module law_steel5
  use elastic_numbers, only: elastic_of_card, elastic_parameters, place_poisson, place_young
  use elasticity, only: moduli
  use hardening, only: most_numbers
  use kinds, only: wp
  use law_api, only: law_line, law_t, parameter, row_of_work
  use materials, only: material_t
  use radial_return, only: flow_stress_at, flow_t, return_point
  use state_variables, only: state_variable, transfer_scalar
  use text, only: add_text, string_t
  implicit none
  private
  public :: law_steel5_row

  integer, parameter :: place_re = 3, place_b1 = 5, place_b2 = 7, place_weak = 8, driver_hydrogen = 2

contains

  function law_steel5_row() result(row)
    type(law_t) :: row

    row%name = 'STEEL5'
    row%number = 9502
    row%purpose = 'two saturations of hardening, softened by hydrogen'
    row%source = 'made for the test'
    allocate (row%lines, source=[law_line(elastic_parameters()), &
                                 law_line([parameter('RE', 'stress', 'yield stress', above=0.0_wp), &
                                           parameter('Q1', 'stress', 'rise of the slow part', lower=0.0_wp), &
                                           parameter('B1', '-', 'rate of the slow part', lower=0.0_wp), &
                                           parameter('Q2', 'stress', 'rise of the fast part', lower=0.0_wp), &
                                           parameter('B2', '-', 'rate of the fast part', lower=0.0_wp), &
                                           parameter('WEAK', '1/hydrogen', 'softening by hydrogen', lower=0.0_wp)])])
    allocate (row%history, source=[state_variable('plastic_strain', '-', transfer_scalar), &
                                   state_variable('plastic_work', 'stress', transfer_scalar)])
    allocate (row%drivers(1))
    row%drivers(driver_hydrogen - 1)%name = 'hydrogen'
    row%effects = 'plasticity'
    row%update => update
    row%flow_stress => flow_stress
    row%elastic => elastic_of_card
    row%check => check
  end function law_steel5_row

  pure subroutine check(material, problems)
    type(material_t), intent(in) :: material
    type(string_t), allocatable, intent(out) :: problems(:)

    allocate (problems(0))
    if (.not. material%values(place_b2) > material%values(place_b1)) &
      call add_text(problems, 'B2 is the rate of the fast part: it must be above B1')
  end subroutine check

  pure subroutine update(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, status)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt, drivers(:, :, :), trial_strain(:, :), committed(:, :)
    real(wp), intent(out) :: stress(:, :), elastic_strain(:, :), history(:, :), tangent(:, :, :)
    integer, intent(out) :: status(:)
    real(wp), parameter :: none(2, 0) = reshape([real(wp) ::], [2, 0])
    real(wp) :: by_work(4)
    integer :: n

    do n = 1, size(trial_strain, 2)
      call return_point(flow_of(material, drivers(driver_hydrogen, 2, n)), none, none, dt, trial_strain(:, n), committed(:, n), &
                        stress(:, n), elastic_strain(:, n), history(:, n), tangent(:4, :, n), by_work, status(n))
      if (size(tangent, 1) >= row_of_work) tangent(row_of_work, :, n) = by_work
    end do
  end subroutine update

  pure function flow_stress(material, drivers, history) result(stress)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: drivers(:), history(:)
    real(wp) :: stress
    real(wp), parameter :: none(2, 0) = reshape([real(wp) ::], [2, 0])

    stress = flow_stress_at(flow_of(material, drivers(driver_hydrogen)), none, none, history(1), 0.0_wp)
  end function flow_stress

  pure function flow_of(material, hydrogen) result(flow)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: hydrogen
    type(flow_t) :: flow

    associate (v => material%values)
      call moduli(v(place_young), v(place_poisson), flow%bulk, flow%shear)
      flow%yield => two_saturations
      flow%below(:5) = v(place_re:place_b2)
      flow%below([1, 2, 4]) = flow%below([1, 2, 4])*(1 - v(place_weak)*hydrogen)
    end associate
  end function flow_of

  pure subroutine two_saturations(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers), curve(:, :), p
    real(wp), intent(out) :: sy, slope

    sy = a(1) + a(2)*(1 - exp(-a(3)*p)) + a(4)*(1 - exp(-a(5)*p))
    slope = a(2)*a(3)*exp(-a(3)*p) + a(4)*a(5)*exp(-a(5)*p)
  end subroutine two_saturations

end module law_steel5
