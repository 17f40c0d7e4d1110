!> Logarithm and exponential of symmetric tensors with components xx, yy, xy, zz, without eigenvectors.
!>
!> With m the mean and (q, s) the deviator of the in-plane part, r^2 = q^2 + s^2:
!> ln b = a 1 + c (b - m 1), a = ln(m^2 - r^2)/2, c = artanh(r/m)/r, smooth at equal eigenvalues,
!> where series in (r/m)^2 are taken.
module plane_tensors
  use kinds, only: wp
  implicit none
  private
  public :: half_log, exp_twice

  !> Below this (r/m)^2 the series is used; its seven terms reach round-off there.
  real(wp), parameter :: series_below = 1.0e-3_wp

contains

  !> e = ln(b)/2 and its derivative `de` (shear row doubled: engineering) along db = h b + b h^T,
  !> h with the components xx, xy, yx, yy, zz.
  pure subroutine half_log(b, e, de)
    real(wp), intent(in) :: b(4)        !! [-]
    real(wp), intent(out) :: e(4)       !! [-]
    real(wp), intent(out) :: de(4, 5)   !! [-]
    real(wp) :: m, q, s, det, t2, c, gamma, r2, inverse, mean
    real(wp) :: dm(4), dq(4), ds(4), da(4), dc(4)

    m = 0.5_wp*(b(1) + b(2))
    q = 0.5_wp*(b(1) - b(2))
    s = b(3)
    r2 = q*q + s*s
    det = m*m - r2
    t2 = r2/(m*m)
    if (t2 < series_below) then
      c = (1 + t2*(1.0_wp/3 + t2*(1.0_wp/5 + t2*(1.0_wp/7 + t2*(1.0_wp/9 + t2*(1.0_wp/11 + t2/13))))))/m
      gamma = (2.0_wp/3 + t2*(4.0_wp/5 + t2*(6.0_wp/7 + t2*(8.0_wp/9 + t2*(10.0_wp/11 + t2*12.0_wp/13)))))/m**3
    else
      c = atanh(sqrt(t2))/sqrt(r2)
      gamma = (m/det - c)/r2
    end if
    mean = 0.25_wp*log(det)
    e(1) = mean + 0.5_wp*c*q
    e(2) = mean - 0.5_wp*c*q
    e(3) = 0.5_wp*c*s
    e(4) = 0.5_wp*log(b(4))

    dm = [b(1), b(3), b(3), b(2)]
    dq = [b(1), b(3), -b(3), -b(2)]
    ds = [b(3), b(2), b(1), b(3)]
    inverse = 1/det
    da = (m*dm - q*dq - s*ds)*inverse
    dc = gamma*(q*dq + s*ds) - dm*inverse
    de = 0
    de(1, 1:4) = 0.5_wp*(da + c*dq + q*dc)
    de(2, 1:4) = 0.5_wp*(da - c*dq - q*dc)
    de(3, 1:4) = c*ds + s*dc
    de(4, 5) = 1
  end subroutine half_log

  !> exp(2 e).
  pure function exp_twice(e) result(b)
    real(wp), intent(in) :: e(4)   !! [-]
    real(wp) :: b(4)
    real(wp) :: m, q, r2, factor, c, s

    m = 0.5_wp*(e(1) + e(2))
    q = 0.5_wp*(e(1) - e(2))
    r2 = 4*(q*q + e(3)**2)
    factor = exp(2*m)
    if (r2 < series_below) then
      c = 1 + r2*(1.0_wp/2 + r2*(1.0_wp/24 + r2*(1.0_wp/720 + r2*(1.0_wp/40320 + r2/3628800))))
      s = 2*(1 + r2*(1.0_wp/6 + r2*(1.0_wp/120 + r2*(1.0_wp/5040 + r2*(1.0_wp/362880 + r2/39916800)))))
    else
      c = cosh(sqrt(r2))
      s = 2*sinh(sqrt(r2))/sqrt(r2)
    end if
    b(1) = factor*(c + s*q)
    b(2) = factor*(c - s*q)
    b(3) = factor*s*e(3)
    b(4) = exp(2*e(4))
  end function exp_twice

end module plane_tensors
