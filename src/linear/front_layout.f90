!> Memory layout of a multifrontal factorisation: fronts, their factors, the matrices that children send to parents.
!>
!> A front of order n with p pivots is kept as its pivot columns (n, p) and the rest of its pivot rows (p, n-p), one after the
!> other: its factors. The rest (n-p, n-p), the border, is sent to the parent and discarded. Fronts are shared out to
!> threads by subtrees; how the tree is split depends on the tree alone, so that results do not depend on the threads.
module front_layout
  use elimination_tree, only: find_fronts, list_neighbours
  use kinds, only: i8, wp
  use matrix_pattern, only: matrix_pattern_t
  implicit none
  private
  public :: front_layout_t, lay_out_fronts

  type :: front_layout_t
    integer :: neq = 0, nfront = 0
    !> Place of every equation in the order of elimination (neq).
    integer, allocatable :: place(:)
    !> Pivots of front f are first(f) ... first(f+1)-1; its order; the longest.
    integer, allocatable :: first(:), order(:)
    integer :: max_order = 0
    !> Children of front f, child(child_first(f):child_first(f+1)-1); those of 0 are the roots.
    integer, allocatable :: child_first(:), child(:)
    !> Parent of every front, 0 for a root; front of every pivot (neq).
    integer, allocatable :: parent(:), front_of(:)
    !> Places of the rows of its border, and their rows in its parent: index(border(f):border(f+1)-1), to_parent the same.
    integer, allocatable :: border(:), index(:), to_parent(:)
    !> Nonzeros of the matrix that enter front f, and where in its factors: source, target(entry(f):entry(f+1)-1).
    integer, allocatable :: entry(:), source(:), target(:)
    !> Where its factors begin, and the matrix of its border; lengths of both stores.
    integer(i8), allocatable :: factor_start(:), border_start(:)
    integer(i8) :: factor_length = 0, border_length = 0
    !> Fronts so high in the tree that threads share each of them; the first front of the subtree of every front.
    logical, allocatable :: shared(:)
    integer, allocatable :: subtree(:)
    !> Operations of a factorisation.
    real(wp) :: flops = 0.0_wp
  end type front_layout_t

  !> Subtrees with less than this share of all operations are done by one thread.
  real(wp), parameter :: subtree_share = 1.0_wp/32
  !> Fewer operations than these are faster on one thread.
  real(wp), parameter :: worth_sharing = 4.0e6_wp

contains

  subroutine lay_out_fronts(pattern, position, layout)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)   !! order of elimination asked for (neq)
    type(front_layout_t), intent(out) :: layout

    call find_fronts(pattern, position, layout%place, layout%first, layout%order, layout%parent)
    layout%neq = pattern%neq
    layout%nfront = size(layout%parent)
    layout%max_order = maxval(layout%order)
    call list_children(layout)
    call list_borders(pattern, layout)
    call map_entries(pattern, layout)
    call split_tree(layout)
    call place_stores(layout)
  end subroutine lay_out_fronts

  pure subroutine list_children(layout)
    type(front_layout_t), intent(inout) :: layout
    integer, allocatable :: next(:)
    integer :: f

    allocate (layout%child_first(0:layout%nfront + 1), source=0)
    do f = 1, layout%nfront
      associate (next_parent => layout%parent(f) + 1)
        layout%child_first(next_parent) = layout%child_first(next_parent) + 1
      end associate
    end do
    layout%child_first(0) = 1
    do f = 1, layout%nfront + 1
      layout%child_first(f) = layout%child_first(f) + layout%child_first(f - 1)
    end do
    allocate (layout%child(layout%nfront), next(0:layout%nfront))
    next = layout%child_first(:layout%nfront)
    do f = 1, layout%nfront
      associate (parent => layout%parent(f))
        layout%child(next(parent)) = f
        next(parent) = next(parent) + 1
      end associate
    end do
  end subroutine list_children

  !> Rows of every border, sorted: neighbours of its pivots and rows of its children's borders that are not pivots.
  subroutine list_borders(pattern, layout)
    class(matrix_pattern_t), intent(in) :: pattern
    type(front_layout_t), intent(inout) :: layout
    integer, allocatable :: start(:), upper(:), mark(:), owner(:), row(:), by_row(:), next(:)
    integer :: f, k, c, j, n

    associate (first => layout%first)
      call list_neighbours(pattern, layout%place, .true., start, upper)
      allocate (layout%border(layout%nfront + 1), mark(layout%neq))
      do f = 1, layout%nfront
        mark(f) = layout%order(f) - (first(f + 1) - first(f))
      end do
      allocate (row(sum(mark(:layout%nfront))), owner(sum(mark(:layout%nfront))))
      mark = 0
      n = 0
      do f = 1, layout%nfront
        layout%border(f) = n + 1
        mark(first(f):first(f + 1) - 1) = f
        do k = start(first(f)), start(first(f + 1)) - 1
          call add(upper(k))
        end do
        do j = layout%child_first(f), layout%child_first(f + 1) - 1
          c = layout%child(j)
          do k = layout%border(c), layout%border(c + 1) - 1
            call add(row(k))
          end do
        end do
        layout%border(f + 1) = n + 1
      end do
    end associate

    ! sorted by counting: all borders by row, then row by row back into their fronts
    allocate (next(layout%neq + 1), source=0)
    do k = 1, n
      next(row(k) + 1) = next(row(k) + 1) + 1
    end do
    next(1) = 1
    do k = 2, layout%neq + 1
      next(k) = next(k) + next(k - 1)
    end do
    allocate (by_row(n))
    do k = 1, n
      by_row(next(row(k))) = k
      next(row(k)) = next(row(k)) + 1
    end do
    allocate (layout%index(n))
    next(:layout%nfront) = layout%border(:layout%nfront)
    do k = 1, n
      f = owner(by_row(k))
      layout%index(next(f)) = row(by_row(k))
      next(f) = next(f) + 1
    end do

  contains

    subroutine add(i)
      integer, intent(in) :: i

      if (mark(i) == f) return
      mark(i) = f
      n = n + 1
      row(n) = i
      owner(n) = f
    end subroutine add

  end subroutine list_borders

  !> Where nonzeros of the matrix and borders of children go in every front.
  subroutine map_entries(pattern, layout)
    class(matrix_pattern_t), intent(in) :: pattern
    type(front_layout_t), intent(inout) :: layout
    integer, allocatable :: local(:), next(:)
    integer :: f, k, c, j, p, n, pass, a, b

    allocate (layout%front_of(layout%neq), local(layout%neq), layout%to_parent(size(layout%index)))
    do f = 1, layout%nfront
      layout%front_of(layout%first(f):layout%first(f + 1) - 1) = f
    end do
    allocate (layout%entry(layout%nfront + 1), source=0)
    do pass = 1, 2
      do k = 1, pattern%nnz
        a = layout%place(pattern%row(k))
        b = layout%place(pattern%column(k))
        f = layout%front_of(min(a, b))
        call note(a, b)
        if (pattern%symmetric .and. a /= b) call note(b, a)
      end do
      if (pass == 2) exit
      layout%entry(1) = 1
      do f = 1, layout%nfront
        layout%entry(f + 1) = layout%entry(f + 1) + layout%entry(f)
      end do
      next = layout%entry(:layout%nfront)
      allocate (layout%source(layout%entry(layout%nfront + 1) - 1), layout%target(layout%entry(layout%nfront + 1) - 1))
    end do

    do f = 1, layout%nfront
      p = layout%first(f + 1) - layout%first(f)
      n = layout%order(f)
      local(layout%first(f):layout%first(f + 1) - 1) = [(k, k=1, p)]
      local(layout%index(layout%border(f):layout%border(f + 1) - 1)) = [(k, k=p + 1, n)]
      do j = layout%child_first(f), layout%child_first(f + 1) - 1
        c = layout%child(j)
        do k = layout%border(c), layout%border(c + 1) - 1
          layout%to_parent(k) = local(layout%index(k))
        end do
      end do
      do k = layout%entry(f), layout%entry(f + 1) - 1
        call place_of(k)
      end do
    end do

  contains

    subroutine note(i, j)
      integer, intent(in) :: i, j

      if (pass == 1) then
        layout%entry(f + 1) = layout%entry(f + 1) + 1
        return
      end if
      ! a nonzero below the diagonal, or the mirror of one above: its sign states which
      layout%source(next(f)) = k
      layout%target(next(f)) = merge(1, -1, i == layout%place(pattern%row(k)))
      next(f) = next(f) + 1
    end subroutine note

    subroutine place_of(k)
      integer, intent(in) :: k
      integer :: r, s, other

      r = local(layout%place(pattern%row(layout%source(k))))
      s = local(layout%place(pattern%column(layout%source(k))))
      if (layout%target(k) < 0) then
        other = r
        r = s
        s = other
      end if
      if (s <= p) then
        layout%target(k) = (s - 1)*n + r
      else
        layout%target(k) = p*n + (s - p - 1)*p + r
      end if
    end subroutine place_of

  end subroutine map_entries

  !> Operations of all subtrees, and which are left to one thread.
  pure subroutine split_tree(layout)
    type(front_layout_t), intent(inout) :: layout
    real(wp), allocatable :: work(:)
    real(wp) :: p, n
    integer :: f

    allocate (work(0:layout%nfront), source=0.0_wp)
    layout%subtree = [(f, f=1, layout%nfront)]
    do f = 1, layout%nfront
      p = layout%first(f + 1) - layout%first(f)
      n = layout%order(f)
      ! LU of the pivots, both triangular solves, product
      work(f) = work(f) + 2*p**3/3 + 2*p**2*(n - p) + 2*p*(n - p)**2
      associate (parent => layout%parent(f))
        work(parent) = work(parent) + work(f)
        if (parent > 0) layout%subtree(parent) = min(layout%subtree(parent), layout%subtree(f))
      end associate
    end do
    layout%flops = work(0)
    layout%shared = work(1:) > max(subtree_share*work(0), worth_sharing)
  end subroutine split_tree

  !> Factors follow each other. Borders are stacked, one stack for even and one for odd depths: a front takes those of its
  !> children off one and puts its own on the other. Every subtree has its stacks; shared fronts have theirs alone.
  pure subroutine place_stores(layout)
    type(front_layout_t), intent(inout) :: layout
    integer, allocatable :: depth(:)
    integer(i8) :: top(0:1), peak(0:1)
    integer :: f, s, p, c, k

    allocate (depth(0:layout%nfront), source=0)
    do f = layout%nfront, 1, -1
      depth(f) = depth(layout%parent(f)) + 1
    end do
    allocate (layout%factor_start(layout%nfront), layout%border_start(layout%nfront))
    do f = 1, layout%nfront
      p = layout%first(f + 1) - layout%first(f)
      layout%factor_start(f) = layout%factor_length + 1
      layout%factor_length = layout%factor_length + int(p, i8)*(2*layout%order(f) - p)
    end do
    layout%border_length = 0
    do f = 1, layout%nfront
      if (layout%shared(f)) then
        layout%border_start(f) = layout%border_length + 1
        layout%border_length = layout%border_length + border_size(f)
        cycle
      end if
      if (layout%parent(f) > 0) then
        if (.not. layout%shared(layout%parent(f))) cycle
      end if
      top = 0
      peak = 0
      do s = layout%subtree(f), f
        p = mod(depth(s), 2)
        do k = layout%child_first(s), layout%child_first(s + 1) - 1
          c = layout%child(k)
          top(1 - p) = top(1 - p) - border_size(c)
        end do
        layout%border_start(s) = top(p) + 1
        top(p) = top(p) + border_size(s)
        peak(p) = max(peak(p), top(p))
      end do
      do s = layout%subtree(f), f
        layout%border_start(s) = layout%border_start(s) + layout%border_length
        if (mod(depth(s), 2) == 1) layout%border_start(s) = layout%border_start(s) + peak(0)
      end do
      layout%border_length = layout%border_length + sum(peak)
    end do

  contains

    pure function border_size(f) result(n)
      integer, intent(in) :: f
      integer(i8) :: n

      n = int(layout%border(f + 1) - layout%border(f), i8)**2
    end function border_size

  end subroutine place_stores

end module front_layout
