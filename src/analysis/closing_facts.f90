!> What is known at the end of a run: the errors that are estimated of it, in space, in time and at contact, and what half of each
!> would cost.
!>
!> The forecast is made of the seconds of this run by tasks, and of how tasks and errors go with the mesh and the steps:
!> - Space: the error of the stress of elements of 8 nodes is of order 2 in their size (O.C. Zienkiewicz, J.Z. Zhu, Int. J.
!>   Num. Meth. Engng 33 (1992) 1331-1364; tests/estimate), so twice as many elements halve it. Loops over elements take twice the
!>   time then, those over sides of contact sqrt(2), a factorisation 2^(3/2) (nested dissection: A. George, SIAM J. Num. Anal. 10
!>   (1973) 345-363). Where a corner is singular the order is less and uniform elements cost more.
!>   So do twice as many elements the error of temperatures on corners, which is of order 2 too.
!> - Time: errors that come of the path within steps are of order 1 in sum; those of heat of order 1, or 2 (TR-BDF2, and
!>   theta = 1/2). Seconds go with the number of steps, at the same iterations a step.
module closing_facts
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use accuracy_costs, only: cost_of_elements, seconds_by_task
  use accuracy_plan, only: accuracy_t
  use cost_file, only: cost_t, ntask
  use csv_reader, only: read_csv
  use energy_balance, only: is_drag_alone
  use energy_round_off, only: energy_without_strain
  use equations, only: equations_t
  use errors, only: error_t
  use estimator, only: stress_error_now
  use estimator_parts, only: estimator_t, set_up_estimator
  use fields, only: displacement_field
  use heat_books, only: has_heat
  use kinds, only: wp
  use path_record, only: motion_error, stress_error, whole_stress_error
  use misplaced_contact, only: leaves_places_out
  use pending_heat, only: pending_temperature
  use phases_in_space, only: errors_of_phases, phase_errors_t
  use remeshing, only: stress_error_of_all
  use scene, only: is_solid, scene_t
  use shape_record, only: shape_errors_t
  use solution, only: solution_t
  use strategy, only: order_in_time
  use text, only: string_t
  implicit none
  private
  public :: closing_t, close_cycle, close_run, largest_stress

  !> An estimated error of the stress above the stress itself says no more than that: the estimate is good where the recovered
  !> stress is better than that of the elements, which it is not then (found: 261 % and 660 % where 74 % and 93 % were true).
  real(wp), parameter :: largest_stress = 1.0_wp

  !> Shares, unless a unit is given; a cost is the time over that of this run.
  type :: closing_t
    !> Errors of the stress and of the strain by patch recovery; the latter is a sum over the steps, where ESTIM or REMSH asks.
    logical :: space = .false., strain_known = .false.
    real(wp) :: stress = 0.0_wp, strain = 0.0_wp, space_cost = 1.0_wp
    !> The first is more than the stress itself: the mesh does not show it, and the number is none of the error.
    logical :: stress_hidden = .false.
    !> What the first has of errors of earlier meshes; it is not known of an operation without ESTIM and REMSH after others.
    real(wp) :: stress_carried = 0.0_wp
    logical :: carried_unknown = .false.
    !> A law flows. Errors of the path within steps, where estimated (NORMS): of the motion in sum, of the stress at the end
    !> with what it owes to the motion (where that is known), and at this motion.
    logical :: flows = .false., path = .false., whole_known = .true.
    real(wp) :: motion = 0.0_wp, path_stress = 0.0_wp, stress_at_motion = 0.0_wp, path_cost = 2.0_wp
    !> There is heat. Its errors in time, where they are estimated (THETA): sum over the steps; of all steps at the end, and
    !> the largest at any time, in the mean square of the volume [temperature]; and how many have one.
    logical :: warm = .false.
    integer :: heat_steps = 0
    real(wp) :: heat = 0.0_wp, heat_now = 0.0_wp, heat_largest = 0.0_wp, heat_cost = 2.0_wp
    !> Errors of temperatures in space (space_error): the largest at the end and at any time, and the same in the mean square of the
    !> volume [temperature]; in how many steps they were followed, 0 where temperatures stand on 8 nodes.
    integer :: space_steps = 0
    real(wp) :: space_now = 0.0_wp, space_largest = 0.0_wp, space_mean = 0.0_wp, space_mean_largest = 0.0_wp
    !> Errors of phases that these make, at the end.
    type(phase_errors_t) :: phases
    !> What the plastic work of the last step would warm the bodies by that has not become heat (SOLVE ONCE) [temperature].
    real(wp) :: heat_due = 0.0_wp
    !> Errors of where contact stands, by which heat passes, are not among them: dies, or the section, are free.
    logical :: places_left_out = .false.
    !> Error of the stress that the errors of temperatures make, where no law flows.
    real(wp) :: heat_stress = 0.0_wp
    !> Depth of the part in its dies, at points of contact and between them [length], over what is allowed (0: nothing states that).
    logical :: contact = .false.
    real(wp) :: depth = 0.0_wp, depth_share = 0.0_wp
    !> Meshes of the whole run with REMSH, the largest errors of the stress and of the strain over all of its steps where these are
    !> in the history, and its seconds by tasks [s]; forecasts are then of all meshes.
    integer :: meshes = 1
    logical :: errors_of_all = .false.
    real(wp) :: stress_worst = 0.0_wp, strain_worst = 0.0_wp, seconds(ntask) = 0.0_wp
    !> Of a deck with ACCURACY that has come to its end.
    type(accuracy_t), allocatable :: accuracy
    !> Errors in space of the shape that fronts of temperature and phases leave.
    type(shape_errors_t) :: shape
  end type closing_t

contains

  !> What is known at the end of a run. The error of the stress is estimated now where the deck did not ask for it.
  subroutine close_run(scene, equations, solution, volume, closing)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: volume   !! of the bodies, per radian when axisymmetric [volume]
    type(closing_t), intent(out) :: closing
    integer :: k

    call close_space(scene, equations, solution, closing)
    closing%stress_hidden = closing%stress > largest_stress
    closing%flows = any([(scene%effects(k)%on .and. scene%effects(k)%name == 'plasticity', k=1, size(scene%effects))])
    closing%path = solution%path%estimated > 0
    closing%motion = motion_error(solution%path)
    ! where nothing is strained both errors and stresses are round-off
    if (max(solution%path%stress, solution%path%stress_recent)**2 > energy_without_strain(scene, equations, volume) &
        .and. .not. is_drag_alone(solution%work)) then
      call whole_stress_error(solution%path, closing%path_stress, closing%whole_known)
      closing%stress_at_motion = stress_error(solution%path)
    end if
    closing%warm = has_heat(scene)
    closing%heat_steps = solution%heat%estimated
    closing%heat = solution%heat%error_sum
    closing%heat_now = solution%heat%error_now
    closing%heat_largest = solution%heat%error_largest
    closing%space_steps = solution%heat%space_steps
    if (closing%warm) closing%space_cost = cost_of_elements(seconds_by_task(equations%timers), 2.0_wp)
    ! above the range of temperatures nothing is known of the place
    closing%space_now = min(solution%heat%space_now, solution%heat%hottest - solution%heat%coldest)
    closing%space_largest = min(solution%heat%space_largest, solution%heat%hottest - solution%heat%coldest)
    closing%space_mean = solution%heat%space_mean
    closing%space_mean_largest = solution%heat%space_mean_largest
    if (closing%space_steps > 0) call errors_of_phases(scene, solution, closing%phases)
    if (solution%work%elastic > energy_without_strain(scene, equations, volume)) closing%heat_stress = solution%heat%stress_error
    closing%places_left_out = leaves_places_out(scene, equations)
    closing%heat_due = pending_temperature(scene, equations%laws, equations%drivers, solution)
    closing%heat_cost = 2.0_wp**(1.0_wp/order_in_time(scene%strategy))
    closing%shape = solution%shape%errors
    closing%contact = size(scene%dies) > 0 .and. closing%space
    closing%depth = max(solution%worst_penetration, solution%worst_sample)
    closing%depth_share = max(solution%worst_penetration_ratio, solution%worst_sample_ratio)
  end subroutine close_run

  !> What the whole run has cost and had of errors, where it had other meshes before: seconds are those of all calls of both
  !> programs, errors those of the history.
  subroutine close_cycle(scene, cost, history, closing)
    type(scene_t), intent(in) :: scene
    type(cost_t), intent(in) :: cost
    character(len=*), intent(in) :: history   !! its file
    type(closing_t), intent(inout) :: closing
    type(string_t), allocatable :: titles(:)
    real(wp), allocatable :: table(:, :)
    type(error_t), allocatable :: error
    integer :: k

    closing%meshes = scene%generation - max(scene%operation, 1) + 1
    if (closing%meshes == 1 .or. .not. closing%space) return
    closing%seconds = cost%seconds
    if (sum(cost%seconds) > 0) closing%space_cost = cost_of_elements(cost%seconds, 2.0_wp)
    call read_csv(history, titles, table, error)
    closing%stress_worst = closing%stress
    closing%strain_worst = closing%strain
    ! a history that is gone says nothing of the steps before, nor does this run then
    closing%errors_of_all = .not. allocated(error)
    if (allocated(error)) return
    do k = 1, size(titles)
      if (index(titles(k)%s, 'error_stress') == 1) closing%stress_worst = max(closing%stress, largest(table(k, :)))
      if (index(titles(k)%s, 'error_strain') == 1) closing%strain_worst = max(closing%strain, largest(table(k, :)))
    end do
  end subroutine close_cycle

  !> Of the cells that have a number.
  pure function largest(column) result(value)
    real(wp), intent(in) :: column(:)   !! (nrow) [-]
    real(wp) :: value

    value = maxval([0.0_wp, pack(column, ieee_is_finite(column))])
  end function largest

  !> Error of the stress, and of the strain where the steps were followed.
  subroutine close_space(scene, equations, solution, closing)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(closing_t), intent(inout) :: closing
    type(estimator_t) :: estimator
    integer :: g

    if (.not. scene%fields(displacement_field)%declared) return
    if (.not. any([(is_solid(scene%groups(g)), g=1, size(scene%groups))])) return
    closing%space = .true.
    closing%strain_known = scene%remesh%estimate
    closing%space_cost = cost_of_elements(seconds_by_task(equations%timers), 2.0_wp)
    closing%stress = stress_error_of_all(solution%estimate, solution%estimate%stress)
    closing%stress_carried = solution%estimate%carried_stress*solution%estimate%stress_left
    closing%strain = solution%estimate%strain
    if (scene%remesh%estimate) return
    ! nobody has followed what the flow of this operation forgets of it
    closing%carried_unknown = closing%stress_carried > 0
    closing%stress_carried = 0
    call set_up_estimator(scene, equations%laws, estimator)
    call stress_error_now(estimator, scene, solution, closing%stress)
  end subroutine close_space

end module closing_facts
