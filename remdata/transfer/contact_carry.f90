!> Transfer of the contact state to the new sides: along each contact interval, from its beginning to its end.
module contact_carry
  use boundary_curves, only: boundary_curve_t, boundary_length, position_at_arc_length, position_t
  use contour_contacts, only: contact_t
  use corrected_contours, only: contour_t
  use fields, only: pilot_field
  use interval_points, only: component_row, interval_points_t, status_row
  use kinds, only: wp
  use new_interval_points, only: new_row, round_off
  use old_interval_points, only: old_row
  use point_depths, only: depths_where_they_lie
  use scene, only: role_heat_contact, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: component_names, find_variable, kind_contact => transfer_contact
  use text, only: string_t
  use tip_carry, only: ends_in_tips, put_on, take_off
  use transfer_contact, only: carry_along
  use transfer_report, only: carried_quantity_t
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: add_integrals, carry_contacts, list_carried

contains

  !> Contact variables and status of all groups of the new solution; open outside of contact intervals. Their integrals along all
  !> intervals before and after are reported.
  pure subroutine carry_contacts(old, from, contours, mesh, new, to, rows)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(new_mesh_t), intent(in) :: mesh
    type(solution_t), intent(inout) :: to
    type(carried_quantity_t), allocatable, intent(out) :: rows(:)   !! (nrow) integrals; over the length, or per radian
    real(wp) :: x(2, size(old%mesh%coordinates, 2))
    type(interval_points_t) :: row_old, row_new, row_of_points
    integer, allocatable :: carried(:)
    logical, allocatable :: conserved(:)
    real(wp), allocatable :: depths(:)
    logical :: in_tip(2)
    integer :: c, k, g, h, i, depth

    allocate (rows(0))
    x = present_coordinates(old, from)
    do c = 1, size(contours)
      do k = 1, size(contours(c)%contacts)
        g = contours(c)%contacts(k)%interval%group
        call old_row(old, g, contours(c)%loop, contours(c)%contacts(k)%interval, x, from%groups(g)%committed, .true., row_old)
        call old_row(old, g, contours(c)%loop, contours(c)%contacts(k)%interval, x, from%groups(g)%committed, .false., &
                     row_of_points)
        call new_row(new, g, contours, c, k, mesh, row_new)
        in_tip = ends_in_tips(old, g, row_old, from%groups(g)%committed)
        ! the group, and heat through its points
        do h = 1, size(old%groups)
          if (h /= g .and. .not. (old%groups(h)%role == role_heat_contact .and. old%groups(h)%host == g)) cycle
          if (h /= g) row_old = row_of_points
          call list_carried(old, h, carried, conserved)
          depth = 0
          if (h == g) depth = component_row(old, g, 'penetration')
          depths = [real(wp) ::]
          if (depth > 0) depths = depths_where_they_lie(old, g, x, from%fields(pilot_field)%value(:, old%groups(g)%die), depth, &
                                                        row_old, from%groups(g)%committed)
          call carry_interval(carried, conserved, findloc(carried, depth, 1), depths, in_tip, row_old, row_new, &
                              from%groups(h)%committed, status_row(old, h), to%groups(h)%committed)
          if (h == g) call place_on_die(new, g, contours(c)%boundary, contours(c)%contacts(k), row_new, to%groups(g)%committed)
          call add_integrals(old, h, carried(pack([(i, i=1, size(carried))], conserved)), row_old, from%groups(h)%committed, &
                             row_new, to%groups(h)%committed, rows)
        end do
      end do
    end do
    do g = 1, size(to%groups)
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_contacts

  !> Where on the die the points of an interval are: one that slides past a corner in the very first step is on the face it comes
  !> from (corner_release), and loses its pressure on a way, not at once.
  pure subroutine place_on_die(scene, g, boundary, contact, row, state)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(boundary_curve_t), intent(in) :: boundary
    type(contact_t), intent(in) :: contact
    type(interval_points_t), intent(in) :: row   !! of the new mesh
    real(wp), intent(inout) :: state(:, :, :)    !! (nstate, npoint, nside) [unit of each component]
    type(position_t) :: position
    integer :: p, first, last, piece, xi

    piece = component_row(scene, g, 'die_piece')
    if (piece == 0 .or. status_row(scene, g) == 0) return
    xi = component_row(scene, g, 'die_xi')
    first = contact%first
    last = modulo(contact%next - 2, size(boundary%arcs)) + 1
    do p = 1, size(row%s)
      ! at the ends of the interval other arcs begin
      if (row%s(p) <= 0) then
        position = position_t(first, boundary%arcs(first)%range(1))
      else if (row%s(p) >= row%length) then
        position = position_t(last, boundary%arcs(last)%range(2))
      else
        position = position_at_arc_length(boundary, modulo(boundary%arc_length(first - 1) + row%s(p), boundary_length(boundary)))
      end if
      associate (point => state(:, row%point(p), row%element(p)), arc => boundary%arcs(position%arc))
        if (nint(point(status_row(scene, g))) == 0 .or. arc%die /= contact%number) cycle
        point([piece, xi]) = [real(arc%piece, wp), min(max(position%xi, -1.0_wp), 1.0_wp)]
      end associate
    end do
  end subroutine place_on_die

  !> Components that are transferred along the contour, and the depth; those of die corners inside sides, which have the same names,
  !> are found again by the solver.
  pure subroutine list_carried(scene, g, carried, conserved)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                            !! group
    integer, allocatable, intent(out) :: carried(:)     !! (n) numbers of components
    logical, allocatable, intent(out) :: conserved(:)   !! (n) their integrals along an interval are kept
    integer :: v, i

    allocate (carried(0), conserved(0))
    do v = 1, size(scene%groups(g)%variables)
      associate (variable => scene%groups(g)%variables(v))
        if (find_variable(scene%groups(g)%variables, variable%name) < v) cycle
        ! the depth results from the contour, and is compared with the old one
        if (variable%transfer /= kind_contact .and. variable%name /= 'penetration') cycle
        carried = [carried, (variable%first + i, i=0, variable%ncomp - 1)]
        ! forces and work are integrals along the interval, a slip is not
        conserved = [conserved, spread(variable%unit /= 'length', 1, variable%ncomp)]
      end associate
    end do
  end subroutine list_carried

  pure subroutine carry_interval(carried, conserved, depth, depths, in_tip, row_old, row_new, before, status, after)
    integer, intent(in) :: carried(:)
    logical, intent(in) :: conserved(:)   !! the integral along the interval is kept
    integer, intent(in) :: depth          !! which of those carried is the depth; 0: none
    real(wp), intent(in) :: depths(:)     !! of the old points, where one is [length]
    logical, intent(in) :: in_tip(2)      !! the interval begins, ends in a corner of the die
    type(interval_points_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)
    integer, intent(in) :: status
    real(wp), intent(inout) :: after(:, :, :)
    real(wp) :: old(size(carried), size(row_old%s)), new(size(carried), size(row_new%s)), change(size(carried)), &
                in_tips(size(carried), 2)
    integer :: p, v, k, nearest

    if (size(row_old%s) == 0) return
    do p = 1, size(row_old%s)
      old(:, p) = before(carried + row_old%offset(p), row_old%point(p), row_old%element(p))
    end do
    if (depth > 0) old(depth, :) = depths
    call share_forces(row_old, old)
    in_tips = 0
    do k = 1, 2
      if (in_tip(k)) call take_off(row_old, row_new, k, conserved, old, in_tips(:, k))
    end do
    do v = 1, size(carried)
      call carry_along(row_old%length, row_old%s, old(v:v, :), row_old%weight, row_new%length, row_new%s, row_new%weight, 2, &
                       conserved(v), new(v:v, :), change(v:v))
    end do
    do k = 1, 2
      call put_on(row_new, k, in_tips(:, k), new)
    end do
    do p = 1, size(row_new%s)
      after(carried, row_new%point(p), row_new%element(p)) = new(:, p)
      if (status == 0) cycle
      nearest = minloc(abs(row_old%s*row_new%length - row_new%s(p)*row_old%length), 1)
      after(status, row_new%point(p), row_new%element(p)) = before(status + row_old%offset(nearest), &
                                                                     row_old%point(nearest), row_old%element(nearest))
    end do
  end subroutine carry_interval

  !> A corner of the die beside a node has a part of its weight, and the larger a pressure for it (corner_weights): both have the
  !> mean over the length that they stand for, be the points of the node those of an interval before, which the node hands over, or
  !> on the face beyond the corner.
  pure subroutine share_forces(row, values)
    type(interval_points_t), intent(in) :: row
    real(wp), intent(inout) :: values(:, :)   !! (component, npoint) [unit of each component]
    logical :: same(size(row%s))
    integer :: p, v

    do p = 1, size(row%s)
      if (row%reach(p) < 0) cycle
      same = row%offset == 0 .and. abs(row%s - row%s(p)) <= row%reach(p) + round_off*row%length
      same(p) = .true.
      if (count(same) < 2 .or. .not. sum(row%weight, mask=same) > 0) cycle
      do v = 1, size(values, 1)
        values(v, :) = merge(sum(values(v, :)*row%weight, mask=same)/sum(row%weight, mask=same), values(v, :), same)
      end do
    end do
  end subroutine share_forces

  !> Add the integrals of the variables of an interval, each to the row of its name.
  pure subroutine add_integrals(scene, g, components, row_old, before, row_new, after, rows)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g               !! group
    integer, intent(in) :: components(:)   !! (n) numbers of components
    type(interval_points_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)       !! (component, point, element), old [unit of each component]
    real(wp), intent(in) :: after(:, :, :)        !! (component, point, element), new [unit of each component]
    type(carried_quantity_t), allocatable, intent(inout) :: rows(:)   !! (nrow)
    type(string_t), allocatable :: names(:)
    type(carried_quantity_t) :: row
    integer :: k, r

    call component_names(scene%groups(g)%variables, names)
    do k = 1, size(components)
      associate (component => components(k))
        row%name = 'contact '//names(component)%s
        row%transfer = kind_contact
        r = row_of(rows, row%name)
        if (r > size(rows)) rows = [rows, row]
        rows(r)%before = rows(r)%before + sum_along(row_old, component, before)
        rows(r)%after = rows(r)%after + sum_along(row_new, component, after)
        rows(r)%carried = rows(r)%after
        rows(r)%limited = rows(r)%after
        rows(r)%magnitude = rows(r)%magnitude + sum_along(row_old, component, abs(before))
        rows(r)%largest_before = max(rows(r)%largest_before, largest_along(row_old, component, before))
        rows(r)%largest_after = max(rows(r)%largest_after, largest_along(row_new, component, after))
      end associate
    end do
  end subroutine add_integrals

  !> Row of a name, one more than there are when it is not among them.
  pure function row_of(rows, name) result(r)
    type(carried_quantity_t), intent(in) :: rows(:)
    character(len=*), intent(in) :: name
    integer :: r

    do r = 1, size(rows)
      if (rows(r)%name == name) return
    end do
  end function row_of

  pure function sum_along(row, component, values) result(total)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: component
    real(wp), intent(in) :: values(:, :, :)   !! (component, point, element)
    real(wp) :: total
    integer :: p

    total = 0
    do p = 1, size(row%s)
      total = total + row%weight(p)*values(component + row%offset(p), row%point(p), row%element(p))
    end do
  end function sum_along

  pure function largest_along(row, component, values) result(largest)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: component
    real(wp), intent(in) :: values(:, :, :)   !! (component, point, element)
    real(wp) :: largest
    integer :: p

    largest = 0
    do p = 1, size(row%s)
      largest = max(largest, abs(values(component + row%offset(p), row%point(p), row%element(p))))
    end do
  end function largest_along

end module contact_carry
