!> A run of a deck with ACCURACY: how fine it is, what is expected of it, and what it has reached.
module accuracy_plan
  use accuracy_costs, only: elements_of, expected_seconds
  use accuracy_laws, only: accuracy_law_t, errors_of
  use accuracy_rules, only: fineness_t
  use fineness_choice, only: asked_for, choose_fineness
  use json_writer, only: json_t
  use kinds, only: wp
  use pilot_differences, only: difference, sample_t
  use text, only: add_text, join, percent, string_t, to_text
  implicit none
  private
  public :: accuracy_plan_t, accuracy_t
  public :: accuracy_lines, accuracy_warning, add_accuracy, expect, fineness_words, judge_run, plan_lines

  !> Differences that are foretold smaller than this share of what is asked say nothing about the laws.
  real(wp), parameter :: least_difference = 0.05_wp

  !> Errors of the quantity that has the largest.
  type :: error_parts_t
    character(len=:), allocatable :: name
    real(wp) :: space = 0.0_wp, time = 0.0_wp, depth = 0.0_wp
  end type error_parts_t

  type :: accuracy_plan_t
    real(wp) :: asked = 0.0_wp
    type(string_t), allocatable :: names(:)   !! (nquantity) STRESS the last where it is judged
    type(string_t), allocatable :: columns(:) !! (ncolumn) titles of those that are columns
    real(wp), allocatable :: scales(:)        !! (ncolumn) ranges of those that are columns [unit of each]
    type(sample_t), allocatable :: pilots(:)
    type(accuracy_law_t) :: law
    type(fineness_t) :: fineness
    !> What is expected: errors, and that they are below what is asked; steps and seconds. Seconds that the pilots took.
    type(error_parts_t) :: expected
    logical :: met = .false.
    integer :: elements = 0, steps = 0
    real(wp) :: seconds = 0.0_wp, pilot_seconds = 0.0_wp
    !> Time for half the error, over that for what was asked.
    real(wp) :: half_costs = 1.0_wp
    !> The mesh can be made finer, by factors that are whole over this.
    logical :: divisible = .false.
    integer :: parts = 1
    !> Probes whose node or point, the nearest to a place, is another one on every mesh.
    type(string_t), allocatable :: elsewhere(:)
    !> What is not known, and why.
    type(string_t), allocatable :: notes(:)
  end type accuracy_plan_t

  !> What a run has reached and spent.
  type :: accuracy_t
    type(accuracy_plan_t) :: plan
    type(error_parts_t) :: reached
    integer :: steps = 0
    real(wp) :: seconds = 0.0_wp
  end type accuracy_t

contains

  !> Errors, steps and seconds that the laws foretell of the plan's fineness.
  pure subroutine expect(plan)
    type(accuracy_plan_t), intent(inout) :: plan
    real(wp), dimension(size(plan%names)) :: space, time, depth
    type(fineness_t) :: finer
    real(wp) :: seconds
    integer :: steps, k
    logical :: met

    plan%elements = elements_of(plan%pilots, plan%fineness%mesh)
    call errors_of(plan%law, plan%fineness, space, time, depth)
    k = maxloc(space + time + depth, 1)
    plan%expected = parts_of(plan%names(k)%s, space(k), time(k), depth(k))
    call expected_seconds(plan%pilots, plan%fineness, plan%elements, plan%seconds, plan%steps)
    call choose_fineness(plan%law, asked_for(total(plan%expected)/2), plan%divisible, finer, met, plan%parts)
    plan%half_costs = 0
    if (.not. (met .and. plan%seconds > 0 .and. total(plan%expected) > 0)) return
    call expected_seconds(plan%pilots, finer, elements_of(plan%pilots, finer%mesh), seconds, steps)
    plan%half_costs = seconds/plan%seconds
  end subroutine expect

  pure function parts_of(name, space, time, depth) result(parts)
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: space, time, depth   !! [-]
    type(error_parts_t) :: parts

    parts%name = name
    parts%space = space
    parts%time = time
    parts%depth = depth
  end function parts_of

  !> What the run has reached: what was expected, times by how much more than foretold it differs from the finest pilot.
  pure subroutine judge_run(plan, run, reached)
    type(accuracy_plan_t), intent(in) :: plan
    type(sample_t), intent(in) :: run
    type(accuracy_t), intent(out) :: reached
    real(wp), dimension(size(plan%names)) :: space, time, depth, space_then, time_then, depth_then, more, found, foretold
    type(fineness_t) :: pilot
    integer :: k, n

    reached%plan = plan
    reached%steps = run%steps
    reached%seconds = sum(run%seconds)
    call errors_of(plan%law, plan%fineness, space, time, depth)
    n = size(plan%scales)
    more = 1
    found = 0
    do k = size(plan%pilots), 1, -1
      if (abs(plan%pilots(k)%fineness%mesh - plan%law%mesh) <= 0) exit
    end do
    if (k > 0) then
      pilot = plan%pilots(k)%fineness
      call errors_of(plan%law, pilot, space_then, time_then, depth_then)
      found(:n) = difference(plan%pilots(k), run, plan%scales)
      foretold = abs(space_then - space) + abs(time_then - time) + abs(depth_then - depth)
      where (found > foretold .and. found > least_difference*plan%asked) more = found/max(foretold, tiny(1.0_wp))
      ! a run of the fineness of the pilot, but for what was not known to matter
      where (more*(space + time + depth) > found .and. more > 1) more = max(found/(space + time + depth), 1.0_wp)
    end if
    if (n < size(space) .and. run%stress >= 0) space(n + 1) = run%stress
    k = maxloc(more*(space + time + depth), 1)
    reached%reached = parts_of(plan%names(k)%s, more(k)*space(k), more(k)*time(k), more(k)*depth(k))
  end subroutine judge_run

  !> What the run is expected to be, before it begins.
  subroutine plan_lines(plan, lines)
    type(accuracy_plan_t), intent(in) :: plan
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    integer :: k

    allocate (lines(0))
    call put('accuracy   '//percent(plan%asked)//' asked of '//join(plan%names, ', '))
    do k = 1, size(plan%pilots)
      associate (pilot => plan%pilots(k))
        call put('           pilot: '//fineness_words(pilot%fineness)//': '//to_text(pilot%elements)//' elements, ' &
                 //to_text(pilot%steps)//' steps, '//to_text(sum(pilot%seconds), 3)//' s of processor')
      end associate
    end do
    call put('           run:   '//fineness_words(plan%fineness)//': '//to_text(plan%elements)//' elements, about ' &
             //to_text(plan%steps)//' steps and '//to_text(plan%seconds, 2)//' s of processor')
    call put('           expected error '//parts_words(plan%expected))
    if (plan%law%space_known .and. plan%divisible) call put('           order of the errors in space: '//orders_of(plan))
    do k = 1, size(plan%notes)
      call put('           '//plan%notes(k)%s)
    end do

  contains

    subroutine put(line)
      character(len=*), intent(in) :: line

      call add_text(lines, line)
    end subroutine put

  end subroutine plan_lines

  !> Each quantity's order, measured by three meshes or taken.
  pure function orders_of(plan) result(words)
    type(accuracy_plan_t), intent(in) :: plan
    character(len=:), allocatable :: words
    integer :: k

    words = ''
    do k = 1, size(plan%names)
      words = words//merge('  ', ', ', k == 1)//plan%names(k)%s//' '//to_text(plan%law%order(k), 3)
    end do
    words = adjustl(words)//trim(merge(' (measured by three meshes)', ' (taken: two meshes)       ', plan%law%order_measured))
  end function orders_of

  pure function fineness_words(fineness) result(words)
    type(fineness_t), intent(in) :: fineness
    character(len=:), allocatable :: words

    words = 'elements along a line x '//to_text(fineness%mesh, 3)//', steps x '//to_text(fineness%steps, 3)//', penetration x ' &
            //to_text(fineness%depth, 3)
  end function fineness_words

  pure function parts_words(parts) result(words)
    type(error_parts_t), intent(in) :: parts
    character(len=:), allocatable :: words

    words = percent(total(parts))//' ('//parts%name//'): in space '//percent(parts%space)//', in time '//percent(parts%time) &
            //', of penetration '//percent(parts%depth)
  end function parts_words

  pure function total(parts) result(error)
    type(error_parts_t), intent(in) :: parts
    real(wp) :: error

    error = parts%space + parts%time + parts%depth
  end function total

  !> Rows of the table at the end.
  pure subroutine accuracy_lines(accuracy, lines)
    type(accuracy_t), intent(in) :: accuracy
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)

    associate (plan => accuracy%plan)
      allocate (lines(2))
      lines(1)%s = '    asked       '//percent(plan%asked)//', expected '//percent(total(plan%expected))//', reached ' &
                   //parts_words(accuracy%reached)
      lines(2)%s = '    spent       '//to_text(accuracy%steps)//' steps and '//to_text(accuracy%seconds, 3) &
                   //' s of processor, expected '//to_text(plan%steps)//' and '//to_text(plan%seconds, 3)//' s; pilots ' &
                   //to_text(plan%pilot_seconds, 3)//' s'
      if (plan%half_costs > 0) lines(2)%s = lines(2)%s//'; half the error costs about '//to_text(plan%half_costs, 2) &
                                            //' times the time, by the measured errors'
    end associate
  end subroutine accuracy_lines

  !> What limits the accuracy where less was reached than asked; nothing where it was reached.
  pure function accuracy_warning(accuracy, by_euler) result(words)
    type(accuracy_t), intent(in) :: accuracy
    logical, intent(in) :: by_euler   !! temperatures are found by a scheme of first order where one of second order can be had
    character(len=:), allocatable :: words
    integer :: k

    words = ''
    associate (reached => accuracy%reached, plan => accuracy%plan)
      if (total(reached) <= plan%asked .and. size(plan%notes) == 0) return
      if (total(reached) > plan%asked) then
        words = 'ACCURACY '//percent(plan%asked)//' was asked, '//percent(total(reached))//' is estimated of '//reached%name
        if (reached%space >= max(reached%time, reached%depth)) then
          words = words//': '//percent(reached%space)//' comes of the mesh'
          if (any([(plan%elsewhere(k)%s == reached%name, k=1, size(plan%elsewhere))])) words = words//', on each of which the ' &
            //'probe reads another node or point, the nearest to its place: ask for the place of a node'
          if (plan%divisible) words = words//'; give a finer one, or elements that are smaller where the stress changes fast'
        else if (reached%time >= reached%depth) then
          words = words//': '//percent(reached%time)//' comes of the steps; '
          if (by_euler) words = words//'take THETA TRBDF2 with TOL, of second order in them, or '
          words = words//'give shorter ones (STRAT)'
        else
          words = words//': '//percent(reached%depth)//' comes of the penetration; give AUGMENT, or a smaller PENETR'
        end if
      else
        words = 'ACCURACY '//percent(plan%asked)//' is not known to be met'
      end if
      if (size(plan%notes) > 0) words = words//'; '//join(plan%notes, '; ')
    end associate
  end function accuracy_warning

  !> The same in summary.json.
  subroutine add_accuracy(json, accuracy)
    type(json_t), intent(inout) :: json
    type(accuracy_t), intent(in) :: accuracy
    integer :: k

    associate (plan => accuracy%plan)
      call json%begin_object('asked')
      call json%add('error_pct', 100*plan%asked)
      call json%add('mesh', plan%fineness%mesh)
      call json%add('steps', plan%fineness%steps)
      call json%add('depth', plan%fineness%depth)
      call add_parts('expected', plan%expected)
      call json%add('expected_steps', plan%steps)
      call json%add('expected_s', plan%seconds)
      call json%add('pilots_s', plan%pilot_seconds)
      call add_parts('reached', accuracy%reached)
      call json%add('spent_steps', accuracy%steps)
      call json%add('spent_s', accuracy%seconds)
      call json%add('met', total(accuracy%reached) <= plan%asked .and. size(plan%notes) == 0)
      if (plan%half_costs > 0) call json%add('half_costs', plan%half_costs)
      call json%begin_object('orders')
      do k = 1, size(plan%names)
        call json%add(plan%names(k)%s, plan%law%order(k))
      end do
      call json%end_object()
      call json%add('orders_measured', plan%law%order_measured)
      call json%end_object()
    end associate

  contains

    subroutine add_parts(name, parts)
      character(len=*), intent(in) :: name
      type(error_parts_t), intent(in) :: parts

      call json%begin_object(name)
      call json%add('quantity', parts%name)
      call json%add('error_pct', 100*total(parts))
      call json%add('space_pct', 100*parts%space)
      call json%add('time_pct', 100*parts%time)
      call json%add('depth_pct', 100*parts%depth)
      call json%end_object()
    end subroutine add_parts

  end subroutine add_accuracy

end module accuracy_plan
