!> SMALL: infinitesimal strains; the geometry stays where it was.
module kinematics_small
  use kinds, only: wp
  use kinematics_api, only: first_history, kinematics_t
  use law_api, only: law_t, row_of_work, tangent_rows
  use materials, only: material_t
  implicit none
  private
  public :: kinematics_small_row

contains

  function kinematics_small_row() result(row)
    type(kinematics_t) :: row

    row%name = 'SMALL'
    row%purpose = 'small strain, geometry not updated'
    row%finite = .false.
    row%update => update
  end function kinematics_small_row

  pure subroutine update(law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, by_work)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: drivers(:, :, :), f(5, n), committed(nstate, n)
    real(wp), intent(out) :: trial(nstate, n), tangent(4, 5, n)
    integer, intent(out) :: status(n)
    real(wp), intent(out), optional :: by_work(5, n)
    real(wp) :: e(4, n), stress(4, n), elastic(4, n), history(nstate - first_history + 1, n)
    real(wp), allocatable :: law_tangent(:, :, :)   ! (4 or more, 4, n)
    real(wp), parameter :: engineering(4) = [1.0_wp, 1.0_wp, 2.0_wp, 1.0_wp]

    allocate (law_tangent(tangent_rows(law, material, present(by_work)), 4, n))
    e(1, :) = committed(5, :) + f(1, :) - 1
    e(2, :) = committed(6, :) + f(4, :) - 1
    e(3, :) = 2*committed(7, :) + f(2, :) + f(3, :)
    e(4, :) = committed(8, :) + f(5, :) - 1
    call law%update(material, dt, drivers, e, committed(first_history:, :), stress, elastic, history, law_tangent, status)
    trial(1:4, :) = stress
    trial(5:8, :) = elastic/spread(engineering, 2, n)
    trial(first_history:, :) = history
    tangent = law_tangent(:4, [1, 3, 3, 2, 4], :)
    if (present(by_work)) by_work = law_tangent(row_of_work, [1, 3, 3, 2, 4], :)
  end subroutine update

end module kinematics_small
