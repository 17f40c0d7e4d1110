!> Totals of an accepted step: reactions, sums over the scene, the worst values so far.
module bookkeeping
  use contact_contour, only: sample_depth
  use contact_penalties, only: allowed_penetration
  use contact_state, only: at_penetration, at_status
  use dies, only: is_deformable, present_die
  use elem_api, only: add_totals, totals_t
  use element_loop, only: group_geometry
  use equations, only: equations_t
  use errors, only: error_t, exit_bug, fail
  use external_loads, only: external_forces
  use fields, only: displacement_field, field_t, on_nodes, pilot_field, section_field
  use kinds, only: wp
  use law_api, only: contact_open
  use own_contact, only: faces_itself
  use plane_vectors, only: cross
  use scene, only: group_t, role_contact, scene_t
  use side_points, only: side_length
  use solution, only: present_coordinates, solution_t
  use spurious_mode, only: find_spurious_mode, has_spurious_mode
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: book_deformable_dies, book_reactions, book_spurious_mode, measure_scene, pressed_on, sample_contacts

  !> Action and reaction of two bodies may differ by this share of the forces at their nodes: round-off of a sum.
  real(wp), parameter :: reaction_slack = 1.0e-10_wp

contains

  !> What supports and imposed motions carry: internal force less nodal forces; pressures are in it already.
  subroutine book_reactions(scene, equations, time, fields)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: time
    type(field_t), intent(inout) :: fields(:)   !! (nfield)
    real(wp) :: external(equations%dofs%ndof)
    integer :: f, k, c, d

    call external_forces(scene, equations%dofs, time, external)
    do f = 1, size(fields)
      fields(f)%reaction = 0
      if (fields(f)%place /= on_nodes .and. .not. fields(f)%imposed_as_value) cycle
      do k = 1, size(fields(f)%reaction, 2)
        do c = 1, fields(f)%ncomp
          d = equations%dofs%fields(f)%number(c, k)
          if (d == 0) cycle
          if (.not. equations%dofs%is_free(d)) fields(f)%reaction(c, k) = equations%force(d) - external(d)
        end do
      end do
    end do
    if (.not. any(equations%wall%held)) return
    associate (reaction => fields(displacement_field)%reaction, number => equations%dofs%fields(displacement_field)%number)
      do k = 1, size(reaction, 2)
        do c = 1, 2
          ! where a support holds the node too, what the wall does to it is part of what it carries
          if (number(c, k) > 0) reaction(c, k) = reaction(c, k) + equations%wall%force(c, k)
        end do
      end do
    end associate
  end subroutine book_reactions

  !> What deformable dies carry: the force of all contacts on them, and its moment about the origin, with the sign of a reaction.
  !> What a die gets the sides that face it give.
  subroutine book_deformable_dies(scene, equations, solution, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: sum(2), magnitude, x(2), force(2)
    integer :: g, e, i, m, n

    do g = 1, size(scene%dies)
      if (is_deformable(scene%dies(g))) solution%fields(pilot_field)%applied(:, g) = 0
    end do
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. scene%groups(g)%role /= role_contact) cycle
      sum = 0
      magnitude = 0
      associate (nodes => equations%dofs%groups(g)%nodes, &
                 applied => solution%fields(pilot_field)%applied(:, scene%groups(g)%die))
        n = size(nodes, 1)
        do e = 1, size(nodes, 2)
          m = equations%solves(1)%pattern%force_start(g) + (e - 1)*size(equations%dofs%groups(g)%dof, 1)
          do i = 1, n
            force = equations%buffers%force([m + i, m + n + i])
            sum = sum + force
            magnitude = magnitude + length_of(force)
            if (i <= size(scene%groups(g)%connectivity, 1)) cycle
            x = scene%mesh%coordinates(:, nodes(i, e)) + solution%fields(displacement_field)%value(:, nodes(i, e))
            applied = applied + [force, cross(x, force)]
          end do
        end do
      end associate
      if (length_of(sum) > reaction_slack*magnitude) then
        call fail(error, exit_bug, 'step '//to_text(solution%step)//': forces of contact '//scene%groups(g)%name &
                  //' on its two bodies differ by '//to_text(length_of(sum)/magnitude, 3)//' of their size')
        return
      end if
    end do
  end subroutine book_deformable_dies

  !> Sum of the forces of all sides on a deformable die, each by its size: what presses on a die whose force is none, as on a ring
  !> all around. Zero for rigid dies, and nothing of what a body presses on itself: that is no load (met_by_itself).
  pure function pressed_on(scene, equations, die) result(total)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: die
    real(wp) :: total
    integer :: g, e, m, n

    total = 0
    if (scene%dies(die)%unasked) return
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0 .or. scene%groups(g)%die /= die .or. scene%groups(g)%role /= role_contact) cycle
      if (faces_itself(scene, scene%groups(g))) cycle
      n = size(equations%dofs%groups(g)%nodes, 1)
      do e = 1, size(equations%dofs%groups(g)%nodes, 2)
        m = equations%solves(1)%pattern%force_start(g) + (e - 1)*size(equations%dofs%groups(g)%dof, 1)
        associate (force => equations%buffers%force, side => size(scene%groups(g)%connectivity, 1))
          total = total + length_of([sum(force(m + 1:m + side)), sum(force(m + n + 1:m + n + side))])
        end associate
      end do
    end do
  end function pressed_on

  !> Sums over all groups at the present displacement, from the trial state (equal to the committed one at rest).
  subroutine measure_scene(scene, equations, solution, totals)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(totals_t), intent(out) :: totals
    type(totals_t) :: part
    real(wp), allocatable :: x(:, :, :)
    integer :: g, law

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), row => equations%elems(scene%groups(g)%elem_id))
        if (.not. associated(row%measure)) cycle
        law = scene%materials(group%material)%law_id
        call group_geometry(scene, group, row, solution%fields(displacement_field)%value, x)
        call row%measure(scene, group, equations%laws(law), solution%fields(section_field)%value(:, 1), &
                         solution%penalty_share, x, solution%groups(g)%trial, solution%groups(g)%committed, part)
        call add_totals(totals, part)
      end associate
    end do
    totals%friction_work = totals%friction_work + solution%friction_apart
  end subroutine measure_scene

  !> The spurious mode of the step, a motion without strain at the points: the worst of all steps is kept.
  subroutine book_spurious_mode(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: x(:, :, :)
    real(wp) :: share
    integer :: g, element

    if (.not. solution%fields(displacement_field)%declared) return
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), elem => equations%elems(scene%groups(g)%elem_id))
        if (.not. has_spurious_mode(elem, group, scene%finite)) cycle
        associate (u => solution%fields(displacement_field))
          call group_geometry(scene, group, elem, u%value, x)
          call find_spurious_mode(scene, elem, group, x, u%last_increment, share, element)
        end associate
        if (.not. share > solution%worst_spurious) cycle
        solution%worst_spurious = share
        solution%spurious_group = g
        solution%spurious_element = element
      end associate
    end do
  end subroutine book_spurious_mode

  !> Depth of the part in the dies all along its sides, between integration points too.
  subroutine sample_contacts(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: x(:, :)
    real(wp) :: depth, ratio, allowed
    integer :: g

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        allowed = allowed_penetration(scene%materials(group%material))
        x = present_coordinates(scene, solution)
        if (faces_itself(scene, group)) then
          call deepest_points(scene, group, solution%groups(g)%committed, allowed, depth, ratio)
        else
          call sample_depth(group, present_die(scene%dies(group%die), x), solution%fields(pilot_field)%value(:, group%die), &
                            scene%mesh%coordinates, x, allowed, depth, ratio)
        end if
      end associate
      solution%worst_sample = max(solution%worst_sample, depth)
      solution%worst_sample_ratio = max(solution%worst_sample_ratio, ratio)
    end do
  end subroutine sample_contacts

  !> Depth of sides that face their own body: at the points in contact, which are many. Elsewhere nothing says by its place
  !> whether a point is in contact.
  pure subroutine deepest_points(scene, group, state, allowed, depth, ratio)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (nstate, npoint, nside) [unit of each component]
    real(wp), intent(in) :: allowed          !! penetration over the side, 0 when none is stated
    real(wp), intent(out) :: depth           !! [length]
    real(wp), intent(out) :: ratio           !! over what the side allows
    real(wp) :: deepest
    integer :: e

    depth = 0
    ratio = 0
    do e = 1, size(state, 3)
      deepest = max(0.0_wp, maxval(state(at_penetration, :, e), mask=nint(state(at_status, :, e)) /= contact_open))
      depth = max(depth, deepest)
      if (allowed > 0) ratio = max(ratio, deepest/(allowed*side_length(scene, group%connectivity(:, e))))
    end do
  end subroutine deepest_points

end module bookkeeping
