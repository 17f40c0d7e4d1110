!> Why a new mesh is due at an accepted instant: every limit of the card REMSH that is passed.
!>
!> Errors, shapes, contacts and distress wait until the mesh has made its least number of steps; times and strokes do not, nor an
!> element of a new mesh that is turned over in its first steps: it takes its neighbours along, until the contour laps. What another
!> mesh would gain is known from the present one: it would begin with the error that this one has shown first, or has fallen to
!> since. It is due when the error is above the limit and worse by half than that; so are bad elements where a new mesh has them
!> beyond the limit.
!>
!> Where what is left of the scene takes two more steps at most the mesh that is there makes them: a new one would hardly be
!> used, and the equilibrium it begins with would be found in steps that have no others behind them. Elements that are turned
!> over, cutbacks, times, strokes and cuts do not wait for the end.
!>
!> Nor is a new mesh made where a node will stand at a sharp corner of a die in a few steps: while the corner is in a side the force
!> is too large, and the new mesh, which has a node there, would begin with a drop of it (corner_sides). Errors, shapes, narrow
!> contacts and sides that have grown wait for that, as long as no element is worn out.
module triggers
  use acceptance, only: is_on_probation
  use contact_quality, only: measure_misfit, misfit_t
  use corner_sides, only: corner_side_t, find_corner_side
  use cuts, only: is_trim, trim_trigger, web_trigger
  use fields, only: displacement_field, pilot_field
  use kinds, only: eps, wp
  use mesh_quality, only: element_shape, is_bad, shape_places, shape_places_t
  use narrow_contacts, only: measure_narrow, narrow_t
  use remeshing, only: criterion_names, ncriteria, never, of_distress, of_narrow, scaled_jacobian, stroke_t, trigger_t
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use web_thickness, only: measure_web, web_t
  implicit none
  private
  public :: find_triggers, find_trims, find_wear, distress_trigger, was_good, has_passed

  !> The error and bad elements of a new mesh grow to this multiple before another one is due.
  real(wp), parameter :: worse = 1.5_wp
  !> An error counts as so many times its limit at most.
  real(wp), parameter :: most_errors = 3.0_wp
  !> So many steps to the end are made on the mesh that is there.
  real(wp), parameter :: last_steps = 2.0_wp
  !> A new mesh waits for a node that will stand at a sharp corner in so many steps, and no longer than until the scaled Jacobian of
  !> an element is below this. Sides take some ten steps to pass a corner (decks/can_sharp), which are short at its middle.
  real(wp), parameter :: soon = 40.0_wp, worn_out = 0.1_wp

contains

  !> All limits passed by the step just accepted.
  pure subroutine find_triggers(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(out) :: found(:)   !! (ntrigger)
    integer :: k

    allocate (found(0))
    if (was_good(scene, solution) .and. .not. nears_end(scene, solution)) then
      call find_wear(scene, solution, found)
    else if (any(abs(scene%remesh%shape) < never) .and. (was_good(scene, solution) .or. is_on_probation(solution%probation))) then
      call find_bad_shapes(scene, solution, found, only_turned_over=.true.)
    end if
    do k = 1, size(scene%remesh%times)
      if (abs(scene%remesh%times(k) - solution%time) <= 64*eps*scene%strategy%end_time) &
        call add(found, 'time', solution%time, scene%remesh%times(k))
    end do
    do k = 1, size(scene%remesh%strokes)
      associate (stroke => scene%remesh%strokes(k))
        if (.not. has_passed(scene, solution, stroke)) cycle
        call add(found, 'stroke', solution%fields(pilot_field)%value(stroke%component, stroke%die) &
                 - scene%dies(stroke%die)%pilot(stroke%component), stroke%value)
      end associate
    end do
    call find_thin_webs(scene, solution, found)
  end subroutine find_triggers

  !> Errors, shapes and contacts beyond their limits.
  pure subroutine find_wear(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    type(trigger_t), allocatable :: shapes(:), misfits(:), others(:)
    real(wp) :: limit, until_node, jacobian

    allocate (shapes(0), misfits(0), others(0))
    until_node = 0
    jacobian = 1
    if (any(abs(scene%remesh%shape) < never)) call find_bad_shapes(scene, solution, shapes, jacobian=jacobian)
    if (scene%remesh%contact < never) call find_misfits(scene, solution, misfits)
    if (scene%remesh%corner < never) call find_long_sides(scene, solution, others, until_node)
    call find_narrow(scene, solution, others)
    others = [shapes, misfits, others]
    limit = max(scene%remesh%stress_error, worse*solution%estimate%first_stress)
    ! where the mesh is due anyhow its error is a reason from the first strain on
    if (solution%estimate%stress > limit) then
      if (size(others) > 0 .or. error_counts(solution, limit, scene%remesh%error_strain)) &
        call add(found, 'stress_error', solution%estimate%stress, limit)
    end if
    found = [found, others]
    if (size(misfits) > 0 .or. jacobian < worn_out) return
    if (until_node > 0 .and. until_node <= soon*min(solution%next_step, scene%strategy%largest_step)) found = found(:0)
  end subroutine find_wear

  !> Webs that part (cards PIERC).
  pure subroutine find_thin_webs(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    type(web_t), allocatable :: ways(:)
    integer :: k

    do k = 1, size(solution%cuts)
      associate (cut => scene%remesher%cuts(k))
        if (is_trim(cut) .or. solution%cuts(k)%generation > 0) cycle
        call measure_web(scene, solution, cut, ways)
        if (any(ways%thickness <= cut%thickness)) &
          call add(found, web_trigger, minval(ways%thickness), cut%thickness, cut%group)
      end associate
    end do
  end subroutine find_thin_webs

  !> Cuts along lines that are due when an operation begins (cards TRIM), one by one.
  pure subroutine find_trims(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(out) :: found(:)   !! (ntrigger)
    integer :: k

    allocate (found(0))
    do k = 1, size(solution%cuts)
      if (is_trim(scene%remesher%cuts(k)) .and. solution%cuts(k)%generation == 0) &
        call add(found, trim_trigger, 0.0_wp, 0.0_wp, scene%remesher%cuts(k)%group)
    end do
  end subroutine find_trims

  !> The mesh has made its least number of steps before another one may be due.
  pure function was_good(scene, solution) result(good)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: good

    good = solution%step - solution%estimate%last_stop >= scene%remesh%least_steps
  end function was_good

  !> The step strategy reaches the end of the scene in a few steps as long as it wants the next one. After another operation the
  !> mesh goes on.
  pure function nears_end(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: nears_end

    nears_end = scene%operation >= scene%operations &
                .and. scene%strategy%end_time - solution%time &
                <= last_steps*min(solution%next_step, scene%strategy%largest_step)
  end function nears_end

  !> So much strain went with the error as makes it count: what a wrong stress leaves in the state goes with the error and with the
  !> strain, so that twice the limit counts from half the strain on. Where contact begins at a point the error is large on any mesh:
  !> no error counts from less than a third of the strain on.
  pure function error_counts(solution, limit, strain) result(counts)
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: limit, strain   !! the error at its limit counts from this strain on
    logical :: counts

    counts = min(solution%estimate%stress, most_errors*limit)*worst_strain(solution) >= limit*strain
  end function error_counts

  !> Equivalent strain of the most strained element, summed over the steps since the mesh began.
  pure function worst_strain(solution) result(strain)
    type(solution_t), intent(in) :: solution
    real(wp) :: strain

    strain = sqrt(2.0_wp/3.0_wp)*maxval(solution%estimate%strain_sums(2, :))
  end function worst_strain

  !> Cutbacks in a row on a mesh that was good before.
  pure function distress_trigger(scene, cutbacks) result(trigger)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: cutbacks
    type(trigger_t) :: trigger

    trigger%name = of_distress
    trigger%value = real(cutbacks, wp)
    trigger%limit = real(scene%remesh%distress, wp)
  end function distress_trigger

  !> The stroke was reached in the last step; reached to round-off is reached.
  pure function has_passed(scene, solution, stroke) result(passed)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(stroke_t), intent(in) :: stroke
    logical :: passed
    real(wp) :: now, before, aim

    now = solution%fields(pilot_field)%value(stroke%component, stroke%die) - scene%dies(stroke%die)%pilot(stroke%component)
    before = now - solution%fields(pilot_field)%last_increment(stroke%component, stroke%die)
    aim = stroke%value*(1 - 64*eps)
    passed = merge(now >= aim .and. before < aim, now <= aim .and. before > aim, stroke%value > 0)
  end function has_passed

  !> Shapes beyond their limits, when more elements than allowed have one: each criterion with its worst element.
  pure subroutine find_bad_shapes(scene, solution, found, only_turned_over, jacobian)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    logical, intent(in), optional :: only_turned_over
    real(wp), intent(out), optional :: jacobian   !! least scaled Jacobian of all elements [-]
    type(shape_places_t) :: places
    real(wp) :: measures(ncriteria), worst(ncriteria), x(2, size(scene%mesh%coordinates, 2)), share, first, limit
    integer :: group(ncriteria), element(ncriteria), g, e, k, n, nbad, nfirst
    logical :: bad(ncriteria), turned_over

    if (present(jacobian)) jacobian = 1
    x = scene%mesh%coordinates
    if (scene%finite) x = x + solution%fields(displacement_field)%value
    places = shape_places()
    worst = scene%remesh%shape
    group = 0
    element = 0
    n = 0
    nbad = 0
    nfirst = 0
    turned_over = .false.
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        measures = element_shape(places, x(:, scene%groups(g)%connectivity(:, e)))
        n = n + 1
        if (any(is_bad(measures, scene%remesh%shape))) nbad = nbad + 1
        ! a new mesh lies where its nodes began
        if (scene%generation > 1) then
          if (any(is_bad(element_shape(places, scene%mesh%coordinates(:, scene%groups(g)%connectivity(:, e))), &
                         scene%remesh%shape))) nfirst = nfirst + 1
        end if
        turned_over = turned_over .or. .not. measures(scaled_jacobian) > 0
        if (present(jacobian)) jacobian = min(jacobian, measures(scaled_jacobian))
        bad = is_bad(measures, worst)
        where (bad)
          worst = measures
          group = g
          element = e
        end where
      end do
    end do
    if (present(only_turned_over)) then
      if (only_turned_over .and. .not. turned_over) return
    end if
    share = real(nbad, wp)/max(n, 1)
    first = real(nfirst, wp)/max(n, 1)
    limit = scene%remesh%bad_share
    if (first > limit) limit = worse*first
    ! an element turned over is bad whatever share may be
    if (.not. (share > limit .or. turned_over)) return
    do k = 1, ncriteria
      if (group(k) > 0) call add(found, trim(criterion_names(k)), worst(k), scene%remesh%shape(k), group(k), element(k))
    end do
    if (limit > 0 .and. share > limit) call add(found, 'bad_share', share, limit)
  end subroutine find_bad_shapes

  !> Sides that do not fit their die.
  pure subroutine find_misfits(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    type(misfit_t) :: misfit
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      misfit = measure_misfit(scene, g, solution)
      if (misfit%between > scene%remesh%contact) &
        call add(found, 'contact_between', misfit%between, scene%remesh%contact, g, misfit%between_side)
      if (misfit%corner > scene%remesh%contact) &
        call add(found, 'contact_corner', misfit%corner, scene%remesh%contact, g, misfit%corner_side)
    end do
  end subroutine find_misfits

  !> Sides that sharp corners of dies press into and that have grown too long, and the time until a node stands at such a corner.
  pure subroutine find_long_sides(scene, solution, found, until_node)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    real(wp), intent(out) :: until_node   !! that is next; 0 where one does, huge where no corner is in a side [time]
    type(corner_side_t) :: corner
    integer :: g

    until_node = huge(until_node)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      call find_corner_side(scene, g, solution, corner)
      until_node = min(until_node, corner%until_node)
      if (corner%growth > scene%remesh%corner) call add(found, 'corner_side', corner%growth, scene%remesh%corner, g, corner%side)
    end do
  end subroutine find_long_sides

  !> A die whose contact is narrow beside the sides there, and was not so, or less, when the mesh began.
  pure subroutine find_narrow(scene, solution, found)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(trigger_t), allocatable, intent(inout) :: found(:)
    type(narrow_t) :: narrow
    real(wp) :: limit

    if (.not. scene%remesh%narrow < never) return
    limit = scene%remesh%narrow*max(1.0_wp, solution%estimate%first_narrow)
    narrow = measure_narrow(scene, solution)
    if (narrow%ratio > limit .and. narrow%error > scene%remesh%stress_error) &
      call add(found, of_narrow, narrow%ratio, limit, narrow%group, narrow%side)
  end subroutine find_narrow

  pure subroutine add(found, name, value, limit, group, element)
    type(trigger_t), allocatable, intent(inout) :: found(:)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value, limit
    integer, intent(in), optional :: group, element
    type(trigger_t), allocatable :: more(:)
    integer :: n

    n = size(found)
    allocate (more(n + 1))
    more(:n) = found
    more(n + 1)%name = name
    more(n + 1)%value = value
    more(n + 1)%limit = limit
    if (present(group)) more(n + 1)%group = group
    if (present(element)) more(n + 1)%element = element
    call move_alloc(more, found)
  end subroutine add

end module triggers
