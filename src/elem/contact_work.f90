!> Work that the penalties and multipliers of contact take in a step, beside friction.
!>
!> Against the pressure p = multiplier + AKP d it is the integral of p dd. Penalties keep it as p**2/(2 AKP); what a
!> multiplier takes when it replaces depth (Uzawa) is no energy that comes back. With p straight between both ends of the
!> step both are (p0 + p1)/2 (d1 - d0). A point that closes begins at no pressure, one that opens ends there: at the surface of the
!> die, or with a negative multiplier as deep in it as that has no pressure. Along the side
!> the tangential penalty keeps tau**2/(2 AKTAU). What is in contact between points (contact_between) keeps its
!> own energy. A point that has lost more than half of its pressure beyond a corner of the die (corner_release) is as
!> one that opens: the share that still acts goes to zero. A corner of the die near an end of the side acts with a share of its
!> pressure and its friction (corner_weights): they take part in the work with the share that they have at either end of the step.
!> Source: P. Wriggers, Computational Contact Mechanics, 2nd ed., Springer 2006 (energies of penalty and augmented Lagrange
!> methods).
module contact_work
  use contact_areas, only: area_of_point
  use contact_state, only: at_augmentation, at_between, at_energy, at_penetration, at_pressure, at_status, at_tau, at_xi, &
                           is_released
  use corner_weights, only: corner_length
  use kinds, only: wp
  use law_api, only: contact_open
  use quadrature, only: rule_t
  use side_points, only: area_at
  implicit none
  private
  public :: friction_energy, kept_work

contains

  !> Work per present area of the side.
  pure function kept_work(before, after, penalty, share) result(work)
    real(wp), intent(in) :: before(:), after(:)   !! (nstate) state of the point [unit of each component]
    real(wp), intent(in) :: penalty(2)            !! normal and tangential [stress/length]
    real(wp), intent(in) :: share(2)              !! of pressure and friction that acts before and after [-]
    real(wp) :: work                              !! [stress*length]
    real(wp) :: pressure(2), tau(2)
    logical :: was, is

    was = nint(before(at_status)) /= contact_open .and. .not. is_released(before(at_xi))
    is = nint(after(at_status)) /= contact_open .and. .not. is_released(after(at_xi))
    ! of the point itself
    pressure = share*[before(at_pressure) - before(at_between), after(at_pressure) - after(at_between)]
    tau = share*[before(at_tau), after(at_tau)]
    work = 0
    if (was .and. is) then
      work = 0.5_wp*sum(pressure)*(after(at_penetration) - before(at_penetration))
    else if (is) then
      work = 0.5_wp*pressure(2)*(pressure(2) - max(after(at_augmentation), 0.0_wp))/penalty(1)
    else if (was) then
      work = -0.5_wp*pressure(1)*(pressure(1) - max(before(at_augmentation), 0.0_wp))/penalty(1)
    end if
    work = work + 0.5_wp*sum(tau)*(after(at_tau) - before(at_tau))/penalty(2) + after(at_energy) - before(at_energy)
  end function kept_work

  !> Work that friction has done so far at a point of a side and at the corner of the die in the interval before it, at the start
  !> and at the end of a step.
  pure function friction_energy(rule, of_body, xi, weight, p, work, section, x) result(energy)
    type(rule_t), intent(in) :: rule
    logical, intent(in) :: of_body             !! the side faces another body
    real(wp), intent(in) :: xi(:), weight(:)   !! (npoint) its points and weights [-]
    integer, intent(in) :: p                   !! the point
    real(wp), intent(in) :: work(3, 2)         !! per present area of the point and of the corner [stress*length], place of that [-]
    real(wp), intent(in) :: section(3, 2)      !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: x(2, 3, 2)         !! nodes of the side then [length]
    real(wp) :: energy(2)                      !! per radian when axisymmetric [energy]
    integer :: k

    do k = 1, 2
      energy(k) = work(1, k)*area_of_point(rule, xi, weight, p, section(:, k), x(:, :, k))
      if (work(2, k) > 0) energy(k) = energy(k) + work(2, k)*corner_length(xi, p, of_body) &
                                      *area_at(work(3, k), section(:, k), x(:, :, k))
    end do
  end function friction_energy

end module contact_work
