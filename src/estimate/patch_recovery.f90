!> Superconvergent patch recovery: a continuous field from values that are best at the 2 x 2 points of 8-node elements.
!>
!> Around every corner node of the mesh a complete quadratic polynomial is fitted, by least squares, to the values at the 2 x 2
!> points of the elements that meet there. Nodes where fewer than three elements meet, on the boundary and on material lines, take
!> the mean of the polynomials of their neighbours that have one; where there is none the patch is widened by a row. Patches whose
!> points do not determine a quadratic, or hardly do, as a row of elements with two points across, get one without what they do not
!> determine (row_polynomials), or where that is more than one term a linear polynomial. In an
!> element the polynomials of its four corners are blended by the bilinear shape functions, so that a field that is quadratic in x
!> and y comes out exactly on elements of any shape.
!> Sources: O.C. Zienkiewicz, J.Z. Zhu, Int. J. Num. Meth. Engng 33 (1992) 1331-1364 and 1365-1382 (patches, points); T. Blacker,
!> T. Belytschko, Int. J. Num. Meth. Engng 37 (1994) 517-536 (blending).
module patch_recovery
  use kinds, only: wp
  use row_polynomials, only: fit_row, scatter_of
  use vertex_patches, only: patches_t
  implicit none
  private
  public :: polynomials_t, fit_patches, recover, nvalue

  !> Terms of the polynomials: 1, x, y, x^2, x y, y^2.
  integer, parameter :: nterm = 6
  !> Sums of products of two terms: x^a y^b up to the fourth degree in the order 1, x, y, x^2, x y, y^2, x^3, x^2 y, ... y^4,
  !> and the position of each product among them.
  integer, parameter :: nmoment = 15
  integer, parameter :: moment(nterm, nterm) = reshape([1, 2, 3, 4, 5, 6, &
                                                        2, 4, 5, 7, 8, 9, &
                                                        3, 5, 6, 8, 9, 10, &
                                                        4, 7, 8, 11, 12, 13, &
                                                        5, 8, 9, 12, 13, 14, &
                                                        6, 9, 10, 13, 14, 15], [nterm, nterm])
  !> Points of an element, and values that are recovered together: a fixed number, so that their loops are short code.
  integer, parameter :: nsample = 4, nvalue = 8
  !> A term that keeps less than this share of its square beside the others is not distinguished from them: `dependent` by
  !> round-off, `hardly` where those of the second degree are told from the others by how elements differ from rectangles. Their
  !> coefficients would be the errors of the values a few dozen times. Patches below `suspect` are looked at: some are merely long
  !> and lie aslant.
  real(wp), parameter :: dependent = 1.0e-8_wp, hardly = 1.0e-3_wp, suspect = 1.0e-2_wp

  !> A polynomial for every vertex: coefficients (nvalue, nterm, nvertex) in (x - node)/scale.
  type :: polynomials_t
    real(wp), allocatable :: centre(:, :), scale(:), coefficient(:, :, :)
  end type polynomials_t

contains

  !> Terms of the polynomials at a point.
  pure function terms(x) result(t)
    real(wp), intent(in) :: x(2)
    real(wp) :: t(nterm)

    t = [1.0_wp, x(1), x(2), x(1)*x(1), x(1)*x(2), x(2)*x(2)]
  end function terms

  !> Polynomials of all vertices from values at the 2 x 2 points.
  pure subroutine fit_patches(patches, coordinates, place, value, polynomials)
    type(patches_t), intent(in) :: patches
    real(wp), intent(in), contiguous :: coordinates(:, :)   !! (2, nnode) [length]
    real(wp), intent(in), contiguous :: place(:, :, :)      !! (2, 4, nelem) points [length]
    real(wp), intent(in), contiguous :: value(:, :, :)      !! (nvalue, 4, nelem) [unit of each value]
    type(polynomials_t), intent(out) :: polynomials
    real(wp) :: moments(nmoment), gram(nterm, nterm), right(nvalue, nterm), sums(nvalue), t(nterm), scale
    real(wp), allocatable :: points(:, :)   ! terms at the points of a patch
    integer :: v, i, j, k, n

    n = size(patches%node)
    allocate (polynomials%centre(2, n), polynomials%scale(n), polynomials%coefficient(nvalue, nterm, n))
    allocate (points(nsample*maxval(patches%first(2:) - patches%first(:n)), nterm))
    do v = 1, n
      associate (mine => patches%element(patches%first(v):patches%first(v + 1) - 1), centre => polynomials%centre(:, v))
        centre = coordinates(:, patches%node(v))
        polynomials%scale(v) = 1
        if (size(mine) == 0) cycle
        scale = 0
        do i = 1, size(mine)
          do k = 1, nsample
            scale = max(scale, abs(place(1, k, mine(i)) - centre(1)), abs(place(2, k, mine(i)) - centre(2)))
          end do
        end do
        polynomials%scale(v) = scale
        scale = 1/scale
        moments = 0
        do i = 1, size(mine)
          do k = 1, nsample
            t = terms(scale*(place(:, k, mine(i)) - centre))
            points(nsample*(i - 1) + k, :) = t
            moments = moments + [t, t(2)*t(4), t(3)*t(4), t(2)*t(6), t(3)*t(6), t(4)*t(4:6), t(5)*t(6), t(6)*t(6)]
          end do
        end do
        do j = 1, nterm
          gram(:, j) = moments(moment(:, j))
          sums = 0
          do i = 1, size(mine)
            do k = 1, nsample
              sums = sums + value(:nvalue, k, mine(i))*points(nsample*(i - 1) + k, j)
            end do
          end do
          right(:, j) = sums
        end do
        call solve_normal(points(:nsample*size(mine), 2:3), gram, right)
        polynomials%coefficient(:, :, v) = right
      end associate
    end do
    do v = 1, n
      if (patches%first(v + 1) == patches%first(v)) call take_mean(patches, v, polynomials)
    end do
  end subroutine fit_patches

  !> Solve for the coefficients, in place, by Cholesky's factors (their diagonal inverted); of a lower degree where the points do
  !> not determine one.
  pure subroutine solve_normal(points, gram, right)
    real(wp), intent(in) :: points(:, :)   !! (npoint, 2) of the patch [scale]
    real(wp), intent(inout) :: gram(nterm, nterm), right(nvalue, nterm)
    real(wp) :: diagonal
    integer :: i, j, degree_end
    logical :: checked, fits

    degree_end = nterm
    checked = .false.
    do j = 1, nterm
      diagonal = gram(j, j)
      call leave_rest(j, gram)
      if (.not. gram(j, j) > dependent*diagonal) then
        degree_end = merge(3, 1, j > 3)
        exit
      end if
      if (j > 3 .and. .not. checked .and. gram(j, j) < suspect*diagonal) then
        if (.not. determine_quadratic(points)) then
          degree_end = 3
          exit
        end if
        checked = .true.
      end if
      call eliminate(j, gram)
    end do
    if (degree_end == 3) then
      call fit_row(points, hardly, right, fits)
      if (fits) return
    end if
    do j = 1, degree_end
      right(:, j) = right(:, j)*gram(j, j)
      do i = j + 1, degree_end
        right(:, i) = right(:, i) - gram(i, j)*right(:, j)
      end do
    end do
    do j = degree_end, 1, -1
      do i = j + 1, degree_end
        right(:, j) = right(:, j) - gram(i, j)*right(:, i)
      end do
      right(:, j) = right(:, j)*gram(j, j)
    end do
    right(:, degree_end + 1:) = 0
  end subroutine solve_normal

  !> What term j has for itself beside those before it, the square of Cholesky's diagonal, in its place in the matrix.
  pure subroutine leave_rest(j, gram)
    integer, intent(in) :: j
    real(wp), intent(inout) :: gram(nterm, nterm)
    integer :: i

    do i = 1, j - 1
      gram(j, j) = gram(j, j) - gram(j, i)**2
    end do
  end subroutine leave_rest

  !> Column j of Cholesky's factor, its diagonal inverted, in place.
  pure subroutine eliminate(j, gram)
    integer, intent(in) :: j
    real(wp), intent(inout) :: gram(nterm, nterm)
    integer :: i

    gram(j, j) = 1/sqrt(gram(j, j))
    do i = j + 1, nterm
      gram(i, j) = (gram(i, j) - dot_product(gram(i, :j - 1), gram(j, :j - 1)))*gram(j, j)
    end do
  end subroutine eliminate

  !> Points determine a quadratic polynomial: each term of the second degree keeps a share of itself beside those before it, in
  !> coordinates in which the points scatter by 1 in every direction, so that it is no matter how long a patch is and how it lies.
  pure function determine_quadratic(points) result(yes)
    real(wp), intent(in) :: points(:, :)   !! (npoint, 2) that do not lie on a line [scale]
    logical :: yes
    real(wp) :: mean(2), spread_of(2), slope, gram(nterm, nterm), t(nterm), diagonal
    integer :: j, k

    call scatter_of(points, mean, spread_of, slope)
    gram = 0
    do k = 1, size(points, 1)
      t(:2) = points(k, :) - mean
      t = terms([t(1)/spread_of(1), (t(2) - slope*t(1))/spread_of(2)])
      do j = 1, nterm
        gram(:, j) = gram(:, j) + t*t(j)
      end do
    end do
    yes = .true.
    do j = 1, nterm
      diagonal = gram(j, j)
      call leave_rest(j, gram)
      yes = gram(j, j) > hardly*diagonal
      if (.not. yes) return
      call eliminate(j, gram)
    end do
  end function determine_quadratic

  !> The mean of the donors' polynomials, moved to the position and scale of this vertex.
  pure subroutine take_mean(patches, v, polynomials)
    type(patches_t), intent(in) :: patches
    integer, intent(in) :: v
    type(polynomials_t), intent(inout) :: polynomials
    real(wp) :: s, t(2)
    integer :: i, d

    associate (c => polynomials%coefficient, donors => patches%donor(patches%first_donor(v):patches%first_donor(v + 1) - 1))
      polynomials%scale(v) = polynomials%scale(donors(1))
      c(:, :, v) = 0
      do i = 1, size(donors)
        d = donors(i)
        s = polynomials%scale(v)/polynomials%scale(d)
        t = (polynomials%centre(:, v) - polynomials%centre(:, d))/polynomials%scale(d)
        c(:, 1, v) = c(:, 1, v) + matmul(c(:, :, d), terms(t))
        c(:, 2, v) = c(:, 2, v) + s*(c(:, 2, d) + 2*t(1)*c(:, 4, d) + t(2)*c(:, 5, d))
        c(:, 3, v) = c(:, 3, v) + s*(c(:, 3, d) + t(1)*c(:, 5, d) + 2*t(2)*c(:, 6, d))
        c(:, 4:6, v) = c(:, 4:6, v) + s*s*c(:, 4:6, d)
      end do
      c(:, :, v) = c(:, :, v)/size(donors)
    end associate
  end subroutine take_mean

  !> The recovered fields at points of element e.
  pure subroutine recover(patches, polynomials, e, place, blend, value)
    type(patches_t), intent(in) :: patches
    type(polynomials_t), intent(in) :: polynomials
    integer, intent(in) :: e
    real(wp), intent(in), contiguous :: place(:, :)          !! (2, n) points [length]
    real(wp), intent(in), contiguous :: blend(:, :)          !! (4, n) bilinear shape functions of the corners there [-]
    real(wp), intent(out) :: value(nvalue, size(place, 2))   !! (nvalue, n) [unit of each value]
    real(wp) :: coefficient(nvalue, nterm), centre(2), scale, t(nterm, size(place, 2))
    integer :: k, i, v, p

    value = 0
    do k = 1, 4
      v = patches%vertex(k, e)
      coefficient = polynomials%coefficient(:, :, v)
      centre = polynomials%centre(:, v)
      scale = polynomials%scale(v)
      do p = 1, size(place, 2)
        t(:, p) = blend(k, p)*terms((place(:, p) - centre)/scale)
      end do
      do p = 1, size(place, 2)
        do i = 1, nvalue
          value(i, p) = value(i, p) + coefficient(i, 1)*t(1, p) + coefficient(i, 2)*t(2, p) + coefficient(i, 3)*t(3, p) &
                        + coefficient(i, 4)*t(4, p) + coefficient(i, 5)*t(5, p) + coefficient(i, 6)*t(6, p)
        end do
      end do
    end do
  end subroutine recover

end module patch_recovery
