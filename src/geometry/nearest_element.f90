!> The element of a mesh of 8-node elements that a point lies in, or is nearest to, and its parent coordinates there.
!>
!> In each element near the point the closest point is sought by the Gauss-Newton method restricted to the parent square, which
!> inside the element is Newton's method for x(xi) = x. Elements whose box is farther than the best one found are skipped.
module nearest_element
  use box_tree, only: box_tree_t, nearest_items
  use kinds, only: wp
  use parabolas, only: box_of_parabola
  use shape_functions, only: quad8, quad8_side
  implicit none
  private
  public :: box_of_element, closest_in_element, find_element, full_step
  public :: at_rest, most_iterations

  !> Elements tried first, and then twice as many while none of them contains the point: inside a mesh one or two boxes do.
  integer, parameter :: first_try = 2
  !> Iterations in an element; Newton needs about five.
  integer, parameter :: most_iterations = 40
  !> A smaller step of the parent coordinates is zero.
  real(wp), parameter :: at_rest = 1.0e-14_wp
  !> A distance over the size of the element that is round-off: the point lies inside.
  real(wp), parameter :: inside = 1.0e-10_wp

contains

  !> Box that contains an element with curved sides.
  pure function box_of_element(x) result(box)
    real(wp), intent(in) :: x(2, 8)   !! coordinates of the nodes [length]
    real(wp) :: box(4)                !! least x, y, largest x, y [length]
    integer :: s

    box = box_of_parabola(x(:, quad8_side(:, 1)))
    do s = 2, 4
      associate (side => box_of_parabola(x(:, quad8_side(:, s))))
        box = [min(box(1:2), side(1:2)), max(box(3:4), side(3:4))]
      end associate
    end do
  end function box_of_element

  !> The element nearest to a point; 0 where the tree is empty.
  pure subroutine find_element(nodes, connectivity, tree, point, element, xi, distance)
    real(wp), intent(in) :: nodes(:, :)         !! (2, nnode) coordinates [length]
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    type(box_tree_t), intent(in) :: tree        !! of the boxes of the elements that count
    real(wp), intent(in) :: point(2)            !! [length]
    integer, intent(out) :: element
    real(wp), intent(out) :: xi(2)              !! parent coordinates, in the square [-]
    real(wp), intent(out) :: distance           !! to the element, 0 inside [length]
    integer :: requested, from

    element = 0
    xi = 0
    distance = 0
    if (tree%n == 0) return
    requested = min(first_try, tree%n)
    from = 1
    do
      call try_nearest(nodes, connectivity, tree, point, requested, from, element, xi, distance)
      if (from == 0 .or. requested == tree%n) exit
      from = requested + 1
      requested = min(2*requested, tree%n)
    end do
  end subroutine find_element

  !> Try elements number `from` to `requested` of the nearest boxes; `from` becomes 0 when no other can be nearer.
  pure subroutine try_nearest(nodes, connectivity, tree, point, requested, from, element, xi, distance)
    real(wp), intent(in) :: nodes(:, :), point(2)
    integer, intent(in) :: connectivity(:, :), requested
    type(box_tree_t), intent(in) :: tree
    integer, intent(inout) :: from, element
    real(wp), intent(inout) :: xi(2), distance
    integer :: items(requested), found, k
    real(wp) :: boxes(requested), own_xi(2), own_distance

    call nearest_items(tree, point, found, items, boxes)
    do k = from, found
      if (element > 0) then
        if (boxes(k) > distance**2) then
          from = 0
          return
        end if
      end if
      call closest_in_element(nodes(:, connectivity(:, items(k))), point, own_xi, own_distance)
      if (element > 0 .and. .not. own_distance < distance) cycle
      element = items(k)
      xi = own_xi
      distance = own_distance
      if (distance > 0) cycle
      from = 0
      return
    end do
  end subroutine try_nearest

  !> Point of an element nearest to a point in space: parent coordinates in the square, and distance, 0 where the point is inside.
  pure subroutine closest_in_element(x, point, xi, distance)
    real(wp), intent(in) :: x(2, 8), point(2)   !! coordinates of the nodes and of the point [length]
    real(wp), intent(out) :: xi(2), distance    !! parent coordinates [-]; distance [length]
    real(wp) :: phi(8), dphi(2, 8), j(2, 2), r(2), step(2), old(2)
    integer :: iteration, a

    xi = 0
    do iteration = 1, most_iterations
      call quad8(xi(1), xi(2), phi, dphi)
      r = point - matmul(x, phi)
      j = matmul(x, transpose(dphi))
      step = full_step(j, r)
      ! a step that would leave the square is restricted to its side
      do a = 1, 2
        if (abs(xi(a)) >= 1 .and. xi(a)*step(a) >= 0) then
          step(a) = 0
          step(3 - a) = dot_product(j(:, 3 - a), r)/max(sum(j(:, 3 - a)**2), tiny(1.0_wp))
          if (abs(xi(3 - a)) >= 1 .and. xi(3 - a)*step(3 - a) >= 0) step(3 - a) = 0
          exit
        end if
      end do
      old = xi
      xi = max(-1.0_wp, min(1.0_wp, xi + max(-1.0_wp, min(1.0_wp, step))))
      if (maxval(abs(xi - old)) <= at_rest) exit
    end do
    call quad8(xi(1), xi(2), phi, dphi)
    r = point - matmul(x, phi)
    distance = sqrt(sum(r**2))
    if (distance <= inside*maxval(maxval(x, 2) - minval(x, 2))) distance = 0
  end subroutine closest_in_element

  !> Newton's step; where the mapping is singular, the one of steepest descent.
  pure function full_step(j, r) result(step)
    real(wp), intent(in) :: j(2, 2), r(2)   !! d(x)/d(xi) [length]; what is missing [length]
    real(wp) :: step(2), det

    det = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
    if (det > inside*sum(j**2)) then
      step = [j(2, 2)*r(1) - j(1, 2)*r(2), j(1, 1)*r(2) - j(2, 1)*r(1)]/det
    else
      step = matmul(r, j)/max(sum(j**2), tiny(1.0_wp))
    end if
  end function full_step

end module nearest_element
