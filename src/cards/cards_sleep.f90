!> ASLEEP: bodies that are not there in an operation, such as the filler of a weld before it is laid down.
!>
!> What is asleep has no elements in the scene: no stiffness, no heat content, no unknowns of its own, no cost. Its nodes stay in
!> the mesh, where they are, so that all operations have one mesh. An operation in which the body is awake for the first time has
!> it without stress, at the temperature of its START card; nodes that it shares with others have a common one (laid_bodies).
module cards_sleep
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use dies, only: is_deformable
  use loads, only: start_t
  use probes, only: probe_node, probe_reaction, probe_t
  use scene, only: group_t, host_of, is_solid, scene_t, wall_t
  use text, only: string_t
  use walls, only: find_walls
  implicit none
  private
  public :: list_sleepers, may_sleep, put_to_sleep, sleep_keyword

  character(len=*), parameter :: sleep_keyword = 'ASLEEP'

contains

  !> Does any operation have this body asleep?
  pure function may_sleep(deck, body) result(yes)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: body
    logical :: yes
    integer :: i, k

    yes = .false.
    do i = 1, size(deck%cards)
      if (all(deck%cards(i)%keyword /= [sleep_keyword//' ', '-'//sleep_keyword])) cycle
      do k = 1, size(deck%cards(i)%head%fields)
        yes = yes .or. deck%cards(i)%head%fields(k)%text == body
      end do
    end do
  end function may_sleep

  !> Words of the ASLEEP cards of an operation, as they are read.
  pure subroutine list_sleepers(deck, names)
    type(deck_t), intent(in) :: deck
    type(string_t), allocatable, intent(out) :: names(:)   !! (n)
    type(string_t) :: more(1)
    integer :: i, k

    allocate (names(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= sleep_keyword) cycle
      do k = 1, size(deck%cards(i)%head%fields)
        more(1)%s = deck%cards(i)%head%fields(k)%text
        names = [names, more]
      end do
    end do
  end subroutine list_sleepers

  !> Take the bodies of the ASLEEP cards out of the scene of an operation, and what belongs to them.
  subroutine put_to_sleep(deck, scene, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(scene_t), intent(inout) :: scene
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(string_t), allocatable :: names(:)
    type(cursor_t) :: cursor
    integer, allocatable :: bodies(:)
    logical :: asleep(size(scene%groups)), awake(size(scene%mesh%labels))
    character(len=:), allocatable :: held
    integer :: g, i, k

    asleep = .false.
    bodies = pack([(g, g=1, size(scene%groups))], is_solid(scene%groups))
    allocate (names(size(bodies)))
    do k = 1, size(bodies)
      names(k)%s = scene%groups(bodies(k))%name
    end do
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= sleep_keyword) cycle
      call cursor%open(deck%cards(i), diagnostics)
      do
        call cursor%name('the name of a body', names, k)
        if (k == 0) exit
        if (asleep(bodies(k))) call cursor%fail(''''//names(k)%s//''' is asleep already')
        asleep(bodies(k)) = .true.
        if (.not. cursor%more()) exit
      end do
      if (all(asleep(bodies))) call cursor%fail('all bodies are asleep')
      if (cursor%failed()) return
      call list_awake(scene, asleep, awake)
      call what_acts_on_sleepers(scene, awake, held)
      if (held /= '') call cursor%fail(''''//held//''' acts on a body that is asleep: expected it in operations that have the body')
      call cursor%end_card()
      if (cursor%failed()) return
    end do
    if (any(asleep)) call take_out(asleep, awake, scene)
  end subroutine put_to_sleep

  !> Nodes of bodies that are awake.
  pure subroutine list_awake(scene, asleep, awake)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: asleep(:)   !! (ngroup)
    logical, intent(out) :: awake(:)   !! (nnode)
    integer :: g

    awake = .false.
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g)) .and. .not. asleep(g)) awake([scene%groups(g)%connectivity]) = .true.
    end do
  end subroutine list_awake

  !> Contact, exchange of heat or a load on sides, a deformable die or a force at a node that is not there; '' for none.
  pure subroutine what_acts_on_sleepers(scene, awake, held)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: awake(:)   !! (nnode)
    character(len=:), allocatable, intent(out) :: held
    integer :: k

    held = ''
    do k = size(scene%groups), 1, -1
      if (size(scene%groups(k)%connectivity, 1) /= 3) cycle
      if (.not. all(awake([scene%groups(k)%connectivity]))) held = scene%groups(k)%name
    end do
    do k = 1, size(scene%dies)
      if (.not. is_deformable(scene%dies(k))) cycle
      if (.not. all(awake([scene%dies(k)%nodes]))) held = scene%dies(k)%name
    end do
    do k = 1, size(scene%forces)
      if (.not. awake(scene%forces(k)%node)) held = 'FORCE'
    end do
  end subroutine what_acts_on_sleepers

  !> The scene without these bodies: formulations and loads on their volume go with them, and probes that read them.
  pure subroutine take_out(asleep, awake, scene)
    logical, intent(in) :: asleep(:)   !! (ngroup)
    logical, intent(in) :: awake(:)    !! (nnode)
    type(scene_t), intent(inout) :: scene
    logical :: stays(size(asleep))
    integer :: number(0:size(asleep))
    integer :: g, k

    number = 0
    k = 0
    do g = 1, size(asleep)
      stays(g) = .not. asleep(host_of(scene, g))
      if (.not. stays(g)) cycle
      k = k + 1
      number(g) = k
    end do
    call keep_some(pack([(k, k=1, size(stays))], stays), &
                   pack([(k, k=1, size(scene%starts))], [(starts_awake(scene, asleep, k), k=1, size(scene%starts))]), number, scene)
    do k = 1, size(scene%fixations)
      scene%fixations(k)%nodes = pack(scene%fixations(k)%nodes, awake(scene%fixations(k)%nodes))
    end do
    do k = 1, size(scene%mesh%sides)
      call keep_sides(awake, scene%mesh%sides(k)%nodes)
    end do
    call keep_probes(number, awake, scene)
    ! without the sleepers a line may be another
    call find_walls([wall_t ::], scene)
  end subroutine take_out

  !> Groups and values at the start that stay. (Lists of types with allocatable components are copied one by one.)
  pure subroutine keep_some(groups, starts, number, scene)
    integer, intent(in) :: groups(:), starts(:)   !! (n) places in the lists of the scene
    integer, intent(in) :: number(0:)             !! (0:ngroup) new numbers, 0 for what is asleep
    type(scene_t), intent(inout) :: scene
    type(group_t), allocatable :: some_groups(:)
    type(start_t), allocatable :: some_starts(:)
    integer :: k

    allocate (some_groups(size(groups)), some_starts(size(starts)))
    do k = 1, size(groups)
      some_groups(k) = scene%groups(groups(k))
      some_groups(k)%host = number(some_groups(k)%host)
    end do
    do k = 1, size(starts)
      some_starts(k) = scene%starts(starts(k))
    end do
    call move_alloc(some_groups, scene%groups)
    call move_alloc(some_starts, scene%starts)
  end subroutine keep_some

  !> Sides of bodies that are awake.
  pure subroutine keep_sides(awake, nodes)
    logical, intent(in) :: awake(:)                      !! (nnode)
    integer, allocatable, intent(inout) :: nodes(:, :)   !! (3, n)
    integer, allocatable :: stays(:)
    integer :: k

    allocate (stays, source=pack([(k, k=1, size(nodes, 2))], awake(nodes(2, :))))
    if (size(stays) < size(nodes, 2)) nodes = nodes(:, stays)
  end subroutine keep_sides

  !> Probes that still read something.
  pure subroutine keep_probes(number, awake, scene)
    integer, intent(in) :: number(0:)   !! (0:ngroup) new numbers, 0 for what is asleep
    logical, intent(in) :: awake(:)     !! (nnode)
    type(scene_t), intent(inout) :: scene
    type(probe_t), allocatable :: some(:)
    logical :: stays(size(scene%probes))
    integer :: k, n

    do k = 1, size(stays)
      call renumber_probe(number, scene%probes(k))
      stays(k) = is_readable(scene%probes(k), awake)
    end do
    allocate (some(count(stays)))
    n = 0
    do k = 1, size(stays)
      if (.not. stays(k)) cycle
      n = n + 1
      some(n) = scene%probes(k)
    end do
    call move_alloc(some, scene%probes)
  end subroutine keep_probes

  !> The values are those of a body that is awake, or of all.
  pure function starts_awake(scene, asleep, k) result(yes)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: asleep(:)   !! (ngroup)
    integer, intent(in) :: k           !! place in the list of starts
    logical :: yes
    integer :: g

    yes = .true.
    do g = 1, size(asleep)
      if (asleep(g) .and. scene%starts(k)%body == scene%groups(g)%name) yes = .false.
    end do
  end function starts_awake

  !> Groups of a probe by their new numbers; those that are asleep are no part of a mean.
  pure subroutine renumber_probe(number, probe)
    integer, intent(in) :: number(0:)   !! (0:ngroup) new numbers, 0 for what is asleep
    type(probe_t), intent(inout) :: probe
    logical, allocatable :: stays(:)

    if (probe%group == 0) return
    probe%group = number(probe%group)
    ! one that reads nothing any more is marked by no group
    if (.not. allocated(probe%more_groups)) return
    probe%more_groups = number(probe%more_groups)
    allocate (stays(size(probe%more_groups)))
    stays = probe%more_groups > 0
    probe%more_components = pack(probe%more_components, stays)
    probe%more_groups = pack(probe%more_groups, stays)
    if (probe%group > 0 .or. size(probe%more_groups) == 0) return
    probe%group = probe%more_groups(1)
    probe%component = probe%more_components(1)
    probe%more_groups = probe%more_groups(2:)
    probe%more_components = probe%more_components(2:)
  end subroutine renumber_probe

  pure function is_readable(probe, awake) result(yes)
    type(probe_t), intent(in) :: probe
    logical, intent(in) :: awake(:)   !! (nnode)
    logical :: yes

    select case (probe%kind)
    case (probe_node)
      yes = all(awake(probe%nodes))
    case (probe_reaction)
      yes = any(awake(probe%nodes))
    case default
      yes = probe%group > 0
    end select
  end function is_readable

end module cards_sleep
