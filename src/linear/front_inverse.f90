!> Entries of the inverse of a factorised matrix, of few rows and columns.
!>
!> The columns of the inverse are solutions for unit vectors. Forward substitution of one of them is zero but in the fronts on the
!> path from the front of its pivot to the root; backward substitution asks for no other fronts to find the rows wanted
!> (P.R. Amestoy, I.S. Duff, J.-Y. L'Excellent, Y. Robert, F.-H. Rouet, B. Ucar, SIAM J. Sci. Comput. 34 (2012) A1975-A1999). All
!> columns go through a front together, by matrix products; in the order of elimination those that begin below a front follow one
!> another.
module front_inverse
  use blas, only: gemm => dgemm
  use dense_lu, only: block
  use front_layout, only: front_layout_t
  use kinds, only: i8, wp, rk => wp
  implicit none
  private
  public :: inverse_entries

  !> The fronts that take part, in the order of elimination, and where each has its rows and what it sends on.
  type :: paths_t
    integer, allocatable :: front(:)
    !> Columns that begin in the subtree of each: first and last; its first row among those of all.
    integer, allocatable :: first(:), last(:), row(:)
    !> Place of each front in these lists, 0 where it takes no part (nfront).
    integer, allocatable :: place(:)
    !> Where what a front sends on begins, rows of its border by its columns; length of all.
    integer, allocatable :: sent(:)
    integer :: nrow = 0, nsent = 0
  end type paths_t

contains

  !> entries(i, j) is the entry of the inverse in row equations(i) and column equations(j).
  subroutine inverse_entries(layout, factors, equations, entries)
    type(front_layout_t), intent(in) :: layout
    real(rk), intent(in) :: factors(layout%factor_length + 1)   !! of all fronts (multifrontal) [residual/unknown]
    integer, intent(in) :: equations(:)      !! (n), none twice
    real(wp), intent(out) :: entries(:, :)   !! (n, n) [unknown/residual]
    type(paths_t) :: paths
    real(rk), allocatable :: y(:, :), sent(:)
    integer :: place(size(equations)), from(size(equations)), row(size(equations)), k

    call sort_places(layout, equations, place, from)
    call find_paths(layout, place, paths)
    allocate (y(paths%nrow, size(equations)), sent(paths%nsent))
    call forward(layout, factors, place, paths, y, sent)
    call backward(layout, factors, paths, size(y, 2), y)
    do k = 1, size(place)
      associate (f => layout%front_of(place(k)))
        row(k) = paths%row(paths%place(f)) + place(k) - layout%first(f)
      end associate
    end do
    do k = 1, size(place)
      entries(from, from(k)) = real(y(row, k), wp)
    end do
  end subroutine inverse_entries

  !> Places of equations in the order of elimination, and which equation each is of.
  pure subroutine sort_places(layout, equations, place, from)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: equations(:)
    integer, intent(out) :: place(:), from(:)
    integer :: k, i, p

    do k = 1, size(equations)
      p = layout%place(equations(k))
      i = k
      do while (i > 1)
        if (place(i - 1) < p) exit
        place(i) = place(i - 1)
        from(i) = from(i - 1)
        i = i - 1
      end do
      place(i) = p
      from(i) = k
    end do
  end subroutine sort_places

  !> The fronts from those of the places to their roots.
  pure subroutine find_paths(layout, place, paths)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: place(:)   !! (n) sorted
    type(paths_t), intent(out) :: paths
    logical :: on_path(layout%nfront)
    integer :: k, f

    on_path = .false.
    do k = 1, size(place)
      f = layout%front_of(place(k))
      do while (f > 0)
        if (on_path(f)) exit
        on_path(f) = .true.
        f = layout%parent(f)
      end do
    end do
    paths%front = pack([(f, f=1, layout%nfront)], on_path)
    allocate (paths%first(size(paths%front)), paths%last(size(paths%front)), paths%row(size(paths%front)), &
              paths%sent(size(paths%front)))
    allocate (paths%place(0:layout%nfront), source=0)
    do k = 1, size(paths%front)
      f = paths%front(k)
      paths%place(f) = k
      paths%first(k) = 1 + count(place < layout%first(layout%subtree(f)))
      paths%last(k) = count(place < layout%first(f + 1))
      paths%row(k) = paths%nrow + 1
      paths%nrow = paths%nrow + layout%first(f + 1) - layout%first(f)
      paths%sent(k) = paths%nsent + 1
      paths%nsent = paths%nsent + (layout%border(f + 1) - layout%border(f))*(paths%last(k) - paths%first(k) + 1)
    end do
  end subroutine find_paths

  !> Forward substitution of unit vectors: y on the pivots of the paths.
  subroutine forward(layout, factors, place, paths, y, sent)
    type(front_layout_t), intent(in) :: layout
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    integer, intent(in) :: place(:)
    type(paths_t), intent(in) :: paths
    real(rk), intent(out) :: y(paths%nrow, size(place)), sent(:)
    real(rk) :: z(layout%max_order, size(place)), before(block, size(place))
    integer(i8) :: at
    integer :: l, f, k, c, j, i, s, p, n, w, ncol

    y = 0
    do l = 1, size(paths%front)
      f = paths%front(l)
      p = layout%first(f + 1) - layout%first(f)
      n = layout%order(f)
      associate (a => paths%first(l), b => paths%last(l))
        ncol = b - a + 1
        z(:n, a:b) = 0
        do j = a, b
          if (layout%front_of(place(j)) == f) z(place(j) - layout%first(f) + 1, j) = 1
        end do
        do k = layout%child_first(f), layout%child_first(f + 1) - 1
          c = layout%child(k)
          if (paths%place(c) == 0) cycle
          s = paths%sent(paths%place(c))
          do j = paths%first(paths%place(c)), paths%last(paths%place(c))
            do i = layout%border(c), layout%border(c + 1) - 1
              z(layout%to_parent(i), j) = z(layout%to_parent(i), j) + sent(s)
              s = s + 1
            end do
          end do
        end do
        do k = 1, p, block
          w = min(block, p - k + 1)
          before(:w, a:b) = z(k:k + w - 1, a:b)
          at = layout%factor_start(f) + (k - 1) + int(k - 1, i8)*n
          call gemm('N', 'N', w, ncol, w, 1.0_rk, factors(at), n, before(1, a), block, 0.0_rk, z(k, a), size(z, 1))
          if (k + w <= n) call gemm('N', 'N', n - k - w + 1, ncol, w, -1.0_rk, factors(at + w), n, z(k, a), size(z, 1), 1.0_rk, &
                                    z(k + w, a), size(z, 1))
        end do
        y(paths%row(l):paths%row(l) + p - 1, a:b) = z(:p, a:b)
        s = paths%sent(l)
        do j = a, b
          sent(s:s + n - p - 1) = z(p + 1:n, j)
          s = s + n - p
        end do
      end associate
    end do
  end subroutine forward

  !> Backward substitution on the paths, all columns.
  subroutine backward(layout, factors, paths, ncol, y)
    type(front_layout_t), intent(in) :: layout
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    type(paths_t), intent(in) :: paths
    integer, intent(in) :: ncol
    real(rk), intent(inout) :: y(paths%nrow, ncol)
    real(rk) :: z(layout%max_order, ncol)
    integer :: row(layout%max_order)
    integer(i8) :: at
    integer :: l, f, g, i, p, n, k

    do l = size(paths%front), 1, -1
      f = paths%front(l)
      p = layout%first(f + 1) - layout%first(f)
      n = layout%order(f)
      associate (first => paths%row(l))
        if (n > p) then
          do i = 1, n - p
            k = layout%index(layout%border(f) + i - 1)
            g = layout%front_of(k)
            row(i) = paths%row(paths%place(g)) + k - layout%first(g)
          end do
          z(:n - p, :) = y(row(:n - p), :)
          at = layout%factor_start(f) + int(p, i8)*n
          call gemm('N', 'N', p, ncol, n - p, -1.0_rk, factors(at), p, z, size(z, 1), 1.0_rk, y(first, 1), size(y, 1))
        end if
        do k = 1 + block*((p - 1)/block) - block, 1, -block
          ! rows of a block, by the pivots of those after it
          at = layout%factor_start(f) + (k - 1) + int(k + block - 1, i8)*n
          call gemm('N', 'N', block, ncol, p - k - block + 1, -1.0_rk, factors(at), n, y(first + k + block - 1, 1), size(y, 1), &
                    1.0_rk, y(first + k - 1, 1), size(y, 1))
        end do
      end associate
    end do
  end subroutine backward

end module front_inverse
