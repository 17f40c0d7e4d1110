!> How the stress to flow grows with the rate of equivalent plastic strain: a factor on its static value.
!>
!> COWPER 1 + (rate/r0)**(1/P): G.R. Cowper, P.S. Symonds, Brown University, Applied Mathematics Report 28 (1957).
!> JOHNSON 1 + C ln(rate/r0), never below 1: G.R. Johnson, W.H. Cook, 7th Int. Symp. Ballistics (1983) 541-547.
!> POWER rate**m: the Norton-Hoff family, without an elastic domain.
!> Where the form of hardening holds the rate itself (rate_within) the factor is 1.
module rate_dependence
  use kinds, only: wp
  implicit none
  private
  public :: rate_factor
  public :: rate_none, rate_cowper, rate_johnson, rate_power, rate_within

  integer, parameter :: rate_none = 0
  integer, parameter :: rate_cowper = 1
  integer, parameter :: rate_johnson = 2
  integer, parameter :: rate_power = 3
  integer, parameter :: rate_within = 4

contains

  !> Factor, and exponent = d ln(factor)/d ln(rate). Numbers `c`: COWPER (r0, P); JOHNSON (r0, C); POWER (m).
  pure subroutine rate_factor(form, c, rate, factor, exponent)
    integer, intent(in) :: form
    real(wp), intent(in) :: c(2)   !! of the form [unit of each number]
    real(wp), intent(in) :: rate   !! [1/time], at least 0
    real(wp), intent(out) :: factor, exponent
    real(wp) :: part

    factor = 1
    exponent = 0
    select case (form)
    case (rate_cowper)
      part = (rate/c(1))**(1/c(2))
      factor = 1 + part
      exponent = part/(c(2)*factor)
    case (rate_johnson)
      if (.not. rate > c(1)) return
      factor = 1 + c(2)*log(rate/c(1))
      exponent = c(2)/factor
    case (rate_power)
      factor = rate**c(1)
      exponent = c(1)
    end select
  end subroutine rate_factor

end module rate_dependence
