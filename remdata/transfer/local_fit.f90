!> Polynomials fitted to values at scattered points by weighted least squares, as weights of those values.
!>
!> Coordinates are local: (x - centre)/size. The matrix of the terms at the points is split into Q R by Gram and Schmidt, twice
!> (L. Giraud, J. Langou, M. Rozloznik, Comput. Math. Appl. 50 (2005) 1069-1075). Where the points do not determine all terms
!> the fit reports it, and the caller takes more points or fewer terms.
module local_fit
  use kinds, only: wp
  implicit none
  private
  public :: terms_of, terms_at, fit_polynomial, max_terms, most_amplified

  !> Terms of the complete quadratic.
  integer, parameter :: max_terms = 6
  !> Sine of the angle between the values of a term and those of the terms before it below which it is not determined: one layer
  !> of points gives 0, a regular grid 0.7, two layers with a bend of a hundredth 0.01.
  real(wp), parameter :: least_angle = 0.02_wp
  !> Largest sum of absolute weights of a good fit, the amplification of an error of the values. Inside a mesh it is below 2, at a
  !> corner 4; with points all to one side of the new one it is much larger.
  real(wp), parameter :: most_amplified = 6.0_wp

contains

  !> Number of terms of a complete polynomial of degree 0, 1 or 2.
  pure function terms_of(degree) result(n)
    integer, intent(in) :: degree
    integer :: n

    n = (degree + 1)*(degree + 2)/2
  end function terms_of

  !> 1, x, y, x^2, xy, y^2 at a point in local coordinates.
  pure function terms_at(x) result(terms)
    real(wp), intent(in) :: x(2)   !! local coordinates [-]
    real(wp) :: terms(max_terms)

    terms = [1.0_wp, x(1), x(2), x(1)**2, x(1)*x(2), x(2)**2]
  end function terms_at

  !> Coefficients of the terms as weights of the values: coefficient t = sum over p of fit(t, p) value(p).
  pure subroutine fit_polynomial(x, weight, nterm, fit, determined)
    real(wp), intent(in) :: x(:, :)     !! (2, n) local coordinates [-]
    real(wp), intent(in) :: weight(:)   !! (n) not negative [-]
    integer, intent(in) :: nterm
    real(wp), intent(out) :: fit(:, :)   !! (max_terms, n) weights of the values [-]; terms not requested are 0
    logical, intent(out) :: determined
    real(wp) :: q(size(x, 2), nterm), r(nterm, nterm), terms(max_terms), root(size(x, 2)), before, part
    integer :: p, t, s, pass, n

    n = size(x, 2)
    fit = 0
    determined = .false.
    if (n < nterm) return
    root = sqrt(weight)
    do p = 1, n
      terms = terms_at(x(:, p))
      q(p, :) = root(p)*terms(:nterm)
    end do
    r = 0
    do t = 1, nterm
      before = sqrt(sum(q(:, t)**2))
      do pass = 1, 2
        do s = 1, t - 1
          part = dot_product(q(:, s), q(:, t))
          q(:, t) = q(:, t) - part*q(:, s)
          r(s, t) = r(s, t) + part
        end do
      end do
      r(t, t) = sqrt(sum(q(:, t)**2))
      if (.not. r(t, t) > least_angle*before) return
      q(:, t) = q(:, t)/r(t, t)
    end do
    ! R coefficients = Q^T root values, from the last term up
    do t = nterm, 1, -1
      fit(t, :n) = root*q(:, t)
      do s = t + 1, nterm
        fit(t, :n) = fit(t, :n) - r(t, s)*fit(s, :n)
      end do
      fit(t, :n) = fit(t, :n)/r(t, t)
    end do
    determined = .true.
  end subroutine fit_polynomial

end module local_fit
