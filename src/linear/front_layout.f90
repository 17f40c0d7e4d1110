!> Memory layout of a multifrontal factorisation: fronts, their factors, the matrices that children send to parents.
!>
!> A front of order n with p pivots is kept as its pivot columns (n, p) and the rest of its pivot rows (p, n-p), one after the
!> other: its factors. The rest (n-p, n-p), the border, is sent to the parent and discarded. Fronts are shared out to
!> threads by subtrees; how the tree is split depends on the tree alone, so that results do not depend on the threads.
module front_layout
  use kinds, only: i8, wp
  implicit none
  private
  public :: front_layout_t

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

end module front_layout
