!> Austenite on heating, and the growth of its grains.
!>
!> dz/dt = (z_eq(T) - z)/tau(T), z_eq from 0 at Ac1 to 1 at Ac3, tau linear between both: J.-B. Leblond, J. Devaux, Acta Metall. 32
!> (1984) 137, in the form of F.M.B. Fernandes. dD/dt = (1/D - 1/D_lim)/lambda, with 1/lambda = exp(-Q/T)/lambda0 and
!> D_lim = D_0 exp(-W/T): M. Waeckel, A. Razakanaivo, code_aster's documentation R4.04.01. Both are exact at one temperature.
!> New austenite is as fine as can be: it dilutes the mean size.
module austenite_kinetics
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use steels, only: celsius_zero, steel_t
  implicit none
  private
  public :: equilibrium_austenite, form_austenite, grow_grains

contains

  !> Austenite in equilibrium on heating.
  pure function equilibrium_austenite(steel, temperature) result(share)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t) :: share

    share = dual_t()
    if (temperature%value >= steel%ac3) then
      share = dual_t(1.0_wp)
    else if (temperature%value > steel%ac1) then
      share = (temperature - steel%ac1)/(steel%ac3 - steel%ac1)
    end if
  end function equilibrium_austenite

  !> Austenite that forms in a time at one temperature.
  pure subroutine form_austenite(steel, time, temperature, present, formed)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time          !! [s]
    type(dual_t), intent(in) :: temperature   !! [degC]
    type(dual_t), intent(in) :: present       !! fraction of austenite
    type(dual_t), intent(out) :: formed       !! [-]
    type(dual_t) :: goal, tau, place

    formed = dual_t()
    if (.not. steel%tau1 > 0) return
    goal = equilibrium_austenite(steel, temperature)
    if (goal%value <= present%value) return
    place = goal
    tau = steel%tau1 + (steel%tau3 - steel%tau1)*place
    formed = (goal - present)*(1.0_wp - exp(-(time/tau)))
  end subroutine form_austenite

  !> Mean size of the grains after new austenite and after a time at one temperature. With y = D/D_lim,
  !> -y - ln(1-y) grows by time/(lambda D_lim^2); grains do not shrink.
  pure subroutine grow_grains(steel, time, temperature, before, formed, grain)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time             !! [s]
    type(dual_t), intent(in) :: temperature      !! [degC]
    type(dual_t), intent(in) :: before, formed   !! fractions of austenite, old and new
    type(dual_t), intent(inout) :: grain         !! [um]
    type(dual_t) :: kelvin, limit, y, total, passed

    if (.not. (steel%lambda0 > 0 .and. before%value + formed%value > 0)) return
    if (formed%value > 0) grain = grain*before/(before + formed)
    kelvin = temperature + celsius_zero
    limit = steel%limit0*exp(-(steel%limit_energy/kelvin))
    if (grain%value >= limit%value) return
    y = grain/limit
    passed = time/(steel%lambda0*exp(steel%lambda_energy/kelvin)*limit*limit)
    total%value = grain_time(y%value) + passed%value
    total%slope = passed%slope + y%value/(1 - y%value)*y%slope
    call size_at(total, y)
    grain = limit*y
  end subroutine grow_grains

  !> -y - ln(1-y), without loss of digits at small y.
  pure function grain_time(y) result(total)
    real(wp), intent(in) :: y   !! 0 to 1
    real(wp) :: total
    real(wp), parameter :: small = 0.2_wp
    real(wp) :: power
    integer :: k

    if (y > small) then
      total = -y - log(1 - y)
    else
      total = 0
      power = y
      do k = 2, 25   ! 0.2^25 is below round-off
        power = power*y
        total = total + power/k
      end do
    end if
  end function grain_time

  !> y at -y - ln(1-y) = total. The function is convex and y^2/2 and -1 - ln(1-y) are below it: Newton's method from the right.
  pure subroutine size_at(total, y)
    type(dual_t), intent(in) :: total
    type(dual_t), intent(out) :: y
    real(wp) :: change
    integer :: iteration

    y = dual_t()
    if (.not. total%value > 0) return
    y%value = min(sqrt(2*total%value), 1 - exp(-total%value - 1))
    do iteration = 1, 60
      change = (grain_time(y%value) - total%value)*(1 - y%value)/y%value
      y%value = y%value - change
      if (.not. abs(change) > 2*epsilon(change)*y%value) exit
    end do
    y%slope = total%slope*(1 - y%value)/y%value
  end subroutine size_at

end module austenite_kinetics
