!> Bodies that no supports and no springs hold, and which of them something acts on.
!>
!> Bodies that are held in X and in Y (axisymmetric ones in Y) have no free motion, and are none of these. One of these that loses
!> its contact within a step may be carried off by round-off of the forces: where a correction is large beside the whole scene, or
!> the matrix is singular, it is found again with diagonals that are a little larger. That changes no force.
module loose_bodies
  use bodies, only: bodies_of_nodes
  use contact_state, only: at_between, at_piece, at_pressure, contact_block, is_in_contact
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: law_t
  use loads, only: multiplier_at
  use matrix_pattern, only: matrix_pattern_t
  use scene, only: axisymmetric, group_t, is_solid, role_contact, role_side_load, role_volume_load, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: find_loose_bodies, hold_loose, mark_acted_on, motion_of_loose

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

  !> Bodies that a contact with a pressure at the start of a step above a share of the modulus behind it, or one that lasts whatever
  !> pulls, or a load at the end of the step, acts on. Bodies that act on one another are an assembly; that of number 0 has those
  !> that rigid dies, loads and bodies that are held act on. One on which nothing acts is an assembly by itself.
  subroutine mark_acted_on(scene, laws, solution, loose, time, least, acted_on, assembly)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: loose(:)           !! (nnode) of find_loose_bodies
    real(wp), intent(in) :: time              !! [time]
    real(wp), intent(in) :: least             !! share of the modulus [-]
    logical, intent(out) :: acted_on(0:)      !! (0:nnode) by the number of the body
    integer, intent(out), optional :: assembly(0:)   !! (0:nnode) number of the assembly of each body
    integer :: part_of(0:size(loose)), g, k
    logical :: outside(0:size(loose))

    acted_on = .false.
    outside = .false.
    part_of = [(k, k=0, size(loose))]
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%role /= role_contact .or. group%material == 0) cycle
        associate (lasts => laws(scene%materials(group%material)%law_id)%lasts)
          call mark_contacts(scene, group, solution%groups(g)%committed, loose, &
                             merge(-1.0_wp, least*group%modulus, lasts), acted_on, part_of)
          ! what touches as the run begins is not known yet
          if (lasts .and. .not. solution%last_step > 0) outside(loose(group%connectivity(1, :))) = .true.
        end associate
      end associate
    end do
    call mark_loads(scene, loose, time, outside)
    acted_on = acted_on .or. outside
    if (.not. present(assembly)) return
    do k = 1, size(loose)
      if (outside(k)) call join(k, 0, part_of)
    end do
    assembly = part_of
  end subroutine mark_acted_on

  !> Two bodies, and all that are in an assembly with them, are in one; that with the number 0 keeps it.
  pure subroutine join(a, b, part_of)
    integer, intent(in) :: a, b              !! numbers of bodies
    integer, intent(inout) :: part_of(0:)    !! (0:nnode)
    integer :: old, new

    new = min(part_of(a), part_of(b))
    old = max(part_of(a), part_of(b))
    if (new /= old) where (part_of == old) part_of = new
  end subroutine join

  !> Bodies on either side of a contact with a point, or a place between points, that bears more than a pressure.
  pure subroutine mark_contacts(scene, group, state, loose, least, acted_on, part_of)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (nstate, npoint, nelem)
    integer, intent(in) :: loose(:)
    real(wp), intent(in) :: least            !! below 0 where contact itself will do [stress]
    logical, intent(inout) :: acted_on(0:)
    integer, intent(inout) :: part_of(0:)    !! (0:nnode) number of the assembly of each body
    integer :: e, p, other
    logical :: corners

    corners = find_variable(group%variables, 'corner_place') > 0
    do e = 1, size(state, 3)
      do p = 1, size(state, 2)
        if (.not. is_in_contact(state(:, p, e), corners)) cycle
        if (.not. presses(state(:, p, e), least, corners)) cycle
        acted_on(loose(group%connectivity(1, e))) = .true.
        ! the sides of a die are of one body; those of a new mesh are not known yet
        other = 0
        if (group%pairs > 0) other = loose(scene%dies(group%die)%nodes(1, max(1, nint(state(at_piece, p, e)))))
        acted_on(other) = .true.
        call join(loose(group%connectivity(1, e)), other, part_of)
      end do
    end do
  end subroutine mark_contacts

  !> Whether a point in contact, or a place beside it, bears more than a pressure.
  pure function presses(state, least, corners) result(yes)
    real(wp), intent(in) :: state(:)    !! (nstate) of the point
    real(wp), intent(in) :: least       !! [stress]
    logical, intent(in) :: corners      !! places at corners of dies are in the state too
    logical :: yes

    yes = abs(state(at_pressure)) > least .or. state(at_between) > least
    if (corners) yes = yes .or. abs(state(contact_block(corners, size(state)) + at_pressure)) > least
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

end module loose_bodies
