!> Values at integration points carried to nodes, for pictures: a bilinear fit in each element, the mean over the elements
!> that meet at a node, and that kept within the range of the values at the points of these elements.
!>
!> A linear field is exact at nodes that its points surround. Elsewhere the fit extrapolates beyond the points: where a field is
!> steep it would show strains that no point has, or ones below zero.
module nodal_average
  use kinds, only: wp
  use quadrature, only: square_rule
  use shape_functions, only: quad8_corner
  implicit none
  private
  public :: nodal_average_t, begin_average, add_elements, limited_average

  !> Sums over the elements of one material at each node (nnode), in the unit of the field, and the range of its points there.
  type :: nodal_average_t
    real(wp), allocatable :: total(:), least(:), largest(:)
    integer, allocatable :: count(:)   !! elements at the node
  end type nodal_average_t

contains

  pure subroutine begin_average(nnode, average)
    integer, intent(in) :: nnode
    type(nodal_average_t), intent(out) :: average

    allocate (average%total(nnode), source=0.0_wp)
    allocate (average%least(nnode), source=huge(1.0_wp))
    allocate (average%largest(nnode), source=-huge(1.0_wp))
    allocate (average%count(nnode), source=0)
  end subroutine begin_average

  !> Add the elements of a group.
  pure subroutine add_elements(connectivity, values, average)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    real(wp), intent(in) :: values(:, :)        !! (npoint, nelem) at the points [unit of the field]
    type(nodal_average_t), intent(inout) :: average
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: fit(4), corner(4), at(8), least, largest
    integer :: e, k

    call square_rule(size(values, 1), xi, weight)
    do e = 1, size(connectivity, 2)
      ! the rule makes 1, xi, eta, xi eta orthogonal, so each coefficient stands alone
      fit(1) = sum(weight*values(:, e))/sum(weight)
      fit(2) = sum(weight*xi(1, :)*values(:, e))/sum(weight*xi(1, :)**2)
      fit(3) = sum(weight*xi(2, :)*values(:, e))/sum(weight*xi(2, :)**2)
      fit(4) = sum(weight*xi(1, :)*xi(2, :)*values(:, e))/sum(weight*(xi(1, :)*xi(2, :))**2)
      corner = fit(1) + fit(2)*quad8_corner(1, :) + fit(3)*quad8_corner(2, :) + fit(4)*quad8_corner(1, :)*quad8_corner(2, :)
      at(1:4) = corner
      at(5:8) = 0.5_wp*(corner + cshift(corner, 1))
      least = minval(values(:, e))
      largest = maxval(values(:, e))
      do k = 1, 8
        associate (node => connectivity(k, e))
          average%total(node) = average%total(node) + at(k)
          average%count(node) = average%count(node) + 1
          average%least(node) = min(average%least(node), least)
          average%largest(node) = max(average%largest(node), largest)
        end associate
      end do
    end do
  end subroutine add_elements

  !> Mean at each node, within the range of the points around it; 0 where there is no element.
  pure function limited_average(average) result(at)
    type(nodal_average_t), intent(in) :: average
    real(wp) :: at(size(average%total))

    at = 0
    where (average%count > 0) at = max(average%least, min(average%largest, average%total/average%count))
  end function limited_average

end module nodal_average
