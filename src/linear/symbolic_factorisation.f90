!> Symbolic factorisation: from the pattern of a matrix and an order of elimination to the layout of its fronts.
module symbolic_factorisation
  use elimination_tree, only: find_fronts, list_neighbours
  use front_layout, only: front_layout_t
  use front_storage, only: place_stores, split_tree
  use matrix_pattern, only: matrix_pattern_t
  implicit none
  private
  public :: lay_out_fronts

contains

  !> Fronts of a matrix, and where its nonzeros, their factors and borders go.
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

end module symbolic_factorisation
