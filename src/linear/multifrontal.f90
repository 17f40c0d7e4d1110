!> Multifrontal factorisation without pivoting, by all threads (I.S. Duff, J.K. Reid, ACM Trans. Math. Softw. 9 (1983) 302-325). A
!> front keeps the inverses of its blocks of pivots, what is below them, and the rows U beside them (dense_lu).
!>
!> Subtrees are tasks; the last of each front is done by the thread that is there: one that waits would help with the tasks of
!> its own only, not with theirs. A front sums its nonzeros and the borders of its children in a fixed order and writes only
!> what is its own, so the bits are the same for any number of threads.
module multifrontal
  use blas, only: gemv => dgemv, keep_blas_to_one_thread
  use dense_lu, only: block, eliminate, eliminate_shared
  use errors, only: error_t, exit_machine, fail
  use front_layout, only: front_layout_t
  use kinds, only: i8, wp, rk => wp
  use matrix_pattern, only: matrix_pattern_t
  use symbolic_factorisation, only: lay_out_fronts
  use text, only: to_text
  implicit none
  private
  public :: multifrontal_t, plan, decompose, substitute

  !> Of an entry of the factors.
  integer, parameter :: bytes = storage_size(0.0_rk)/8

  type :: multifrontal_t
    type(front_layout_t) :: layout
    !> Factors of all fronts; matrices of their borders; what borders send on in a solve.
    real(rk), allocatable :: factors(:), borders(:), sent(:)
    !> Pivots below 0.
    integer :: negative = 0
  end type multifrontal_t

contains

  !> Find fronts and their positions.
  subroutine plan(solver, pattern, position, error)
    type(multifrontal_t), intent(inout) :: solver
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)   !! order of elimination (neq)
    type(error_t), allocatable, intent(out) :: error
    integer :: status

    call keep_blas_to_one_thread()
    if (allocated(solver%factors)) deallocate (solver%factors)
    if (allocated(solver%borders)) deallocate (solver%borders)
    if (allocated(solver%sent)) deallocate (solver%sent)
    call lay_out_fronts(pattern, position, solver%layout)
    allocate (solver%sent(size(solver%layout%index)))
    ! one more than is used: where the empty border of a last front begins
    allocate (solver%factors(solver%layout%factor_length + 1), stat=status)
    if (status == 0) allocate (solver%borders(solver%layout%border_length + 1), stat=status)
    if (status /= 0) then
      call fail(error, exit_machine, 'not enough memory for the factors of the matrix ('// &
                to_text(nint(bytes*real(solver%layout%factor_length + solver%layout%border_length, wp)/2.0_wp**20))//' MB)', &
                'use a coarser mesh or a machine with more memory')
    end if
  end subroutine plan

  !> Factorise; `regular` is false when a pivot is zero or NaN.
  subroutine decompose(solver, values, regular)
    type(multifrontal_t), intent(inout) :: solver
    real(wp), intent(in) :: values(:)   !! (nnz) [residual/unknown]
    logical, intent(out) :: regular
    logical :: sound(solver%layout%nfront)
    integer :: negative(solver%layout%nfront)

    negative = 0
    !$omp parallel if (any(solver%layout%shared)) default(shared)
    !$omp single
    call decompose_below(solver%layout, values, 0, solver%factors, solver%borders, sound, negative)
    !$omp end single
    !$omp end parallel
    regular = all(sound)
    solver%negative = sum(negative)
  end subroutine decompose

  !> Children of front f, then the front itself.
  recursive subroutine decompose_below(layout, values, f, factors, borders, sound, negative)
    type(front_layout_t), intent(in) :: layout
    real(wp), intent(in) :: values(:)
    integer, intent(in) :: f
    real(rk), intent(inout) :: factors(layout%factor_length + 1), borders(layout%border_length + 1)
    logical, intent(inout) :: sound(:)
    integer, intent(inout) :: negative(:)
    integer :: k, c, s

    do k = layout%child_first(f), layout%child_first(f + 1) - 1
      !$omp task default(shared) firstprivate(k) private(c, s) if (k < layout%child_first(f + 1) - 1)
      c = layout%child(k)
      if (layout%shared(c)) then
        call decompose_below(layout, values, c, factors, borders, sound, negative)
      else
        do s = layout%subtree(c), c
          call decompose_front(layout, values, s, factors, borders, sound, negative)
        end do
      end if
      !$omp end task
    end do
    !$omp taskwait
    if (f > 0) call decompose_front(layout, values, f, factors, borders, sound, negative)
  end subroutine decompose_below

  !> Assemble a front and eliminate its pivots.
  subroutine decompose_front(layout, values, f, factors, borders, sound, negative)
    type(front_layout_t), intent(in) :: layout
    real(wp), intent(in) :: values(:)
    integer, intent(in) :: f
    real(rk), intent(inout) :: factors(layout%factor_length + 1), borders(layout%border_length + 1)
    logical, intent(inout) :: sound(:)
    integer, intent(inout) :: negative(:)
    integer :: k, c, p, n

    p = layout%first(f + 1) - layout%first(f)
    n = layout%order(f)
    sound(f) = .true.
    associate (pivot => layout%factor_start(f), row => layout%factor_start(f) + int(p, kind(layout%factor_start))*n, &
               border => layout%border_start(f))
      factors(pivot:pivot + int(p, kind(pivot))*(2*n - p) - 1) = 0
      do k = layout%entry(f), layout%entry(f + 1) - 1
        factors(pivot + layout%target(k) - 1) = factors(pivot + layout%target(k) - 1) + real(values(layout%source(k)), rk)
      end do
      do k = layout%child_first(f), layout%child_first(f + 1) - 1
        c = layout%child(k)
        sound(f) = sound(f) .and. sound(c)
        if (layout%border(c + 1) == layout%border(c)) cycle
        call add_to_pivots(layout%border(c + 1) - layout%border(c), layout%to_parent(layout%border(c)), &
                           borders(layout%border_start(c)), p, n, factors(pivot), factors(row))
      end do
      if (.not. sound(f)) return
      if (layout%shared(f)) then
        call eliminate_shared(p, n, factors(pivot), factors(row), borders(border), sound(f), negative(f))
      else
        call eliminate(p, n, factors(pivot), factors(row), borders(border), sound(f), negative(f))
      end if
      if (n == p) return
      do k = layout%child_first(f), layout%child_first(f + 1) - 1
        c = layout%child(k)
        if (layout%border(c + 1) == layout%border(c)) cycle
        call add_to_border(layout%border(c + 1) - layout%border(c), layout%to_parent(layout%border(c)), &
                           borders(layout%border_start(c)), p, n, borders(border))
      end do
    end associate
  end subroutine decompose_front

  !> Add the border of a child to the pivot columns and rows of a front, whose rows `to` it goes to.
  pure subroutine add_to_pivots(m, to, child, p, n, pivot, row)
    integer, intent(in) :: m, to(m), p, n
    real(rk), intent(in) :: child(m, m)
    real(rk), intent(inout) :: pivot(n, p), row(p, n - p)
    integer :: i, j, inside

    inside = count(to <= p)
    do j = 1, inside
      do i = 1, m
        pivot(to(i), to(j)) = pivot(to(i), to(j)) + child(i, j)
      end do
    end do
    do j = inside + 1, m
      do i = 1, inside
        row(to(i), to(j) - p) = row(to(i), to(j) - p) + child(i, j)
      end do
    end do
  end subroutine add_to_pivots

  !> Add the rest of the border of a child to the border of the front, which the elimination has begun.
  pure subroutine add_to_border(m, to, child, p, n, border)
    integer, intent(in) :: m, to(m), p, n
    real(rk), intent(in) :: child(m, m)
    real(rk), intent(inout) :: border(n - p, n - p)
    integer :: i, j, inside

    inside = count(to <= p)
    do j = inside + 1, m
      do i = inside + 1, m
        border(to(i) - p, to(j) - p) = border(to(i) - p, to(j) - p) + child(i, j)
      end do
    end do
  end subroutine add_to_border

  !> x := A^-1 x.
  subroutine substitute(solver, x)
    type(multifrontal_t), intent(inout) :: solver
    real(wp), intent(inout) :: x(:)   !! (neq) [residual] in, [unknown] out
    real(rk) :: y(size(x))
    real(wp) :: unit

    ! by a power of two, which leaves the bits: of single precision, numbers far from 1 are none
    unit = scale(1.0_wp, exponent(maxval(abs(x))))
    y(solver%layout%place) = real(x/unit, rk)
    !$omp parallel if (any(solver%layout%shared)) default(shared)
    !$omp single
    call forward_below(solver%layout, 0, solver%factors, y, solver%sent)
    call backward_below(solver%layout, 0, solver%factors, y)
    !$omp end single
    !$omp end parallel
    x = unit*y(solver%layout%place)
  end subroutine substitute

  !> Forward substitution: children of front f, then the front itself.
  recursive subroutine forward_below(layout, f, factors, y, sent)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: f
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    real(rk), intent(inout) :: y(:), sent(:)
    integer :: k, c, s

    do k = layout%child_first(f), layout%child_first(f + 1) - 1
      !$omp task default(shared) firstprivate(k) private(c, s) if (k < layout%child_first(f + 1) - 1)
      c = layout%child(k)
      if (layout%shared(c)) then
        call forward_below(layout, c, factors, y, sent)
      else
        do s = layout%subtree(c), c
          call forward(layout, s, factors, y, sent)
        end do
      end if
      !$omp end task
    end do
    !$omp taskwait
    if (f > 0) call forward(layout, f, factors, y, sent)
  end subroutine forward_below

  subroutine forward(layout, f, factors, y, sent)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: f
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    real(rk), intent(inout) :: y(:), sent(:)
    real(rk) :: z(layout%max_order), before(block)
    integer(i8) :: at
    integer :: k, c, i, p, n, w

    p = layout%first(f + 1) - layout%first(f)
    n = layout%order(f)
    z(:p) = y(layout%first(f):layout%first(f + 1) - 1)
    z(p + 1:n) = 0
    do k = layout%child_first(f), layout%child_first(f + 1) - 1
      c = layout%child(k)
      do i = layout%border(c), layout%border(c + 1) - 1
        z(layout%to_parent(i)) = z(layout%to_parent(i)) + sent(i)
      end do
    end do
    do k = 1, p, block
      w = min(block, p - k + 1)
      before(:w) = z(k:k + w - 1)
      at = layout%factor_start(f) + (k - 1) + int(k - 1, i8)*n
      call gemv('N', w, w, 1.0_rk, factors(at), n, before, 1, 0.0_rk, z(k), 1)
      if (k + w <= n) call gemv('N', n - k - w + 1, w, -1.0_rk, factors(at + w), n, z(k), 1, 1.0_rk, z(k + w), 1)
    end do
    y(layout%first(f):layout%first(f + 1) - 1) = z(:p)
    sent(layout%border(f):layout%border(f + 1) - 1) = z(p + 1:n)
  end subroutine forward

  !> Backward substitution: front f, then its children.
  recursive subroutine backward_below(layout, f, factors, y)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: f
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    real(rk), intent(inout) :: y(:)
    integer :: k, c, s

    if (f > 0) call backward(layout, f, factors, y)
    do k = layout%child_first(f), layout%child_first(f + 1) - 1
      !$omp task default(shared) firstprivate(k) private(c, s) if (k < layout%child_first(f + 1) - 1)
      c = layout%child(k)
      if (layout%shared(c)) then
        call backward_below(layout, c, factors, y)
      else
        do s = c, layout%subtree(c), -1
          call backward(layout, s, factors, y)
        end do
      end if
      !$omp end task
    end do
    !$omp taskwait
  end subroutine backward_below

  subroutine backward(layout, f, factors, y)
    type(front_layout_t), intent(in) :: layout
    integer, intent(in) :: f
    real(rk), intent(in) :: factors(layout%factor_length + 1)
    real(rk), intent(inout) :: y(:)
    real(rk) :: z(layout%max_order)
    integer(i8) :: at
    integer :: p, n, k

    p = layout%first(f + 1) - layout%first(f)
    n = layout%order(f)
    z(:p) = y(layout%first(f):layout%first(f + 1) - 1)
    z(p + 1:n) = y(layout%index(layout%border(f):layout%border(f + 1) - 1))
    at = layout%factor_start(f) + int(p, i8)*n
    if (n > p) call gemv('N', p, n - p, -1.0_rk, factors(at), p, z(p + 1), 1, 1.0_rk, z, 1)
    do k = 1 + block*((p - 1)/block) - block, 1, -block
      ! rows of a block, by the pivots of those after it
      at = layout%factor_start(f) + (k - 1) + int(k + block - 1, i8)*n
      call gemv('N', block, p - k - block + 1, -1.0_rk, factors(at), n, z(k + block), 1, 1.0_rk, z(k), 1)
    end do
    y(layout%first(f):layout%first(f + 1) - 1) = z(:p)
  end subroutine backward

end module multifrontal
