!> The pilots of a deck with ACCURACY: short runs that measure how its errors fall, and the fineness that follows from them.
module accuracy_runs
  use accuracy_laws, only: measure_laws
  use accuracy_pilots, only: add_pilot, run_i
  use accuracy_plan, only: accuracy_plan_t, expect
  use accuracy_rules, only: coarsest_mesh, fineness_t
  use accuracy_samples, only: join_forces, range_of
  use errors, only: error_t, exit_done, exit_no_convergence, fail
  use fineness_choice, only: choose_fineness
  use kinds, only: wp
  use pilot_differences, only: steps_differ
  use probes, only: is_elsewhere
  use remesher_options, only: has_contours
  use run_options, only: run_options_t
  use scene, only: scene_t
  use strategy, only: order_in_time
  use text, only: add_text
  implicit none
  private
  public :: make_plan

  !> Meshes of bodies that are given by their contours can be finer by any factor: quarters are fine enough.
  integer, parameter :: quarters = 4

  !> Steps of half the length, a quarter of the penetration.
  real(wp), parameter :: half = 0.5_wp, quarter = 0.25_wp
  !> No pilot has shorter steps than this share of the deck's.
  real(wp), parameter :: least_pilot = 1/64.0_wp
  !> Meshes that do not show how errors fall are made finer up to so many times the elements along a line.
  real(wp), parameter :: most_hidden = 8.0_wp

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

    code = exit_done
    call start_plan(scene, plan)
    call measure_meshes()
    call measure_steps()
    if (has_rigid_contact(scene) .and. goes_on()) call measure_penetration()
    call refine_laws()
    if (goes_on()) call note_what_is_unknown(plan)

  contains

    logical function goes_on()
      goes_on = .not. allocated(error) .and. code == exit_done
    end function goes_on

    recursive subroutine pilot(mesh, steps, depth, there)
      real(wp), intent(in) :: mesh, steps, depth   !! its fineness [-]
      logical, intent(out) :: there                !! it has reached its end

      call add_pilot(options, scene, deck_text, run, fineness_t(mesh, steps, depth), plan, there, code, error)
    end subroutine pilot

    !> Two meshes, the coarser one the coarsest that there can be.
    recursive subroutine measure_meshes()
      logical :: there

      coarsest = merge(coarsest_mesh, 1.0_wp, scene%accuracy%halvable)
      call pilot(coarsest, 1.0_wp, 1.0_wp, there)
      if (.not. there .and. coarsest < 1 .and. goes_on()) then
        coarsest = 1
        call pilot(coarsest, 1.0_wp, 1.0_wp, there)
      end if
      if (plan%divisible .and. goes_on()) call pilot(2*coarsest, 1.0_wp, 1.0_wp, there)
    end subroutine measure_meshes

    !> Half the steps, and shorter ones as long as there are hardly more of them.
    recursive subroutine measure_steps()
      logical :: there

      shortest = 1
      do while (goes_on())
        call pilot(coarsest, half*shortest, 1.0_wp, there)
        if (.not. there) exit
        shortest = half*shortest
        if (enough_steps(plan) .or. .not. shortest > least_pilot) exit
      end do
      if (.not. shortest < 1 .and. goes_on()) call add_text(plan%notes, 'errors in time are not known')
    end subroutine measure_steps

    recursive subroutine measure_penetration()
      logical :: there

      call pilot(coarsest, 1.0_wp, quarter, there)
      if (.not. there .and. goes_on()) call add_text(plan%notes, 'errors of the penetration are not known')
    end subroutine measure_penetration

    !> More pilots near the fineness that the laws of those so far ask for: a law is good near those that it was measured with.
    recursive subroutine refine_laws()
      logical :: there

      do while (goes_on())
        call choose_from_pilots(options, scene, plan, error)
        if (allocated(error)) return
        if (shortest < 1 .and. plan%fineness%steps < half*shortest .and. shortest > least_pilot) then
          shortest = max(next_power(plan%fineness%steps), shortest/8, least_pilot)
          call pilot(coarsest, shortest, 1.0_wp, there)
          if (.not. there) shortest = 0
          cycle
        end if
        if (.not. (plan%divisible .and. plan%law%space_known)) exit
        if (.not. (plan%fineness%mesh > 2*plan%law%mesh .or. may_yet_be_met(plan))) exit
        call pilot(2*plan%law%mesh, 1.0_wp, 1.0_wp, there)
        if (.not. there) exit
      end do
    end subroutine refine_laws

  end subroutine make_plan

  !> A plan without pilots.
  subroutine start_plan(scene, plan)
    type(scene_t), intent(in) :: scene
    type(accuracy_plan_t), intent(inout) :: plan
    integer :: k

    allocate (plan%pilots(0), plan%notes(0), plan%names(0), plan%scales(0), plan%columns(0), plan%elsewhere(0))
    do k = 1, size(scene%probes)
      if (is_elsewhere(scene%probes(k), scene%mesh%origin)) call add_text(plan%elsewhere, scene%probes(k)%name)
    end do
    plan%asked = scene%accuracy%asked
    plan%divisible = scene%accuracy%divisible
    if (has_contours(scene%remesher)) plan%parts = quarters
  end subroutine start_plan

  !> The last pilot has so many more steps than the first that their errors can be seen.
  pure function enough_steps(plan) result(yes)
    type(accuracy_plan_t), intent(in) :: plan
    logical :: yes

    yes = .true.
    if (size(plan%pilots) > 1) yes = steps_differ(plan%pilots(1), plan%pilots(size(plan%pilots)))
  end function enough_steps

  !> No fineness was found, but the meshes so far do not say that there is none: an order is assumed, or differences do not fall as
  !> errors do yet. Those of a probe that reads another place on every mesh never do.
  pure function may_yet_be_met(plan) result(yes)
    type(accuracy_plan_t), intent(in) :: plan
    logical :: yes
    integer :: k, i

    yes = .not. plan%met
    if (.not. yes .or. .not. plan%law%order_measured) return
    yes = .false.
    if (plan%law%mesh >= most_hidden) return
    do k = 1, size(plan%names)
      if (any([(plan%elsewhere(i)%s == plan%names(k)%s, i=1, size(plan%elsewhere))])) cycle
      yes = yes .or. plan%law%hidden(k)
    end do
  end function may_yet_be_met

  !> The laws of all pilots so far, and what they allow.
  subroutine choose_from_pilots(options, scene, plan, error)
    type(run_options_t), intent(in) :: options
    type(scene_t), intent(in) :: scene
    type(accuracy_plan_t), intent(inout) :: plan
    type(error_t), allocatable, intent(out) :: error
    integer :: finest

    if (size(plan%pilots) == 0) then
      call fail(error, exit_no_convergence, 'ACCURACY: the deck has no run to its end, on its own mesh with its own steps', &
                'the pilots are in '//options%out//'; find what stops them without ACCURACY')
      return
    end if
    finest = maxloc(plan%pilots%fineness%mesh, 1)
    call range_of(plan%pilots(finest), plan%scales)
    if (size(scene%accuracy%columns) == 0) call join_forces(plan%names, plan%scales)
    call measure_laws(plan%pilots, plan%scales, scene%accuracy%stress, is_smooth(scene), scene%accuracy%of_sides, &
                      time_order(scene), plan%law)
    call choose_fineness(plan%law, plan%asked, plan%divisible .and. plan%law%space_known, plan%fineness, plan%met, plan%parts)
    call expect(plan)
  end subroutine choose_from_pilots

  subroutine note_what_is_unknown(plan)
    type(accuracy_plan_t), intent(inout) :: plan

    if (.not. plan%divisible) then
      call add_text(plan%notes, 'errors in space are not known: the mesh is written out in the deck, only those of BLOCK cards ' &
                    //'are made finer')
    else if (.not. plan%law%space_known) then
      call add_text(plan%notes, 'errors in space are not known')
    else if (.not. plan%met) then
      call add_text(plan%notes, 'no fineness was found for it')
    end if
  end subroutine note_what_is_unknown

  !> The power of 1/2 that is not below a factor.
  pure function next_power(factor) result(power)
    real(wp), intent(in) :: factor
    real(wp) :: power

    power = 0.5_wp**int(-log(factor)/log(2.0_wp))
  end function next_power

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
