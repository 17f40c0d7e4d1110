!> Location of a point in a mesh: the element and the parent coordinates.
!>
!> In each element near the point the closest point is sought by the Gauss-Newton method restricted to the parent square, which
!> inside the element is Newton's method for x(xi) = x. Elements whose box is farther than the best one found are skipped.
module locate_point
  use box_tree, only: nearest_items
  use kinds, only: wp
  use shape_functions, only: quad8
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: element_location_t, locate, closest_in_element

  !> Elements tried first, and then twice as many while none of them contains the point: inside a mesh one or two boxes do.
  integer, parameter :: first_try = 2
  !> Iterations in an element; Newton needs about five.
  integer, parameter :: most_iterations = 40
  !> A smaller step of the parent coordinates is zero.
  real(wp), parameter :: at_rest = 1.0e-14_wp
  !> A distance over the size of the element that is round-off: the point lies inside.
  real(wp), parameter :: inside = 1.0e-10_wp

  type :: element_location_t
    integer :: element = 0
    !> Parent coordinates; outside the square by at most the extrapolation allowed where the point lies outside the mesh.
    real(wp) :: xi(2) = 0.0_wp
    !> Distance of the point to the mesh, 0 inside [length].
    real(wp) :: distance = 0.0_wp
  end type element_location_t

contains

  !> Location of a point among the elements of its material. Outside of them the nearest element is extrapolated by at most
  !> `outside` (1 is half an element); farther away the value is that of the last location reached.
  pure subroutine locate(mesh, material, point, outside, location)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material
    real(wp), intent(in) :: point(2), outside   !! coordinates [length]; limit of the extrapolation [-]
    type(element_location_t), intent(out) :: location
    integer :: requested, from

    if (material < 1 .or. material > mesh%nmaterial) return
    if (mesh%element_trees(material)%n == 0) return
    requested = min(first_try, mesh%element_trees(material)%n)
    from = 1
    do
      call try_nearest(mesh, material, point, requested, from, location)
      if (from == 0 .or. requested == mesh%element_trees(material)%n) exit
      from = requested + 1
      requested = min(2*requested, mesh%element_trees(material)%n)
    end do
    if (location%distance > 0) call prolong(mesh%nodes(:, mesh%connectivity(:, location%element)), point, outside, location%xi)
  end subroutine locate

  !> Try elements number `from` to `wanted` of the nearest boxes; `from` becomes 0 when no other can be nearer.
  pure subroutine try_nearest(mesh, material, point, requested, from, location)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material, requested
    real(wp), intent(in) :: point(2)
    integer, intent(inout) :: from
    type(element_location_t), intent(inout) :: location
    integer :: items(requested), found, k
    real(wp) :: boxes(requested), xi(2), distance

    call nearest_items(mesh%element_trees(material), point, found, items, boxes)
    do k = from, found
      if (location%element > 0) then
        if (boxes(k) > location%distance**2) then
          from = 0
          return
        end if
      end if
      call closest_in_element(mesh%nodes(:, mesh%connectivity(:, items(k))), point, xi, distance)
      if (location%element > 0 .and. .not. distance < location%distance) cycle
      location%element = items(k)
      location%xi = xi
      location%distance = distance
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
    real(wp), intent(in) :: j(2, 2), r(2)
    real(wp) :: step(2), det

    det = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
    if (det > inside*sum(j**2)) then
      step = [j(2, 2)*r(1) - j(1, 2)*r(2), j(1, 1)*r(2) - j(2, 1)*r(1)]/det
    else
      step = matmul(r, j)/max(sum(j**2), tiny(1.0_wp))
    end if
  end function full_step

  !> Extrapolation beyond the element by Newton's method from its side, limited to the allowed distance.
  pure subroutine prolong(x, point, outside, xi)
    real(wp), intent(in) :: x(2, 8), point(2), outside
    real(wp), intent(inout) :: xi(2)
    real(wp) :: phi(8), dphi(2, 8), step(2)
    integer :: iteration

    do iteration = 1, most_iterations
      call quad8(xi(1), xi(2), phi, dphi)
      step = full_step(matmul(x, transpose(dphi)), point - matmul(x, phi))
      step = max(-1 - outside - xi, min(1 + outside - xi, step))
      xi = xi + step
      if (maxval(abs(step)) <= at_rest) exit
    end do
  end subroutine prolong

end module locate_point
