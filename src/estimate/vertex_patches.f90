!> Patches of elements around the corner nodes of a mesh, and the nodes from which a vertex without one takes its polynomial.
!>
!> Nodes where fewer than three elements meet, on the boundary and on material lines, have none: they take the mean of their
!> neighbours that have one; where there is none the patch is widened by a row.
module vertex_patches
  implicit none
  private
  public :: patches_t, find_patches

  !> Elements that a node needs for a patch of its own.
  integer, parameter :: least_elements = 3

  !> Patches of a set of elements; only their nodes matter.
  type :: patches_t
    !> Corner nodes (nvertex), and the vertices of the elements (4, nelem).
    integer, allocatable :: node(:), vertex(:, :)
    !> Elements of the patch of vertex v: element(first(v):first(v + 1) - 1); none where it has no patch.
    integer, allocatable :: first(:), element(:)
    !> Vertices whose polynomials it takes where it has none, in the same way.
    integer, allocatable :: first_donor(:), donor(:)
  end type patches_t

contains

  !> Patches of elements.
  pure subroutine find_patches(connectivity, patches)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    type(patches_t), intent(out) :: patches
    integer, allocatable :: start(:), around(:), seen_element(:), seen_vertex(:)
    integer :: v, nvertex, pass

    call number_vertices(connectivity, patches)
    nvertex = size(patches%node)
    call list_elements(patches%vertex, nvertex, start, around)
    allocate (patches%first(nvertex + 1), patches%first_donor(nvertex + 1))
    allocate (patches%element(0), patches%donor(0))
    do pass = 1, 2   ! count, then fill
      seen_element = spread(0, 1, size(connectivity, 2))
      seen_vertex = spread(0, 1, nvertex)
      patches%first = 1
      patches%first_donor = 1
      do v = 1, nvertex
        patches%first(v + 1) = patches%first(v)
        patches%first_donor(v + 1) = patches%first_donor(v)
        if (has_own(v)) then
          call list_own(v, seen_element, patches)
        else
          call list_donors(v, .false., seen_vertex, patches)
          if (.not. has_donors(v)) call list_donors(v, .true., seen_vertex, patches)
          if (.not. has_donors(v)) call widen(patches%vertex, start, around, v, seen_element, patches%element, patches%first(v + 1))
        end if
      end do
      if (pass == 2) exit
      deallocate (patches%element, patches%donor)
      allocate (patches%element(patches%first(nvertex + 1) - 1), patches%donor(patches%first_donor(nvertex + 1) - 1), source=0)
    end do

  contains

    pure logical function has_own(v)
      integer, intent(in) :: v

      has_own = start(v + 1) - start(v) >= least_elements
    end function has_own

    pure logical function has_donors(v)
      integer, intent(in) :: v

      has_donors = patches%first_donor(v + 1) > patches%first_donor(v)
    end function has_donors

    !> List the elements around vertex v.
    pure subroutine list_own(v, seen, patches)
      integer, intent(in) :: v
      integer, intent(inout) :: seen(:)
      type(patches_t), intent(inout) :: patches
      integer :: i

      do i = start(v), start(v + 1) - 1
        call add(around(i), v, seen, patches%element, patches%first(v + 1))
      end do
    end subroutine list_own

    !> List the vertices with patches of their own that vertex v meets along the sides of elements, or across these.
    pure subroutine list_donors(v, across, seen, patches)
      integer, intent(in) :: v
      logical, intent(in) :: across
      integer, intent(inout) :: seen(:)
      type(patches_t), intent(inout) :: patches
      integer :: i, k, at

      do i = start(v), start(v + 1) - 1
        at = findloc(patches%vertex(:, around(i)), v, 1)
        do k = 1, 4
          if (mod(k - at, 2) == 0 .neqv. across) cycle
          if (has_own(patches%vertex(k, around(i)))) &
            call add(patches%vertex(k, around(i)), v, seen, patches%donor, patches%first_donor(v + 1))
        end do
      end do
    end subroutine list_donors

  end subroutine find_patches

  !> List the elements around vertex v, and all that touch these.
  pure subroutine widen(vertex, start, around, v, seen, list, next)
    integer, intent(in) :: vertex(:, :), start(:), around(:), v
    integer, intent(inout) :: seen(:), list(:), next
    integer :: i, j, k, w

    do i = start(v), start(v + 1) - 1
      do k = 1, 4
        w = vertex(k, around(i))
        do j = start(w), start(w + 1) - 1
          call add(around(j), v, seen, list, next)
        end do
      end do
    end do
  end subroutine widen

  !> Put a number into a list, once for each vertex v; a list without room is only counted.
  pure subroutine add(number, v, seen, list, next)
    integer, intent(in) :: number, v
    integer, intent(inout) :: seen(:), list(:), next

    if (seen(number) == v) return
    seen(number) = v
    if (next <= size(list)) list(next) = number
    next = next + 1
  end subroutine add

  !> Corner nodes in the order met.
  pure subroutine number_vertices(connectivity, patches)
    integer, intent(in) :: connectivity(:, :)
    type(patches_t), intent(inout) :: patches
    integer :: number(maxval(connectivity)), node(4*size(connectivity, 2))
    integer :: e, k, n

    number = 0
    n = 0
    allocate (patches%vertex(4, size(connectivity, 2)))
    do e = 1, size(connectivity, 2)
      do k = 1, 4
        if (number(connectivity(k, e)) == 0) then
          n = n + 1
          node(n) = connectivity(k, e)
          number(connectivity(k, e)) = n
        end if
        patches%vertex(k, e) = number(connectivity(k, e))
      end do
    end do
    allocate (patches%node(n), source=node(:n))
  end subroutine number_vertices

  !> Elements around vertex v: around(start(v):start(v + 1) - 1), ascending.
  pure subroutine list_elements(vertex, nvertex, start, around)
    integer, intent(in) :: vertex(:, :), nvertex
    integer, allocatable, intent(out) :: start(:), around(:)
    integer :: e, k, v, next(nvertex)

    allocate (start(nvertex + 1), around(size(vertex)))
    start = 0
    do e = 1, size(vertex, 2)
      do k = 1, 4
        start(vertex(k, e) + 1) = start(vertex(k, e) + 1) + 1
      end do
    end do
    start(1) = 1
    do v = 1, nvertex
      start(v + 1) = start(v) + start(v + 1)
    end do
    next = start(:nvertex)
    do e = 1, size(vertex, 2)
      do k = 1, 4
        around(next(vertex(k, e))) = e
        next(vertex(k, e)) = next(vertex(k, e)) + 1
      end do
    end do
  end subroutine list_elements

end module vertex_patches
