!> Transfer of contact at nodes on the axis, which hold a force of their own (axis_contact of the solver).
!>
!> At r = 0 no pressure on sides stands for what the point of a die does to the node there: without it a new mesh would begin
!> without the force of a cone that has entered a part. The node of the new mesh is at the same place and keeps the pressure, as
!> far as it is what matter around the point bears at most; the force goes with the discs that old and new sides give it: that of a
!> large disc would push a small element through. Its state is that of a corner at an end of its side.
module axis_carry
  use contact_carry, only: add_integrals, list_carried
  use corner_weights, only: area_of_disc
  use interval_points, only: interval_points_t
  use kinds, only: wp
  use scene, only: axisymmetric, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use transfer_report, only: carried_quantity_t
  use vectors, only: length_of
  implicit none
  private
  public :: carry_axis_nodes

  !> A radius below this share of a side is zero.
  real(wp), parameter :: no_radius = 1.0e-9_wp

contains

  !> States of all nodes on the axis that hold a force. Integrals before and after are added to the rows of their names.
  pure subroutine carry_axis_nodes(old, from, new, to, rows)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(solution_t), intent(inout) :: to
    type(carried_quantity_t), allocatable, intent(inout) :: rows(:)   !! (nrow) integrals; per radian
    type(interval_points_t) :: row_old, row_new
    integer, allocatable :: carried(:)
    logical, allocatable :: conserved(:)
    real(wp) :: x(2, size(old%mesh%coordinates, 2))
    integer :: g, e, k, i, place, status

    if (old%plane_state /= axisymmetric) return
    x = present_coordinates(old, from)
    do g = 1, size(old%groups)
      place = component_of(old, g, 'corner_place')
      status = component_of(old, g, 'corner_contact_status')
      if (place == 0 .or. status == 0 .or. old%groups(g)%pairs > 0) cycle
      call list_carried(old, g, carried, conserved)
      do e = 1, size(old%groups(g)%connectivity, 2)
        do k = 1, 3, 2
          call end_row(old, g, e, k, row_old)
          associate (state => from%groups(g)%committed(:, row_old%point(1), e))
            ! zero when open; at an end of the side it is the state of the node there
            if (nint(state(status)) == 0 .or. (k - 2)*state(place) < 1) cycle
            call nearest_end(new, g, x(:, old%groups(g)%connectivity(k, e)), row_new)
            if (size(row_new%s) == 0) cycle
            call carry_node(old, g, carried, state, to%groups(g)%committed(:, row_new%point(1), row_new%element(1)))
            to%groups(g)%committed(place, row_new%point(1), row_new%element(1)) = &
              end_of(new, g, row_new%element(1)) - 2
          end associate
          call add_integrals(old, g, carried(pack([(i, i=1, size(carried))], conserved)), row_old, from%groups(g)%committed, &
                             row_new, to%groups(g)%committed, rows)
        end do
      end do
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_axis_nodes

  !> State of a node.
  pure subroutine carry_node(scene, g, carried, before, after)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g              !! group
    integer, intent(in) :: carried(:)     !! (n) numbers of components of a point
    real(wp), intent(in) :: before(:)     !! (component) [unit of each component]
    real(wp), intent(inout) :: after(:)   !! (component) [unit of each component]
    integer :: taken(4)

    taken = [component_of(scene, g, 'corner_contact_status'), component_of(scene, g, 'corner_die_piece'), &
             component_of(scene, g, 'corner_die_xi'), component_of(scene, g, 'corner_share')]
    after(taken) = before(taken)
    associate (of_corner => carried + offset_of_corner(scene, g))
      after(of_corner) = before(of_corner)
    end associate
  end subroutine carry_node

  !> The state of the node at one end of a side, as a row of one point with the disc that the node stands for.
  pure subroutine end_row(scene, g, e, k, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, e, k   !! group, side, and 1 or 3: its end
    type(interval_points_t), intent(out) :: row

    row%s = [0.0_wp]
    row%reach = [-1.0_wp]
    associate (x => scene%mesh%coordinates, side => scene%groups(g)%connectivity(:, e))
      row%weight = [area_of_disc(length_of(x(:, side(3)) - x(:, side(1))))]
    end associate
    row%point = [merge(1, scene%groups(g)%rule%n, k == 1)]
    row%element = [e]
    row%offset = [offset_of_corner(scene, g)]
  end subroutine end_row

  !> The same of the end on the axis that is nearest to a point; no row where a group has none.
  pure subroutine nearest_end(scene, g, point, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: point(2)   !! [length]
    type(interval_points_t), intent(out) :: row
    real(wp) :: least, apart
    integer :: e, k

    allocate (row%s(0))
    least = huge(least)
    do e = 1, size(scene%groups(g)%connectivity, 2)
      k = end_of(scene, g, e)
      if (k == 0) cycle
      apart = length_of(scene%mesh%coordinates(:, scene%groups(g)%connectivity(k, e)) - point)
      if (apart >= least) cycle
      least = apart
      call end_row(scene, g, e, k, row)
    end do
  end subroutine nearest_end

  !> The end of a side that lies on the axis: 1 or 3, 0 where none does, or the side lies on it.
  pure function end_of(scene, g, e) result(k)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, e
    integer :: k

    associate (x => scene%mesh%coordinates(:, scene%groups(g)%connectivity(:, e)))
      associate (on_axis => x(1, :) <= no_radius*length_of(x(:, 3) - x(:, 1)))
        k = 0
        if (.not. on_axis(2)) k = merge(1, merge(3, 0, on_axis(3)), on_axis(1))
      end associate
    end associate
  end function end_of

  !> What is added to the number of a component of a point for that of a corner.
  pure function offset_of_corner(scene, g) result(offset)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    integer :: offset

    offset = component_of(scene, g, 'corner_pressure') - component_of(scene, g, 'pressure')
  end function offset_of_corner

  !> Number of the first component of a variable; 0 where a group has none of the name.
  pure function component_of(scene, g, name) result(row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    character(len=*), intent(in) :: name
    integer :: row

    row = find_variable(scene%groups(g)%variables, name)
    if (row > 0) row = scene%groups(g)%variables(row)%first
  end function component_of

end module axis_carry
