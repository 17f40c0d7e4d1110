!> Where the force between a point of a side and a side of another body goes, and its derivatives: to the nodes of both, by their
!> shape functions, as a force and its opposite.
module pair_forces
  use kinds, only: wp
  implicit none
  private
  public :: spread_force, spread_matrix

contains

  !> The force q on the side met, and its opposite on the point's side.
  pure subroutine spread_force(share, q, place, force)
    real(wp), intent(in) :: share(6)        !! of the nodes of the point's side (negative), and of the side met [-]
    real(wp), intent(in) :: q(2)            !! [force]
    integer, intent(in) :: place(:)         !! (nunknown) in the element's rows
    real(wp), intent(inout) :: force(:)     !! (ndof) of the element [force]
    integer :: i

    do i = 1, 6
      force(place(row(i, 1))) = force(place(row(i, 1))) + share(i)*q(1)
      force(place(row(i, 2))) = force(place(row(i, 2))) + share(i)*q(2)
    end do
  end subroutine spread_force

  pure subroutine spread_matrix(share, dq, place, stiffness)
    real(wp), intent(in) :: share(6)               !! as in spread_force [-]
    real(wp), intent(in) :: dq(:, :)               !! (2, nunknown) derivatives of that force [force/unknown]
    integer, intent(in) :: place(:)                !! (nunknown) in the element's rows
    real(wp), intent(inout) :: stiffness(:, :)     !! (ndof, ndof) of the element [force/unknown]
    integer :: i, j, c

    do j = 1, size(place)
      do c = 1, 2
        do i = 1, 6
          associate (entry => stiffness(place(row(i, c)), place(j)))
            entry = entry + share(i)*dq(c, j)
          end associate
        end do
      end do
    end do
  end subroutine spread_matrix

  !> Local unknown of component c of node i: side nodes 1 to 3, nodes of the side met 4 to 6.
  pure function row(i, c)
    integer, intent(in) :: i, c
    integer :: row

    row = merge(i, i + 3, i <= 3) + 3*(c - 1)
  end function row

end module pair_forces
