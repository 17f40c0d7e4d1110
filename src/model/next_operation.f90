!> What an operation takes over from the one before: the bodies with their mesh, motion, temperatures and the state of their points.
!>
!> Dies, loads and contacts are those of the operation. A contact that both have, of the same sides with the same die at the same
!> place, goes on. The mesh is that of the one before, as a generation of its own: files and remeshing know nothing of operations.
module next_operation
  use fields, only: displacement_field, find_field, on_nodes, on_section, pilot_field
  use finer_temperatures, only: start_finer, take_finer
  use kinds, only: wp
  use new_bodies, only: note_laid, place_new_nodes
  use remesh, only: remesh_t
  use same_dies, only: same_die, same_place
  use scene, only: group_t, is_solid, pilot_at, scene_t
  use solution, only: solution_t, start_solution
  use state_variables, only: find_variable
  implicit none
  private
  public :: begin_operation, mesh_for_operation, remesh_of, same_group

contains

  !> The mesh of a scene, for the cards.
  pure subroutine remesh_of(scene, step, remesh)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: step   !! steps made so far
    type(remesh_t), intent(inout) :: remesh
    integer :: g

    remesh%generation = scene%generation
    remesh%operation = scene%operation
    remesh%step = step
    remesh%coordinates = scene%mesh%coordinates
    remesh%origin = scene%mesh%origin
    remesh%own_mesh = scene%remesher%own_mesh
    if (.not. allocated(remesh%folding)) allocate (remesh%folding(0))
    allocate (remesh%sides, source=scene%mesh%sides)
    if (allocated(scene%walls)) remesh%walls = scene%walls
    allocate (remesh%groups(size(scene%groups)))
    do g = 1, size(scene%groups)
      remesh%groups(g)%name = scene%groups(g)%name
      remesh%groups(g)%role = scene%groups(g)%role
      remesh%groups(g)%connectivity = scene%groups(g)%connectivity
    end do
  end subroutine remesh_of

  !> The same for the operation that follows.
  pure subroutine mesh_for_operation(scene, step, remesh)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: step   !! steps made so far
    type(remesh_t), intent(out) :: remesh

    call remesh_of(scene, step, remesh)
    remesh%generation = scene%generation + 1
    remesh%operation = scene%operation + 1
  end subroutine mesh_for_operation

  !> The state with which an operation begins. The part is in equilibrium with the dies of the one before: it is `unbalanced`.
  pure subroutine begin_operation(old, before, new, after)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(scene_t), intent(in) :: new
    type(solution_t), intent(out) :: after
    type(solution_t) :: fresh
    logical :: was_there(size(new%mesh%coordinates, 2))
    integer :: f, g, k

    call start_solution(new, fresh, before%time)
    call start_finer(new, fresh%heat%finer)
    do k = 1, size(new%dies)
      fresh%fields(pilot_field)%value(:, k) = pilot_at(new, k, before%time)
    end do
    call keep_free_dies(old, before, new, fresh%fields(pilot_field)%value)
    after = before
    after%unbalanced = .true.
    after%next_step = fresh%next_step
    after%last_step = 0
    after%older_step = 0
    after%probation = fresh%probation
    after%crossing = fresh%crossing
    after%pace = fresh%pace
    after%sunk_group = 0
    after%sunk_depth = 0
    after%sunk_share = 0
    after%largest_force = 0
    after%confinement = fresh%confinement
    after%narrow = fresh%narrow
    after%unsettled_steps = 0
    after%unsettled_share = 0
    after%damping = 0
    after%damping_bound = after%work%damping
    after%friction_apart = 0
    after%path%error = fresh%path%error
    ! what its last steps erred says nothing of the first ones now, which no estimate is made of (settle_path)
    after%path%motion_rate = 0
    after%path%stress_rate = 0
    after%path%smooth_rate = fresh%path%smooth_rate
    ! the dies are others, with temperatures of their own
    after%heat%die_error = fresh%heat%die_error
    after%heat%finer = fresh%heat%finer
    after%heat%finer_content = fresh%heat%finer_content
    call take_finer(old, before%heat, new, after%heat)
    after%estimate = fresh%estimate
    ! what this mesh errs is seen on it later too
    after%estimate%carried_stress = before%estimate%carried_stress*before%estimate%stress_left
    after%estimate%began = before%estimate%began
    after%estimate%first_stress = before%estimate%first_stress
    after%estimate%first_narrow = before%estimate%first_narrow
    after%cuts = fresh%cuts
    after%estimate%last_stop = before%step
    after%fields = fresh%fields
    was_there = .false.
    do g = 1, size(old%groups)
      if (is_solid(old%groups(g))) was_there([old%groups(g)%connectivity]) = .true.
    end do
    ! bodies have come or gone: volumes are compared with that of now, and what temperatures make of them counts from now on
    if (.not. same_bodies(old, new)) then
      after%initial_volume = 0
      after%work%grown = 0
    end if
    do f = 1, size(after%fields)
      k = find_field(before%fields, after%fields(f)%name)
      if (k == 0 .or. .not. any(after%fields(f)%place == [on_nodes, on_section])) cycle
      if (any(shape(before%fields(k)%value) /= shape(after%fields(f)%value))) cycle
      if (after%fields(f)%place == on_section) then
        after%fields(f)%value = before%fields(k)%value
      else if (size(after%fields(f)%value, 2) == size(was_there)) then
        where (spread(was_there, 1, after%fields(f)%ncomp)) after%fields(f)%value = before%fields(k)%value
      end if
    end do
    if (after%fields(displacement_field)%declared) call place_new_nodes(new, was_there, after%fields(displacement_field)%value)
    after%groups = fresh%groups
    after%pairs = fresh%pairs
    do g = 1, size(new%groups)
      k = same_group(old, before, new, fresh, g)
      if (k == 0) then
        if (is_solid(new%groups(g)) .and. .not. new%finite) &
          call note_laid(new%groups(g), after%fields(displacement_field)%value, after%groups(g)%laid)
        cycle
      end if
      if (allocated(before%groups(k)%laid)) after%groups(g)%laid = before%groups(k)%laid
      call take_state(old%groups(k), before%groups(k)%committed, new%groups(g), after%groups(g)%committed)
      if (size(before%groups(k)%error, 3) == size(after%groups(g)%error, 3)) then
        call take_state(old%groups(k), before%groups(k)%error, new%groups(g), after%groups(g)%error)
      else if (size(after%groups(g)%error) > 0) then
        after%path%unknown = 1
      end if
      if (size(before%groups(k)%space_error, 3) == size(after%groups(g)%space_error, 3)) &
        call take_state(old%groups(k), before%groups(k)%space_error, new%groups(g), after%groups(g)%space_error)
      if (size(before%groups(k)%span) == size(after%groups(g)%span)) after%groups(g)%span = before%groups(k)%span
      after%groups(g)%trial = after%groups(g)%committed
      if (new%groups(g)%pairs == 0 .or. new%groups(g)%host > 0 .or. old%groups(k)%pairs == 0) cycle
      if (all(shape(after%pairs(new%groups(g)%pairs)%piece) == shape(before%pairs(old%groups(k)%pairs)%piece))) &
        after%pairs(new%groups(g)%pairs)%piece = before%pairs(old%groups(k)%pairs)%piece
    end do
  end subroutine begin_operation

  !> A die of both operations that is free in the new one, to go where its force takes it, begins where the one before has left it;
  !> unless its card puts it elsewhere now.
  pure subroutine keep_free_dies(old, before, new, pilots)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before
    real(wp), intent(inout) :: pilots(:, :)   !! x, y, angle (3, ndie) [length], [length], [rad]
    integer :: i, k

    do i = 1, size(new%die_forces)
      associate (die => new%die_forces(i)%die, component => new%die_forces(i)%component)
        do k = 1, size(old%dies)
          if (.not. same_die(old%dies(k), new%dies(die))) cycle
          if (same_place(new%dies(die), old%dies(k)%pilot, new%dies(die)%pilot)) &
            pilots(component, die) = before%fields(pilot_field)%value(component, k)
        end do
      end associate
    end do
  end subroutine keep_free_dies

  !> Are the bodies of both operations the same?
  pure function same_bodies(old, new) result(same)
    type(scene_t), intent(in) :: old, new
    logical :: same
    integer :: g, k

    same = count(is_solid(old%groups)) == count(is_solid(new%groups))
    do g = 1, size(new%groups)
      if (.not. is_solid(new%groups(g))) cycle
      same = same .and. any([(old%groups(k)%name == new%groups(g)%name, k=1, size(old%groups))])
    end do
  end function same_bodies

  !> The group of the operation before that goes on as this one, 0 where there is none.
  pure function same_group(old, before, new, fresh, g) result(k)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before, fresh
    integer, intent(in) :: g   !! place in the new list
    integer :: k
    logical :: same

    associate (group => new%groups(g))
      do k = 1, size(old%groups)
        associate (other => old%groups(k))
          same = other%name == group%name .and. other%role == group%role .and. other%elem == group%elem &
                 .and. other%rule%n == group%rule%n .and. all(shape(other%connectivity) == shape(group%connectivity))
          if (same) same = all(other%connectivity == group%connectivity) .and. (other%die > 0 .eqv. group%die > 0)
          if (same .and. group%die > 0) same = same_die(old%dies(other%die), new%dies(group%die)) &
            .and. same_place(old%dies(other%die), place_of(before, other%die), place_of(fresh, group%die))
          if (same) return
        end associate
      end do
    end associate
    k = 0
  end function same_group

  !> Where a die stands (x, y, angle).
  pure function place_of(solution, die) result(place)
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: die
    real(wp) :: place(3)   !! [length], [length], [rad]

    place = solution%fields(pilot_field)%value(:, die)
  end function place_of

  !> The state of points, variable by variable; one that the operation before did not have begins at its declared value.
  pure subroutine take_state(old, before, new, after)
    type(group_t), intent(in) :: old, new
    real(wp), intent(in) :: before(:, :, :)     !! (component, point, element) [unit of the variable]
    real(wp), intent(inout) :: after(:, :, :)   !! (component, point, element) [unit of the variable]
    integer :: v, k, n

    do v = 1, size(new%variables)
      k = find_variable(old%variables, new%variables(v)%name)
      if (k == 0) cycle
      n = new%variables(v)%ncomp
      if (old%variables(k)%ncomp /= n) cycle
      after(new%variables(v)%first:new%variables(v)%first + n - 1, :, :) = &
        before(old%variables(k)%first:old%variables(k)%first + n - 1, :, :)
    end do
  end subroutine take_state

end module next_operation
