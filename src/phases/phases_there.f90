!> The phases that a steel may have: austenite, and what its kinetics form.
module phases_there
  use steels, only: austenite, first_diffusive, kinetics_none, last_diffusive, martensite, phase_count, steel_t, tempered, &
                    unknown_temperature
  implicit none
  private
  public :: phases_that_form

contains

  pure function phases_that_form(steel) result(there)
    type(steel_t), intent(in) :: steel
    logical :: there(phase_count)   !! (phase_count)

    there = .false.
    there(austenite) = .true.
    there(first_diffusive:last_diffusive) = steel%kinetics%kind /= kinetics_none .or. steel%cct%n > 0
    there(martensite) = steel%ms > unknown_temperature
    there(tempered) = any(steel%temper_rate > 0)
  end function phases_that_form

end module phases_there
