!> Depths of points of contact in their die by where their sides lie.
!>
!> What the state has is another depth at a control point, that of the side all along (control_point_contact), and at a corner of
!> the die within a side, along a normal of its own of which a part makes no pressure (corner_contact). The depths of the new mesh
!> are compared with where the old sides were.
module point_depths
  use closest_point, only: closest_point_t
  use curve_search, only: closest_on_pieces
  use dies, only: die_t, in_pilot_axes, present_die
  use interval_points, only: interval_points_t
  use kinds, only: wp
  use quadrature, only: is_control_point, line_rule
  use scene, only: scene_t
  use shape_functions, only: line3
  implicit none
  private
  public :: depths_where_they_lie, measure_depths

contains

  !> Put the depths of all points of a row where their sides lie.
  pure subroutine measure_depths(scene, g, x, pilot, component, row, state)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: x(:, :)             !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilot(3)            !! of the die now [length and radian]
    integer, intent(in) :: component            !! that is the depth
    type(interval_points_t), intent(in) :: row  !! of points alone, no corners of the die
    real(wp), intent(inout) :: state(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    real(wp) :: depths(size(row%s))
    integer :: p

    depths = depths_of_state(component, row, state)
    call measure(scene, g, x, pilot, row, spread(.true., 1, size(depths)), depths)
    do p = 1, size(depths)
      state(component, row%point(p), row%element(p)) = depths(p)
    end do
  end subroutine measure_depths

  !> Depths of the points of an interval: of those whose state has another, where their sides lie. A control point at an end of the
  !> interval, beyond which its side leaves the die, has that of the point beside it.
  pure function depths_where_they_lie(scene, g, x, pilot, component, row, state) result(depths)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: x(:, :)            !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilot(3)           !! of the die now [length and radian]
    integer, intent(in) :: component           !! that is the depth
    type(interval_points_t), intent(in) :: row
    real(wp), intent(in) :: state(:, :, :)     !! (nstate, npoint, nside) [unit of each component]
    real(wp) :: depths(size(row%s))            !! [length]
    logical, dimension(size(row%s)) :: control, leaves
    integer :: p

    depths = depths_of_state(component, row, state)
    control = [(row%offset(p) == 0 .and. is_control_point(scene%groups(g)%rule, row%point(p)), p=1, size(depths))]
    if (.not. any(control)) return
    leaves = control .and. any(.not. control) .and. .not. (row%s > 0 .and. row%s < row%length)
    call measure(scene, g, x, pilot, row, control .and. .not. leaves, depths)
    do p = 1, size(depths)
      if (leaves(p)) depths(p) = depths(minloc(abs(row%s - row%s(p)), 1, mask=.not. control))
    end do
  end function depths_where_they_lie

  !> What the state has.
  pure function depths_of_state(component, row, state) result(depths)
    integer, intent(in) :: component
    type(interval_points_t), intent(in) :: row
    real(wp), intent(in) :: state(:, :, :)
    real(wp) :: depths(size(row%s))   !! [length]
    integer :: p

    depths = [(state(component + row%offset(p), row%point(p), row%element(p)), p=1, size(depths))]
  end function depths_of_state

  !> Depths of some points of a row where their sides lie; others, and where the die is nowhere near, stay.
  pure subroutine measure(scene, g, x, pilot, row, some, depths)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: x(:, :), pilot(3)
    type(interval_points_t), intent(in) :: row
    logical, intent(in) :: some(:)           !! (npoint)
    real(wp), intent(inout) :: depths(:)     !! (npoint) [length]
    type(die_t) :: die
    type(closest_point_t) :: closest
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: side(2, 3), phi(3), dphi(3)
    integer :: p

    call line_rule(scene%groups(g)%rule, xi, weight)
    die = present_die(scene%dies(scene%groups(g)%die), x)
    do p = 1, size(depths)
      if (.not. some(p)) cycle
      call line3(xi(row%point(p)), phi, dphi)
      side = in_pilot_axes(x(:, scene%groups(g)%connectivity(:, row%element(p))), pilot)
      call closest_on_pieces(die, matmul(side, phi), 1, size(die%pieces, 3), closest)
      if (closest%piece > 0) depths(p) = closest%d
    end do
  end subroutine measure

end module point_depths
