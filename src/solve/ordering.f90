!> Elimination order by METIS nested dissection of the node graph, once per mesh.
!>
!> The graph has one vertex per node, so the equations of a node stay together.
!> Source: G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392.
module ordering
  use, intrinsic :: iso_c_binding, only: c_int, c_null_ptr, c_ptr
  use dofs, only: dofs_t
  use errors, only: error_t, exit_machine, fail
  use system, only: raise_termination
  use text, only: to_text
  implicit none
  private
  public :: order_equations

  integer(c_int), parameter :: metis_ok = 1, metis_error = -4

  interface
    integer(c_int) function metis_node_nd(nvtxs, xadj, adjncy, vwgt, options, perm, iperm) bind(c, name='METIS_NodeND')
      import :: c_int, c_ptr
      integer(c_int), intent(in) :: nvtxs, xadj(*), adjncy(*)
      type(c_ptr), value :: vwgt, options
      integer(c_int), intent(out) :: perm(*), iperm(*)
    end function metis_node_nd
  end interface

contains

  !> Position of each equation in the order of elimination. Equations of no node come last.
  subroutine order_equations(connectivity, nnode, dofs, equation_of, position, error)
    integer, intent(in) :: connectivity(:, :)   !! (nnode, nelem) of the solid elements, and of links between bodies
    integer, intent(in) :: nnode                !! of the mesh
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: equation_of(:)              !! (ndof) of each unknown, 0 where there is none
    integer, allocatable, intent(out) :: position(:)   !! (neq)
    type(error_t), allocatable, intent(out) :: error
    integer(c_int), allocatable :: xadj(:), adjncy(:), perm(:), place(:)
    integer, allocatable :: node_at(:)
    integer :: status, f, k, d, n

    call node_graph(connectivity, nnode, xadj, adjncy)
    allocate (perm(nnode), place(nnode), node_at(nnode))
    status = metis_node_nd(int(nnode, c_int), xadj, adjncy, c_null_ptr, c_null_ptr, perm, place)
    if (status == metis_error) then
      ! METIS takes TERM for a failure of its own while it is at work: it is passed on, and the order made anew
      call raise_termination()
      status = metis_node_nd(int(nnode, c_int), xadj, adjncy, c_null_ptr, c_null_ptr, perm, place)
    end if
    if (status /= metis_ok) then
      call fail(error, exit_machine, 'METIS could not order the mesh (status '//to_text(status)//')')
      return
    end if
    do k = 1, nnode
      node_at(place(k) + 1) = k
    end do
    allocate (position(maxval(equation_of)), source=0)
    n = 0
    do k = 1, nnode
      do f = 1, size(dofs%fields)
        if (.not. dofs%fields(f)%at_nodes) cycle
        do d = 1, size(dofs%fields(f)%number, 1)
          call take(dofs%fields(f)%number(d, node_at(k)))
        end do
      end do
    end do
    do k = 1, dofs%ndof
      call take(k)
    end do

  contains

    subroutine take(dof)
      integer, intent(in) :: dof
      integer :: equation

      if (dof == 0) return
      equation = equation_of(dof)
      if (equation == 0) return
      if (position(equation) > 0) return
      n = n + 1
      position(equation) = n
    end subroutine take

  end subroutine order_equations

  !> Neighbours of every node (zero-based compressed lists): nodes that share an element, or a link of contact.
  subroutine node_graph(connectivity, nnode, xadj, adjncy)
    integer, intent(in) :: connectivity(:, :), nnode
    integer(c_int), allocatable, intent(out) :: xadj(:), adjncy(:)
    integer, allocatable :: first(:), elements(:), mark(:)
    integer :: e, i, j, k, n, capacity

    allocate (first(nnode + 2), source=0)
    do e = 1, size(connectivity, 2)
      ! one by one: a node may stand several times in a link
      do i = 1, size(connectivity, 1)
        first(connectivity(i, e) + 2) = first(connectivity(i, e) + 2) + 1
      end do
    end do
    first(1:2) = 1
    do k = 2, nnode + 1
      first(k + 1) = first(k + 1) + first(k)
    end do
    allocate (elements(size(connectivity)))
    do e = 1, size(connectivity, 2)
      do i = 1, size(connectivity, 1)
        k = connectivity(i, e) + 1
        elements(first(k)) = e
        first(k) = first(k) + 1
      end do
    end do
    ! now first(k) is the start of node k and first(k+1) its end plus one
    capacity = 0
    do k = 1, nnode
      capacity = capacity + (first(k + 1) - first(k))*(size(connectivity, 1) - 1)
    end do
    allocate (xadj(nnode + 1), adjncy(capacity), mark(nnode))
    mark = 0
    n = 0
    do k = 1, nnode
      xadj(k) = int(n, c_int)
      mark(k) = k
      do i = first(k), first(k + 1) - 1
        do j = 1, size(connectivity, 1)
          associate (other => connectivity(j, elements(i)))
            if (mark(other) == k) cycle
            mark(other) = k
            n = n + 1
            adjncy(n) = int(other - 1, c_int)
          end associate
        end do
      end do
    end do
    xadj(nnode + 1) = int(n, c_int)
  end subroutine node_graph

end module ordering
