!> Stress to flow at rest by equivalent plastic strain: linear, Voce, Swift, a table, Norton-Hoff, G'Sell-Jonas.
module hardening
  use kinds, only: wp
  implicit none
  private
  public :: yield_stress, yield_between
  public :: hardening_linear, hardening_voce, hardening_swift, hardening_table, hardening_norton, hardening_gsell

  integer, parameter :: hardening_linear = 1
  integer, parameter :: hardening_voce = 2
  integer, parameter :: hardening_swift = 3
  integer, parameter :: hardening_table = 4
  integer, parameter :: hardening_norton = 5
  integer, parameter :: hardening_gsell = 6

contains

  !> Yield stress and its slope at plastic strain p.
  !>
  !> Numbers `a` of the form: LINEAR (yield, modulus); VOCE (yield, saturation, exponent, modulus);
  !> SWIFT (factor, offset, exponent); TABLE none; NORTON (factor, exponent, decay) = factor p**exponent exp(-decay p);
  !> GSELL (factor, w, h) = factor (1 - exp(-w p)) exp(h p**2). A table is linear between its points, and
  !> constant after the last one. The slope of NORTON and GSELL is asked for above p = 0 only.
  pure subroutine yield_stress(form, a, curve, p, sy, slope)
    integer, intent(in) :: form
    real(wp), intent(in) :: a(4)
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain, yield stress
    real(wp), intent(in) :: p
    real(wp), intent(out) :: sy, slope
    real(wp) :: rise
    integer :: i, n

    select case (form)
    case (hardening_voce)
      sy = a(1) + a(2)*(1 - exp(-a(3)*p)) + a(4)*p
      slope = a(2)*a(3)*exp(-a(3)*p) + a(4)
    case (hardening_swift)
      sy = a(1)*(a(2) + p)**a(3)
      slope = a(3)*sy/(a(2) + p)
    case (hardening_table)
      n = size(curve, 2)
      if (p >= curve(1, n)) then
        sy = curve(2, n)
        slope = 0
      else
        do i = 2, n - 1
          if (p < curve(1, i)) exit
        end do
        slope = (curve(2, i) - curve(2, i - 1))/(curve(1, i) - curve(1, i - 1))
        sy = curve(2, i - 1) + slope*(p - curve(1, i - 1))
      end if
    case (hardening_norton)
      sy = a(1)*p**a(2)*exp(-a(3)*p)
      slope = 0
      if (p > 0) slope = sy*(a(2)/p - a(3))
    case (hardening_gsell)
      rise = 2*exp(-0.5_wp*a(2)*p)*sinh(0.5_wp*a(2)*p)    ! 1 - exp(-w p) without loss of digits
      sy = a(1)*rise*exp(a(3)*p*p)
      slope = a(1)*exp(a(3)*p*p)*(a(2)*exp(-a(2)*p) + 2*a(3)*p*rise)
    case default
      sy = a(1) + a(2)*p
      slope = a(2)
    end select
  end subroutine yield_stress

  !> The same between two sets of numbers: (1 - share) of the first, share of the second.
  pure subroutine yield_between(form, a, b, share, curve_a, curve_b, p, sy, slope)
    integer, intent(in) :: form
    real(wp), intent(in) :: a(4), b(4), share, curve_a(:, :), curve_b(:, :), p
    real(wp), intent(out) :: sy, slope
    real(wp) :: sy_b, slope_b

    call yield_stress(form, a, curve_a, p, sy, slope)
    if (.not. share > 0) return
    call yield_stress(form, b, curve_b, p, sy_b, slope_b)
    sy = (1 - share)*sy + share*sy_b
    slope = (1 - share)*slope + share*slope_b
  end subroutine yield_between

end module hardening
