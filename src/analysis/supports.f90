!> Rigid motions of bodies that nothing holds, as far as supports, springs and dies at the start tell.
module supports
  use contact_outlook, only: moves, outlook_t
  use dies, only: is_deformable
  use fields, only: displacement_field
  use kinds, only: wp
  use resting_dies, only: has_spring
  use scene, only: axisymmetric, group_t, is_solid, role_side_load, role_volume_load, scene_t
  use scene_effects, only: has_effect
  use text, only: string_t
  implicit none
  private
  public :: free_motions, is_mechanical_load

  character(len=*), parameter :: directions = 'XY'
  !> A die presses along a direction, and does not hold across it by friction, where its pushes have at least this component.
  real(wp), parameter :: least_component = sqrt(0.5_wp)
  !> Dies push across a direction alone where no push has this component: that of round-off in their rows.
  real(wp), parameter :: no_component = 1.0e-6_wp

contains

  !> A warning for each body, with all it is joined to, and each direction in which nothing holds it: no support, and no contact,
  !> none that touches at the start, dies that press it from one side alone, or across it without friction. In the plane also for a
  !> turn about the only point that is held.
  subroutine free_motions(scene, outlook, warnings)
    type(scene_t), intent(in) :: scene
    type(outlook_t), intent(in) :: outlook(:)   !! (ngroup) of groups that face rigid dies
    type(string_t), allocatable, intent(inout) :: warnings(:)
    integer :: part(size(scene%mesh%coordinates, 2)), g, c
    logical :: touched, near

    call find_parts(scene, part)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      if (.not. is_first(scene, part, g)) cycle
      associate (group => scene%groups(g), own => part(scene%groups(g)%connectivity(1, 1)))
        if (group%material == 0) cycle
        call contacts_of(scene, outlook, part, own, touched, near)
        do c = merge(2, 1, scene%plane_state == axisymmetric), 2
          if (held(scene, part, own, c)) cycle
          if (sprung(scene, part, own, c)) cycle
          if (touched) then
            if (floats_with_dies(scene, part, own, c)) then
              call add(group%name//': nothing says where it is along '//directions(c:c)//', no support, and all dies that face ' &
                       //'it are free there (FORCE, FREE): a support, a SPRNG card, or MOVE for one of them does')
            else if (pressed_from_one_side(scene, outlook, part, own, c)) then
              call add(group%name//': dies press it along '//directions(c:c)//' from one side, and nothing holds it on the ' &
                       //'other, no support and no contact: they would push it ahead of them')
            else if (pressed_across(scene, outlook, part, own, c)) then
              call add(group%name//': nothing says where it is along '//directions(c:c)//', no support, and all dies that face ' &
                       //'it press it across that and without friction: a support, a SPRNG card, or friction does')
            end if
          else if (near) then
            call add(group%name//': nothing holds it in '//directions(c:c)//' before it meets a die: contact alone does, and ' &
                     //'there is a gap')
          else
            call add(group%name//': nothing holds it in '//directions(c:c)//', no support and no contact')
          end if
        end do
        if (scene%plane_state == axisymmetric .or. touched .or. near) cycle
        if (any([(sprung(scene, part, own, c), c=1, 2)])) cycle
        if (held(scene, part, own, 1) .and. held(scene, part, own, 2) .and. .not. held_turning(scene, part, own)) &
          call add(group%name//': nothing keeps it from turning about what holds it')
      end associate
    end do

  contains

    subroutine add(line)
      character(len=*), intent(in) :: line

      warnings = [warnings, string_t(line)]
    end subroutine add

  end subroutine free_motions

  !> Nodes of one body, or of bodies joined, have one number.
  pure subroutine find_parts(scene, part)
    type(scene_t), intent(in) :: scene
    integer, intent(out) :: part(:)   !! (nnode)
    integer :: g, e, k, least
    logical :: changed

    part = [(k, k=1, size(part))]
    do
      changed = .false.
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g))) cycle
        least = huge(least)
        do e = 1, size(scene%groups(g)%connectivity, 2)
          least = min(least, minval(part(scene%groups(g)%connectivity(:, e))))
        end do
        do e = 1, size(scene%groups(g)%connectivity, 2)
          associate (nodes => scene%groups(g)%connectivity(:, e))
            changed = changed .or. any(part(nodes) /= least)
            part(nodes) = least
          end associate
        end do
      end do
      if (.not. changed) exit
    end do
  end subroutine find_parts

  !> The group is the first of its part.
  pure function is_first(scene, part, g) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), g
    logical :: yes
    integer :: k

    yes = .true.
    do k = 1, g - 1
      if (is_solid(scene%groups(k))) &
        yes = yes .and. part(scene%groups(k)%connectivity(1, 1)) /= part(scene%groups(g)%connectivity(1, 1))
    end do
  end function is_first

  !> Contacts of a part: one touches at the start; there is one.
  pure subroutine contacts_of(scene, outlook, part, own, touched, near)
    type(scene_t), intent(in) :: scene
    type(outlook_t), intent(in) :: outlook(:)
    integer, intent(in) :: part(:), own
    logical, intent(out) :: touched, near
    logical :: mine
    integer :: g

    touched = .false.
    near = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        mine = part(group%connectivity(1, 1)) == own
        if (allocated(scene%dies(group%die)%nodes)) then
          mine = mine .or. part(scene%dies(group%die)%nodes(1, 1)) == own
          ! two bodies: whether they touch is not looked at
          touched = touched .or. mine
        else
          touched = touched .or. mine .and. outlook(g)%faces .and. outlook(g)%over_side > -1.0e-3_wp
        end if
        near = near .or. mine
      end associate
    end do
  end subroutine contacts_of

  !> Rigid dies face the part, one of them moves or is pushed, and all would push it to one side; no load pushes it back.
  !> Dies that stand across the direction somewhere may hold it by friction.
  pure function pressed_from_one_side(scene, outlook, part, own, component) result(yes)
    type(scene_t), intent(in) :: scene
    type(outlook_t), intent(in) :: outlook(:)
    integer, intent(in) :: part(:), own, component
    logical :: yes
    real(wp) :: least, largest
    integer :: g
    logical :: mine, driven

    yes = .false.
    driven = .false.
    least = 1
    largest = -1
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        ! groups of dies (springs, heat capacities) have no nodes
        if (size(group%connectivity) == 0) cycle
        mine = part(group%connectivity(1, 1)) == own
        if (mine .and. is_mechanical_load(group)) return
        if (group%die == 0 .or. group%material == 0) cycle
        if (is_deformable(scene%dies(group%die))) return
        if (.not. mine) cycle
        if (.not. outlook(g)%faces) return
        driven = driven .or. moves(scene, group%die) .or. any(scene%die_forces%die == group%die)
        least = min(least, outlook(g)%least_push(component))
        largest = max(largest, outlook(g)%largest_push(component))
      end associate
    end do
    if (any(part(scene%forces%node) == own)) return
    yes = driven .and. (least >= least_component .or. largest <= -least_component)
  end function pressed_from_one_side

  !> Rigid dies face the part at the start, none would push it along a direction, and no contact law has friction.
  pure function pressed_across(scene, outlook, part, own, component) result(yes)
    type(scene_t), intent(in) :: scene
    type(outlook_t), intent(in) :: outlook(:)
    integer, intent(in) :: part(:), own, component
    logical :: yes
    integer, allocatable :: facing(:)

    call list_groups_on_rigid_dies(scene, part, own, facing)
    yes = size(facing) > 0 .and. .not. has_effect(scene, 'friction') .and. &
          all(max(outlook(facing)%largest_push(component), -outlook(facing)%least_push(component)) <= no_component)
  end function pressed_across

  !> Rigid dies face the part, and all of them are free in a direction, without a spring: they and the part move in it as one.
  pure function floats_with_dies(scene, part, own, component) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), own, component
    logical :: yes
    integer, allocatable :: facing(:)
    integer :: k

    call list_groups_on_rigid_dies(scene, part, own, facing)
    yes = size(facing) > 0
    do k = 1, size(facing)
      associate (die => scene%groups(facing(k))%die)
        yes = yes .and. any(scene%die_forces%die == die .and. scene%die_forces%component == component) &
              .and. .not. has_spring(scene, die, component)
      end associate
    end do
  end function floats_with_dies

  !> Groups of contact of the part, all with rigid dies; none where there is a contact with a body, which may hold it.
  pure subroutine list_groups_on_rigid_dies(scene, part, own, facing)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), own
    integer, allocatable, intent(out) :: facing(:)   !! (nfacing)
    integer :: g

    allocate (facing(0))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        ! groups of dies (springs, heat capacities) have no nodes
        if (group%die == 0 .or. group%material == 0 .or. size(group%connectivity) == 0) cycle
        if (is_deformable(scene%dies(group%die))) then
          deallocate (facing)
          allocate (facing(0))
          return
        end if
        if (part(group%connectivity(1, 1)) == own) facing = [facing, g]
      end associate
    end do
  end subroutine list_groups_on_rigid_dies

  !> A load on sides or in a volume that is no heat.
  pure function is_mechanical_load(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = any(group%role == [role_side_load, role_volume_load]) .and. .not. group%brings_heat
  end function is_mechanical_load

  !> Weak springs hold the part in a direction, and with it against a turn.
  pure function sprung(scene, part, own, component) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), own, component
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%is_spring .and. group%direction == component) yes = yes .or. part(group%connectivity(1, 1)) == own
      end associate
    end do
  end function sprung

  !> A support holds a node of the part in a direction.
  pure function held(scene, part, own, component) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), own, component
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(scene%fixations)
      associate (fixation => scene%fixations(k))
        if (fixation%field == displacement_field .and. fixation%component == component) &
          yes = yes .or. any(part(fixation%nodes) == own)
      end associate
    end do
  end function held

  !> Two supports in one direction whose lines of action differ.
  pure function held_turning(scene, part, own) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: part(:), own
    logical :: yes
    real(wp) :: low, high
    integer :: c, k, n

    yes = .false.
    do c = 1, 2
      low = huge(low)
      high = -huge(high)
      do k = 1, size(scene%fixations)
        associate (fixation => scene%fixations(k))
          if (fixation%field /= displacement_field .or. fixation%component /= c) cycle
          do n = 1, size(fixation%nodes)
            if (part(fixation%nodes(n)) /= own) cycle
            low = min(low, scene%mesh%coordinates(3 - c, fixation%nodes(n)))
            high = max(high, scene%mesh%coordinates(3 - c, fixation%nodes(n)))
          end do
        end associate
      end do
      yes = yes .or. high > low
    end do
  end function held_turning

end module supports
