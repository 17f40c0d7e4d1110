!> Free dies that nothing holds, or that go on without end under their force: why a run cannot go on.
module unheld_dies
  use contact_changes, only: touching_dies
  use contact_state, only: at_pressure, is_in_contact
  use equations, only: equations_t
  use fields, only: pilot_field
  use history, only: circumference
  use kinds, only: wp
  use loads, only: die_force_t, multiplier_at
  use resting_dies, only: has_spring, unresisted_pilots
  use scene, only: role_contact, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use text, only: to_text
  implicit none
  private
  public :: find_unheld_die, limit_load_words, unheld_die_t, unheld_die_words

  character(len=*), parameter :: names(3) = ['along X ', 'along Y ', 'to turn ']
  !> A force is near a limit where its die goes so many times as far for a little more of it as it did for all of it.
  real(wp), parameter :: goes_far = 20.0_wp

  !> A component of a free die that nothing resists in an attempt at a step.
  type :: unheld_die_t
    !> The die, 0 for none; and X, Y or the angle (1, 2, 3).
    integer :: die = 0, component = 0
    !> Points of contact that touched it at the start of the step, and in the attempt.
    integer :: before = 0, now = 0
    !> Its force takes it to the part in the step (seating).
    logical :: seated = .false.
  end type unheld_die_t

contains

  !> The first component of a die that no force answers in the last matrix of an attempt that failed.
  pure function find_unheld_die(scene, equations, solution, singular) result(unheld)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: singular   !! the attempt failed for a singular matrix
    type(unheld_die_t) :: unheld
    logical :: unresisted(3, size(scene%dies))
    integer :: s, k, before(size(scene%dies)), now(size(scene%dies))

    if (size(scene%die_forces) == 0) return
    unresisted = equations%slides
    do s = 1, size(equations%solves)
      if (singular .and. equations%solves(s)%own(pilot_field)) unresisted = unresisted_pilots(equations%dofs, equations%solves(s))
    end do
    if (.not. any(unresisted)) return
    before = touching_dies(scene, solution, at_start=.true.)
    now = touching_dies(scene, solution)
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        if (.not. unresisted(load%component, load%die)) cycle
        unheld = unheld_die_t(load%die, load%component, before(load%die), now(load%die), equations%seated(load%die) > 0)
        return
      end associate
    end do
  end function find_unheld_die

  !> What has happened to such a die, and what it needs.
  function unheld_die_words(scene, solution, unheld) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(unheld_die_t), intent(in) :: unheld
    character(len=:), allocatable :: words

    words = ''
    if (unheld%die == 0) return
    words = 'die '//scene%dies(unheld%die)%name//' is free '//trim(names(unheld%component))
    if (unheld%before == 0 .and. unheld%now == 0 .and. unheld%seated) then
      words = words//', and where its force takes it to the part nothing holds it: it slips or rolls off what it touches first; ' &
              //'a SPRNG card holds it where no force pushes it'
    else if (unheld%before == 0 .and. unheld%now == 0) then
      words = words//' and touches nothing, nor does a force push it to a side that faces it: a SPRNG card holds it until it ' &
              //'does'
    else if (unheld%now > 0) then
      words = words//', and nothing resists it there: what touches it slides, and friction bears no more; a SPRNG card holds it, ' &
              //'or MOVE drives it'
    else if (.not. still_presses()) then
      words = words//', and at time '//to_text(solution%time, 6)//' its force lets it go'//last_place() &
              //': a SPRNG card holds it, or an operation (OPERA) goes on without it'
    else
      words = words//', and at time '//to_text(solution%time, 6)//' it loses the last that carries it'//last_place() &
              //': the part slides out from under it, or flows away as at a limit load (a die that MOVE drives, in place of ' &
              //'FORCE, goes beyond it); a fixed body beside the part that faces it (CNT2D) stops it as distance blocks do, ' &
              //'or an operation (OPERA) goes on without it'
    end if

  contains

    !> Its force is as large as a step ago, or larger.
    function still_presses() result(yes)
      logical :: yes
      real(wp) :: force
      integer :: k

      yes = .false.
      do k = 1, size(scene%die_forces)
        associate (load => scene%die_forces(k))
          if (load%die /= unheld%die .or. load%component /= unheld%component .or. load%multiplier == 0) cycle
          force = force_at(scene, load, solution%time)
          yes = abs(force) > 0 .and. force*(force - force_at(scene, load, solution%time - solution%last_step)) >= 0
        end associate
      end do
    end function still_presses

    !> Where the die bore on the part at the start of the step.
    function last_place() result(place)
      character(len=:), allocatable :: place
      real(wp), allocatable :: x(:, :)
      real(wp) :: pressure, largest
      logical :: corners
      integer :: g, e, p, node
      character(len=:), allocatable :: name

      place = ''
      largest = -1
      node = 0
      do g = 1, size(scene%groups)
        if (scene%groups(g)%role /= role_contact .or. scene%groups(g)%die /= unheld%die) cycle
        corners = find_variable(scene%groups(g)%variables, 'corner_place') > 0
        do e = 1, size(scene%groups(g)%connectivity, 2)
          associate (state => solution%groups(g)%committed(:, :, e))
            if (.not. any([(is_in_contact(state(:, p), corners), p=1, size(state, 2))])) cycle
            pressure = maxval(state(at_pressure, :))
            if (.not. pressure > largest) cycle
            largest = pressure
            node = scene%groups(g)%connectivity(2, e)
            name = scene%groups(g)%name
          end associate
        end do
      end do
      if (node == 0) return
      allocate (x, source=present_coordinates(scene, solution))
      place = ' ('//name//', the side at node '//to_text(scene%mesh%labels(node))//', x = '//to_text(x(1, node), 4)//', y = ' &
              //to_text(x(2, node), 4)//')'
    end function last_place
  end function unheld_die_words

  !> A die under a force that grows, and that goes ever further for it, or past a limit point in the attempt that failed: its force
  !> is near the largest that the part bears, or of a part of its way, as where a node passes an edge.
  function limit_load_words(scene, solution, past_limit) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: past_limit   !! the attempt has been past a limit point
    character(len=:), allocatable :: words
    real(wp) :: force, more, way, further
    logical :: far
    integer :: k

    words = ''
    if (.not. solution%last_step > 0) return
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k), pilots => solution%fields(pilot_field))
        if (load%multiplier == 0 .or. has_spring(scene, load%die, load%component)) cycle
        force = force_at(scene, load, solution%time)
        more = force - force_at(scene, load, solution%time - solution%last_step)
        way = pilots%value(load%component, load%die) - scene%dies(load%die)%pilot(load%component)
        further = pilots%last_increment(load%component, load%die)
        if (.not. (more*force > 0 .and. way*force > 0 .and. further*force > 0)) cycle
        far = further*force >= goes_far*way*more
        if (.not. (far .or. past_limit)) cycle
        words = 'die '//scene%dies(load%die)%name//' under FORCE '
        if (far) then
          words = words//'goes '//to_text(further*force/(way*more), 3)//' times as far for a little more force as it did for ' &
                  //'all of it, '
        else
          words = words//'goes past a limit point at '
        end if
        words = words//to_text(abs(circumference(scene)*force), 5)//', as at a limit load: MOVE in place of FORCE leads beyond it; '
        return
      end associate
    end do
  end function limit_load_words

  !> Force on a pilot at a time, per radian when axisymmetric.
  pure function force_at(scene, load, time) result(force)
    type(scene_t), intent(in) :: scene
    type(die_force_t), intent(in) :: load
    real(wp), intent(in) :: time   !! [time]
    real(wp) :: force              !! [force, or moment]

    force = load%amplitude*multiplier_at(scene%multipliers(load%multiplier), time)
  end function force_at

end module unheld_dies
