!> Bodies that nothing holds and nothing loads rest.
!>
!> A part that has lost all contact is in equilibrium wherever it is, and so also where the motion of its last step would take it.
!> One that dies touch with no pressure at all is such a part too.
!> Without inertia it has no reason to go on: the prediction of a step leaves such a body where it is, and until a contact closes in
!> the step the diagonals of its equations are a little larger, as nothing else resists it and the matrix would be singular. That
!> changes no force. One that loses its contact within a step may be carried off by round-off of the forces: where a correction is
!> large beside the whole scene, or the matrix is singular, it is found again with such diagonals. Bodies that supports or springs
!> hold in X and in Y (axisymmetric ones in Y) have no such motion, and are not looked at: springs are far softer than the diagonals
!> are larger.
module resting_bodies
  use bodies, only: bodies_of_nodes
  use contact_point, only: at_between, at_piece, at_pressure, contact_block, is_in_contact
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use kinds, only: wp
  use loads, only: multiplier_at
  use matrix_pattern, only: matrix_pattern_t
  use scene, only: axisymmetric, group_t, is_solid, role_contact, role_side_load, role_volume_load, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: find_loose_bodies, leave_at_rest, hold_resting, hold_loose, mark_acted_on, motion_of_loose

  !> What is added to a diagonal, over it: hardly felt by motions that strain the body.
  real(wp), parameter :: hold = 1.0e-6_wp

contains

  !> The body of every node that supports and springs do not hold (nnode), 0 for other nodes; of no size where there is none.
  subroutine find_loose_bodies(scene, dofs, loose)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    integer, allocatable, intent(out) :: loose(:)
    integer :: body(size(scene%mesh%coordinates, 2)), g, k, c
    logical :: held(2, size(body)), of_element(size(body))

    allocate (loose(0))
    if (.not. scene%fields(displacement_field)%declared) return
    of_element = .false.
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      of_element(reshape(scene%groups(g)%connectivity, [size(scene%groups(g)%connectivity)])) = .true.
    end do
    body = bodies_of_nodes(scene)
    held = .false.
    associate (number => dofs%fields(displacement_field)%number)
      do k = 1, size(body)
        do c = 1, 2
          if (number(c, k) == 0) cycle
          if (.not. dofs%is_free(number(c, k))) held(c, body(k)) = .true.
        end do
      end do
    end associate
    do g = 1, size(scene%groups)
      if (scene%groups(g)%is_spring) held(scene%groups(g)%direction, body(scene%groups(g)%connectivity(1, :))) = .true.
    end do
    ! no ring moves along r as a whole
    if (scene%plane_state == axisymmetric) held(1, :) = .true.
    body = merge(0, body, all(held(:, body), 1) .or. .not. of_element)
    if (.not. any(body > 0)) return
    deallocate (loose)
    allocate (loose, source=body)
  end subroutine find_loose_bodies

  !> Take back the predicted motion of bodies that neither a contact nor a load acts on.
  subroutine leave_at_rest(scene, dofs, loose, solution, time, du, resting)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: loose(:)   !! (nnode) of find_loose_bodies
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: time         !! at the end of the step
    real(wp), intent(inout) :: du(:)                !! (ndof) motion of the step [unknown]
    logical, allocatable, intent(inout) :: resting(:)   !! (ndof) unknowns of such bodies; of no size where no body is loose
    logical :: acted_on(0:size(loose))
    integer :: k, c

    if (size(loose) == 0) return
    call mark_acted_on(scene, solution, loose, time, acted_on)
    if (size(resting) /= dofs%ndof) deallocate (resting)
    if (.not. allocated(resting)) allocate (resting(dofs%ndof))
    resting = .false.
    associate (number => dofs%fields(displacement_field)%number)
      do k = 1, size(loose)
        if (loose(k) == 0 .or. acted_on(loose(k))) cycle
        do c = 1, 2
          if (number(c, k) == 0) cycle
          du(number(c, k)) = 0
          resting(number(c, k)) = .true.
        end do
      end do
    end associate
  end subroutine leave_at_rest

  !> Increase the diagonals of a matrix for unknowns at rest, of bodies without a contact now: slender ones would feel it.
  subroutine hold_resting(scene, dofs, solution, loose, pattern, equation, resting, values)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: loose(:)          !! (nnode) of find_loose_bodies
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: equation(:)       !! (ndof) of every unknown, 0 where it has none
    logical, intent(in) :: resting(:)        !! (ndof) or of no size
    real(wp), intent(inout) :: values(:)     !! (nnz) [residual/unknown]
    logical :: held(0:pattern%neq), acted_on(0:size(loose))
    integer :: k

    if (.not. any(resting)) return
    acted_on = .false.
    call mark_contacts(scene, solution, .true., loose, acted_on)
    call find_equations(dofs, merge(0, loose, acted_on(loose)), equation, held)
    do k = 1, size(resting)
      if (.not. resting(k)) held(equation(k)) = .false.
    end do
    call enlarge(pattern, held, values)
  end subroutine hold_resting

  !> Increase the diagonals of a matrix for all bodies that supports do not hold.
  pure subroutine hold_loose(dofs, loose, pattern, equation, values)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: loose(:)          !! (nnode) of find_loose_bodies
    class(matrix_pattern_t), intent(in) :: pattern
    integer, intent(in) :: equation(:)       !! (ndof) of every unknown, 0 where it has none
    real(wp), intent(inout) :: values(:)     !! (nnz) [residual/unknown]
    logical :: held(0:pattern%neq)

    call find_equations(dofs, loose, equation, held)
    call enlarge(pattern, held, values)
  end subroutine hold_loose

  !> Largest component of a correction of bodies that supports do not hold [length].
  pure function motion_of_loose(dofs, loose, equation, correction) result(largest)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: loose(:)           !! (nnode) of find_loose_bodies
    integer, intent(in) :: equation(:)        !! (ndof) of every unknown, 0 where it has none
    real(wp), intent(in) :: correction(:)     !! (neq) [unknown]
    real(wp) :: largest
    logical :: found(0:size(correction))

    call find_equations(dofs, loose, equation, found)
    largest = max(0.0_wp, maxval(abs(correction), mask=found(1:)))
  end function motion_of_loose

  !> Equations of the nodes of some bodies.
  pure subroutine find_equations(dofs, body, equation, found)
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: body(:)        !! (nnode), 0 for nodes that are not wanted
    integer, intent(in) :: equation(:)
    logical, intent(out) :: found(0:)     !! (0:neq); that of 0 means nothing
    integer :: c, k

    found = .false.
    associate (number => dofs%fields(displacement_field)%number)
      do k = 1, size(body)
        if (body(k) == 0) cycle
        do c = 1, 2
          if (number(c, k) > 0) found(equation(number(c, k))) = .true.
        end do
      end do
    end associate
  end subroutine find_equations

  !> Make the diagonals of some equations a little larger.
  pure subroutine enlarge(pattern, held, values)
    class(matrix_pattern_t), intent(in) :: pattern
    logical, intent(in) :: held(0:)
    real(wp), intent(inout) :: values(:)
    integer :: k

    do k = 1, pattern%nnz
      if (pattern%row(k) == pattern%column(k) .and. held(pattern%row(k))) values(k) = (1 + hold)*values(k)
    end do
  end subroutine enlarge

  !> Bodies that a contact at the start of a step, or a load at its end, acts on.
  subroutine mark_acted_on(scene, solution, loose, time, acted_on)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: loose(:)           !! (nnode) of find_loose_bodies
    real(wp), intent(in) :: time              !! [time]
    logical, intent(out) :: acted_on(0:)      !! (0:nnode) by the number of the body

    acted_on = .false.
    call mark_contacts(scene, solution, .false., loose, acted_on)
    call mark_loads(scene, loose, time, acted_on)
  end subroutine mark_acted_on

  !> Bodies with a point, or a place between points, on either side, that bears a force at the start of the step, or that is in
  !> contact in its trial state: one that touches without a force does not act, and would let the body go on with its last motion.
  subroutine mark_contacts(scene, solution, trial, loose, acted_on)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: trial
    integer, intent(in) :: loose(:)
    logical, intent(inout) :: acted_on(0:)
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%role /= role_contact) cycle
      if (trial) then
        call mark(scene%groups(g), solution%groups(g)%trial)
      else
        call mark(scene%groups(g), solution%groups(g)%committed)
      end if
    end do

  contains

    subroutine mark(group, state)
      type(group_t), intent(in) :: group
      real(wp), intent(in) :: state(:, :, :)
      integer :: e, p
      logical :: corners

      corners = find_variable(group%variables, 'corner_place') > 0
      do e = 1, size(state, 3)
        do p = 1, size(state, 2)
          if (.not. is_in_contact(state(:, p, e), corners)) cycle
          if (.not. (trial .or. presses(state(:, p, e), corners))) cycle
          acted_on(loose(group%connectivity(1, e))) = .true.
          if (group%pairs > 0) acted_on(loose(scene%dies(group%die)%nodes(1, nint(state(at_piece, p, e))))) = .true.
        end do
      end do
    end subroutine mark

  end subroutine mark_contacts

  !> Whether a point in contact, or a place beside it, bears a force.
  pure function presses(state, corners) result(yes)
    real(wp), intent(in) :: state(:)    !! (nstate) of the point
    logical, intent(in) :: corners      !! places at corners of dies are in the state too
    logical :: yes

    yes = abs(state(at_pressure)) > 0 .or. state(at_between) > 0
    if (corners) yes = yes .or. abs(state(contact_block(corners, size(state)) + at_pressure)) > 0
  end function presses

  !> Bodies with a pressure, a force on the volume or a nodal force that is not zero at the end of the step.
  pure subroutine mark_loads(scene, loose, time, acted_on)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: loose(:)
    real(wp), intent(in) :: time
    logical, intent(inout) :: acted_on(0:)
    integer :: g, k

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (all(group%role /= [role_side_load, role_volume_load]) .or. group%multiplier == 0) cycle
        if (.not. abs(group%amplitude*multiplier_at(scene%multipliers(group%multiplier), time)) > 0) cycle
        acted_on(loose(group%connectivity(1, :))) = .true.
      end associate
    end do
    do k = 1, size(scene%forces)
      associate (load => scene%forces(k))
        if (load%field /= displacement_field) cycle
        if (abs(load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)) > 0) acted_on(loose(load%node)) = .true.
      end associate
    end do
  end subroutine mark_loads

end module resting_bodies
