!> Heat through contact: conductance of closed points, exchange across a gap, and the temperatures of rigid dies.
!>
!> Heat that comes into the body per area, from the facing point of the die at Td to its own surface at T:
!> q = h (Td - T) + EPS SIGMA ((Td + Z)^4 - (T + Z)^4). Closed points have h = H f(pressure) and no radiation; open ones within the
!> reach have h = H g(gap) + HO (a film of gas conducts as 1/gap; convection) and radiate; f and g are tables, f = 1 and g = 0 where
!> none is given. Sources: M.G. Cooper, B.B. Mikic, M.M. Yovanovich, Int. J. Heat Mass Transfer 12 (1969) 279-300 (conductance by
!> pressure); F.P. Incropera, D.P. DeWitt, Fundamentals of Heat and Mass Transfer, sec. 3.1 and 13.3 (gaps, radiation).
module heat_contacts
  use kinds, only: wp
  use loads, only: value_in_table
  use radiation, only: fourth_powers
  implicit none
  private
  public :: die_heat_t, heat_contact_t, conductance_of, flow_from_die, jumps_at_opening, largest_conductance, share_by_effusivity

  !> Numbers of the exchange of heat between sides and a die.
  type :: heat_contact_t
    !> Conductance where they touch [power/area/temperature], and factors of it by pressure and by gap (2, n); not allocated where
    !> none are given.
    real(wp) :: conductance = 0.0_wp
    real(wp), allocatable :: by_pressure(:, :), by_gap(:, :)
    !> Convection across a gap [power/area/temperature]; emissivity times the constant of radiation, and what makes temperatures
    !> absolute; largest gap across which heat is exchanged [length].
    real(wp) :: convection = 0.0_wp, radiation = 0.0_wp, zero = 0.0_wp, reach = 0.0_wp
    !> Share of the work of friction that becomes heat; of this the share of the body, below 0: by effusivity; effusivity of a rigid
    !> die [power time^(1/2)/area/temperature].
    real(wp) :: friction = 0.0_wp, share = -1.0_wp, effusivity = 0.0_wp
  end type heat_contact_t

  !> Temperature of a rigid die: given, times a multiplier (0 for none); or with a heat capacity [energy/temperature, per radian
  !> when axisymmetric], one temperature that begins there.
  type :: die_heat_t
    integer :: die = 0
    real(wp) :: temperature = 0.0_wp, capacity = 0.0_wp
    integer :: multiplier = 0
  end type die_heat_t

contains

  !> Conductance [power/area/temperature] and share of the radiation of a point: none beyond the reach, and of radiation none where
  !> it touches.
  pure function conductance_of(contact, closed, pressure, gap) result(h)
    type(heat_contact_t), intent(in) :: contact
    logical, intent(in) :: closed
    real(wp), intent(in) :: pressure   !! [stress]
    real(wp), intent(in) :: gap        !! [length]
    real(wp) :: h(2)
    real(wp) :: factor, unused

    h = 0
    if (closed) then
      factor = 1
      if (allocated(contact%by_pressure)) call value_in_table(contact%by_pressure, pressure, factor, unused)
      h(1) = contact%conductance*factor
    else if (gap <= contact%reach) then
      factor = 0
      if (allocated(contact%by_gap)) call value_in_table(contact%by_gap, gap, factor, unused)
      h = [contact%conductance*factor + contact%convection, 1.0_wp]
    end if
  end function conductance_of

  !> No point has more.
  pure function largest_conductance(contact) result(h)
    type(heat_contact_t), intent(in) :: contact
    real(wp) :: h(2)   !! as above
    real(wp) :: touching, apart

    touching = 1
    if (allocated(contact%by_pressure)) touching = maxval(contact%by_pressure(2, :))
    apart = 0
    if (allocated(contact%by_gap)) apart = maxval(contact%by_gap(2, :))
    h = [max(contact%conductance*touching, contact%conductance*apart + contact%convection), 1.0_wp]
  end function largest_conductance

  !> Heat that comes into the body per area, and its derivatives by the temperatures of the body and of the die.
  pure subroutine flow_from_die(contact, h, t, t_die, q, slope, slope_die)
    type(heat_contact_t), intent(in) :: contact
    real(wp), intent(in) :: h(2)               !! of the point (conductance_of)
    real(wp), intent(in) :: t, t_die           !! [temperature]
    real(wp), intent(out) :: q                 !! [power/area]
    real(wp), intent(out) :: slope, slope_die  !! [power/area/temperature]
    real(wp) :: powers, by_body, by_die

    q = h(1)*(t_die - t)
    slope = -h(1)
    slope_die = h(1)
    if (.not. h(2)*contact%radiation > 0) return
    call fourth_powers(t_die + contact%zero, t + contact%zero, powers, by_die, by_body)
    q = q + h(2)*contact%radiation*powers
    slope = slope + h(2)*contact%radiation*by_body
    slope_die = slope_die + h(2)*contact%radiation*by_die
  end subroutine flow_from_die

  !> The conductance of a point that is about to open is another than that of one that has just opened, by more than a hundredth of
  !> H; or by more than half of it under a little pressure, which is as much as a jump to the mechanics.
  pure function jumps_at_opening(contact, little) result(yes)
    type(heat_contact_t), intent(in) :: contact
    real(wp), intent(in) :: little   !! [stress]
    logical :: yes
    real(wp), parameter :: share(2) = [0.01_wp, 0.5_wp]
    real(wp) :: touching(2), apart, unused

    touching = 1
    if (allocated(contact%by_pressure)) then
      call value_in_table(contact%by_pressure, 0.0_wp, touching(1), unused)
      call value_in_table(contact%by_pressure, little, touching(2), unused)
    end if
    apart = 0
    if (allocated(contact%by_gap)) call value_in_table(contact%by_gap, 0.0_wp, apart, unused)
    apart = contact%conductance*apart + contact%convection
    yes = any(abs(contact%conductance*touching - apart) > share*contact%conductance)
  end function jumps_at_opening

  !> Share of friction heat that goes into a body: its effusivity over the sum of both (half spaces that rub have one temperature
  !> where they touch; H.S. Carslaw, J.C. Jaeger, Conduction of Heat in Solids, sec. 2.15).
  pure function share_by_effusivity(body, die) result(share)
    real(wp), intent(in) :: body, die   !! sqrt(conductivity times heat capacity) [power time^(1/2)/area/temperature]
    real(wp) :: share

    share = 1
    if (body + die > 0) share = body/(body + die)
  end function share_by_effusivity

end module heat_contacts
