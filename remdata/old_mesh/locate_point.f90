!> Where a point lies in a mesh: the element and the parent coordinates.
!>
!> In each element near the point the closest point is sought: Gauss-Newton kept on the parent square, which inside the element is
!> Newton's method for x(xi) = x. No element is tried in vain: its box tells how near it can be at best.
module locate_point
  use box_tree, only: nearest_items
  use kinds, only: wp
  use shape_functions, only: quad8
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: place_t, locate, closest_in_element

  !> Elements tried first, and then twice as many while none of these holds the point: inside a mesh one or two boxes hold it.
  integer, parameter :: first_try = 2
  !> Iterations in an element; Newton needs about five.
  integer, parameter :: most_iterations = 40
  !> A step of the parent coordinates that moves nothing any more.
  real(wp), parameter :: at_rest = 1.0e-14_wp
  !> A distance over the size of the element that is round-off: the point lies inside.
  real(wp), parameter :: inside = 1.0e-10_wp

  type :: place_t
    integer :: element = 0
    !> Parent coordinates; outside the square by what the caller allowed where the point lies outside the mesh.
    real(wp) :: xi(2) = 0.0_wp
    !> Distance of the point to the mesh, 0 inside [length].
    real(wp) :: distance = 0.0_wp
  end type place_t

contains

  !> Place of a point among the elements of its material. Outside of them the nearest element is prolonged by at most `outside`
  !> (1 is half an element); farther away the value is that of the last place reached.
  pure subroutine locate(mesh, material, point, outside, place)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material
    real(wp), intent(in) :: point(2), outside
    type(place_t), intent(out) :: place
    integer :: wanted, from

    if (material < 1 .or. material > mesh%nmaterial) return
    if (mesh%element_trees(material)%n == 0) return
    wanted = min(first_try, mesh%element_trees(material)%n)
    from = 1
    do
      call try_nearest(mesh, material, point, wanted, from, place)
      if (from == 0 .or. wanted == mesh%element_trees(material)%n) exit
      from = wanted + 1
      wanted = min(2*wanted, mesh%element_trees(material)%n)
    end do
    if (place%distance > 0) call prolong(mesh%nodes(:, mesh%connectivity(:, place%element)), point, outside, place%xi)
  end subroutine locate

  !> Try elements from number `from` to `wanted` of the nearest boxes; `from` becomes 0 when no other can be nearer.
  pure subroutine try_nearest(mesh, material, point, wanted, from, place)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material, wanted
    real(wp), intent(in) :: point(2)
    integer, intent(inout) :: from
    type(place_t), intent(inout) :: place
    integer :: items(wanted), found, k
    real(wp) :: boxes(wanted), xi(2), distance

    call nearest_items(mesh%element_trees(material), point, found, items, boxes)
    do k = from, found
      if (place%element > 0) then
        if (boxes(k) > place%distance**2) then
          from = 0
          return
        end if
      end if
      call closest_in_element(mesh%nodes(:, mesh%connectivity(:, items(k))), point, xi, distance)
      if (place%element > 0 .and. .not. distance < place%distance) cycle
      place%element = items(k)
      place%xi = xi
      place%distance = distance
      if (distance > 0) cycle
      from = 0
      return
    end do
  end subroutine try_nearest

  !> Point of an element nearest to a point in space: parent coordinates in the square, and distance, 0 where the point is inside.
  pure subroutine closest_in_element(x, point, xi, distance)
    real(wp), intent(in) :: x(2, 8), point(2)
    real(wp), intent(out) :: xi(2), distance
    real(wp) :: phi(8), dphi(2, 8), j(2, 2), r(2), step(2), old(2)
    integer :: iteration, a

    xi = 0
    do iteration = 1, most_iterations
      call quad8(xi(1), xi(2), phi, dphi)
      r = point - matmul(x, phi)
      j = matmul(x, transpose(dphi))
      step = full_step(j, r)
      ! one that would leave the square stays on its side, and the other one moves along that side
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

  !> Beyond the element by Newton from its side, not farther than allowed.
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
