!> The pilots of a deck with ACCURACY: short runs that measure how its errors fall, each in a folder of its own beside the results.
!> A pilot that is there already, of the same deck and program, is not made again. Those of a deck with REMSH need new meshes,
!> which the solver does not make: it asks `lagacycle` for one after the other (`NAME.pilot`, exit code 7).
module accuracy_runs
  use accuracy_laws, only: choose_fineness, measure_laws, sample_t, steps_differ
  use accuracy_plan, only: accuracy_plan_t, expect, fineness_words
  use accuracy_rules, only: coarsest_mesh, fineness_t, stress_name
  use accuracy_samples, only: join_forces, key_of, range_of, read_sample, select_columns
  use atomic, only: read_text, write_text
  use cost_file, only: cost_t, read_cost
  use errors, only: error_t, exit_done, exit_input, exit_no_convergence, exit_pilot, fail
  use exact_numbers, only: exact_text
  use kinds, only: wp
  use remesher_options, only: has_contours
  use run_options, only: run_options_t, stem_of
  use scene, only: scene_t
  use standard_streams, only: print_line
  use strategy, only: order_in_time
  use system, only: file_exists, join_path, make_directory
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: make_plan, run_i

  !> Meshes of bodies that are given by their contours can be finer by any factor: quarters are fine enough.
  integer, parameter :: quarters = 4

  !> Steps of half the length, a quarter of the penetration.
  real(wp), parameter :: half = 0.5_wp, quarter = 0.25_wp
  !> No pilot has shorter steps than this share of the deck's.
  real(wp), parameter :: least_pilot = 1/64.0_wp

  abstract interface
    !> A run by its options; its exit code, where there is no error.
    recursive subroutine run_i(options, code, error)
      import :: error_t, run_options_t
      type(run_options_t), intent(in) :: options
      integer, intent(out) :: code
      type(error_t), allocatable, intent(out) :: error
    end subroutine run_i
  end interface

contains

  !> Make the pilots and choose the fineness of the run.
  recursive subroutine make_plan(options, scene, deck_text, run, plan, code, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene   !! as the deck says
    character(len=*), intent(in) :: deck_text
    procedure(run_i) :: run
    type(accuracy_plan_t), intent(out) :: plan
    integer, intent(out) :: code         !! of a pilot that was stopped by a signal
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: coarsest, shortest
    logical :: there

    code = exit_done
    allocate (plan%pilots(0), plan%notes(0), plan%names(0), plan%scales(0), plan%columns(0))
    plan%asked = scene%accuracy%asked
    plan%divisible = scene%accuracy%divisible
    if (has_contours(scene%remesher)) plan%parts = quarters
    coarsest = merge(coarsest_mesh, 1.0_wp, scene%accuracy%halvable)
    call pilot(fineness_t(coarsest, 1.0_wp, 1.0_wp), there)
    if (.not. there .and. coarsest < 1 .and. goes_on()) then
      coarsest = 1
      call pilot(fineness_t(coarsest, 1.0_wp, 1.0_wp), there)
    end if
    if (plan%divisible .and. goes_on()) call pilot(fineness_t(2*coarsest, 1.0_wp, 1.0_wp), there)
    shortest = 1
    do while (goes_on())
      ! half the steps, and shorter ones as long as there are hardly more of them
      call pilot(fineness_t(coarsest, half*shortest, 1.0_wp), there)
      if (.not. there) exit
      shortest = half*shortest
      if (enough_steps() .or. .not. shortest > least_pilot) exit
    end do
    if (.not. shortest < 1 .and. goes_on()) call note('errors in time are not known')
    if (has_rigid_contact(scene) .and. goes_on()) then
      call pilot(fineness_t(coarsest, 1.0_wp, quarter), there)
      if (.not. there .and. goes_on()) call note('errors of the penetration are not known')
    end if
    do while (goes_on())
      call choose()
      if (allocated(error)) return
      if (shortest < 1 .and. plan%fineness%steps < half*shortest .and. shortest > least_pilot) then
        ! a law of the steps is good near those that it was measured with
        shortest = max(next_power(plan%fineness%steps), shortest/8, least_pilot)
        call pilot(fineness_t(coarsest, shortest, 1.0_wp), there)
        if (.not. there) shortest = 0
        cycle
      end if
      if (.not. (plan%divisible .and. plan%law%space_known .and. plan%fineness%mesh > 2*plan%law%mesh)) exit
      call pilot(fineness_t(2*plan%law%mesh, 1.0_wp, 1.0_wp), there)
      if (.not. there) exit
    end do
    if (.not. goes_on()) return
    if (.not. plan%divisible) then
      call note('errors in space are not known: the mesh is written out in the deck, only those of BLOCK cards are made finer')
    else if (.not. plan%law%space_known) then
      call note('errors in space are not known')
    else if (.not. plan%met) then
      call note('no fineness was found for it')
    end if

  contains

    logical function goes_on()
      goes_on = .not. allocated(error) .and. code == exit_done
    end function goes_on

    !> The last pilot has so many more steps than the first that their errors can be seen.
    logical function enough_steps()
      enough_steps = .true.
      if (size(plan%pilots) > 1) enough_steps = steps_differ(plan%pilots(1), plan%pilots(size(plan%pilots)))
    end function enough_steps

    subroutine note(words)
      character(len=*), intent(in) :: words

      call add_text(plan%notes, words)
    end subroutine note

    !> The laws of all pilots so far, and what they allow.
    subroutine choose()
      integer :: finest

      if (size(plan%pilots) == 0) then
        call fail(error, exit_no_convergence, 'ACCURACY: the deck has no run to its end, on its own mesh with its own steps', &
                  'the pilots are in '//options%out//'; find what stops them without ACCURACY')
        return
      end if
      finest = maxloc(plan%pilots%fineness%mesh, 1)
      call range_of(plan%pilots(finest), plan%scales)
      if (size(scene%accuracy%columns) == 0) call join_forces(plan%names, plan%scales)
      call measure_laws(plan%pilots, plan%scales, scene%accuracy%stress, is_smooth(scene), time_order(scene), plan%law)
      call choose_fineness(plan%law, plan%asked, plan%divisible .and. plan%law%space_known, plan%fineness, plan%met, &
                            plan%parts)
      call expect(plan)
    end subroutine choose

    !> One pilot, made where it is not there; `there` is false where it did not reach its end.
    recursive subroutine pilot(fineness, there)
      type(fineness_t), intent(in) :: fineness
      logical, intent(out) :: there
      type(run_options_t) :: own
      type(sample_t) :: sample

      own = options
      own%out = join_path(options%out, 'pilot_'//to_text(fineness%mesh, 3)//'_'//to_text(fineness%steps, 3)//'_' &
                          //to_text(fineness%depth, 3))
      own%default_out = .false.
      own%check = .false.
      own%forecast = .false.
      own%quiet = .true.
      own%progress = .false.
      if (allocated(own%resume)) deallocate (own%resume)
      own%fineness = fineness
      call read_sample(own, deck_text, fineness, plan%columns, sample, there)
      if (.not. there .and. scene%remesh%on) then
        call ask_for_cycle(options, own, deck_text, error)
        if (allocated(error)) return
        call note('the pilot with '//fineness_words(fineness)//' did not reach its end')
        return
      end if
      if (.not. there) then
        if (.not. (options%quiet .or. options%progress)) call print_line('pilot of ACCURACY: '//fineness_words(fineness), error)
        if (.not. allocated(error)) call run(own, code, error)
        if (allocated(error)) code = error%code
        if (code == exit_no_convergence) then
          ! one that finds no equilibrium is no reason why the run should not
          if (allocated(error)) deallocate (error)
          code = exit_done
          call note('the pilot with '//fineness_words(fineness)//' did not reach its end')
          return
        end if
        if (allocated(error) .or. code /= exit_done) return
      end if
      if (size(plan%columns) == 0 .and. .not. only_stress()) then
        call select_columns(own, scene, plan%columns, plan%names, error)
        if (allocated(error)) return
        if (scene%accuracy%stress) call add_text(plan%names, stress_name)
        plan%scales = spread(1.0_wp, 1, size(plan%columns))
      else if (size(plan%names) == 0) then
        plan%names = [string_t(stress_name)]
      end if
      call read_sample(own, deck_text, fineness, plan%columns, sample, there)
      if (.not. there) then
        call fail(error, exit_input, 'ACCURACY: the pilot in '//own%out//' cannot be read')
        return
      end if
      plan%pilots = [plan%pilots, sample]
      plan%pilot_seconds = plan%pilot_seconds + sum(sample%seconds)
    end subroutine pilot

    logical function only_stress()
      only_stress = scene%accuracy%stress .and. size(scene%accuracy%columns) == 0
    end function only_stress

  end subroutine make_plan

  !> The power of 1/2 that is not below a factor.
  pure function next_power(factor) result(power)
    real(wp), intent(in) :: factor
    real(wp) :: power

    power = 0.5_wp**int(-log(factor)/log(2.0_wp))
  end function next_power

  !> Ask for a pilot that needs new meshes: `NAME.pilot` names its folder, its fineness, and how it begins. No error where it has
  !> been made and did not reach its end: then its folder has that file.
  subroutine ask_for_cycle(options, own, deck_text, error)
    type(run_options_t), intent(in) :: options, own   !! of the run and of the pilot
    character(len=*), intent(in) :: deck_text
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: nl = new_line('a')
    character(len=:), allocatable :: name, what, tried
    type(cost_t) :: cost
    logical :: there

    name = stem_of(options%deck)//'.pilot'
    what = own%out//nl//exact_text(own%fineness%mesh)//','//exact_text(own%fineness%steps)//','//exact_text(own%fineness%depth)//nl
    if (file_exists(join_path(own%out, name))) then
      call read_text(join_path(own%out, name), tried, error)
      if (allocated(error)) return
      if (index(tried, what) == 1 .and. index(tried, nl//key_of(deck_text)//nl) > 0) return
    end if
    call read_cost(join_path(own%out, stem_of(options%deck)), key_of(deck_text), cost, there)
    call make_directory(options%out, error)
    if (.not. allocated(error)) &
      call write_text(join_path(options%out, name), what//trim(merge('go on', 'begin', there .and. .not. cost%finished))//nl &
                                                  //key_of(deck_text)//nl, error)
    if (allocated(error)) return
    call fail(error, exit_pilot, 'ACCURACY with REMSH: the pilot with '//fineness_words(own%fineness) &
              //' is missing, and needs new meshes', &
              'call lagacycle with this deck, or lagacycle --forecast: it makes pilots and new meshes')
  end subroutine ask_for_cycle

  !> A part of the scene faces a rigid die by a law with a penetration.
  pure function has_rigid_contact(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: g

    yes = any([(scene%groups(g)%die > 0 .and. scene%groups(g)%material > 0, g=1, size(scene%groups))])
  end function has_rigid_contact

  !> Neither contact nor flow nor phases.
  pure function is_smooth(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: m

    yes = size(scene%dies) == 0 .and. .not. scene%follows_path &
          .and. .not. any([(allocated(scene%materials(m)%steel), m=1, size(scene%materials))])
  end function is_smooth

  !> Order of the errors in time: that of the scheme of heat where nothing else has errors in time.
  pure function time_order(scene) result(order)
    type(scene_t), intent(in) :: scene
    real(wp) :: order

    order = 1
    if (is_smooth(scene)) order = order_in_time(scene%strategy)
  end function time_order

end module accuracy_runs
