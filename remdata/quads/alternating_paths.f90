!> Alternating paths over pairs of triangles: from a triangle without partner to another one, with odd cycles contracted
!> (J. Edmonds, Paths, trees, and flowers, Canadian J. Math. 17 (1965) 449-467).
module alternating_paths
  use kinds, only: wp
  use triangulation, only: triangulation_t
  implicit none
  private
  public :: path_search_t, begin_search, exchange_pairs, find_path, forget

  !> A path reaches so many triangles at most.
  integer, parameter :: most_reached = 20000

  !> Search for a path: one entry a triangle.
  type :: path_search_t
    integer, allocatable :: from(:), base(:)
    logical, allocatable :: queued(:), in_cycle(:), marked(:)
    integer, allocatable :: queue(:), reached(:)
    integer :: nqueue = 0, nreached = 0
  end type path_search_t

contains

  !> No triangle is reached yet.
  pure subroutine begin_search(n, search)
    integer, intent(in) :: n   !! triangles
    type(path_search_t), intent(out) :: search
    integer :: t

    allocate (search%from(n), search%base(n), search%queue(n), search%reached(n), source=0)
    allocate (search%queued(n), search%in_cycle(n), search%marked(n), source=.false.)
    do t = 1, n
      search%base(t) = t
    end do
  end subroutine begin_search

  !> Breadth-first search from a triangle without partner to another one; `last` is that one, 0 where none is reached.
  pure subroutine find_path(mesh, quality, least, root, partner, search, last)
    type(triangulation_t), intent(in) :: mesh
    real(wp), intent(in) :: quality(:, :)   !! of the quadrilateral across each side (3, ntriangle) [-]
    real(wp), intent(in) :: least           !! quality that is used [-]
    integer, intent(in) :: root
    integer, intent(in) :: partner(:)       !! (ntriangle)
    type(path_search_t), intent(inout) :: search
    integer, intent(out) :: last
    integer :: next, v, to, k
    logical :: is_outer

    last = 0
    call reach(search, root)
    call put_in_queue(search, root)
    next = 0
    do while (next < search%nqueue .and. search%nreached < most_reached)
      next = next + 1
      v = search%queue(next)
      do k = 1, 3
        if (quality(k, v) < least) cycle
        to = mesh%across(k, v)
        if (search%base(v) == search%base(to) .or. partner(v) == to) cycle
        is_outer = to == root
        if (.not. is_outer .and. partner(to) > 0) is_outer = search%from(partner(to)) > 0
        if (is_outer) then
          call contract(v, to, partner, search)
        else if (search%from(to) == 0) then
          call reach(search, to)
          search%from(to) = v
          if (partner(to) == 0) then
            last = to
            return
          end if
          call reach(search, partner(to))
          call put_in_queue(search, partner(to))
        end if
      end do
    end do
  end subroutine find_path

  pure subroutine reach(search, t)
    type(path_search_t), intent(inout) :: search
    integer, intent(in) :: t

    if (search%marked(t)) return
    search%marked(t) = .true.
    search%nreached = search%nreached + 1
    search%reached(search%nreached) = t
  end subroutine reach

  pure subroutine put_in_queue(search, t)
    type(path_search_t), intent(inout) :: search
    integer, intent(in) :: t

    if (search%queued(t)) return
    search%queued(t) = .true.
    search%nqueue = search%nqueue + 1
    search%queue(search%nqueue) = t
  end subroutine put_in_queue

  !> Contract the odd cycle that the neighbours v and w close, to where their ways to the root meet.
  pure subroutine contract(v, w, partner, search)
    integer, intent(in) :: v, w, partner(:)
    type(path_search_t), intent(inout) :: search
    integer :: base, i

    base = meeting_point(v, w, partner, search)
    do i = 1, search%nreached
      search%in_cycle(search%reached(i)) = .false.
    end do
    call mark_way(v, base, w, partner, search)
    call mark_way(w, base, v, partner, search)
    do i = 1, search%nreached
      associate (t => search%reached(i))
        if (.not. search%in_cycle(search%base(t))) cycle
        search%base(t) = base
        call put_in_queue(search, t)
      end associate
    end do
  end subroutine contract

  pure function meeting_point(v, w, partner, search) result(base)
    integer, intent(in) :: v, w, partner(:)
    type(path_search_t), intent(in) :: search
    integer :: base
    integer :: t
    integer :: seen(search%nreached), n

    n = 0
    t = v
    do
      t = search%base(t)
      n = n + 1
      seen(n) = t
      if (partner(t) == 0) exit
      t = search%from(partner(t))
    end do
    base = w
    do
      base = search%base(base)
      if (any(seen(:n) == base)) return
      base = search%from(partner(base))
    end do
  end function meeting_point

  pure subroutine mark_way(from, base, to, partner, search)
    integer, intent(in) :: from, base, to, partner(:)
    type(path_search_t), intent(inout) :: search
    integer :: t, next

    t = from
    next = to
    do while (search%base(t) /= base)
      search%in_cycle(search%base(t)) = .true.
      search%in_cycle(search%base(partner(t))) = .true.
      search%from(t) = next
      next = partner(t)
      t = search%from(partner(t))
    end do
  end subroutine mark_way

  !> Along a path from its last triangle to the first, pairs are exchanged.
  pure subroutine exchange_pairs(last, from, partner)
    integer, intent(in) :: last
    integer, intent(in) :: from(:)         !! (ntriangle) of the search
    integer, intent(inout) :: partner(:)   !! (ntriangle)
    integer :: t, v, next

    t = last
    do while (t > 0)
      v = from(t)
      next = partner(v)
      partner(t) = v
      partner(v) = t
      t = next
    end do
  end subroutine exchange_pairs

  pure subroutine forget(search)
    type(path_search_t), intent(inout) :: search
    integer :: i

    do i = 1, search%nreached
      associate (t => search%reached(i))
        search%from(t) = 0
        search%base(t) = t
        search%queued(t) = .false.
        search%in_cycle(t) = .false.
        search%marked(t) = .false.
      end associate
    end do
    search%nreached = 0
    search%nqueue = 0
  end subroutine forget

end module alternating_paths
