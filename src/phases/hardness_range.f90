!> Compositions that Maynier's formulas of hardness (hardness) were found for, low-alloy steels: the ranges that are quoted with
!> them. Beyond 0.5 % of carbon the hardness of martensite no longer grows with it by 949 HV a per cent, but levels off at some
!> 900 HV (G. Krauss, Steels: Processing, Structure, and Performance, ASM 2005).
module hardness_range
  use composition_range, only: beyond
  use kinds, only: wp
  use steels, only: composition_t, el_c, el_cr, el_cu, el_mn, el_mo, el_ni, el_si, el_v
  implicit none
  private
  public :: beyond_maynier

  !> Elements, their least and their most [mass per cent].
  integer, parameter :: elements(8) = [el_c, el_si, el_mn, el_ni, el_cr, el_mo, el_v, el_cu]
  real(wp), parameter :: least(8) = [0.1_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
  real(wp), parameter :: most(8) = [0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp, 3.0_wp, 1.0_wp, 0.2_wp, 0.5_wp]

contains

  !> Elements of a composition that are beyond, as `beyond` has them.
  pure function beyond_maynier(composition) result(words)
    type(composition_t), intent(in) :: composition
    character(len=:), allocatable :: words

    words = beyond(composition, elements, least, most, 0.0_wp)
  end function beyond_maynier

end module hardness_range
