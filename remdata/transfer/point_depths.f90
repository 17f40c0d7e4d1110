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

  !> Depths of the points of a row; what the state has where the die is nowhere near.
  pure subroutine measure_depths(scene, g, x, pilot, component, row, state)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: x(:, :)             !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilot(3)            !! of the die now [length and radian]
    integer, intent(in) :: component            !! that is the depth
    type(interval_points_t), intent(in) :: row
    real(wp), intent(inout) :: state(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    type(die_t) :: die
    real(wp), allocatable :: xi(:), weight(:)
    integer :: p

    call line_rule(scene%groups(g)%rule, xi, weight)
    die = present_die(scene%dies(scene%groups(g)%die), x)
    do p = 1, size(row%s)
      associate (depth => state(component, row%point(p), row%element(p)))
        depth = depth_at(die, in_pilot_axes(x(:, scene%groups(g)%connectivity(:, row%element(p))), pilot), xi(row%point(p)), depth)
      end associate
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
    type(die_t) :: die
    real(wp), allocatable :: xi(:), weight(:)
    logical :: control(size(row%s))
    integer :: p

    call line_rule(scene%groups(g)%rule, xi, weight)
    die = present_die(scene%dies(scene%groups(g)%die), x)
    depths = [(state(component + row%offset(p), row%point(p), row%element(p)), p=1, size(depths))]
    control = [(row%offset(p) == 0 .and. is_control_point(scene%groups(g)%rule, row%point(p)), p=1, size(depths))]
    do p = 1, size(depths)
      if (.not. control(p)) cycle
      if (any(.not. control) .and. .not. (row%s(p) > 0 .and. row%s(p) < row%length)) then
        depths(p) = depths(minloc(abs(row%s - row%s(p)), 1, mask=.not. control))
      else
        depths(p) = depth_at(die, in_pilot_axes(x(:, scene%groups(g)%connectivity(:, row%element(p))), pilot), &
                             xi(row%point(p)), depths(p))
      end if
    end do
  end function depths_where_they_lie

  !> Depth of a place of a side, or another where the die is nowhere near.
  pure function depth_at(die, side, xi, otherwise) result(depth)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: side(2, 3)   !! nodes, in the axes of the pilot [length]
    real(wp), intent(in) :: xi
    real(wp), intent(in) :: otherwise    !! [length]
    real(wp) :: depth                    !! [length]
    type(closest_point_t) :: closest
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    call closest_on_pieces(die, matmul(side, phi), 1, size(die%pieces, 3), closest)
    depth = otherwise
    if (closest%piece > 0) depth = closest%d
  end function depth_at

end module point_depths
