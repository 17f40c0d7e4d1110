!> A state transfer as a sparse matrix from the points of the old mesh to those of the new one, or two of them with the nodes of the
!> old mesh in between. Computed once, used for every variable.
module transfer_map
  use kinds, only: wp
  implicit none
  private
  public :: sparse_rows_t, transfer_map_t, start_rows, append_rows, start_map, carry, range_of_sources

  type :: sparse_rows_t
    !> Row p has entries first(p) ... first(p + 1) - 1 of the two lists (nrow + 1).
    integer, allocatable :: first(:)
    !> Columns, and their weights; the weights of a row sum to 1.
    integer, allocatable :: source(:)
    real(wp), allocatable :: weight(:)
  end type sparse_rows_t

  !> Rows are the new points. Columns are the old points, or the rows of `nodal` where that is there.
  type, extends(sparse_rows_t) :: transfer_map_t
    !> Distance of new points outside the old mesh, where the method computes it [length]; degree of the polynomial fitted.
    real(wp), allocatable :: outside(:)
    integer, allocatable :: degree(:)
    !> From the old points to the nodes.
    type(sparse_rows_t), allocatable :: nodal
  end type transfer_map_t

contains

  !> Rows to be filled by `append_rows`, in their order.
  pure subroutine start_rows(n, rows)
    integer, intent(in) :: n
    class(sparse_rows_t), intent(inout) :: rows

    allocate (rows%first(n + 1), source=1)
    allocate (rows%source(0), rows%weight(0))
  end subroutine start_rows

  !> Append rows to the `done` ones: `used(k)` entries of column k of two wide tables.
  pure subroutine append_rows(done, source, weight, used, rows)
    integer, intent(in) :: done
    integer, intent(in) :: source(:, :), used(:)   !! (wide, n) columns of the rows; (n) number of entries
    real(wp), intent(in) :: weight(:, :)           !! (wide, n) [-]
    class(sparse_rows_t), intent(inout) :: rows
    integer, allocatable :: wider(:)
    real(wp), allocatable :: wider_weight(:)
    integer :: k, n, needed

    n = rows%first(done + 1) - 1
    needed = n + sum(used)
    if (done + size(used) == size(rows%first) - 1 .or. needed > size(rows%source)) then
      ! no room is left after the last rows
      if (done + size(used) < size(rows%first) - 1) then
        allocate (wider(2*needed), wider_weight(2*needed))
      else
        allocate (wider(needed), wider_weight(needed))
      end if
      wider(:n) = rows%source(:n)
      wider_weight(:n) = rows%weight(:n)
      call move_alloc(wider, rows%source)
      call move_alloc(wider_weight, rows%weight)
    end if
    do k = 1, size(used)
      rows%source(n + 1:n + used(k)) = source(:used(k), k)
      rows%weight(n + 1:n + used(k)) = weight(:used(k), k)
      n = n + used(k)
      rows%first(done + k + 1) = n + 1
    end do
  end subroutine append_rows

  !> A map with room for `lengths(p)` sources of point p.
  pure subroutine start_map(lengths, map)
    integer, intent(in) :: lengths(:)   !! (n)
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

  !> Values (component, new point) from those of the old mesh (component, old point). Each new point is summed in its own order:
  !> the same bits for any number of threads.
  subroutine carry(map, old, new)
    type(transfer_map_t), intent(in) :: map
    real(wp), intent(in) :: old(:, :)    !! (component, nold) [unit of each component]
    real(wp), intent(out) :: new(:, :)   !! (component, nnew) [unit of each component]
    real(wp), allocatable :: at_nodes(:, :)

    if (allocated(map%nodal)) then
      allocate (at_nodes(size(old, 1), size(map%nodal%first) - 1))
      call multiply(map%nodal, old, at_nodes)
      call multiply(map, at_nodes, new)
    else
      call multiply(map, old, new)
    end if
  end subroutine carry

  subroutine multiply(rows, old, new)
    class(sparse_rows_t), intent(in) :: rows
    real(wp), intent(in), contiguous :: old(:, :)
    real(wp), intent(out), contiguous :: new(:, :)
    integer :: p, k

    !$omp parallel do schedule(static) private(k)
    do p = 1, size(rows%first) - 1
      new(:, p) = 0
      do k = rows%first(p), rows%first(p + 1) - 1
        new(:, p) = new(:, p) + rows%weight(k)*old(:, rows%source(k))
      end do
    end do
    !$omp end parallel do
  end subroutine multiply

  !> Least and largest value of the old points each new point is computed from.
  pure subroutine range_of_sources(map, old, lower, upper)
    type(transfer_map_t), intent(in) :: map
    real(wp), intent(in) :: old(:)                !! (nold) [unit of the variable]
    real(wp), intent(out) :: lower(:), upper(:)   !! (nnew) [unit of the variable]
    real(wp), allocatable :: at_nodes(:, :)

    if (allocated(map%nodal)) then
      allocate (at_nodes(size(map%nodal%first) - 1, 2))
      call range_of_rows(map%nodal, old, old, at_nodes(:, 1), at_nodes(:, 2))
      call range_of_rows(map, at_nodes(:, 1), at_nodes(:, 2), lower, upper)
    else
      call range_of_rows(map, old, old, lower, upper)
    end if
  end subroutine range_of_sources

  pure subroutine range_of_rows(rows, least, largest, lower, upper)
    class(sparse_rows_t), intent(in) :: rows
    real(wp), intent(in) :: least(:), largest(:)
    real(wp), intent(out) :: lower(:), upper(:)
    integer :: p

    do p = 1, size(rows%first) - 1
      associate (sources => rows%source(rows%first(p):rows%first(p + 1) - 1))
        lower(p) = minval(least(sources))
        upper(p) = maxval(largest(sources))
      end associate
    end do
  end subroutine range_of_rows

end module transfer_map
