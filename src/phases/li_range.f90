!> Compositions that Li's kinetics (li_kinetics) were compared with measured hardness for: the five steels of table I of their
!> source, M.V. Li et al., Metall. Mater. Trans. B 29 (1998) 661, A36, A588, 4140, 4340 and MIL-S-23284 class 1. No range is stated
!> there. Their formulas make time grow with exp(10.18 C) for bainite and exp(6.31 C) for ferrite, C the per cent of carbon, so
!> that errors grow fast beyond them (decks/jominy).
module li_range
  use composition_range, only: beyond
  use kinds, only: wp
  use steels, only: composition_t, el_c, el_cr, el_mn, el_mo, el_ni
  implicit none
  private
  public :: beyond_li

  !> Elements, their least and their most [mass per cent]. Silicon acts on ferrite and pearlite alone, and little.
  integer, parameter :: elements(5) = [el_c, el_mn, el_ni, el_cr, el_mo]
  real(wp), parameter :: least(5) = [0.20_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
  real(wp), parameter :: most(5) = [0.41_wp, 1.01_wp, 3.04_wp, 0.98_wp, 0.44_wp]
  !> A heat may differ by so much from the steel that it is one of.
  real(wp), parameter :: slack = 0.1_wp

contains

  !> Elements of a composition that are beyond, as `beyond` has them.
  pure function beyond_li(composition) result(words)
    type(composition_t), intent(in) :: composition
    character(len=:), allocatable :: words

    words = beyond(composition, elements, least, most, slack)
  end function beyond_li

end module li_range
