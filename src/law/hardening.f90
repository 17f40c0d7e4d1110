!> Stress to flow at rest by equivalent plastic strain: linear, Voce, Swift, a table, Norton-Hoff, G'Sell-Jonas.
!>
!> Each form is a procedure of the interface `yield_i`, so that a law may bring one of its own.
module hardening
  use kinds, only: wp
  implicit none
  private
  public :: yield_i, yield_between, most_numbers
  public :: yield_linear, yield_voce, yield_swift, yield_table, yield_norton, yield_gsell

  !> Most numbers of a form.
  integer, parameter :: most_numbers = 8

  abstract interface
    !> Yield stress and its slope at an equivalent plastic strain.
    pure subroutine yield_i(a, curve, p, sy, slope)
      import :: most_numbers, wp
      real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) of the form [unit of each number]
      real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
      real(wp), intent(in) :: p             !! equivalent plastic strain [-]
      real(wp), intent(out) :: sy, slope    !! [stress], d(sy)/dp [stress]
    end subroutine yield_i
  end interface

contains

  !> Yield a(1), modulus a(2).
  pure subroutine yield_linear(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]

    sy = a(1) + a(2)*p
    slope = a(2)
  end subroutine yield_linear

  !> E. Voce (1948): yield a(1), rise a(2) at the rate a(3), modulus a(4) that remains.
  pure subroutine yield_voce(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]

    sy = a(1) + a(2)*(1 - exp(-a(3)*p)) + a(4)*p
    slope = a(2)*a(3)*exp(-a(3)*p) + a(4)
  end subroutine yield_voce

  !> H.W. Swift (1952): a(1) (a(2) + p)**a(3).
  pure subroutine yield_swift(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]

    sy = a(1)*(a(2) + p)**a(3)
    slope = a(3)*sy/(a(2) + p)
  end subroutine yield_swift

  !> Linear between the points of the curve, and constant after the last one.
  pure subroutine yield_table(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]
    integer :: i, n

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
  end subroutine yield_table

  !> Norton-Hoff: a(1) p**a(2) exp(-a(3) p). The slope is needed above p = 0 only; below, where a small share of an error of the
  !> state (path_stress) may be, the stress is that of 0.
  pure subroutine yield_norton(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]

    sy = a(1)*max(p, 0.0_wp)**a(2)*exp(-a(3)*p)
    slope = 0
    if (p > 0) slope = sy*(a(2)/p - a(3))
  end subroutine yield_norton

  !> G'Sell-Jonas: a(1) (1 - exp(-a(2) p)) exp(a(3) p**2). The slope is needed above p = 0 only.
  pure subroutine yield_gsell(a, curve, p, sy, slope)
    real(wp), intent(in) :: a(most_numbers)   !! (most_numbers) [unit of each number]
    real(wp), intent(in) :: curve(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p             !! [-]
    real(wp), intent(out) :: sy, slope    !! [stress]
    real(wp) :: rise

    ! 1 - exp(-w p): without loss of digits near 0, without overflow far out
    rise = tanh(0.5_wp*a(2)*p)
    rise = 2*rise/(1 + rise)
    sy = a(1)*rise*exp(a(3)*p*p)
    slope = a(1)*exp(a(3)*p*p)*(a(2)*exp(-a(2)*p) + 2*a(3)*p*rise)
  end subroutine yield_gsell

  !> A form between two sets of numbers: (1 - share) of the first, share of the second.
  pure subroutine yield_between(yield, a, b, share, curve_a, curve_b, p, sy, slope)
    procedure(yield_i) :: yield
    real(wp), intent(in) :: a(most_numbers), b(most_numbers)
    real(wp), intent(in) :: share                          !! [-]
    real(wp), intent(in) :: curve_a(:, :), curve_b(:, :)   !! (2, npoint): plastic strain [-], yield stress [stress]
    real(wp), intent(in) :: p                              !! [-]
    real(wp), intent(out) :: sy, slope                     !! [stress]
    real(wp) :: sy_b, slope_b

    call yield(a, curve_a, p, sy, slope)
    if (.not. share > 0) return
    call yield(b, curve_b, p, sy_b, slope_b)
    sy = (1 - share)*sy + share*sy_b
    slope = (1 - share)*slope + share*slope_b
  end subroutine yield_between

end module hardening
