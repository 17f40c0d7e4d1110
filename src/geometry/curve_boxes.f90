!> The tree of boxes over a curve, gone through from its root with the nearest box first.
module curve_boxes
  use kinds, only: wp
  use piecewise_curves, only: piecewise_curve_t
  implicit none
  private
  public :: waiting_nodes_t, box_distance, box_gap, box_of_node, start_at_root, wait_below

  !> Nodes waiting in a search are one for each row of the tree at most: pieces are counted by 32 bits.
  integer, parameter :: most_waiting = 40

  !> Nodes that wait, the next one last, and the squares of their distances.
  type :: waiting_nodes_t
    integer :: n
    integer :: node(most_waiting)
    real(wp) :: gap(most_waiting)   !! [length^2]
  end type waiting_nodes_t

contains

  !> The root of the tree waits, in front of a box.
  pure subroutine start_at_root(curve, box, waiting)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: box(4)   !! xmin, ymin, xmax, ymax; a point twice [length]
    type(waiting_nodes_t), intent(out) :: waiting

    waiting%n = 1
    waiting%node(1) = 1
    waiting%gap(1) = box_gap(box_of_node(curve, 1), box)
  end subroutine start_at_root

  !> Both nodes below one wait instead of it, the nearer last: it is next.
  pure subroutine wait_below(curve, box, node, waiting)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: box(4)   !! xmin, ymin, xmax, ymax; a point twice [length]
    integer, intent(in) :: node
    type(waiting_nodes_t), intent(inout) :: waiting
    real(wp) :: gap(2)
    integer :: near, far

    gap(1) = box_gap(box_of_node(curve, 2*node), box)
    gap(2) = box_gap(box_of_node(curve, 2*node + 1), box)
    near = merge(0, 1, gap(1) <= gap(2))
    far = 1 - near
    waiting%node(waiting%n + 1:waiting%n + 2) = 2*node + [far, near]
    waiting%gap(waiting%n + 1:waiting%n + 2) = gap([far + 1, near + 1])
    waiting%n = waiting%n + 2
  end subroutine wait_below

  !> Distance from a box (xmin, ymin, xmax, ymax) to the boxes of a curve; 0 when they meet [length].
  pure function box_distance(curve, box) result(distance)
    class(piecewise_curve_t), intent(in) :: curve
    real(wp), intent(in) :: box(4)   !! xmin, ymin, xmax, ymax [length]
    real(wp) :: distance
    type(waiting_nodes_t) :: waiting
    integer :: node

    distance = huge(1.0_wp)
    call start_at_root(curve, box, waiting)
    do while (waiting%n > 0)
      node = waiting%node(waiting%n)
      waiting%n = waiting%n - 1
      if (.not. waiting%gap(waiting%n + 1) < distance) cycle
      if (node > size(curve%tree, 2)) then
        distance = waiting%gap(waiting%n + 1)
      else
        call wait_below(curve, box, node, waiting)
      end if
    end do
    distance = sqrt(distance)
  end function box_distance

  !> Box of a node of the tree; nothing is near one that holds no piece.
  pure function box_of_node(curve, node) result(box)
    class(piecewise_curve_t), intent(in) :: curve
    integer, intent(in) :: node
    real(wp) :: box(4)
    integer :: piece

    piece = node - size(curve%tree, 2)
    if (piece <= 0) then
      box = curve%tree(:, node)
    else if (piece <= size(curve%boxes, 2)) then
      box = curve%boxes(:, piece)
    else
      box = [huge(1.0_wp), huge(1.0_wp), -huge(1.0_wp), -huge(1.0_wp)]
    end if
  end function box_of_node

  !> Square of the distance between two boxes (xmin, ymin, xmax, ymax), 0 when they meet; the first may be empty.
  pure function box_gap(one, other) result(gap)
    real(wp), intent(in) :: one(4), other(4)   !! [length]
    real(wp) :: gap

    gap = huge(gap)
    if (one(1) > one(3)) return
    gap = sum(max(one(1:2) - other(3:4), other(1:2) - one(3:4), 0.0_wp)**2)
  end function box_gap

end module curve_boxes
