!> Squares that carry the requested element sizes, for a mesher that evaluates them between given points.
!>
!> A square around the body is divided into four, recursively, until none is larger than two elements there: bilinear between
!> its corners the size is then accurate, since it grows slowly (gradation).
module size_cells
  use gmsh_files, only: cell_t
  use kinds, only: wp
  use size_field, only: size_at, size_field_t
  implicit none
  private
  public :: cover

  !> Largest width of a square in elements, and largest depth of the recursion.
  real(wp), parameter :: widest = 2.0_wp
  integer, parameter :: deepest = 14
  !> Margin of the square around the body, as a share of its size.
  real(wp), parameter :: margin = 0.01_wp

contains

  !> Squares over the box from `low` to `high`.
  pure subroutine cover(field, material, low, high, cells)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: low(2), high(2)              !! [length]
    type(cell_t), allocatable, intent(out) :: cells(:)   !! (ncell)
    type(cell_t) :: cell, open_cells(4*deepest + 1)
    type(cell_t), allocatable :: more(:)
    real(wp) :: corner(2)
    integer :: waiting, n, k

    allocate (cells(64))
    n = 0
    cell%width = (1 + 2*margin)*maxval(high - low)
    cell%low = 0.5_wp*(low + high) - 0.5_wp*cell%width
    waiting = 1
    open_cells(1) = measured(cell)
    do while (waiting > 0)
      cell = open_cells(waiting)
      waiting = waiting - 1
      if (any(cell%low > high) .or. any(cell%low + cell%width < low)) cycle
      if (cell%depth < deepest .and. cell%width > widest*min(minval(cell%sizes), size_at(field, material, middle(cell)))) then
        do k = 0, 3
          corner = cell%low + 0.5_wp*cell%width*[mod(k, 2), k/2]
          waiting = waiting + 1
          open_cells(waiting) = measured(cell_t(corner, 0.5_wp*cell%width, depth=cell%depth + 1))
        end do
        cycle
      end if
      if (n == size(cells)) then
        allocate (more(2*n))
        more(:n) = cells
        call move_alloc(more, cells)
      end if
      n = n + 1
      cells(n) = cell
    end do
    cells = cells(:n)

  contains

    pure function middle(square) result(x)
      type(cell_t), intent(in) :: square
      real(wp) :: x(2)

      x = square%low + 0.5_wp*square%width
    end function middle

    pure function measured(square) result(known)
      type(cell_t), intent(in) :: square
      type(cell_t) :: known
      integer :: i
      real(wp), parameter :: corners(2, 4) = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp], [2, 4])

      known = square
      do i = 1, 4
        known%sizes(i) = size_at(field, material, square%low + square%width*corners(:, i))
      end do
    end function measured

  end subroutine cover

end module size_cells
