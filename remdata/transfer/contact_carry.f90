!> The state of contact on the new sides: along each run of contact, from where it begins to where it ends.
module contact_carry
  use boundary_sides, only: loop_t
  use contact_runs, only: run_t
  use contour_chain, only: arc_at, chain_length
  use kinds, only: wp
  use new_scene, only: middle_place
  use part_contour, only: contour_t
  use quadrature, only: line_rule
  use scene, only: axisymmetric, scene_t
  use shape_functions, only: line3
  use solution, only: solution_t
  use state_variables, only: component_names, find_variable, kind_contact => transfer_contact
  use stretches, only: length_between, stretch_t
  use text, only: string_t
  use transfer_contact, only: carry_along
  use transfer_report, only: balance_t
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: carry_contacts

  !> Points of a run in their order along it: arc length from its start, length each stands for, values.
  type :: row_t
    real(wp) :: length = 0.0_wp                  !! of the run [length]
    real(wp), allocatable :: s(:), weight(:)     !! [length], times the radius when axisymmetric
    integer, allocatable :: point(:), element(:)
  end type row_t

contains

  !> Contact variables and status of all groups of the new solution; open where there was no run. What their integrals along all
  !> runs are before and after is told.
  pure subroutine carry_contacts(old, from, contours, mesh, new, to, rows)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: from
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(in) :: mesh
    type(solution_t), intent(inout) :: to
    type(balance_t), allocatable, intent(out) :: rows(:)   !! [unit length, times the radius when axisymmetric]
    real(wp) :: x(2, size(old%mesh%coordinates, 2))
    type(row_t) :: row_old, row_new
    integer, allocatable :: carried(:)
    logical, allocatable :: conserved(:)
    integer :: c, k, g, i

    allocate (rows(0))
    x = old%mesh%coordinates + from%displacement
    do c = 1, size(contours)
      do k = 1, size(contours(c)%contacts)
        g = contours(c)%contacts(k)%run%group
        call old_row(old, g, contours(c)%loop, contours(c)%contacts(k)%run, x, row_old)
        call new_row(new, g, contours, c, k, mesh, row_new)
        call list_carried(old, g, carried, conserved)
        call carry_run(carried, conserved, row_old, row_new, from%groups(g)%committed, status_place(old, g), to%groups(g)%committed)
        call add_integrals(old, g, carried(pack([(i, i=1, size(carried))], conserved)), row_old, from%groups(g)%committed, &
                           row_new, to%groups(g)%committed, rows)
      end do
    end do
    do g = 1, size(to%groups)
      to%groups(g)%trial = to%groups(g)%committed
    end do
  end subroutine carry_contacts

  pure function status_place(scene, g) result(place)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    integer :: place

    place = find_variable(scene%groups(g)%variables, 'contact_status')
    if (place > 0) place = scene%groups(g)%variables(place)%first
  end function status_place

  !> Components that go along the contour, and the depth; those of corners of dies inside sides, of the same names, find themselves
  !> anew.
  pure subroutine list_carried(scene, g, carried, conserved)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    integer, allocatable, intent(out) :: carried(:)
    logical, allocatable, intent(out) :: conserved(:)
    integer :: v, i

    allocate (carried(0), conserved(0))
    do v = 1, size(scene%groups(g)%variables)
      associate (variable => scene%groups(g)%variables(v))
        if (find_variable(scene%groups(g)%variables, variable%name) < v) cycle
        ! the depth is found anew on the contour, and held against what it was
        if (variable%transfer /= kind_contact .and. variable%name /= 'penetration') cycle
        carried = [carried, (variable%first + i, i=0, variable%ncomp - 1)]
        ! forces and work are sums along the run, a slip is none
        conserved = [conserved, spread(variable%unit /= 'length', 1, variable%ncomp)]
      end associate
    end do
  end subroutine list_carried

  !> Old points of a group that lie in a run.
  pure subroutine old_row(scene, g, loop, run, x, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(loop_t), intent(in) :: loop
    type(run_t), intent(in) :: run
    real(wp), intent(in) :: x(:, :)
    type(row_t), intent(out) :: row
    real(wp), allocatable :: xi(:), weight(:)
    type(stretch_t) :: part
    integer :: side, number, e, p

    allocate (row%s(0), row%weight(0), row%point(0), row%element(0))
    call line_rule(scene%groups(g)%npoint, xi, weight)
    if (.not. run%from%xi > -1) call add_neighbour(scene, g, loop, x, run%from%side - 1, 1.0_wp, row)
    do side = run%from%side, run%to%side
      number = modulo(side - 1, size(loop%sides, 2)) + 1
      associate (nodes => x(:, loop%sides(:, number)))
        part%points = nodes
        part%range = [-1.0_wp, 1.0_wp]
        if (side == run%from%side) part%range(1) = run%from%xi
        if (side == run%to%side) part%range(2) = run%to%xi
        e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, number), 1)
        do p = 1, size(xi)
          if (e == 0 .or. xi(p) < part%range(1) .or. xi(p) > part%range(2)) cycle
          call add_point(row%length + length_between(part, part%range(1), xi(p)), &
                         weight(p)*stretch_at(nodes, xi(p), scene%plane_state == axisymmetric), p, e, row)
        end do
      end associate
      row%length = row%length + length_between(part, part%range(1), part%range(2))
    end do
    if (.not. run%to%xi < 1) call add_neighbour(scene, g, loop, x, run%to%side + 1, -1.0_wp, row)
  end subroutine old_row

  !> The point that a side before or behind a run has in the node where the run begins (so far) or ends.
  pure subroutine add_neighbour(scene, g, loop, x, side, at, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, side
    type(loop_t), intent(in) :: loop
    real(wp), intent(in) :: x(:, :), at
    type(row_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: stretch
    integer :: n, e, p

    n = modulo(side - 1, size(loop%sides, 2)) + 1
    e = findloc(scene%groups(g)%connectivity(2, :), loop%sides(2, n), 1)
    if (e == 0) return
    call line_rule(scene%groups(g)%npoint, xi, weight)
    stretch = stretch_at(x(:, loop%sides(:, n)), at, scene%plane_state == axisymmetric)
    do p = 1, size(xi)
      if (abs(xi(p) - at) > 0) cycle
      call add_point(row%length, weight(p)*stretch, p, e, row)
    end do
  end subroutine add_neighbour

  !> Points of other sides of the group in the nodes where the sides of a row begin and end.
  pure subroutine add_neighbours(scene, g, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    type(row_t), intent(inout) :: row
    real(wp), allocatable :: xi(:), weight(:)
    logical :: inside(size(scene%groups(g)%connectivity, 2))
    real(wp) :: stretch, at
    integer :: ends(2), k, e, p

    call line_rule(scene%groups(g)%npoint, xi, weight)
    associate (sides => scene%groups(g)%connectivity)
      ends(1) = sides(1, row%element(minloc(row%s, 1)))
      ends(2) = sides(3, row%element(maxloc(row%s, 1)))
      inside = .false.
      inside(row%element) = .true.
      do e = 1, size(inside)
        do k = 1, 2
          if (inside(e) .or. sides(5 - 2*k, e) /= ends(k)) cycle
          at = 3 - 2*k
          stretch = stretch_at(scene%mesh%coordinates(:, sides(:, e)), at, scene%plane_state == axisymmetric)
          do p = 1, size(xi)
            if (abs(xi(p) - at) > 0) cycle
            call add_point(merge(0.0_wp, row%length, k == 1), weight(p)*stretch, p, e, row)
          end do
        end do
      end do
    end associate
  end subroutine add_neighbours

  !> d(length)/d(xi), times the radius.
  pure function stretch_at(x, xi, round) result(stretch)
    real(wp), intent(in) :: x(2, 3), xi
    logical, intent(in) :: round
    real(wp) :: stretch
    real(wp) :: phi(3), dphi(3)

    call line3(xi, phi, dphi)
    stretch = length_of(matmul(x, dphi))
    if (round) stretch = stretch*dot_product(x(1, :), phi)
  end function stretch_at

  pure subroutine add_point(s, weight, point, element, row)
    real(wp), intent(in) :: s, weight
    integer, intent(in) :: point, element
    type(row_t), intent(inout) :: row

    row%s = [row%s, s]
    row%weight = [row%weight, weight]
    row%point = [row%point, point]
    row%element = [row%element, element]
  end subroutine add_point

  !> New points of a group on the stretches of a run.
  pure subroutine new_row(scene, g, contours, c, run, mesh, row)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, c, run
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(in) :: mesh
    type(row_t), intent(out) :: row
    type(row_t) :: unsorted
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: start, from, to, total
    integer, allocatable :: order(:)
    logical :: taken((size(mesh%sides) + 2)*abs(scene%groups(g)%npoint))
    integer :: k, e, p

    allocate (unsorted%s(0), unsorted%weight(0), unsorted%point(0), unsorted%element(0))
    call line_rule(scene%groups(g)%npoint, xi, weight)
    associate (chain => contours(c)%chain, contact => contours(c)%contacts(run))
      total = chain_length(chain)
      start = chain%arc(contact%first - 1)
      row%length = modulo(chain%arc(contact%next - 1) - start, total)
      if (.not. row%length > 0) row%length = total
      unsorted%length = row%length
      do k = 1, size(mesh%sides)
        if (mesh%sides(k)%chain /= c) cycle
        associate (place => middle_place(contours, mesh%sides(k)))
          if (chain%stretches(place%stretch)%run /= run) cycle
        end associate
        e = findloc(scene%groups(g)%connectivity(2, :), mesh%sides(k)%nodes(2), 1)
        if (e == 0) cycle
        from = modulo(arc_at(chain, mesh%sides(k)%from) - start, total)
        to = modulo(arc_at(chain, mesh%sides(k)%to) - start, total)
        if (from > row%length) from = 0
        if (.not. to > from) to = row%length
        do p = 1, size(xi)
          call add_point(from + 0.5_wp*(1 + xi(p))*(to - from), weight(p)*stretch_at(mesh%coordinates(:, mesh%sides(k)%nodes), &
                                                                          xi(p), scene%plane_state == axisymmetric), p, e, unsorted)
        end do
      end do
    end associate
    if (size(unsorted%s) > 0) call add_neighbours(scene, g, unsorted)
    allocate (order(size(unsorted%s)))
    taken = .false.
    do k = 1, size(order)
      order(k) = minloc(unsorted%s, 1, mask=.not. taken(:size(order)))
      taken(order(k)) = .true.
    end do
    row%s = unsorted%s(order)
    row%weight = unsorted%weight(order)
    row%point = unsorted%point(order)
    row%element = unsorted%element(order)
  end subroutine new_row

  pure subroutine carry_run(carried, conserved, row_old, row_new, before, status, after)
    integer, intent(in) :: carried(:)
    logical, intent(in) :: conserved(:)   !! the integral along the run is kept
    type(row_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :)
    integer, intent(in) :: status
    real(wp), intent(inout) :: after(:, :, :)
    real(wp) :: old(size(carried), size(row_old%s)), new(size(carried), size(row_new%s)), change(size(carried))
    integer :: p, v, nearest

    if (size(row_old%s) == 0) return
    do p = 1, size(row_old%s)
      old(:, p) = before(carried, row_old%point(p), row_old%element(p))
    end do
    do v = 1, size(carried)
      call carry_along(row_old%length, row_old%s, old(v:v, :), row_old%weight, row_new%length, row_new%s, row_new%weight, 2, &
                       conserved(v), new(v:v, :), change(v:v))
    end do
    do p = 1, size(row_new%s)
      after(carried, row_new%point(p), row_new%element(p)) = new(:, p)
      if (status == 0) cycle
      nearest = minloc(abs(row_old%s*row_new%length - row_new%s(p)*row_old%length), 1)
      after(status, row_new%point(p), row_new%element(p)) = before(status, row_old%point(nearest), row_old%element(nearest))
    end do
  end subroutine carry_run

  !> Add what the variables of a run sum up to, each to the row of its name.
  pure subroutine add_integrals(scene, g, components, row_old, before, row_new, after, rows)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g, components(:)
    type(row_t), intent(in) :: row_old, row_new
    real(wp), intent(in) :: before(:, :, :), after(:, :, :)
    type(balance_t), allocatable, intent(inout) :: rows(:)
    type(string_t), allocatable :: names(:)
    type(balance_t) :: row
    integer :: k, place

    call component_names(scene%groups(g)%variables, names)
    do k = 1, size(components)
      associate (component => components(k))
        row%name = 'contact '//names(component)%s
        row%transfer = kind_contact
        place = position_of(rows, row%name)
        if (place > size(rows)) rows = [rows, row]
        rows(place)%before = rows(place)%before + sum_along(row_old, before(component, :, :))
        rows(place)%after = rows(place)%after + sum_along(row_new, after(component, :, :))
        rows(place)%carried = rows(place)%after
        rows(place)%limited = rows(place)%after
        rows(place)%magnitude = rows(place)%magnitude + sum_along(row_old, abs(before(component, :, :)))
        rows(place)%largest_before = max(rows(place)%largest_before, largest_along(row_old, before(component, :, :)))
        rows(place)%largest_after = max(rows(place)%largest_after, largest_along(row_new, after(component, :, :)))
      end associate
    end do
  end subroutine add_integrals

  !> Row of a name, one more than there are when it is not among them.
  pure function position_of(rows, name) result(place)
    type(balance_t), intent(in) :: rows(:)
    character(len=*), intent(in) :: name
    integer :: place

    do place = 1, size(rows)
      if (rows(place)%name == name) return
    end do
  end function position_of

  pure function sum_along(row, values) result(total)
    type(row_t), intent(in) :: row
    real(wp), intent(in) :: values(:, :)   !! (point, element)
    real(wp) :: total
    integer :: p

    total = 0
    do p = 1, size(row%s)
      total = total + row%weight(p)*values(row%point(p), row%element(p))
    end do
  end function sum_along

  pure function largest_along(row, values) result(largest)
    type(row_t), intent(in) :: row
    real(wp), intent(in) :: values(:, :)   !! (point, element)
    real(wp) :: largest
    integer :: p

    largest = 0
    do p = 1, size(row%s)
      largest = max(largest, abs(values(row%point(p), row%element(p))))
    end do
  end function largest_along

end module contact_carry
