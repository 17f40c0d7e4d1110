!> Values at integration points carried to nodes, for pictures: a bilinear fit in each element,
!> then the mean over the elements that meet at a node.
module nodal_average
  use kinds, only: wp
  use quadrature, only: square_rule
  use shape_functions, only: quad8_corner
  implicit none
  private
  public :: add_to_nodes

contains

  !> Add the nodal values of a group to `sum` and count them in `count`; divide afterwards.
  pure subroutine add_to_nodes(connectivity, values, sum_at, count_at)
    integer, intent(in) :: connectivity(:, :)       !! (8, nelem)
    real(wp), intent(in) :: values(:, :)            !! (npoint, nelem)
    real(wp), intent(inout) :: sum_at(:), count_at(:)
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: fit(4), corner(4), at(8)
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
      do k = 1, 8
        sum_at(connectivity(k, e)) = sum_at(connectivity(k, e)) + at(k)
        count_at(connectivity(k, e)) = count_at(connectivity(k, e)) + 1
      end do
    end do
  end subroutine add_to_nodes

end module nodal_average
