!> Derivatives of heat through contact along the motion of sides and dies, where motion and temperature are solved for together.
!>
!> Heat at a point depends on the motion through what contact makes of it: pressure and gap, on which the conductance depends, the
!> facing point and the tangent of the die there, the area, and the work of friction that becomes heat. The element
!> (elem_heat_contact) is linearised at given contact. Here contact and heat of a side are computed again with each of its unknowns
!> moved by a little to both sides, and central differences take the place of the columns of the motion: exact for what is of second
!> order in the motion, as pressure times slip. Where a point opens, closes, sticks or slips the other way within that little, heat
!> has a kink or a jump: the difference is then taken to the side where all points are as they are now; where there is none the
!> column of the element stands.
!>
!> They hold near equilibrium alone. Far from it the pressures of penalties change from one iterate to the next by many times the
!> range of a table of conductances (PRESS): the conductance stays within its table, its linear continuation does not, and the
!> temperatures of the next iterate are beyond all bounds. So conductances are handed over first (exchange_in_turns), from those
!> that the last step has left, whenever the residual is small. Once they hardly change they follow pressure and gap, and the
!> columns are in the matrix whatever the residual: without them heat that leaves by the pressure that it lowers goes to and fro
!> (J. Nocedal, S.J. Wright, Numerical Optimization, 2nd ed., Springer 2006, sec. 11.2: the order of convergence is that of the
!> matrices near the solution).
module contact_heat_tangent
  use drivers, only: at_corner_place, at_status
  use elem_api, only: instant_t, layout_t, report_t
  use element_loop, only: gather_geometry, gather_matrix
  use equations, only: equations_t, solves_heat
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use law_api, only: contact_open
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use step_instants, only: make_instant
  implicit none
  private
  public :: couples_contact, follow_contact

  !> Step of differences over the length of a side, far below the depth that penalties allow; or, where that is less, over the least
  !> depth or gap of its points, so that few open or close within it; and the least, far above the round-off of places.
  real(wp), parameter :: little = 1.0e-7_wp, of_depth = 0.1_wp, least = 1.0e-10_wp

  !> One element of a group, as the element loop calls it.
  type :: evaluated_side_t
    integer :: g = 0, e = 0, law = 1
    type(layout_t) :: layout
    !> (ndof) unknowns; (nnode) nodes.
    integer, allocatable :: dof(:), nodes(:)
    !> (2, nnode, 1) at the start of the step [length]; (ndof, 1) motion of the step, and values at its start [unknown].
    real(wp), allocatable :: x(:, :, :), motion(:, :), start(:, :)
    !> (nstate, npoint, 1) at the start and at the end of the step [unit of each component].
    real(wp), allocatable :: committed(:, :, :), trial(:, :, :)
    !> (ndriver, 2, npoint, 1) [unit of each driver]
    real(wp), allocatable :: drivers(:, :, :, :)
    !> (ndof, 1) [residual]
    real(wp), allocatable :: force(:, :)
  end type evaluated_side_t

contains

  !> The present solve has heat through contact together with the motion.
  pure function couples_contact(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes

    yes = any(equations%drivers%is_of_heat_contact) .and. solves_heat(scene, equations) &
          .and. equations%solves(equations%now)%own(displacement_field)
  end function couples_contact

  !> Put the columns into the matrix of the last evaluation, which was at the motion `du`. Nothing is done where the present solve
  !> has no heat through contact together with the motion.
  subroutine follow_contact(scene, equations, solution, dt, du)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    type(instant_t) :: instant
    integer :: g, e

    if (.not. couples_contact(scene, equations) .or. any(equations%drivers%hands_conductance)) return
    associate (solve => equations%solves(equations%now))
      call make_instant(scene, equations, solution, dt, du, .false., instant)
      instant%pairs = solution%pairs
      do g = 1, size(scene%groups)
        if (.not. equations%drivers(g)%is_of_heat_contact) cycle
        do e = 1, size(scene%groups(g)%connectivity, 2)
          call follow_side(scene, equations, solution, instant, du, g, e)
        end do
      end do
      call gather_matrix(solve%pattern, equations%buffers, solve%values)
    end associate
  end subroutine follow_contact

  !> The columns of one side: of its nodes, of those of the pieces that it may face, and of the pilot of the die.
  subroutine follow_side(scene, equations, solution, instant, du, g, e)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    type(instant_t), intent(inout) :: instant
    real(wp), intent(in) :: du(:)
    integer, intent(in) :: g, e
    integer, parameter :: moved(2) = [displacement_field, pilot_field]
    type(evaluated_side_t) :: heat, contact
    real(wp) :: length, step
    integer :: k, c, i, field, node, d

    call take_side(scene, equations, solution, instant, du, g, e, heat)
    call take_side(scene, equations, solution, instant, du, scene%groups(g)%host, e, contact)
    length = maxval(maxval(contact%x(:, 1:3, 1), 2) - minval(contact%x(:, 1:3, 1), 2))
    do k = 1, size(moved)
      field = findloc(heat%layout%field(:heat%layout%nfield), moved(k), 1)
      if (field == 0) cycle
      do c = 1, count(heat%layout%first(:, field) > 0)
        do i = 1, heat%layout%count(field)
          d = heat%dof(heat%layout%first(c, field) + i - 1)
          if (equations%solves(equations%now)%equation(d) == 0) cycle
          node = 0
          if (moved(k) == displacement_field) node = heat%nodes(i)
          ! a node may stand there several times
          if (i > 1 .and. node > 0) then
            if (any(heat%nodes(:i - 1) == node)) cycle
          end if
          step = length_of_step(scene%groups(contact%g), contact%trial(:, :, 1), length)
          if (equations%dofs%is_angle(d)) step = step/equations%size
          call set_column(scene, equations, solution, instant, d, node, c, step, heat, contact)
        end do
      end do
    end do
  end subroutine follow_side

  !> The column of an unknown: central difference, or to the side where contact is as it is now.
  subroutine set_column(scene, equations, solution, instant, d, node, component, step, heat, contact)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    type(instant_t), intent(inout) :: instant
    integer, intent(in) :: d, node, component   !! the unknown; of a node, which, and along which axis
    real(wp), intent(in) :: step                !! [unknown]
    type(evaluated_side_t), intent(inout) :: heat, contact
    real(wp) :: force(size(heat%dof), -1:1)
    integer :: ends(2), s, f, m, j, own

    associate (pattern => equations%solves(equations%now)%pattern, ndof => size(heat%dof))
      f = pattern%force_start(heat%g) + (heat%e - 1)*ndof
      force(:, 0) = equations%buffers%force(f + 1:f + ndof)
      ends = 0
      do s = -1, 1, 2
        call move(s*step)
        call compute(scene, equations, instant, contact)
        if (same_contact(scene%groups(contact%g), scene%groups(heat%g)%heat_contact%friction > 0, contact%trial, &
                         solution%groups(contact%g)%trial(:, :, contact%e))) then
          call drive(equations, contact, heat)
          call compute(scene, equations, instant, heat)
          force(:, s) = heat%force(:, 1)
          ends((s + 3)/2) = s
        end if
        call move(-s*step)
      end do
      if (all(ends == 0)) return
      own = findloc(heat%dof, d, 1)
      do j = 1, ndof
        if (heat%dof(j) /= d) cycle
        ! the whole derivative stands once
        m = pattern%matrix_start(heat%g) + ((heat%e - 1)*ndof + j - 1)*ndof
        equations%buffers%matrix(m + 1:m + ndof) = 0
        if (j == own) equations%buffers%matrix(m + 1:m + ndof) = (force(:, ends(2)) - force(:, ends(1)))/((ends(2) - ends(1))*step)
      end do
    end associate

  contains

    !> Move the unknown wherever it stands, in the pieces of a deformable die too.
    subroutine move(by)
      real(wp), intent(in) :: by   !! [unknown]
      integer :: q, n

      where (heat%dof == d) heat%motion(:, 1) = heat%motion(:, 1) + by
      where (contact%dof == d) contact%motion(:, 1) = contact%motion(:, 1) + by
      if (node == 0 .or. .not. allocated(instant%dies)) return
      associate (die => instant%dies(scene%groups(heat%g)%die))
        if (.not. allocated(die%nodes)) return
        do q = 1, size(die%nodes, 2)
          do n = 1, 3
            if (die%nodes(n, q) == node) die%pieces(component, n, q) = die%pieces(component, n, q) + by
          end do
        end do
      end associate
    end subroutine move

  end subroutine set_column

  !> Step of the differences of a side.
  pure function length_of_step(group, state, length) result(step)
    type(group_t), intent(in) :: group          !! of contact
    real(wp), intent(in) :: state(:, :)         !! (nstate, npoint) [unit of each component]
    real(wp), intent(in) :: length              !! of the side [length]
    real(wp) :: step
    integer :: v

    step = little*length
    v = find_variable(group%variables, 'penetration')
    if (v == 0) return
    associate (depth => abs(state(group%variables(v)%first, :)))
      if (any(depth > least*length)) step = min(step, of_depth*minval(depth, mask=depth > least*length))
    end associate
    step = max(step, least*length)
  end function length_of_step

  !> All points and corners of the side touch alike in two states; stick and slip alike too, where friction makes heat.
  pure function same_contact(group, by_friction, one, other) result(same)
    type(group_t), intent(in) :: group
    logical, intent(in) :: by_friction
    real(wp), intent(in) :: one(:, :, :), other(:, :)   !! (nstate, npoint, 1), (nstate, npoint) [unit of each component]
    logical :: same
    character(len=21), parameter :: names(2) = ['contact_status       ', 'corner_contact_status']
    integer :: k, v, row

    same = .true.
    do k = 1, size(names)
      v = find_variable(group%variables, trim(names(k)))
      if (v == 0) cycle
      row = group%variables(v)%first
      same = same .and. all((nint(one(row, :, 1)) == contact_open) .eqv. (nint(other(row, :)) == contact_open))
      if (by_friction) same = same .and. all(nint(one(row, :, 1)) == nint(other(row, :)))
    end do
  end function same_contact

  !> What contact has reached drives heat at the end of the step.
  pure subroutine drive(equations, contact, heat)
    type(equations_t), intent(in) :: equations
    type(evaluated_side_t), intent(in) :: contact
    type(evaluated_side_t), intent(inout) :: heat
    integer :: k

    associate (source => equations%drivers(heat%g)%source)
      do k = at_status, at_corner_place
        if (allocated(source(k)%row)) heat%drivers(k, 2, :, 1) = contact%trial(source(k)%row(contact%g), :, 1)
      end do
    end associate
  end subroutine drive

  !> Forces and trial state.
  subroutine compute(scene, equations, instant, side)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(instant_t), intent(in) :: instant
    type(evaluated_side_t), intent(inout) :: side
    real(wp) :: unused(size(side%dof), size(side%dof), 1)
    type(report_t) :: report

    associate (group => scene%groups(side%g), row => equations%elems(scene%groups(side%g)%elem_id))
      call row%compute(scene, group, equations%kinematics, equations%laws(side%law), instant, side%layout, side%e, side%x, &
                       side%motion, side%start, side%drivers, side%committed, side%trial, side%force, unused, report)
    end associate
  end subroutine compute

  !> What an element is called with.
  subroutine take_side(scene, equations, solution, instant, du, g, e, side)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: du(:)
    integer, intent(in) :: g, e
    type(evaluated_side_t), intent(out) :: side

    side%g = g
    side%e = e
    associate (group => scene%groups(g), own => equations%dofs%groups(g), state => solution%groups(g))
      if (group%material > 0) side%law = scene%materials(group%material)%law_id
      side%layout = own%layout
      allocate (side%dof, source=own%dof(:, e))
      allocate (side%nodes, source=own%nodes(:, e))
      allocate (side%x(2, size(side%nodes), 1), side%motion(size(side%dof), 1), side%start(size(side%dof), 1), &
                side%force(size(side%dof), 1))
      call gather_geometry(scene, equations%elems(group%elem_id), equations%kinematics%finite, own%nodes(:, e:e), &
                           solution%fields(displacement_field)%value, side%x)
      side%motion(:, 1) = du(side%dof)
      side%start(:, 1) = instant%values(side%dof)
      allocate (side%committed, source=state%committed(:, :, e:e))
      allocate (side%trial, source=state%trial(:, :, e:e))
      allocate (side%drivers, source=equations%drivers(g)%value(:, :, :, e:e))
    end associate
  end subroutine take_side

end module contact_heat_tangent
