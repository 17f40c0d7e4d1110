!> Mesh of a block with four straight or curved sides by transfinite interpolation.
!>
!> The corners are 1 to 4 counter-clockwise; side 1 goes from corner 1 to 2, side 2 from 2 to 3,
!> side 3 from 3 to 4, side 4 from 4 to 1. With the sides as curves c1(s), c3(s) (from the left to the
!> right) and c4(t), c2(t) (upwards), a point of the block is Coons' patch
!> x(s,t) = (1-t) c1 + t c3 + (1-s) c4 + s c2 - bilinear(corners).
!> Source: W.J. Gordon, C.A. Hall, Int. J. Num. Meth. Engng 7 (1973) 461-477.
module block_mesh
  use kinds, only: wp
  use plane_vectors, only: angle_between
  use shape_functions, only: quad8, quad8_corner, quad8_side
  use quadrature, only: square_rule
  use vectors, only: length_of
  implicit none
  private
  public :: block_t, divisions_of, mesh_block, grading, least_jacobian, polygon_area
  public :: side_straight, side_arc, side_parabola

  !> Forms of a side: the point given is the centre of the arc, or the middle point of the parabola.
  integer, parameter :: side_straight = 0
  integer, parameter :: side_arc = 1
  integer, parameter :: side_parabola = 2

  type :: block_t
    real(wp) :: corners(2, 4) = 0.0_wp
    !> Divisions along sides 1 and 3, and along sides 2 and 4.
    integer :: divisions(2) = 1
    !> Last over first element size, in the direction 1 -> 2, and in the direction 1 -> 4.
    real(wp) :: ratios(2) = 1.0_wp
    integer :: form(4) = side_straight
    real(wp) :: point(2, 4) = 0.0_wp
    !> Elements along a line over the divisions: 1/2, where these are even, or whole.
    real(wp) :: refinement = 1.0_wp
  end type block_t

contains

  !> Nodes, elements and the four sides, each traversed with the block on its left.
  !> Nodes are numbered along side 1 first, row after row; elements likewise.
  pure subroutine mesh_block(block, coordinates, connectivity, side_first, side_nodes)
    type(block_t), intent(in) :: block
    real(wp), allocatable, intent(out) :: coordinates(:, :)   !! (2, nnode) [length]
    integer, allocatable, intent(out) :: connectivity(:, :)   !! (8, nelem)
    integer, intent(out) :: side_first(5)                     !! side k holds columns side_first(k) ... side_first(k+1) - 1
    integer, allocatable, intent(out) :: side_nodes(:, :)     !! (3, nside)
    real(wp), allocatable :: s(:), t(:)
    integer, allocatable :: number(:, :)
    integer :: i, j, k, n, nx, ny

    nx = divisions_of(block, 1)
    ny = divisions_of(block, 2)
    call refined_grading(block, 1, s)
    call refined_grading(block, 2, t)
    allocate (number(0:2*nx, 0:2*ny), source=0)
    allocate (coordinates(2, (2*nx + 1)*(2*ny + 1) - nx*ny), connectivity(8, nx*ny), side_nodes(3, 2*(nx + ny)))
    n = 0
    do j = 0, 2*ny
      do i = 0, 2*nx
        if (mod(i, 2) == 1 .and. mod(j, 2) == 1) cycle
        n = n + 1
        number(i, j) = n
        coordinates(:, n) = block_point(block, s(i + 1), t(j + 1))
      end do
    end do
    n = 0
    do j = 0, 2*ny - 2, 2
      do i = 0, 2*nx - 2, 2
        n = n + 1
        connectivity(:, n) = [number(i, j), number(i + 2, j), number(i + 2, j + 2), number(i, j + 2), &
                              number(i + 1, j), number(i + 2, j + 1), number(i + 1, j + 2), number(i, j + 1)]
      end do
    end do
    side_first = 1 + [0, nx, nx + ny, 2*nx + ny, 2*(nx + ny)]
    do k = 1, nx
      side_nodes(:, k) = connectivity(quad8_side(:, 1), k)
      side_nodes(:, nx + ny + k) = connectivity(quad8_side(:, 3), ny*nx - k + 1)
    end do
    do k = 1, ny
      side_nodes(:, nx + k) = connectivity(quad8_side(:, 2), k*nx)
      side_nodes(:, 2*nx + ny + k) = connectivity(quad8_side(:, 4), (ny - k)*nx + 1)
    end do
  end subroutine mesh_block

  !> Elements along sides 1 and 3 (k = 1), or 2 and 4 (k = 2).
  elemental function divisions_of(block, k) result(n)
    type(block_t), intent(in) :: block
    integer, intent(in) :: k
    integer :: n

    n = max(nint(block%refinement*block%divisions(k)), 1)
  end function divisions_of

  !> Parameters of the ends and middles of the elements: each division in equal parts, or two of them together.
  pure subroutine refined_grading(block, k, s)
    type(block_t), intent(in) :: block
    integer, intent(in) :: k
    real(wp), allocatable, intent(out) :: s(:)   !! (2*n + 1) [-]
    real(wp), allocatable :: own(:)
    integer :: i, j, n, parts

    call grading(block%divisions(k), block%ratios(k), own)
    n = divisions_of(block, k)
    if (n == block%divisions(k)) then
      call move_alloc(own, s)
      return
    end if
    allocate (s(2*n + 1))
    if (n < block%divisions(k)) then
      s(1::2) = own(1::4)
    else
      parts = n/block%divisions(k)
      do i = 1, block%divisions(k)
        do j = 0, parts
          s(1 + 2*(parts*(i - 1) + j)) = own(2*i - 1) + (own(2*i + 1) - own(2*i - 1))*j/parts
        end do
      end do
    end if
    s(2::2) = 0.5_wp*(s(1:2*n - 1:2) + s(3::2))
  end subroutine refined_grading

  !> Parameters from 0 to 1 of the ends and middles of n elements in geometric progression.
  pure subroutine grading(n, ratio, s)
    integer, intent(in) :: n
    real(wp), intent(in) :: ratio
    real(wp), allocatable, intent(out) :: s(:)   !! (2*n + 1) [-]
    real(wp) :: length, factor
    integer :: i

    allocate (s(2*n + 1))
    factor = 1
    if (n > 1) factor = exp(log(ratio)/(n - 1))
    s(1) = 0
    length = 1
    do i = 1, n
      s(2*i + 1) = s(2*i - 1) + length
      length = length*factor
    end do
    s(3::2) = s(3::2)/s(2*n + 1)
    s(2*n + 1) = 1
    s(2::2) = 0.5_wp*(s(1:2*n - 1:2) + s(3::2))
  end subroutine grading

  !> Coons' patch; points of the sides are exactly those of the curves.
  pure function block_point(block, s, t) result(x)
    type(block_t), intent(in) :: block
    real(wp), intent(in) :: s, t
    real(wp) :: x(2)

    if (.not. t > 0) then
      x = side_point(block, 1, s)
    else if (.not. t < 1) then
      x = side_point(block, 3, 1 - s)
    else if (.not. s > 0) then
      x = side_point(block, 4, 1 - t)
    else if (.not. s < 1) then
      x = side_point(block, 2, t)
    else
      associate (p => block%corners)
        x = (1 - t)*side_point(block, 1, s) + t*side_point(block, 3, 1 - s) &
            + (1 - s)*side_point(block, 4, 1 - t) + s*side_point(block, 2, t) &
            - ((1 - s)*(1 - t)*p(:, 1) + s*(1 - t)*p(:, 2) + s*t*p(:, 3) + (1 - s)*t*p(:, 4))
      end associate
    end if
  end function block_point

  !> Point of side k at parameter u, 0 at its first corner and 1 at its second.
  pure function side_point(block, k, u) result(x)
    type(block_t), intent(in) :: block
    integer, intent(in) :: k
    real(wp), intent(in) :: u
    real(wp) :: x(2)
    real(wp) :: a(2), b(2), turn, radius, direction(2)

    associate (first => block%corners(:, k), last => block%corners(:, mod(k, 4) + 1), point => block%point(:, k))
      if (.not. u > 0) then
        x = first
      else if (.not. u < 1) then
        x = last
      else if (block%form(k) == side_arc) then
        a = first - point
        b = last - point
        turn = u*angle_between(a, b)
        radius = (1 - u)*length_of(a) + u*length_of(b)
        direction = a/length_of(a)
        x = point + radius*[cos(turn)*direction(1) - sin(turn)*direction(2), sin(turn)*direction(1) + cos(turn)*direction(2)]
      else if (block%form(k) == side_parabola) then
        x = (1 - u)*(1 - 2*u)*first + 4*u*(1 - u)*point + u*(2*u - 1)*last
      else
        x = (1 - u)*first + u*last
      end if
    end associate
  end function side_point

  !> Smallest Jacobian of an element over its Gauss points and its corners, relative to its largest one.
  pure function least_jacobian(x, npoint) result(least)
    real(wp), intent(in) :: x(2, 8)   !! nodes [length]
    integer, intent(in) :: npoint
    real(wp) :: least
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8), dphi(2, 8), detj(npoint + 4), jacobian(2, 2)
    integer :: p

    call square_rule(npoint, xi, weight)
    do p = 1, npoint + 4
      if (p <= npoint) then
        call quad8(xi(1, p), xi(2, p), phi, dphi)
      else
        call quad8(quad8_corner(1, p - npoint), quad8_corner(2, p - npoint), phi, dphi)
      end if
      jacobian = matmul(dphi, transpose(x))
      detj(p) = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
    end do
    least = minval(detj)/max(maxval(abs(detj)), tiny(1.0_wp))
  end function least_jacobian

  !> Area of a polygon, negative when it is traversed clockwise.
  pure function polygon_area(x) result(area)
    real(wp), intent(in) :: x(:, :)   !! (2, ncorner) [length]
    real(wp) :: area
    integer :: i, j

    area = 0
    do i = 1, size(x, 2)
      j = mod(i, size(x, 2)) + 1
      area = area + 0.5_wp*(x(1, i)*x(2, j) - x(1, j)*x(2, i))
    end do
  end function polygon_area

end module block_mesh
