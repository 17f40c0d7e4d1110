!> A state transfer as what it is: a sparse matrix from the points of the old mesh to those of the new one. Made once, used for
!> every variable.
module transfer_map
  use kinds, only: wp
  implicit none
  private
  public :: transfer_map_t, start_map, carry, range_of_sources

  type :: transfer_map_t
    !> New point p takes from places first(p) ... first(p + 1) - 1 of the two lists (npoint + 1).
    integer, allocatable :: first(:)
    !> Old points, and their weights; the weights of a new point sum to 1.
    integer, allocatable :: source(:)
    real(wp), allocatable :: weight(:)
    !> Distance of new points outside the old mesh, where the method looks at it [length]; degree of the polynomial fitted.
    real(wp), allocatable :: outside(:)
    integer, allocatable :: degree(:)
  end type transfer_map_t

contains

  !> A map with room for `lengths(p)` sources of point p.
  pure subroutine start_map(lengths, map)
    integer, intent(in) :: lengths(:)
    type(transfer_map_t), intent(out) :: map
    integer :: p, n

    n = size(lengths)
    allocate (map%first(n + 1))
    map%first(1) = 1
    do p = 1, n
      map%first(p + 1) = map%first(p) + lengths(p)
    end do
    allocate (map%source(map%first(n + 1) - 1), source=0)
    allocate (map%weight(map%first(n + 1) - 1), source=0.0_wp)
    allocate (map%outside(n), source=0.0_wp)
    allocate (map%degree(n), source=0)
  end subroutine start_map

  !> Values (component, point) of the new mesh from those of the old one.
  subroutine carry(map, old, new)
    type(transfer_map_t), intent(in) :: map
    real(wp), intent(in) :: old(:, :)
    real(wp), intent(out) :: new(:, :)
    integer :: p, k

    !$omp parallel do schedule(static) private(k)
    do p = 1, size(map%first) - 1
      new(:, p) = 0
      do k = map%first(p), map%first(p + 1) - 1
        new(:, p) = new(:, p) + map%weight(k)*old(:, map%source(k))
      end do
    end do
    !$omp end parallel do
  end subroutine carry

  !> Least and largest value among the old points each new point takes from.
  pure subroutine range_of_sources(map, old, lower, upper)
    type(transfer_map_t), intent(in) :: map
    real(wp), intent(in) :: old(:)
    real(wp), intent(out) :: lower(:), upper(:)
    integer :: p

    do p = 1, size(lower)
      associate (sources => map%source(map%first(p):map%first(p + 1) - 1))
        lower(p) = minval(old(sources))
        upper(p) = maxval(old(sources))
      end associate
    end do
  end subroutine range_of_sources

end module transfer_map
