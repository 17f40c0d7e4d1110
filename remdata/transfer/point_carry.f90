!> Transfer of contact at points of the contour (point_contacts) to the nodes of the new mesh that are nearest.
!>
!> What is an integral over sides, as a force is, is kept as such, whatever the lengths of old and new sides are; other variables
!> are those of the old point that presses most.
module point_carry
  use contact_carry, only: add_integrals, list_carried
  use corrected_contours, only: contour_t
  use fields, only: pilot_field
  use interval_points, only: component_row, interval_points_t, status_row, surface
  use kinds, only: wp
  use old_interval_points, only: old_row
  use point_contacts, only: point_contact_t
  use point_depths, only: measure_depths
  use quadrature, only: is_control_point, line_rule
  use scene, only: role_heat_contact, scene_t
  use shape_functions, only: line3
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use transfer_report, only: carried_quantity_t
  use vectors, only: length_of
  implicit none
  private
  public :: carry_points

  !> Points of the new sides are at one place within this share of a side.
  real(wp), parameter :: same_place = 1.0e-6_wp

contains

  !> Contact variables and status at the points of contact of all contours, added to what intervals have there. Integrals before
  !> and after are added to the rows of their names.
  pure subroutine carry_points(old, from, contours, new, to, rows)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(solution_t), intent(inout) :: to
    type(carried_quantity_t), allocatable, intent(inout) :: rows(:)   !! (nrow) integrals; over the length, or per radian
    type(interval_points_t) :: row_old, row_new
    integer, allocatable :: carried(:), along_die(:)
    logical, allocatable :: conserved(:)
    real(wp) :: x(2, size(old%mesh%coordinates, 2))
    integer :: c, k, g, h, i, most

    x = present_coordinates(old, from)
    do c = 1, size(contours)
      if (.not. allocated(contours(c)%points)) cycle
      do k = 1, size(contours(c)%points)
        associate (point => contours(c)%points(k))
          g = point%interval%group
          call new_points(new, g, point, row_new)
          if (size(row_new%s) == 0) cycle
          do h = 1, size(old%groups)
            if (h /= g .and. .not. (old%groups(h)%role == role_heat_contact .and. old%groups(h)%host == g)) cycle
            call old_row(old, g, contours(c)%loop, point%interval, x, from%groups(g)%committed, h == g, row_old)
            if (size(row_old%s) == 0) cycle
            call list_carried(old, h, carried, conserved)
            along_die = [integer ::]
            if (h == g) along_die = rows_of(old, g, [character(len=9) :: 'die_piece', 'die_xi'])
            most = strongest(from%groups(g)%committed, rows_of(old, g, ['pressure']), h == g, row_old)
            call carry_one(carried, conserved, [along_die, pack([status_row(old, h)], status_row(old, h) > 0)], most, row_old, &
                           row_new, from%groups(h)%committed, to%groups(h)%committed)
            ! the contour is the part's own there
            if (h == g .and. (row_old%offset(most) > 0 .or. is_control_point(old%groups(g)%rule, row_old%point(most)))) &
              call measure_depths(new, g, new%mesh%coordinates, to%fields(pilot_field)%value(:, new%groups(g)%die), &
                                  component_row(new, g, 'penetration'), row_new, to%groups(g)%committed)
            call add_integrals(old, h, carried(pack([(i, i=1, size(carried))], conserved)), row_old, from%groups(h)%committed, &
                               row_new, to%groups(h)%committed, rows)
          end do
        end associate
      end do
    end do
    do g = 1, size(to%groups)
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_points

  !> Numbers of components of a group by the names of their variables, those that there are.
  pure function rows_of(scene, g, names) result(rows)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    character(len=*), intent(in) :: names(:)
    integer, allocatable :: rows(:)
    integer :: k

    rows = [(component_row(scene, g, trim(names(k))), k=1, size(names))]
    rows = pack(rows, rows > 0)
  end function rows_of

  !> The point of a row with the largest force, as a number in the row.
  pure function strongest(state, pressure, with_corners, row) result(p)
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, element) of the contact group
    integer, intent(in) :: pressure(:)       !! number of the component, where there is one
    logical, intent(in) :: with_corners
    type(interval_points_t), intent(in) :: row
    integer :: p
    real(wp) :: force(size(row%s))
    integer :: k

    force = row%weight
    if (size(pressure) > 0 .and. with_corners) &
      force = [(row%weight(k)*state(pressure(1) + row%offset(k), row%point(k), row%element(k)), k=1, size(force))]
    p = maxloc(force, 1)
  end function strongest

  pure subroutine carry_one(carried, conserved, taken, from_point, row_old, row_new, before, after)
    integer, intent(in) :: carried(:)
    logical, intent(in) :: conserved(:)   !! the integral is kept
    integer, intent(in) :: taken(:)       !! components taken from one point
    integer, intent(in) :: from_point     !! that point of the old row
    type(interval_points_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)
    real(wp), intent(inout) :: after(:, :, :)
    real(wp) :: integral
    integer :: v, k, p

    associate (one => before(:, row_old%point(from_point), row_old%element(from_point)), offset => row_old%offset(from_point))
      do p = 1, size(row_new%s)
        after(taken, row_new%point(p), row_new%element(p)) = one(taken + offset)
      end do
      do v = 1, size(carried)
        integral = 0
        do k = 1, size(row_old%s)
          integral = integral + row_old%weight(k)*before(carried(v) + row_old%offset(k), row_old%point(k), row_old%element(k))
        end do
        do p = 1, size(row_new%s)
          associate (value => after(carried(v), row_new%point(p), row_new%element(p)))
            if (conserved(v)) then
              value = value + integral/sum(row_new%weight)
            else
              value = one(carried(v) + offset)
            end if
          end associate
        end do
      end do
    end associate
  end subroutine carry_one

  !> Points of contact of the new sides of a group in the node nearest to a point, or at the nearest place where they are in no
  !> node; of the whole sides around where it is on the axis and has no surface. None where the part around the point was cut off.
  pure subroutine new_points(scene, g, point, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(point_contact_t), intent(in) :: point
    type(interval_points_t), intent(out) :: row
    real(wp), allocatable :: xi(:), weight(:), apart(:, :), area(:, :)
    logical, allocatable :: near(:, :)
    real(wp) :: phi(3), dphi(3)
    integer :: e, p, n

    call line_rule(scene%groups(g)%rule, xi, weight)
    associate (sides => scene%groups(g)%connectivity, coordinates => scene%mesh%coordinates)
      allocate (apart(size(xi), size(sides, 2)), area(size(xi), size(sides, 2)))
      do e = 1, size(sides, 2)
        do p = 1, size(xi)
          call line3(xi(p), phi, dphi)
          apart(p, e) = length_of(matmul(coordinates(:, sides(:, e)), phi) - point%point)
          area(p, e) = surface(scene, g, coordinates(:, sides(:, e)), xi, weight, p)
        end do
      end do
    end associate
    near = apart <= minval(apart) + same_place*point%side_length
    if (minval(apart) > point%side_length) near = .false.
    if (.not. any(near .and. area > 0)) near = spread(any(near, 1), 1, size(xi)) .and. area > 0
    n = count(near)
    allocate (row%s(n), row%offset(n), row%reach(n))
    row%s = 0
    row%offset = 0
    row%reach = -1
    row%weight = pack(area, near)
    row%point = pack(spread([(p, p=1, size(xi))], 2, size(apart, 2)), near)
    row%element = pack(spread([(e, e=1, size(apart, 2))], 1, size(xi)), near)
  end subroutine new_points

end module point_carry
