!> Which unknowns are eliminated together: the fronts of a sparse factorisation and their tree.
!>
!> From the order of elimination follow the elimination tree and the fill (J.W.H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990)
!> 134-172). Columns of one structure make a front; fronts are merged with their parents while few zeros are stored for it
!> (C. Ashcraft, R. Grimes, ACM Trans. Math. Softw. 15 (1989) 291-309).
module elimination_tree
  use kinds, only: wp
  use matrix_pattern, only: matrix_pattern_t
  implicit none
  private
  public :: find_fronts, list_neighbours

  !> Share of stored zeros up to which fronts with so many pivots are merged.
  integer, parameter :: merge_pivots(3) = [8, 24, 64]
  real(wp), parameter :: merge_zeros(4) = [0.4_wp, 0.2_wp, 0.1_wp, 0.02_wp]

contains

  !> Fronts in postorder: front f eliminates the unknowns at positions first(f) ... first(f+1)-1, has `order(f)` rows and sends
  !> what is left to parent(f), 0 for a root. `place` keeps the fill of `position`.
  subroutine find_fronts(pattern, position, place, first, order, parent)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: position(:)                         !! (neq) of each unknown in the order of elimination
    integer, allocatable, intent(out) :: place(:)              !! (neq) the same in the order of the fronts
    integer, allocatable, intent(out) :: first(:)              !! (nfront + 1)
    integer, allocatable, intent(out) :: order(:), parent(:)   !! (nfront)
    integer, allocatable :: start(:), lower(:), up(:), renumbered(:), count(:)
    integer, allocatable :: column_first(:), pivots(:), into(:), new(:)
    integer :: j, s, n, nsuper, nfront

    call list_neighbours(pattern, position, .false., start, lower)
    call grow_tree(start, lower, up)
    call postorder(up, renumbered)
    place = renumbered(position)
    call list_neighbours(pattern, place, .false., start, lower)
    call grow_tree(start, lower, up)
    call count_columns(start, lower, up, count)

    ! columns of one structure
    n = pattern%neq
    allocate (column_first(n + 1), order(n), parent(n), new(n))
    nsuper = 0
    do j = 1, n
      if (j > 1) then
        if (up(j - 1) == j .and. count(j - 1) == count(j) + 1) then
          new(j) = nsuper
          cycle
        end if
      end if
      nsuper = nsuper + 1
      column_first(nsuper) = j
      order(nsuper) = count(j)
      new(j) = nsuper
    end do
    column_first(nsuper + 1) = n + 1
    do s = 1, nsuper
      parent(s) = up(column_first(s + 1) - 1)
      if (parent(s) > 0) parent(s) = new(parent(s))
    end do
    allocate (pivots, source=column_first(2:nsuper + 1) - column_first(:nsuper))
    call merge_fronts(parent(:nsuper), pivots, order(:nsuper), into)

    call renumber(nsuper, column_first, into, new, first)
    place = new(place)
    ! what is left of the lists of fronts, in the same order
    nfront = 0
    do s = 1, nsuper
      if (into(s) /= s) cycle
      nfront = nfront + 1
      order(nfront) = order(s)
      if (parent(s) > 0) parent(s) = root_of(into, parent(s))
      parent(nfront) = parent(s)
      new(s) = nfront
    end do
    order = order(:nfront)
    parent = parent(:nfront)
    where (parent > 0) parent = new(max(parent, 1))
  end subroutine find_fronts

  !> Neighbours of every unknown in the order given: those before it, or those after it.
  subroutine list_neighbours(pattern, place, after, start, list)
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: place(:)   !! (neq) position of each unknown in the order
    logical, intent(in) :: after
    integer, allocatable, intent(out) :: start(:)   !! (neq + 2) entries start(k) ... start(k + 1) - 1 of the list are those of k
    integer, allocatable, intent(out) :: list(:)    !! (nneighbour)
    integer :: k, i, j, pass

    allocate (start(pattern%neq + 2), source=0)
    do pass = 1, 2
      do k = 1, pattern%nnz
        i = max(place(pattern%row(k)), place(pattern%column(k)))
        j = min(place(pattern%row(k)), place(pattern%column(k)))
        if (i == j) cycle
        if (after) then
          call note(j, i)
        else
          call note(i, j)
        end if
      end do
      if (pass == 2) exit
      start(1:2) = 1
      do k = 2, pattern%neq + 1
        start(k + 1) = start(k + 1) + start(k)
      end do
      allocate (list(start(pattern%neq + 2) - 1))
    end do

  contains

    subroutine note(owner, other)
      integer, intent(in) :: owner, other

      if (pass == 1) then
        start(owner + 2) = start(owner + 2) + 1
      else
        list(start(owner + 1)) = other
        start(owner + 1) = start(owner + 1) + 1
      end if
    end subroutine note

  end subroutine list_neighbours

  !> Parent of every column in the elimination tree, 0 for a root; paths are shortened as they are followed.
  pure subroutine grow_tree(start, lower, up)
    integer, intent(in) :: start(:), lower(:)
    integer, allocatable, intent(out) :: up(:)
    integer, allocatable :: ancestor(:)
    integer :: i, k, j, next

    allocate (up(size(start) - 2), source=0)
    allocate (ancestor, source=up)
    do i = 1, size(up)
      do k = start(i), start(i + 1) - 1
        j = lower(k)
        do while (j > 0 .and. j < i)
          next = ancestor(j)
          ancestor(j) = i
          if (next == 0) up(j) = i
          j = next
        end do
      end do
    end do
  end subroutine grow_tree

  !> renumbered(j): position of column j when every subtree is numbered without gaps.
  pure subroutine postorder(up, renumbered)
    integer, intent(in) :: up(:)
    integer, allocatable, intent(out) :: renumbered(:)
    integer, allocatable :: weight(:), next(:)
    integer :: j, n

    n = size(up)
    allocate (weight(n), source=1)
    do j = 1, n
      if (up(j) > 0) weight(up(j)) = weight(up(j)) + weight(j)
    end do
    ! a subtree ends where its root stands: roots are placed from the last one down
    allocate (renumbered(n), next(0:n))
    next(0) = n
    do j = n, 1, -1
      renumbered(j) = next(up(j))
      next(up(j)) = renumbered(j) - weight(j)
      next(j) = renumbered(j) - 1
    end do
  end subroutine postorder

  !> Entries of every column of the factor, the diagonal included.
  pure subroutine count_columns(start, lower, up, count)
    integer, intent(in) :: start(:), lower(:), up(:)
    integer, allocatable, intent(out) :: count(:)
    integer, allocatable :: seen(:)
    integer :: i, k, j

    allocate (count(size(up)), source=1)
    allocate (seen(size(up)), source=0)
    do i = 1, size(up)
      seen(i) = i
      do k = start(i), start(i + 1) - 1
        j = lower(k)
        do while (seen(j) /= i)
          seen(j) = i
          count(j) = count(j) + 1
          j = up(j)
        end do
      end do
    end do
  end subroutine count_columns

  !> Merge fronts into their parents: `into` points to the front that took one over, to itself where none did.
  pure subroutine merge_fronts(parent, pivots, order, into)
    integer, intent(in) :: parent(:)
    integer, intent(inout) :: pivots(:), order(:)
    integer, allocatable, intent(out) :: into(:)
    real(wp), allocatable :: zeros(:)
    integer, allocatable :: child(:), sibling(:)
    integer :: s, c, both
    real(wp) :: z

    allocate (child(size(parent)), sibling(size(parent)), source=0)
    allocate (zeros(size(parent)), source=0.0_wp)
    into = [(s, s=1, size(parent))]
    do s = size(parent), 1, -1
      if (parent(s) == 0) cycle
      sibling(s) = child(parent(s))
      child(parent(s)) = s
    end do
    do s = 1, size(parent)
      c = child(s)
      do while (c > 0)
        both = pivots(c) + pivots(s)
        z = zeros(c) + zeros(s) + real(pivots(c), wp)*(pivots(c) + order(s) - order(c))
        if (z <= merge_zeros(1 + count(both > merge_pivots))*both*(pivots(c) + order(s))) then
          zeros(s) = z
          order(s) = pivots(c) + order(s)
          pivots(s) = both
          into(c) = s
        end if
        c = sibling(c)
      end do
    end do
  end subroutine merge_fronts

  !> The front that holds `s` now.
  pure function root_of(into, s) result(root)
    integer, intent(in) :: into(:), s
    integer :: root

    root = s
    do while (into(root) /= root)
      root = into(root)
    end do
  end function root_of

  !> New positions of the columns, merged fronts together, and the first position of every front.
  pure subroutine renumber(nsuper, column_first, into, new, first)
    integer, intent(in) :: nsuper, column_first(:), into(:)
    integer, intent(out) :: new(:)
    integer, allocatable, intent(out) :: first(:)
    integer, allocatable :: next(:)
    integer :: s, r, j, nfront

    allocate (next(nsuper), source=0)
    do s = 1, nsuper
      r = root_of(into, s)
      next(r) = next(r) + column_first(s + 1) - column_first(s)
    end do
    allocate (first(nsuper + 1))
    nfront = 0
    first(1) = 1
    do s = 1, nsuper
      if (into(s) /= s) cycle
      nfront = nfront + 1
      first(nfront + 1) = first(nfront) + next(s)
      next(s) = first(nfront)
    end do
    first = first(:nfront + 1)
    do s = 1, nsuper
      r = root_of(into, s)
      do j = column_first(s), column_first(s + 1) - 1
        new(j) = next(r)
        next(r) = next(r) + 1
      end do
    end do
  end subroutine renumber

end module elimination_tree
