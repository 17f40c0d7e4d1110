!> A scene and a solution in which no member stands at its default value, and visitors that show it.
module member_cases
  use contact_ends, only: contact_end_t
  use contour_cases, only: add_block, add_contact, add_die, begin_scene, box, polyline, start
  use cuts, only: cut_record_t, cut_t
  use dies, only: die_t, place_on_nodes
  use fields, only: field_t, mechanical_fields, on_nodes, transfer_nodal
  use kept_members, only: member_memory_t
  use kinds, only: wp
  use loads, only: fixation_t
  use remesher_options, only: by_gmsh, own_mesh_t
  use remeshing, only: trigger_t
  use run_warnings, only: add_warning
  use scene, only: group_t, role_second, scene_t
  use solution, only: solution_t
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute, transfer_scalar, &
    transfer_tensor
  use mesh_windows, only: mesh_window_t
  use zone_marks, only: contour_card_t, mark_crossing, zone_card_t, zone_mark_t
  implicit none
  private
  public :: default_members_t, filler_t, full_scene, full_solution, full_ends, general_path, same_values

  !> Remembers the members of a type as they are before anything is set, one entry of each list, called `*`.
  type, extends(member_memory_t) :: default_members_t
  contains
    procedure :: listed => one_entry
    procedure :: label => star
  end type default_members_t

  !> Gives every number a value of its own, within its range and below 1 where it has none.
  type, extends(member_memory_t) :: filler_t
    integer :: count = 0
  contains
    procedure :: visit_real => fill_real
    procedure :: visit_reals => fill_reals
    procedure :: visit_integer => fill_integer
    procedure :: visit_integers => fill_integers
    procedure :: visit_text => fill_text
  end type filler_t

contains

  subroutine one_entry(self, name, n)
    class(default_members_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: n

    n = 1
  end subroutine one_entry

  pure function star(self, k) result(label)
    class(default_members_t), intent(in) :: self
    integer, intent(in) :: k
    character(len=:), allocatable :: label

    label = '*'
  end function star

  subroutine fill_real(self, name, value, carried, unit, low, high)
    class(filler_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    character(len=*), intent(in) :: carried
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high

    if (.not. (self%all .or. carried == 'kept')) return
    self%count = self%count + 1
    value = 1.0e-3_wp*self%count
  end subroutine fill_real

  subroutine fill_reals(self, name, values, carried, extents, unit, low, high)
    class(filler_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: values(:)
    character(len=*), intent(in) :: carried, extents
    character(len=*), intent(in), optional :: unit
    real(wp), intent(in), optional :: low, high
    integer :: k

    self%count = self%count + 1
    values = [(1.0e-3_wp*self%count + 1.0e-6_wp*k, k=1, size(values))]
  end subroutine fill_reals

  subroutine fill_integer(self, name, value, carried, low, high)
    class(filler_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    character(len=*), intent(in) :: carried
    integer, intent(in), optional :: low, high

    if (name == 'count' .or. .not. (self%all .or. carried == 'kept')) return
    self%count = self%count + 1
    value = self%count
    if (present(high)) value = high
  end subroutine fill_integer

  subroutine fill_integers(self, name, values, carried, extents, low, high)
    class(filler_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: values(:)
    character(len=*), intent(in) :: carried, extents
    integer, intent(in), optional :: low, high

    values = 1
  end subroutine fill_integers

  subroutine fill_text(self, name, value, carried)
    class(filler_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(inout) :: value
    character(len=*), intent(in) :: carried
  end subroutine fill_text

  !> Two bodies about an axis: a die of pieces under the one, the other a die made of sides; zones and contours.
  subroutine full_scene(scene)
    type(scene_t), intent(out) :: scene
    type(die_t) :: sides
    type(field_t) :: temperature
    type(group_t) :: second

    call begin_scene(scene, .true.)
    call add_block(scene, 'lower', box([1.0_wp, 0.0_wp], [3.0_wp, 1.0_wp], [2, 1]))
    call add_block(scene, 'upper', box([1.0_wp, 2.0_wp], [3.0_wp, 3.0_wp], [2, 1]))
    scene%finite = .false.
    scene%follows_path = .true.
    scene%generation = 3
    scene%operation = 2
    scene%mesh%origin = scene%mesh%coordinates + 0.1_wp
    call add_die(scene, polyline(reshape([0.5_wp, 0.0_wp, 4.0_wp, 0.0_wp], [2, 2]), [0.5_wp, -1.0_wp, 0.25_wp]))
    sides%name = 'above'
    sides%unasked = .true.
    sides%nodes = scene%mesh%sides(5)%nodes(3:1:-1, size(scene%mesh%sides(5)%nodes, 2):1:-1)
    allocate (sides%pieces(2, 3, size(sides%nodes, 2)))
    call place_on_nodes(scene%mesh%coordinates, sides)
    call add_die(scene, sides)
    call add_contact(scene, 1, 1, 2)
    call add_contact(scene, 3, 2, -3)
    scene%groups(3)%rule_is_chosen = .true.
    second = scene%groups(1)
    second%role = role_second
    second%host = 1
    second%name = 'heat'
    allocate (scene%materials(2))
    scene%materials(1)%name = 'steel'
    scene%materials(2)%name = 'tool'
    call append(second)
    call contact_variables(scene%groups(3)%variables)
    call contact_variables(scene%groups(4)%variables)
    scene%fixations = [fixation_t(nodes=[1, 3], component=2)]
    allocate (scene%walls(1))
    scene%walls(1)%label = 'FIXED lower.1 Y'
    scene%walls(1)%component = 2
    scene%walls(1)%side = -1
    scene%walls(1)%node = 3
    temperature = field_t(name='temperature', unit='temperature', dual='heat_flow', dual_unit='power', place=on_nodes, &
                          at_corners=.true., ncomp=1, quantity='temperature', imposed_as_value=.true., given=.true., &
                          transfer=transfer_nodal, word='T', initial=20.0_wp, declared=.true.)
    scene%fields = [mechanical_fields(), temperature]
    call fill_options()

  contains

    subroutine append(group)
      type(group_t), intent(in) :: group
      type(group_t), allocatable :: groups(:)
      integer :: k

      allocate (groups(size(scene%groups) + 1))
      do k = 1, size(scene%groups)
        groups(k) = scene%groups(k)
        deallocate (groups(k)%variables)
        allocate (groups(k)%variables(1))
        groups(k)%variables(1) = state_variable('stress', 'stress', transfer_tensor, 4)
        groups(k)%variables(1)%first = 1
        groups(k)%variables(1)%initial = 0.5_wp
      end do
      groups(size(groups)) = group
      groups(4)%pairs = 1
      groups(3)%material = 2
      call move_alloc(groups, scene%groups)
    end subroutine append

    subroutine fill_options()
      associate (options => scene%remesher)
        options%wanted = .true.
        options%transfer = 2
        options%exponent = 3.0_wp
        options%neighbours = 20
        options%smallest = 0.1_wp
        options%smallest_at_bends = 0.05_wp
        options%smallest_at_corners = 0.04_wp
        options%turn_at_dies = 0.2_wp
        options%largest = 0.7_wp
        options%strain_error = 0.06_wp
        options%most_elements = 77
        options%across_contact = 5
        options%turn = 0.4_wp
        options%stretch = 2.5_wp
        options%mesher = by_gmsh
        options%tries = 6
        options%windows = [mesh_window_t(low=[0.1_wp, 0.2_wp], high=[0.3_wp, 0.5_wp], smallest=0.02_wp, largest=0.04_wp, &
                                         by_matter=.true., die=1)]
        options%own_mesh = own_mesh_t(12, 0.3_wp, 0.6_wp, [0.9_wp, 0.8_wp])
        options%across_slender = 4.0_wp
        allocate (options%marks(1), options%zones(1), options%contours(1), options%cuts(1))
        options%marks(1) = zone_mark_t(name='corner', form=mark_crossing, x=[0.3_wp, 0.4_wp], axis=1, pick=-1, by_matter=.true., &
                                       die=1, stays=.true.)
        options%cuts(1) = cut_t(group=2, line=[0.1_wp, 0.2_wp, 0.3_wp, 0.4_wp], die=1, thickness=0.05_wp, names_kept=.true., &
                                kept=[0.6_wp, 0.7_wp])
        options%zones(1) = zone_card_t(name='zone', group=2, marks=[1, 1, 1, 1])
        options%contours(1) = contour_card_t(group=2, pieces=reshape([1, 2, 3, 4, 5, 6]*0.5_wp, [2, 3, 1]), row=[4], &
                                               loop=[1], smallest=0.03_wp, largest=0.7_wp)
      end associate
      scene%remesh%estimate = .true.
    end subroutine fill_options

  end subroutine full_scene

  !> What contact must have.
  subroutine contact_variables(list)
    type(state_variable_t), allocatable, intent(out) :: list(:)
    character(len=14), parameter :: names(5) = ['contact_status', 'penetration   ', 'pressure      ', 'die_piece     ', &
                                                'die_xi        ']
    integer :: k

    allocate (list(size(names)))
    do k = 1, size(names)
      list(k) = state_variable(trim(names(k)), 'length', transfer_contact)
      list(k)%first = k
    end do
    list(1)%transfer = transfer_recompute
    list(2)%transfer = transfer_scalar
  end subroutine contact_variables

  !> All numbers of a solution set.
  subroutine full_solution(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(out) :: solution
    type(filler_t) :: filler
    integer :: g

    call start(scene, solution)
    do g = 1, size(scene%groups)
      allocate (solution%groups(g)%laid(2, size(scene%groups(g)%connectivity, 1), size(scene%groups(g)%connectivity, 2)))
    end do
    call fill(filler, solution)
    solution%spurious_group = 2
    if (allocated(solution%cuts)) deallocate (solution%cuts)
    allocate (solution%cuts(1))
    solution%cuts(1) = cut_record_t(generation=2, time=0.3_wp, volume=0.2_wp, thickness=0.1_wp, force=12.0_wp)
    deallocate (solution%estimate%triggers)
    allocate (solution%estimate%triggers(2))
    solution%estimate%triggers(1)%name = 'aspect_ratio'
    solution%estimate%triggers(1) = trigger_t('aspect_ratio', 12.5_wp, 10.0_wp, 1, 2)
    solution%estimate%triggers(2) = trigger_t('time', 0.5_wp, 0.4_wp, 0, 0)
    call add_warning(solution%warnings, 'press', 'billet has thinned to 9 %', 'a check', again=.true.)
    call add_warning(solution%warnings, 'release', 'the die is deep', 'another', again=.true.)
  end subroutine full_solution

  subroutine fill(filler, solution)
    use visit_solution, only: visit_solution_members
    type(filler_t), intent(inout) :: filler
    type(solution_t), intent(inout) :: solution

    filler%all = .true.
    call visit_solution_members(filler, solution)
  end subroutine fill

  !> Two ends of contact.
  subroutine full_ends(ends)
    type(contact_end_t), allocatable, intent(out) :: ends(:)

    allocate (ends(2))
    ends(1) = contact_end_t(begins=.false., group=3, side=2, place=0.25_wp, piece=1, xi=-0.5_wp)
    ends(2) = contact_end_t(begins=.true., group=3, side=1, place=-0.25_wp, piece=1, xi=0.5_wp)
  end subroutine full_ends

  !> `groups/2/variables/1/name` -> `groups/*/variables/*/name`, `fields/pilot/value` -> `fields/*/value`.
  pure function general_path(path) result(general)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: general
    character(len=:), allocatable :: word
    integer :: first, last

    general = ''
    first = 1
    do while (first <= len(path))
      last = first + index(path(first:)//'/', '/') - 2
      word = path(first:last)
      if (verify(word, '0123456789') == 0 .or. general == 'fields/') word = '*'
      general = general//word//'/'
      first = last + 2
    end do
    general = general(:len(general) - 1)
  end function general_path

  !> Member i of one memory has the values of member k of another.
  pure function same_values(one, i, other, k) result(same)
    class(member_memory_t), intent(in) :: one, other
    integer, intent(in) :: i, k
    logical :: same

    associate (a => one%members(i), b => other%members(k))
      same = (allocated(a%reals) .eqv. allocated(b%reals)) .and. (allocated(a%integers) .eqv. allocated(b%integers)) .and. &
             (allocated(a%text) .eqv. allocated(b%text))
      if (.not. same) return
      if (allocated(a%reals)) then
        same = size(a%reals) == size(b%reals)
        if (same) same = all(.not. abs(a%reals - b%reals) > 0)
      else if (allocated(a%integers)) then
        same = size(a%integers) == size(b%integers)
        if (same) same = all(a%integers == b%integers)
      else if (allocated(a%text)) then
        same = len(a%text) == len(b%text) .and. a%text == b%text
      end if
    end associate
  end function same_values

end module member_cases
