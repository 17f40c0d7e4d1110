!> Polynomials of patches whose points determine all quadratics but one, as a row of elements with two points across: of those
!> that fit the values, the one that has nothing of the quadratic that is hardly anything at the points.
!>
!> Along a row the polynomial is of the second degree, across it, where two points tell a slope and no more, of the first. It is
!> found in coordinates in which the points scatter by 1 in every direction, among x^2, sqrt(2) x y and y^2 there: the sum of the
!> squares of their coefficients does not depend on how the row lies.
!> Source: G.H. Golub, C.F. Van Loan, Matrix Computations, 4th ed., 2013, sec. 5.5 (deficient rank, the solution of least norm).
module row_polynomials
  use kinds, only: wp
  implicit none
  private
  public :: fit_row, scatter_of

  !> Terms of the polynomials, 1, x, y, x^2, x y, y^2, those of the first degree, and those of the second.
  integer, parameter :: nterm = 6, nlinear = 3, nsquare = 3
  !> Squarings of a matrix that leave its largest eigenvalue alone.
  integer, parameter :: most_squarings = 6

contains

  !> Coefficients of the polynomials from sums of values times terms, in place; `fits`: the points do determine all quadratics but
  !> one (`right` is as it was where they do not).
  pure subroutine fit_row(points, hardly, right, fits)
    real(wp), intent(in) :: points(:, :)      !! (npoint, 2) that do not lie on a line [scale]
    real(wp), intent(in) :: hardly            !! share of its square below which a quadratic is hardly anything at the points [-]
    real(wp), intent(inout) :: right(:, :)    !! (nvalue, nterm) [unit of each value]
    logical, intent(out) :: fits
    real(wp) :: to_even(nterm, nterm), gram(nterm, nterm), rest(nsquare, nsquare), least(nsquare)
    real(wp) :: sums(size(right, 1), nterm), t(nterm)
    integer :: j, k

    call even_terms(points, to_even)
    gram = 0
    do k = 1, size(points, 1)
      t = matmul(to_even, [1.0_wp, points(k, 1), points(k, 2), points(k, 1)**2, points(k, 1)*points(k, 2), points(k, 2)**2])
      do j = 1, nterm
        gram(:, j) = gram(:, j) + t*t(j)
      end do
    end do
    ! points that scatter evenly: terms of the first degree are orthogonal
    rest = gram(nlinear + 1:, nlinear + 1:)
    do j = 1, nlinear
      do k = 1, nsquare
        rest(:, k) = rest(:, k) - gram(nlinear + 1:, j)*(gram(nlinear + k, j)/gram(j, j))
      end do
    end do
    call find_least(rest, least)
    fits = determines_others(rest, least, hardly*maxval([(gram(nlinear + j, nlinear + j), j=1, nsquare)]))
    if (.not. fits) return
    sums = matmul(right, transpose(to_even))
    do j = 1, nlinear
      sums(:, j) = sums(:, j)/gram(j, j)
    end do
    do k = 1, nsquare
      do j = 1, nlinear
        sums(:, nlinear + k) = sums(:, nlinear + k) - gram(nlinear + k, j)*sums(:, j)
      end do
    end do
    call solve_without(rest, least, sums(:, nlinear + 1:))
    do j = 1, nlinear
      do k = 1, nsquare
        sums(:, j) = sums(:, j) - gram(nlinear + k, j)/gram(j, j)*sums(:, nlinear + k)
      end do
    end do
    right = matmul(sums, to_even)
  end subroutine fit_row

  !> Terms 1, X, Y, X^2, sqrt(2) X Y, Y^2 of coordinates in which the points scatter by 1 in every direction, each by the terms of x
  !> and y.
  pure subroutine even_terms(points, to_even)
    real(wp), intent(in) :: points(:, :)             !! (npoint, 2) [scale]
    real(wp), intent(out) :: to_even(nterm, nterm)   !! (even term, term)
    real(wp) :: mean(2), spread_of(2), slope, a(3), b(3)

    call scatter_of(points, mean, spread_of, slope)
    a = [-mean(1), 1.0_wp, 0.0_wp]/spread_of(1)
    b = [slope*mean(1) - mean(2), -slope, 1.0_wp]/spread_of(2)
    to_even = 0
    to_even(1, 1) = 1
    to_even(2, :3) = a
    to_even(3, :3) = b
    to_even(4, :) = product_of(a, a)
    to_even(5, :) = sqrt(2.0_wp)*product_of(a, b)
    to_even(6, :) = product_of(b, b)
  end subroutine even_terms

  !> Middle of points, how far they scatter along x, and along y beside the line of this slope through the middle.
  pure subroutine scatter_of(points, mean, spread_of, slope)
    real(wp), intent(in) :: points(:, :)                !! (npoint, 2) that do not lie on a line [scale]
    real(wp), intent(out) :: mean(2), spread_of(2)      !! [scale]
    real(wp), intent(out) :: slope                      !! [-]
    integer :: n

    n = size(points, 1)
    mean = sum(points, 1)/n
    spread_of(1) = sqrt(sum((points(:, 1) - mean(1))**2)/n)
    slope = sum((points(:, 1) - mean(1))*(points(:, 2) - mean(2)))/(n*spread_of(1)**2)
    spread_of(2) = sqrt(sum((points(:, 2) - mean(2) - slope*(points(:, 1) - mean(1)))**2)/n)
  end subroutine scatter_of

  !> The product of two linear functions of 1, x, y.
  pure function product_of(a, b) result(c)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: c(nterm)

    c = [a(1)*b(1), a(1)*b(2) + a(2)*b(1), a(1)*b(3) + a(3)*b(1), a(2)*b(2), a(2)*b(3) + a(3)*b(2), a(3)*b(3)]
  end function product_of

  !> Eigenvector of the least eigenvalue of a symmetric matrix, none of whose eigenvalues is below 0: that of the largest one of the
  !> matrix of cofactors, by squaring it.
  pure subroutine find_least(matrix, least)
    real(wp), intent(in) :: matrix(nsquare, nsquare)
    real(wp), intent(out) :: least(nsquare)
    real(wp) :: cofactors(nsquare, nsquare)
    integer :: i, j

    do j = 1, nsquare
      do i = 1, nsquare
        cofactors(i, j) = matrix(next(i), next(j))*matrix(next(next(i)), next(next(j))) &
                          - matrix(next(i), next(next(j)))*matrix(next(next(i)), next(j))
      end do
    end do
    do i = 1, most_squarings
      if (.not. trace(cofactors) > 0) exit
      cofactors = cofactors/trace(cofactors)
      cofactors = matmul(cofactors, cofactors)
    end do
    j = maxloc([(cofactors(i, i), i=1, nsquare)], 1)
    least = cofactors(:, j)
    if (norm2(least) > 0) least = least/norm2(least)
  end subroutine find_least

  elemental integer function next(i)
    integer, intent(in) :: i

    next = mod(i, nsquare) + 1
  end function next

  pure function trace(matrix)
    real(wp), intent(in) :: matrix(nsquare, nsquare)
    real(wp) :: trace
    integer :: i

    trace = sum([(matrix(i, i), i=1, nsquare)])
  end function trace

  !> Both eigenvalues of the others are above `lowest`, by their sum and product.
  pure function determines_others(matrix, least, lowest) result(yes)
    real(wp), intent(in) :: matrix(nsquare, nsquare), least(nsquare), lowest
    logical :: yes
    real(wp) :: smallest, total, squares

    yes = norm2(least) > 0
    if (.not. yes) return
    smallest = dot_product(least, matmul(matrix, least))
    total = trace(matrix) - smallest
    squares = sum(matrix**2) - smallest**2
    ! a + b and a^2 + b^2 give the smaller one
    yes = 0.5_wp*(total - sqrt(max(0.0_wp, 2*squares - total**2))) > lowest
  end function determines_others

  !> The solution that has nothing of the eigenvector of the least eigenvalue, in place.
  pure subroutine solve_without(matrix, least, right)
    real(wp), intent(in) :: matrix(nsquare, nsquare), least(nsquare)
    real(wp), intent(inout) :: right(:, :)   !! (nvalue, nsquare)
    real(wp) :: a(nsquare, nsquare), factor
    integer :: i, j

    a = matrix
    do j = 1, nsquare
      a(:, j) = a(:, j) + (trace(matrix) - dot_product(least, matmul(matrix, least)))*least*least(j)
    end do
    right = right - spread(matmul(right, least), 2, nsquare)*spread(least, 1, size(right, 1))
    do j = 1, nsquare
      do i = j + 1, nsquare
        factor = a(i, j)/a(j, j)
        a(i, :) = a(i, :) - factor*a(j, :)
        right(:, i) = right(:, i) - factor*right(:, j)
      end do
    end do
    do j = nsquare, 1, -1
      do i = j + 1, nsquare
        right(:, j) = right(:, j) - a(j, i)*right(:, i)
      end do
      right(:, j) = right(:, j)/a(j, j)
    end do
  end subroutine solve_without

end module row_polynomials
