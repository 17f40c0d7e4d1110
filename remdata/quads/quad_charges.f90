!> How far the number of quadrilaterals around a point is from the angle there: the measure of a mesh's connection.
!>
!> A point is charged with the square of the number of its quadrilaterals less its angle in right angles.
module quad_charges
  use kinds, only: wp
  use quad_mesh, only: quad_mesh_t
  implicit none
  private
  public :: charge, charge_of, saved, is_flat

  !> A charge at a contour counts so many times; corners wider than 1.6 right angles, as at an inner point with two
  !> quadrilaterals, and several narrower than 0.4, cost this.
  real(wp), parameter :: on_contour = 2.0_wp, widest = 1.6_wp, narrowest = 0.4_wp, cost_of_flat = 10.0_wp

contains

  !> What a point costs with so many quadrilaterals more than it has.
  pure function charge(mesh, point, more) result(cost)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: point, more
    real(wp) :: cost

    cost = charge_of(mesh%count(point) + more, mesh%ideal(point), mesh%fixed(point))
  end function charge

  pure function charge_of(number, ideal, fixed) result(cost)
    integer, intent(in) :: number
    real(wp), intent(in) :: ideal
    logical, intent(in) :: fixed
    real(wp) :: cost

    cost = (number - ideal)**2
    if (number < 1) cost = huge(cost)/100
    if (ideal > widest*number .or. (number > 1 .and. ideal < narrowest*number)) cost = cost + cost_of_flat
    if (fixed) cost = on_contour*cost
  end function charge_of

  !> What the points cost less than before when their numbers change.
  pure function saved(mesh, points, more) result(gained)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: points(:)   !! (n)
    integer, intent(in) :: more(:)     !! quadrilaterals that each gets (n)
    real(wp) :: gained
    integer :: k

    gained = 0
    do k = 1, size(points)
      gained = gained + charge(mesh, points(k), 0) - charge(mesh, points(k), more(k))
    end do
  end function saved

  !> Is a point of a contour the flat corner of a quadrilateral?
  pure function is_flat(mesh, point) result(yes)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: point
    logical :: yes

    yes = mesh%fixed(point) .and. mesh%ideal(point) > widest*mesh%count(point)
  end function is_flat

end module quad_charges
