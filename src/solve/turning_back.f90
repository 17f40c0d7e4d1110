!> What turns back with a die or a support that goes the other way than in the last step.
!>
!> The bodies that it moves unload: a step that began with their last motion would find the matrix of loading there, and a
!> correction far too large. So they begin a little way back along it (predictor), with all that touches them: a die or a body that
!> went on alone would go into them by the whole motion of the step. Other bodies and dies go on, their contact kept, and so do
!> temperatures. A support that turns back counts where the body that it holds touches nothing: contact that it may pull open is
!> found sooner from a motion that goes on, while dies that leave are followed (leaving_dies).
module turning_back
  use bodies, only: bodies_of_nodes
  use contact_state, only: at_piece, is_in_contact
  use dies, only: is_deformable
  use dofs, only: dofs_t
  use fields, only: displacement_field, pilot_field, section_field
  use kinds, only: wp
  use scene, only: role_contact, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: reversed_unknowns, move_along, turn_back

contains

  !> Unknowns of motion that are given in the other sense than they moved in the last step (ndof).
  pure function reversed_unknowns(dofs, before, motion) result(reversed)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: before(:)   !! (ndof) motion of the last step [unknown]
    real(wp), intent(in) :: motion(:)   !! (nprescribed) that of the step [unknown]
    logical :: reversed(size(before))
    integer :: f, k

    reversed = .false.
    do k = 1, size(motion)
      associate (d => dofs%prescribed(k)%dof)
        reversed(d) = motion(k)*before(d) < 0
      end associate
    end do
    do f = section_field + 1, size(dofs%fields)
      associate (number => dofs%fields(f)%number)
        reversed(pack(number, number > 0)) = .false.
      end associate
    end do
  end function reversed_unknowns

  !> Bodies and dies that turn back with dies (and supports, where contact is none of theirs) that go the other way.
  subroutine turn_back(scene, dofs, solution, reversed, back, dies)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: reversed(:)   !! (ndof) of reversed_unknowns
    logical, intent(out) :: back(:)      !! (ndof) unknowns of them
    logical, intent(out) :: dies(:)      !! (ndie) dies among them, of sides too
    logical :: of_dies(size(reversed)), held(size(reversed)), touched(size(dies)), touches

    of_dies = .false.
    associate (pilots => dofs%fields(pilot_field)%number)
      call mark(reshape(pilots, [size(pilots)]), of_dies)
    end associate
    call move_along(scene, dofs, solution, reversed .and. of_dies, back, dies)
    call move_along(scene, dofs, solution, reversed .and. .not. of_dies, held, touched, touches)
    if (touches) return
    back = back .or. held
    dies = dies .or. touched
  end subroutine turn_back

  !> Bodies and dies that some of their unknowns move, directly or through contacts that are closed at the start of the step.
  subroutine move_along(scene, dofs, solution, moving, moved, dies, touches)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: moving(:)   !! (ndof)
    logical, intent(out) :: moved(:)   !! (ndof) unknowns of them
    logical, intent(out) :: dies(:)    !! (ndie) dies among them, of sides too
    logical, intent(out), optional :: touches   !! contact of theirs is closed
    integer :: body(size(scene%mesh%coordinates, 2))
    logical :: of_body(size(body)), of_die(size(scene%dies)), changed, closed
    integer :: g, k

    if (present(touches)) touches = .false.

    moved = .false.
    dies = .false.
    if (.not. any(moving)) return
    body = bodies_of_nodes(scene)
    associate (nodes => dofs%fields(displacement_field)%number, pilots => dofs%fields(pilot_field)%number, &
               section => dofs%fields(section_field)%number)
      ! the section is that of all bodies
      of_body = is_among(reshape(section, [size(section)]), moving)
      do k = 1, size(nodes, 2)
        if (is_among(nodes(:, k), moving)) of_body(body(k)) = .true.
      end do
      do k = 1, size(of_die)
        of_die(k) = is_among(pilots(:, k), moving)
      end do
      changed = .true.
      do while (changed)
        changed = .false.
        closed = .false.
        do g = 1, size(scene%groups)
          if (scene%groups(g)%role == role_contact .and. scene%groups(g)%material > 0) call join_over(g)
        end do
      end do
      if (present(touches)) touches = closed
      do k = 1, size(nodes, 2)
        if (of_body(body(k))) call mark(nodes(:, k), moved)
      end do
      do k = 1, size(of_die)
        if (of_die(k)) call mark(pilots(:, k), moved)
        dies(k) = of_die(k)
        if (is_deformable(scene%dies(k))) dies(k) = any(of_body(body(scene%dies(k)%nodes(1, :))))
      end do
      if (any(of_body)) call mark(reshape(section, [size(section)]), moved)
    end associate

  contains

    !> What touches in a group of contact is moved together.
    subroutine join_over(g)
      integer, intent(in) :: g
      integer :: e, p, one, other
      logical :: corners

      associate (group => scene%groups(g), state => solution%groups(g)%committed)
        corners = find_variable(group%variables, 'corner_place') > 0
        do e = 1, size(state, 3)
          do p = 1, size(state, 2)
            if (.not. is_in_contact(state(:, p, e), corners)) cycle
            one = body(group%connectivity(1, e))
            closed = closed .or. of_body(one)
            if (is_deformable(scene%dies(group%die))) then
              other = nint(state(at_piece, p, e))
              if (other == 0) cycle
              other = body(scene%dies(group%die)%nodes(1, other))
              changed = changed .or. (of_body(one) .neqv. of_body(other))
              of_body([one, other]) = of_body(one) .or. of_body(other)
            else
              changed = changed .or. (of_body(one) .neqv. of_die(group%die))
              of_body(one) = of_body(one) .or. of_die(group%die)
              of_die(group%die) = of_body(one)
            end if
          end do
        end do
      end associate
    end subroutine join_over

  end subroutine move_along

  !> One of some unknowns (0: none) is marked.
  pure function is_among(numbers, marks) result(yes)
    integer, intent(in) :: numbers(:)
    logical, intent(in) :: marks(:)   !! (ndof)
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(numbers)
      if (numbers(k) > 0) yes = yes .or. marks(numbers(k))
    end do
  end function is_among

  !> Mark some unknowns (0: none).
  pure subroutine mark(numbers, marks)
    integer, intent(in) :: numbers(:)
    logical, intent(inout) :: marks(:)   !! (ndof)
    integer :: k

    do k = 1, size(numbers)
      if (numbers(k) > 0) marks(numbers(k)) = .true.
    end do
  end subroutine mark

end module turning_back
