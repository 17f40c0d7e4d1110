!> Characteristic temperatures of a steel, and its martensite, from its composition in mass per cent.
!>
!> Sources: K.W. Andrews, J. Iron Steel Inst. 203 (1965) 721 (Ac1, Ac3; all signs as printed there: Cr and Cu lower Ac3, P and Al
!> raise it); M.V. Li et al., Metall. Mater. Trans. B 29 (1998) 661 (Bs); S.M.C. van Bohemen, Mater. Sci. Technol. 28 (2012) 487
!> (Ms, rate of martensite).
module critical_temperatures
  use kinds, only: wp
  use steels, only: composition_t, el_al, el_as, el_c, el_cr, el_cu, el_mn, el_mo, el_ni, el_p, el_si, el_ti, el_v, el_w
  implicit none
  private
  public :: andrews_ae1, andrews_ae3, li_bs, van_bohemen_ms, van_bohemen_rate, lever_rule_ferrite

  !> Carbon that ferrite dissolves at most, at the eutectoid temperature [mass per cent] (iron-carbon diagram).
  real(wp), parameter :: carbon_in_ferrite = 0.02_wp
  !> Andrews' factor of the square root of carbon [degC/(mass per cent)^(1/2)].
  real(wp), parameter :: root_carbon = 203.0_wp

contains

  pure function andrews_ae1(composition) result(t)
    type(composition_t), intent(in) :: composition
    real(wp) :: t   !! [degC]

    associate (w => composition%w)
      t = 723 - 10.7_wp*w(el_mn) - 16.9_wp*w(el_ni) + 29.1_wp*w(el_si) + 16.9_wp*w(el_cr) + 290*w(el_as) + 6.38_wp*w(el_w)
    end associate
  end function andrews_ae1

  pure function andrews_ae3(composition) result(t)
    type(composition_t), intent(in) :: composition
    real(wp) :: t   !! [degC]

    t = without_carbon(composition) - root_carbon*sqrt(composition%w(el_c))
  end function andrews_ae3

  !> Andrews' Ac3 of the steel without carbon.
  pure function without_carbon(composition) result(t)
    type(composition_t), intent(in) :: composition
    real(wp) :: t

    associate (w => composition%w)
      t = 910 - 15.2_wp*w(el_ni) + 44.7_wp*w(el_si) + 104*w(el_v) + 31.5_wp*w(el_mo) + 13.1_wp*w(el_w) - 30*w(el_mn) &
          - 11*w(el_cr) - 20*w(el_cu) + 700*w(el_p) + 400*w(el_al) + 120*w(el_as) + 400*w(el_ti)
    end associate
  end function without_carbon

  !> Share of ferrite in equilibrium, by the lever rule: austenite has the carbon for which `ae3` equals the temperature, along
  !> Andrews' line, which is prolonged below the eutectoid temperature (A. Hultgren, Trans. ASM 39 (1947) 915).
  pure function lever_rule_ferrite(composition, ae3, temperature) result(share)
    type(composition_t), intent(in) :: composition
    real(wp), intent(in) :: ae3           !! of the steel, where the share is 0 [degC]
    real(wp), intent(in) :: temperature   !! [degC]
    real(wp) :: share
    real(wp) :: carbon, root

    carbon = composition%w(el_c)
    share = 0
    if (temperature >= ae3 .or. carbon <= 0) return
    root = sqrt(carbon) + (ae3 - temperature)/root_carbon
    share = max(0.0_wp, min(1.0_wp, (root**2 - carbon)/(root**2 - min(carbon_in_ferrite, carbon))))
  end function lever_rule_ferrite

  pure function li_bs(composition) result(t)
    type(composition_t), intent(in) :: composition
    real(wp) :: t   !! [degC]

    associate (w => composition%w)
      t = 637 - 58*w(el_c) - 35*w(el_mn) - 15*w(el_ni) - 34*w(el_cr) - 41*w(el_mo)
    end associate
  end function li_bs

  pure function van_bohemen_ms(composition) result(t)
    type(composition_t), intent(in) :: composition
    real(wp) :: t   !! [degC]

    associate (w => composition%w)
      t = 565 - (31*w(el_mn) + 13*w(el_si) + 10*w(el_cr) + 18*w(el_ni) + 12*w(el_mo)) - 600*(1 - exp(-0.96_wp*w(el_c)))
    end associate
  end function van_bohemen_ms

  !> Rate of Koistinen and Marburger's law.
  pure function van_bohemen_rate(composition) result(rate)
    type(composition_t), intent(in) :: composition
    real(wp) :: rate   !! [1/K]

    associate (w => composition%w)
      rate = 1.0e-3_wp*(27.2_wp - (0.14_wp*w(el_mn) + 0.21_wp*w(el_si) + 0.11_wp*w(el_cr) + 0.08_wp*w(el_ni) + 0.05_wp*w(el_mo)) &
                        - 19.8_wp*(1 - exp(-1.56_wp*w(el_c))))
    end associate
  end function van_bohemen_rate

end module critical_temperatures
