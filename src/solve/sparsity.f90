!> Pattern of the assembled matrix, and the map from element matrices to it.
!>
!> Rows are sorted by column. For every nonzero the entries of the element matrices that it sums are listed, in
!> a fixed order: gathering (not scattering) makes the sum the same for any number of threads.
module sparsity
  use dofs, only: dofs_t
  use kinds, only: wp
  use matrix_pattern, only: matrix_pattern_t
  implicit none
  private
  public :: pattern_t, build_pattern, entries_of

  type, extends(matrix_pattern_t) :: pattern_t
    !> Entries of the element matrices summed by nonzero k: entry(first(k):first(k+1)-1).
    integer, allocatable :: first(:), entry(:)
    !> Entries of the element forces summed by unknown d: force_entry(force_first(d):force_first(d+1)-1).
    integer, allocatable :: force_first(:), force_entry(:)
    !> Where the matrices and the forces of each group begin in the flat arrays, and their total lengths.
    integer, allocatable :: matrix_start(:), force_start(:)
    integer :: matrix_length = 0, force_length = 0
  end type pattern_t

contains

  !> Build pattern and maps from the unknowns of the elements of all active groups.
  subroutine build_pattern(dofs, neq, equation, active, symmetric, pattern)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: neq
    integer, intent(in) :: equation(:)   !! of each unknown, 0 where there is none (ndof)
    logical, intent(in) :: active(:)     !! (ngroup)
    logical, intent(in) :: symmetric
    type(pattern_t), intent(out) :: pattern
    integer, allocatable :: row(:), column(:), entry(:), order(:)
    integer :: g, k, n

    pattern%neq = neq
    pattern%symmetric = symmetric
    allocate (pattern%matrix_start(size(dofs%groups)), pattern%force_start(size(dofs%groups)))
    do g = 1, size(dofs%groups)
      pattern%matrix_start(g) = pattern%matrix_length
      pattern%force_start(g) = pattern%force_length
      pattern%matrix_length = pattern%matrix_length + size(dofs%groups(g)%dof)*size(dofs%groups(g)%dof, 1)
      pattern%force_length = pattern%force_length + size(dofs%groups(g)%dof)
    end do

    call list_entries(dofs, equation, active, pattern, row, column, entry)
    ! sorted by row, then column, then element: stable counting sorts, least significant first
    order = [(k, k=1, size(row))]
    call sort_by(column, neq, order)
    call sort_by(row, neq, order)
    pattern%entry = entry(order)
    allocate (pattern%row(size(order)), pattern%column(size(order)), pattern%first(size(order) + 1))
    n = 0
    do k = 1, size(order)
      if (n > 0) then
        if (row(order(k)) == pattern%row(n) .and. column(order(k)) == pattern%column(n)) cycle
      end if
      n = n + 1
      pattern%row(n) = row(order(k))
      pattern%column(n) = column(order(k))
      pattern%first(n) = k
    end do
    pattern%first(n + 1) = size(order) + 1
    pattern%nnz = n
    pattern%row = pattern%row(:n)
    pattern%column = pattern%column(:n)
    pattern%first = pattern%first(:n + 1)
    call map_forces(dofs, active, pattern)
  end subroutine build_pattern

  !> How many entries all element matrices have, more than an integer holds perhaps.
  pure function entries_of(dofs) result(n)
    type(dofs_t), intent(in) :: dofs
    real(wp) :: n
    integer :: g

    n = 0
    do g = 1, size(dofs%groups)
      n = n + real(size(dofs%groups(g)%dof), wp)*size(dofs%groups(g)%dof, 1)
    end do
  end function entries_of

  !> Row, column and place of every entry of every element matrix between free unknowns.
  subroutine list_entries(dofs, equation, active, pattern, row, column, entry)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: equation(:)
    logical, intent(in) :: active(:)
    type(pattern_t), intent(in) :: pattern
    integer, allocatable, intent(out) :: row(:), column(:), entry(:)
    integer :: g, e, i, j, r, c, n, place

    allocate (row(pattern%matrix_length), column(pattern%matrix_length), entry(pattern%matrix_length))
    n = 0
    do g = 1, size(dofs%groups)
      if (.not. active(g)) cycle
      place = pattern%matrix_start(g)
      associate (dof => dofs%groups(g)%dof)
        do e = 1, size(dof, 2)
          do j = 1, size(dof, 1)
            c = equation(dof(j, e))
            do i = 1, size(dof, 1)
              place = place + 1
              r = equation(dof(i, e))
              if (r == 0 .or. c == 0) cycle
              if (pattern%symmetric .and. r < c) cycle
              n = n + 1
              row(n) = r
              column(n) = c
              entry(n) = place
            end do
          end do
        end do
      end associate
    end do
    row = row(:n)
    column = column(:n)
    entry = entry(:n)
  end subroutine list_entries

  !> Stable counting sort of `order` by key(order), keys in 1 ... nkey.
  subroutine sort_by(key, nkey, order)
    integer, intent(in) :: key(:), nkey
    integer, intent(inout) :: order(:)
    integer, allocatable :: start(:), sorted(:)
    integer :: k, j

    allocate (start(nkey + 1), source=0)
    allocate (sorted(size(order)))
    do k = 1, size(order)
      start(key(order(k)) + 1) = start(key(order(k)) + 1) + 1
    end do
    do k = 1, nkey
      start(k + 1) = start(k + 1) + start(k)
    end do
    do k = 1, size(order)
      j = key(order(k))
      start(j) = start(j) + 1
      sorted(start(j)) = order(k)
    end do
    order = sorted
  end subroutine sort_by

  !> For every unknown, the entries of element forces that act on it.
  subroutine map_forces(dofs, active, pattern)
    type(dofs_t), intent(in) :: dofs
    logical, intent(in) :: active(:)
    type(pattern_t), intent(inout) :: pattern
    integer, allocatable :: key(:)
    integer :: g, e, k, n

    allocate (key(pattern%force_length), pattern%force_entry(pattern%force_length))
    n = 0
    do g = 1, size(dofs%groups)
      if (.not. active(g)) cycle
      associate (dof => dofs%groups(g)%dof)
        do e = 1, size(dof, 2)
          k = pattern%force_start(g) + (e - 1)*size(dof, 1)
          key(k + 1:k + size(dof, 1)) = dof(:, e)
        end do
        pattern%force_entry(n + 1:n + size(dof)) = [(pattern%force_start(g) + k, k=1, size(dof))]
        n = n + size(dof)
      end associate
    end do
    pattern%force_entry = pattern%force_entry(:n)
    allocate (pattern%force_first(dofs%ndof + 1), source=0)
    do k = 1, n
      associate (d => key(pattern%force_entry(k)))
        pattern%force_first(d + 1) = pattern%force_first(d + 1) + 1
      end associate
    end do
    call sort_by(key, dofs%ndof, pattern%force_entry)
    pattern%force_first(1) = 1
    do k = 1, dofs%ndof
      pattern%force_first(k + 1) = pattern%force_first(k + 1) + pattern%force_first(k)
    end do
  end subroutine map_forces

end module sparsity
