!> Superconvergent patch recovery: a continuous field from values that are best at the 2 x 2 points of 8-node elements.
!>
!> Around every corner node of the mesh a complete quadratic polynomial is fitted, by least squares, to the values at the 2 x 2
!> points of the elements that meet there. Nodes where fewer than three elements meet, on the boundary and on material lines, take
!> the mean of the polynomials of their neighbours that have one; where there is none the patch is widened by a row. Patches whose
!> points do not determine a quadratic get a linear polynomial. In an element the polynomials of its four corners are blended by the
!> bilinear shape functions, so that a field that is quadratic in x and y comes out exactly on elements of any shape.
!> Sources: O.C. Zienkiewicz, J.Z. Zhu, Int. J. Num. Meth. Engng 33 (1992) 1331-1364 and 1365-1382 (patches, points); T. Blacker,
!> T. Belytschko, Int. J. Num. Meth. Engng 37 (1994) 517-536 (blending).
module patch_recovery
  use kinds, only: wp
  implicit none
  private
  public :: patches_t, polynomials_t, find_patches, fit_patches, recover, nvalue

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
  !> Elements that a node needs for a patch of its own.
  integer, parameter :: least_elements = 3
  !> A term that keeps less than this share of itself beside the others is not distinguished from them.
  real(wp), parameter :: dependent = 1.0e-8_wp

  !> Patches of a set of elements; only their nodes matter.
  type :: patches_t
    !> Corner nodes (nvertex), and the vertices of the elements (4, nelem).
    integer, allocatable :: node(:), vertex(:, :)
    !> Elements of the patch of vertex v: element(first(v):first(v + 1) - 1); none where it has no patch.
    integer, allocatable :: first(:), element(:)
    !> Vertices whose polynomials it takes where it has none, in the same way.
    integer, allocatable :: first_donor(:), donor(:)
  end type patches_t

  !> A polynomial for every vertex: coefficients (nvalue, nterm, nvertex) in (x - node)/scale.
  type :: polynomials_t
    real(wp), allocatable :: centre(:, :), scale(:), coefficient(:, :, :)
  end type polynomials_t

contains

  !> Patches of elements.
  pure subroutine find_patches(connectivity, patches)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    type(patches_t), intent(out) :: patches
    integer, allocatable :: start(:), around(:), seen_element(:), seen_vertex(:)
    integer :: v, nvertex, pass

    call number_vertices(connectivity, patches)
    nvertex = size(patches%node)
    call list_elements(patches%vertex, nvertex, start, around)
    allocate (patches%first(nvertex + 1), patches%first_donor(nvertex + 1))
    allocate (patches%element(0), patches%donor(0))
    do pass = 1, 2   ! count, then fill
      seen_element = spread(0, 1, size(connectivity, 2))
      seen_vertex = spread(0, 1, nvertex)
      patches%first = 1
      patches%first_donor = 1
      do v = 1, nvertex
        patches%first(v + 1) = patches%first(v)
        patches%first_donor(v + 1) = patches%first_donor(v)
        if (has_own(v)) then
          call list_own(v, seen_element, patches)
        else
          call list_donors(v, .false., seen_vertex, patches)
          if (.not. has_donors(v)) call list_donors(v, .true., seen_vertex, patches)
          if (.not. has_donors(v)) call widen(patches%vertex, start, around, v, seen_element, patches%element, patches%first(v + 1))
        end if
      end do
      if (pass == 2) exit
      deallocate (patches%element, patches%donor)
      allocate (patches%element(patches%first(nvertex + 1) - 1), patches%donor(patches%first_donor(nvertex + 1) - 1), source=0)
    end do

  contains

    pure logical function has_own(v)
      integer, intent(in) :: v

      has_own = start(v + 1) - start(v) >= least_elements
    end function has_own

    pure logical function has_donors(v)
      integer, intent(in) :: v

      has_donors = patches%first_donor(v + 1) > patches%first_donor(v)
    end function has_donors

    !> List the elements around vertex v.
    pure subroutine list_own(v, seen, patches)
      integer, intent(in) :: v
      integer, intent(inout) :: seen(:)
      type(patches_t), intent(inout) :: patches
      integer :: i

      do i = start(v), start(v + 1) - 1
        call add(around(i), v, seen, patches%element, patches%first(v + 1))
      end do
    end subroutine list_own

    !> List the vertices with patches of their own that vertex v meets along the sides of elements, or across these.
    pure subroutine list_donors(v, across, seen, patches)
      integer, intent(in) :: v
      logical, intent(in) :: across
      integer, intent(inout) :: seen(:)
      type(patches_t), intent(inout) :: patches
      integer :: i, k, at

      do i = start(v), start(v + 1) - 1
        at = findloc(patches%vertex(:, around(i)), v, 1)
        do k = 1, 4
          if (mod(k - at, 2) == 0 .neqv. across) cycle
          if (has_own(patches%vertex(k, around(i)))) &
            call add(patches%vertex(k, around(i)), v, seen, patches%donor, patches%first_donor(v + 1))
        end do
      end do
    end subroutine list_donors

  end subroutine find_patches

  !> List the elements around vertex v, and all that touch these.
  pure subroutine widen(vertex, start, around, v, seen, list, next)
    integer, intent(in) :: vertex(:, :), start(:), around(:), v
    integer, intent(inout) :: seen(:), list(:), next
    integer :: i, j, k, w

    do i = start(v), start(v + 1) - 1
      do k = 1, 4
        w = vertex(k, around(i))
        do j = start(w), start(w + 1) - 1
          call add(around(j), v, seen, list, next)
        end do
      end do
    end do
  end subroutine widen

  !> Put a number into a list, once for each vertex v; a list without room is only counted.
  pure subroutine add(number, v, seen, list, next)
    integer, intent(in) :: number, v
    integer, intent(inout) :: seen(:), list(:), next

    if (seen(number) == v) return
    seen(number) = v
    if (next <= size(list)) list(next) = number
    next = next + 1
  end subroutine add

  !> Corner nodes in the order met.
  pure subroutine number_vertices(connectivity, patches)
    integer, intent(in) :: connectivity(:, :)
    type(patches_t), intent(inout) :: patches
    integer :: number(maxval(connectivity)), node(4*size(connectivity, 2))
    integer :: e, k, n

    number = 0
    n = 0
    allocate (patches%vertex(4, size(connectivity, 2)))
    do e = 1, size(connectivity, 2)
      do k = 1, 4
        if (number(connectivity(k, e)) == 0) then
          n = n + 1
          node(n) = connectivity(k, e)
          number(connectivity(k, e)) = n
        end if
        patches%vertex(k, e) = number(connectivity(k, e))
      end do
    end do
    allocate (patches%node(n), source=node(:n))
  end subroutine number_vertices

  !> Elements around vertex v: around(start(v):start(v + 1) - 1), ascending.
  pure subroutine list_elements(vertex, nvertex, start, around)
    integer, intent(in) :: vertex(:, :), nvertex
    integer, allocatable, intent(out) :: start(:), around(:)
    integer :: e, k, v, next(nvertex)

    allocate (start(nvertex + 1), around(size(vertex)))
    start = 0
    do e = 1, size(vertex, 2)
      do k = 1, 4
        start(vertex(k, e) + 1) = start(vertex(k, e) + 1) + 1
      end do
    end do
    start(1) = 1
    do v = 1, nvertex
      start(v + 1) = start(v) + start(v + 1)
    end do
    next = start(:nvertex)
    do e = 1, size(vertex, 2)
      do k = 1, 4
        around(next(vertex(k, e))) = e
        next(vertex(k, e)) = next(vertex(k, e)) + 1
      end do
    end do
  end subroutine list_elements

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
        call solve_normal(gram, right)
        polynomials%coefficient(:, :, v) = right
      end associate
    end do
    do v = 1, n
      if (patches%first(v + 1) == patches%first(v)) call take_mean(patches, v, polynomials)
    end do
  end subroutine fit_patches

  !> Solve for the coefficients, in place, by Cholesky's factors (their diagonal inverted); of a lower degree where the points do
  !> not determine one.
  pure subroutine solve_normal(gram, right)
    real(wp), intent(inout) :: gram(nterm, nterm), right(nvalue, nterm)
    real(wp) :: diagonal
    integer :: i, j, degree_end

    degree_end = nterm
    do j = 1, nterm
      diagonal = gram(j, j)
      do i = 1, j - 1
        gram(j, j) = gram(j, j) - gram(j, i)**2
      end do
      if (.not. gram(j, j) > dependent*diagonal) then
        degree_end = merge(3, 1, j > 3)
        exit
      end if
      gram(j, j) = 1/sqrt(gram(j, j))
      do i = j + 1, nterm
        gram(i, j) = (gram(i, j) - dot_product(gram(i, :j - 1), gram(j, :j - 1)))*gram(j, j)
      end do
    end do
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
