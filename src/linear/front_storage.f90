!> Which fronts threads share, and where factors and borders are stored.
module front_storage
  use front_layout, only: front_layout_t
  use kinds, only: i8, wp
  implicit none
  private
  public :: split_tree, place_stores

  !> Subtrees with less than this share of all operations are done by one thread.
  real(wp), parameter :: subtree_share = 1.0_wp/32
  !> Fewer operations than these are faster on one thread.
  real(wp), parameter :: worth_sharing = 4.0e6_wp

contains

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

end module front_storage
