!> Error in space of the shape that fronts of temperature and phases leave, at the end of a run.
!>
!> A front that passes an element is sampled at its points. Where the strain of temperature and phases differs by J across the
!> element (strain_spans) and by S over all of the front, the element holds the share J/S of the front. Temperatures linear in it
!> and strains linear in it make plastic strains, those of transformation among them, err by a share of J that goes with J/S: of
!> second order in the size of elements. The strain that is left wrong is taken as
!>   e = J^2/(6 S),
!> where 6 was found by plates quenched on one side or unlike on both (tests/heat/run_shape_error.py): an estimate of the size, by
!> which no sign is known. Its sign is taken as the same everywhere, so that what errs alike on both sides of a part bends nothing.
!> S is what austenite shrinks between the hottest and the coldest temperature of the run.
!>
!> The shape that this strain makes is that by which an elastic body answers to it (H. Reissner, Z. Angew. Math. Mech. 11 (1931)
!> 1-8): the laws make the last step once more from a state with elastic strains that are less by a small share of e, and the
!> factors at hand balance what that leaves.
module shape_error
  use bodies, only: bodies_of_nodes
  use corrections, only: solve_correction
  use drivers, only: drivers_t
  use equations, only: equations_t, take_turn
  use errors, only: exit_no_convergence
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use kinematics_api, only: first_history, first_strain
  use path_states, only: advance_beside, begin_beside, has_stress, on_nodes, unbalanced_forces
  use phase_point, only: row_plastic, row_trip
  use plane_vectors, only: cross
  use resting_bodies, only: remove_rigid_motion
  use scene, only: axisymmetric, scene_t
  use sections, only: thickness_at
  use shape_record, only: shape_errors_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  use strain_spans, only: strain_of_range
  implicit none
  private
  public :: find_shape_error

  !> The share of the strain along which all is linear.
  real(wp), parameter :: small = 1.0e-3_wp
  !> 6 of the formula, of elements of 4 points; of 9 points half of it: at these strains linear in the element are not those that
  !> what flows would have (J. Barlow, Int. J. Num. Meth. Engng 10 (1976) 243-251).
  real(wp), parameter :: parts(2) = [6.0_wp, 3.0_wp]
  !> Errors below this share of a body's extent are round-off, and curvatures over it.
  real(wp), parameter :: resolution = 1.0e-6_wp
  !> Normal components of a tensor (xx, yy, zz among xx, yy, xy, zz).
  integer, parameter :: normal(3) = [1, 2, 4]

contains

  !> Errors of the shape at the end of a step that has been found; none where no body that flows has had a front in it.
  subroutine find_shape_error(scene, equations, solution, dt, at_hand, outcome)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution   !! its trial state is that of the step
    real(wp), intent(in) :: dt        !! [time]
    logical, intent(in) :: at_hand    !! factors of a matrix of this step are
    type(outcome_t), intent(inout) :: outcome
    type(drivers_t), allocatable :: drivers(:)
    type(solution_t) :: other
    real(wp), dimension(equations%dofs%ndof) :: residual, answer
    real(wp) :: element_force(size(equations%buffers%force)), range, part, wrong, most
    logical :: active(size(scene%groups)), done
    integer :: g, e, c

    if (.not. any([(size(solution%groups(g)%span) > 0, g=1, size(scene%groups))])) return
    if (.not. solution%shape%followed) return
    call begin_beside(solution, other)
    most = 0
    do g = 1, size(scene%groups)
      if (size(solution%groups(g)%span) == 0) cycle
      range = strain_of_range(scene, solution, g)
      if (.not. range > 0) cycle
      part = parts(merge(1, 2, scene%groups(g)%rule%n == 4))
      do e = 1, size(solution%groups(g)%span)
        wrong = min(solution%groups(g)%span(e)**2/(part*range), maxval(flowed(solution%groups(g)%trial(:, :, e))))
        most = max(most, wrong)
        do c = 1, size(normal)
          associate (strain => other%groups(g)%committed(first_strain - 1 + normal(c), :, e))
            strain = strain - small*wrong
          end associate
        end do
      end do
    end do
    if (.not. most > 0) return
    call take_turn(equations, displacement_field)
    ! the books want the element forces of the step
    element_force = equations%buffers%force
    active = has_stress(scene, equations%laws)
    allocate (drivers, source=equations%drivers)
    drivers%vary = .false.
    call advance_beside(scene, equations, active, drivers, outcome%du, dt, other, done)
    if (done) then
      call unbalanced_forces(scene, equations, solution, outcome%du, residual)
      call solve_correction(equations, residual/small, answer, outcome%error, at_hand=at_hand)
      if (.not. allocated(outcome%error)) call remove_rigid_motion(scene, equations, solution, answer)
      if (.not. allocated(outcome%error)) call compare(scene, equations, solution, outcome%du, answer, outcome%shape)
    end if
    equations%buffers%force = element_force
    if (.not. allocated(outcome%error)) return
    ! there is no estimate then
    if (outcome%error%code == exit_no_convergence) deallocate (outcome%error)
  end subroutine find_shape_error

  !> What has flowed at points, plastically and by transformation (npoint) [-].
  pure function flowed(states) result(strain)
    real(wp), intent(in) :: states(:, :)   !! (component, point) [unit of each component]
    real(wp) :: strain(size(states, 2))

    strain = states(first_history - 1 + row_plastic, :) + abs(states(first_history - 1 + row_trip, :))
  end function flowed

  !> Share of a front that an element holds, in the mean over the bodies.
  pure function share_in_element(scene, solution) result(share)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: share   !! [-]
    real(wp) :: whole, volume, range, x(2, 4)
    integer :: g, e

    share = 0
    whole = 0
    do g = 1, size(scene%groups)
      if (size(solution%groups(g)%span) == 0) cycle
      range = strain_of_range(scene, solution, g)
      if (.not. range > 0) cycle
      do e = 1, size(solution%groups(g)%span)
        x = scene%mesh%coordinates(:, scene%groups(g)%connectivity(:4, e))
        volume = 0.5_wp*abs(cross(x(:, 3) - x(:, 1), x(:, 4) - x(:, 2)))*thickness_at(scene%section, sum(x, 2)/4)
        share = share + volume*solution%groups(g)%span(e)/range
        whole = whole + volume
      end do
    end do
    if (whole > 0) share = share/whole
  end function share_in_element

  !> The errors of the body whose displacements err most, and of the section.
  subroutine compare(scene, equations, solution, du, answer, errors)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:), answer(:)   !! (ndof) motion of the step, and the error [unknown]
    type(shape_errors_t), intent(out) :: errors
    real(wp), dimension(2, size(scene%mesh%coordinates, 2)) :: error, whole
    integer :: body(size(error, 2))
    integer, allocatable :: nodes(:)
    logical :: cools(size(error, 2)), has_axis
    real(wp) :: off, growth, extent, least
    integer :: g, c, d, b, k

    error = on_nodes(equations, answer)
    ! since the start, over all meshes
    whole = scene%mesh%coordinates + solution%fields(displacement_field)%value + on_nodes(equations, du) - scene%mesh%origin
    has_axis = scene%plane_state == axisymmetric
    cools = .false.
    do g = 1, size(scene%groups)
      if (size(solution%groups(g)%span) > 0) cools([scene%groups(g)%connectivity(:8, :)]) = .true.
    end do
    body = merge(bodies_of_nodes(scene), 0, cools)
    extent = 0
    errors%known = .true.
    errors%share = share_in_element(scene, solution)
    do b = 1, size(body)
      if (body(b) /= b) cycle
      nodes = pack([(k, k=1, size(body))], body == b)
      least = resolution*maxval(maxval(scene%mesh%coordinates(:, nodes), 2) - minval(scene%mesh%coordinates(:, nodes), 2))
      extent = max(extent, least/resolution)
      call part_motion(scene%mesh%coordinates(:, nodes), error(:, nodes), has_axis, growth, off)
      if (off <= max(errors%displacement, least)) cycle
      errors%displacement = off
      errors%growth = abs(growth)
      call part_motion(scene%mesh%origin(:, nodes), whole(:, nodes), has_axis, errors%of_growth, errors%of_displacement)
    end do
    do c = 2, 3
      d = equations%dofs%fields(section_field)%number(c, 1)
      if (d == 0) cycle
      if (equations%solves(equations%now)%equation(d) == 0) cycle
      off = abs(answer(d))/scene%section(1)
      if (off <= max(errors%curvature, resolution/extent)) cycle
      errors%curvature = off
      errors%of_curvature = abs(solution%fields(section_field)%value(c, 1) + du(d))/scene%section(1)
    end do
  end subroutine compare

  !> Displacements as a motion, a turn, an even growth and the rest, by least squares over the nodes: the growth, and the largest
  !> rest. With an axis there is neither a turn nor a motion across it.
  pure subroutine part_motion(x, u, has_axis, growth, rest)
    real(wp), intent(in) :: x(:, :), u(:, :)   !! (2, nnode) [length]
    logical, intent(in) :: has_axis
    real(wp), intent(out) :: growth, rest      !! [-], [length]
    real(wp), dimension(2, size(x, 2)) :: place, way
    real(wp) :: turn, square
    integer :: c

    place = x
    way = u
    do c = merge(2, 1, has_axis), 2
      place(c, :) = place(c, :) - sum(place(c, :))/size(x, 2)
      way(c, :) = way(c, :) - sum(way(c, :))/size(x, 2)
    end do
    square = sum(place**2)
    growth = sum(place*way)/square
    turn = 0
    if (.not. has_axis) turn = sum(place(1, :)*way(2, :) - place(2, :)*way(1, :))/square
    way(1, :) = way(1, :) - growth*place(1, :) + turn*place(2, :)
    way(2, :) = way(2, :) - growth*place(2, :) - turn*place(1, :)
    rest = sqrt(maxval(sum(way**2, 1)))
  end subroutine part_motion

end module shape_error
