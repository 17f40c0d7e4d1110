!> Quadrilaterals between given points and new ones: what a mesher makes of the contours of a body.
module quad_lists
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  implicit none
  private
  public :: quads_t, refuse_mesh

  type :: quads_t
    real(wp), allocatable :: inside(:, :)   !! new points, numbered after the given ones (2, n) [length]
    integer, allocatable :: corners(:, :)   !! (4, nelem), in either direction; the fourth is 0 for a triangle
  end type quads_t

contains

  !> Reason why a mesh is refused, and advice.
  pure subroutine refuse_mesh(who, why, error)
    character(len=*), intent(in) :: who   !! the mesher
    character(len=*), intent(in) :: why
    type(error_t), allocatable, intent(out) :: error

    call fail(error, exit_no_convergence, 'remdata: what '//who//' made is no mesh of the contour: '//why, &
              'give ZONE cards, or other sizes of elements')
  end subroutine refuse_mesh

end module quad_lists
