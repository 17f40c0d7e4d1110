!> Work that the penalties and multipliers of contact take in a step, beside friction.
!>
!> Against the pressure p = multiplier + AKP d it is the integral of p dd. Penalties keep it as p**2/(2 AKP); what a
!> multiplier takes when it replaces depth (Uzawa) is no energy that comes back. With p straight between both ends of the
!> step both are (p0 + p1)/2 (d1 - d0). A point that closes begins at no pressure, one that opens ends there. Along the side
!> the tangential penalty keeps tau**2/(2 AKTAU). Source: P. Wriggers, Computational Contact Mechanics, 2nd ed., Springer
!> 2006 (energies of penalty and augmented Lagrange methods).
module contact_work
  use contact_point, only: at_augmentation, at_penetration, at_pressure, at_status, at_tau
  use kinds, only: wp
  use law_api, only: contact_open
  implicit none
  private
  public :: kept_work

contains

  !> Work per present area of the side.
  pure function kept_work(before, after, penalty) result(work)
    real(wp), intent(in) :: before(:), after(:)   !! (nstate) state of the point [unit of each component]
    real(wp), intent(in) :: penalty(2)            !! normal and tangential [stress/length]
    real(wp) :: work                              !! [stress*length]
    logical :: was, is

    was = nint(before(at_status)) /= contact_open
    is = nint(after(at_status)) /= contact_open
    work = 0
    if (was .and. is) then
      work = 0.5_wp*(before(at_pressure) + after(at_pressure))*(after(at_penetration) - before(at_penetration))
    else if (is) then
      work = 0.5_wp*after(at_pressure)*(after(at_pressure) - after(at_augmentation))/penalty(1)
    else if (was) then
      work = -0.5_wp*before(at_pressure)*(before(at_pressure) - before(at_augmentation))/penalty(1)
    end if
    work = work + 0.5_wp*(after(at_tau)**2 - before(at_tau)**2)/penalty(2)
  end function kept_work

end module contact_work
