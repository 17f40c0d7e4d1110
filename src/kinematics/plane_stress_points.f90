!> Plane stress for every law and every kinematics: the stretch across the plane is found for each
!> point so that sigma_zz = 0.
!>
!> Newton's method on the strain across the plane, kept in a bracket: sigma_zz grows with that strain
!> for any stable law. The element condenses the strain across the plane out of its tangent.
!> Source: condensation at the point, R. de Borst, Int. J. Numer. Meth. Eng. 31 (1991) 1279-1299.
module plane_stress_points
  use kinds, only: eps, wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_done, law_not_converged, law_t
  use materials, only: material_t
  implicit none
  private
  public :: update_plane_stress

  integer, parameter :: max_iterations = 60
  !> Largest change of the strain across the plane in one iteration.
  real(wp), parameter :: largest_change = 0.2_wp
  !> sigma_zz is zero below this share of the stress in the plane, or where its strain is round-off.
  real(wp), parameter :: share_of_stress = 1.0e-13_wp, round_off_strain = 4*eps

contains

  !> As `kinematics%update`, with the stretch f(5, :) across the plane as a result; `by_work` is along the plane, with that stretch
  !> as it follows.
  pure subroutine update_plane_stress(kinematics, law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, &
                                      by_work)
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: drivers(:, :, :)       !! (ndriver, 2, n) of the law at both ends of the step [unit of each driver]
    real(wp), intent(inout) :: f(5, n)             !! [-]
    real(wp), intent(in) :: committed(nstate, n)   !! [unit of each component]
    real(wp), intent(out) :: trial(nstate, n)      !! [unit of each component]
    real(wp), intent(out) :: tangent(4, 5, n)      !! [stress]
    integer, intent(out) :: status(n)              !! answers of the law
    real(wp), intent(out), optional :: by_work(5, n)   !! d(plastic work)/dh [stress]
    real(wp) :: strain(n), low(n), high(n), step
    integer :: i, iteration
    logical :: met(n)

    strain = 0
    low = -huge(1.0_wp)
    high = huge(1.0_wp)
    do iteration = 1, max_iterations
      if (kinematics%finite) then
        f(5, :) = exp(strain)
      else
        f(5, :) = 1 + strain
      end if
      call kinematics%update(law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, by_work)
      if (any(status /= law_done)) return
      do i = 1, n
        met(i) = abs(trial(4, i)) <= max(share_of_stress*maxval(abs(trial(1:3, i))), round_off_strain*abs(tangent(4, 5, i)))
        if (met(i)) cycle
        if (trial(4, i) > 0) then
          high(i) = strain(i)
        else
          low(i) = strain(i)
        end if
        step = -sign(largest_change, trial(4, i))
        if (tangent(4, 5, i) > 0) step = -trial(4, i)/tangent(4, 5, i)
        step = max(-largest_change, min(largest_change, step))
        if (strain(i) + step <= low(i) .or. strain(i) + step >= high(i)) step = 0.5_wp*(low(i) + high(i)) - strain(i)
        met(i) = .not. abs(step) > round_off_strain
        strain(i) = strain(i) + step
      end do
      if (all(met)) exit
    end do
    where (.not. met) status = law_not_converged
    call condense(n, tangent, trial)
    if (.not. present(by_work)) return
    do i = 1, n
      if (tangent(4, 5, i) > 0) by_work(:4, i) = by_work(:4, i) - by_work(5, i)/tangent(4, 5, i)*tangent(4, :4, i)
      by_work(5, i) = 0
    end do
  end subroutine update_plane_stress

  !> Stresses in the plane at sigma_zz = 0, along the tangent: the strain across the plane is known to round-off, which a large bulk
  !> modulus turns into a pressure beside which what acts in the plane is small.
  pure subroutine condense(n, tangent, trial)
    integer, intent(in) :: n
    real(wp), intent(in) :: tangent(4, 5, n)   !! [stress]
    real(wp), intent(inout) :: trial(:, :)     !! (nstate, n) [unit of each component]
    integer :: i

    do i = 1, n
      if (tangent(4, 5, i) > 0) trial(1:3, i) = trial(1:3, i) - tangent(1:3, 5, i)/tangent(4, 5, i)*trial(4, i)
    end do
  end subroutine condense

end module plane_stress_points
