!> Yield stress by equivalent plastic strain: linear, Voce, Swift, or a table.
module hardening
  use kinds, only: wp
  implicit none
  private
  public :: yield_stress
  public :: hardening_linear, hardening_voce, hardening_swift, hardening_table

  integer, parameter :: hardening_linear = 1
  integer, parameter :: hardening_voce = 2
  integer, parameter :: hardening_swift = 3
  integer, parameter :: hardening_table = 4

contains

  !> Yield stress and its slope at plastic strain p.
  !>
  !> Numbers `a` of the form: LINEAR (yield, modulus); VOCE (yield, saturation, exponent, modulus);
  !> SWIFT (factor, offset, exponent); TABLE none. A table is linear between its points, and
  !> constant after the last one.
  pure subroutine yield_stress(form, a, curve, p, sy, slope)
    integer, intent(in) :: form
    real(wp), intent(in) :: a(4)
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain, yield stress
    real(wp), intent(in) :: p
    real(wp), intent(out) :: sy, slope
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
    case default
      sy = a(1) + a(2)*p
      slope = a(2)
    end select
  end subroutine yield_stress

end module hardening
