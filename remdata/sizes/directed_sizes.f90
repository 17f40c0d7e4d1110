!> Sizes of elements along and across a direction, so that elements may be longer than wide.
!>
!> A stretch s is half the logarithm of the ratio of length to width r >= 1, times cosine and sine of twice the angle of the
!> length: 0 for a square, and what is between two of them is their mean. exp of its tensor, times the mean size, is the size in
!> every direction (logarithms of metrics: F. Alauzet, A. Loseille, A decade of progress on anisotropic mesh adaptation,
!> Computer-Aided Design 72 (2016) 13-39).
module directed_sizes
  use kinds, only: wp
  implicit none
  private
  public :: size_along, ratio_of, to_squares, no_stretch

  real(wp), parameter :: no_stretch(2) = 0.0_wp

contains

  !> Ratio of length to width.
  pure function ratio_of(stretch) result(ratio)
    real(wp), intent(in) :: stretch(2)   !! [-]
    real(wp) :: ratio

    ratio = exp(2*norm2(stretch))
  end function ratio_of

  !> Size in a direction: the radius of the ellipse of width `across` and of its length.
  pure function size_along(across, stretch, direction) result(h)
    real(wp), intent(in) :: across         !! [length]
    real(wp), intent(in) :: stretch(2)     !! [-]
    real(wp), intent(in) :: direction(2)   !! of any length, not 0 [length]
    real(wp) :: h
    real(wp) :: s, twofold(2), share

    h = across
    s = norm2(stretch)
    if (.not. s > 0) return
    twofold = [direction(1)**2 - direction(2)**2, 2*direction(1)*direction(2)]/sum(direction**2)
    ! square of the cosine of the angle to the length
    share = min(max(0.5_wp*(1 + dot_product(stretch, twofold)/s), 0.0_wp), 1.0_wp)
    h = across/sqrt(1 - share + share*exp(-4*s))
  end function size_along

  !> The linear map that makes a square of the mean size of an element of that stretch: the identity, to the bit, without.
  pure function to_squares(stretch) result(map)
    real(wp), intent(in) :: stretch(2)   !! [-]
    real(wp) :: map(2, 2)
    real(wp) :: s, c, d(2)

    s = norm2(stretch)
    c = cosh(s)
    d = 0
    if (s > 0) d = sinh(s)*stretch/s
    map = reshape([c - d(1), -d(2), -d(2), c + d(1)], [2, 2])
  end function to_squares

end module directed_sizes
