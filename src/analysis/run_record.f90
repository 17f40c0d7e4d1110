!> A run and its files: what is written when.
module run_record
  use accuracy_plan, only: accuracy_plan_t
  use contact_contour, only: find_contact_ends
  use contact_ends, only: contact_end_t
  use csv_writer, only: csv_t
  use dies, only: present_die
  use elem_api, only: totals_t
  use equations, only: equations_t
  use errors, only: error_t, exit_done
  use estimator_parts, only: estimator_t
  use exchange, only: write_checkpoint
  use fields, only: pilot_field
  use history, only: write_row
  use kinds, only: eps, wp
  use listing, only: listing_t
  use own_contact, only: faces_itself
  use restore_balance, only: balance_t
  use results, only: results_t, save_fields
  use quadrature, only: line_rule
  use scene, only: group_t, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use step_outcome, only: outcome_t
  use system, only: caught_signal
  use text, only: string_t
  use watch_mesh, only: mesh_is_due
  implicit none
  private
  public :: at_end, ends_now, record, run_t, save_all

  !> A run: its files, and what is needed to write them.
  type :: run_t
    !> Folder of the results, path of the run's own files without endings; the deck's path and canonical text.
    character(len=:), allocatable :: folder, stem, deck_path, deck_text
    logical :: resume = .false.
    !> An operation begins with the state that the one before has left.
    logical :: begins_operation = .false.
    !> The deck has new meshes, in this operation or in another one: what it costs is added up over all of them.
    logical :: has_new_meshes = .false.
    !> Columns of the history of all operations; not allocated for a deck without any.
    type(string_t), allocatable :: columns(:)
    type(equations_t) :: equations
    !> Set up where errors are estimated.
    type(estimator_t) :: estimator
    type(listing_t) :: listing
    type(csv_t) :: table
    type(results_t) :: results
    type(totals_t) :: totals
    !> How equilibrium was restored on a new mesh; not allocated where it was not.
    type(balance_t), allocatable :: balance
    !> A new mesh was refused, at the restart or on probation.
    logical :: mesh_refused = .false.
    !> Other new meshes agree on the forces of the one that the run goes on with: they do not speak against it.
    logical :: force_agreed = .false.
    !> The note on a spurious mode has been given.
    logical :: spurious_reported = .false.
    !> The first of the steps that are damped now; 0 where none is.
    integer :: damped_from = 0
    !> Step that was tried without damping again as it was shortened, or is not to be; 0 for none.
    integer :: undamped_again = 0
    !> A group of the body whose sides have met, where no card gives them contact, and why it is known; 0 where none have.
    integer :: folding = 0
    character(len=:), allocatable :: folds
    !> Of a deck with ACCURACY, but for its pilots.
    type(accuracy_plan_t), allocatable :: plan
    integer :: exit_code = exit_done
    character(len=:), allocatable :: stop_reason
  end type run_t

contains

  !> History after every step; fields and checkpoint when they are due.
  subroutine record(scene, solution, outcome, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical :: fields_due

    call write_row(scene, solution, outcome, run%totals, run%table, error)
    if (allocated(error)) return
    fields_due = is_due(solution%step, scene%strategy%save_every) .or. at_end(scene, solution) &
                 .or. is_save_time(scene, solution) .or. mesh_is_due(solution)
    if (fields_due) then
      call save_all(scene, solution, run, error)
    else if (is_due(solution%step, scene%strategy%checkpoint_every)) then
      call save_checkpoint(scene, solution, run, error)
    else if (caught_signal() /= 0) then
      call save_checkpoint(scene, solution, run, error, between_saves=.true.)
    end if
  end subroutine record

  !> Fields and checkpoint of the accepted instant.
  subroutine save_all(scene, solution, run, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error

    call save_fields(scene, solution, run%results, error)
    if (.not. allocated(error)) call save_checkpoint(scene, solution, run, error)
  end subroutine save_all

  !> The checkpoint; the rows of the history up to it are on the disk before it is.
  subroutine save_checkpoint(scene, solution, run, error, between_saves)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(run_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: between_saves   !! none was due

    call run%table%flush_rows(error)
    if (allocated(error)) return
    call write_checkpoint(run%stem//'.ckp.h5', run%deck_path, run%deck_text, scene, solution, ends_now(scene, solution), error, &
                          between_saves)
  end subroutine save_checkpoint

  !> Where contact begins and ends in all contact groups.
  function ends_now(scene, solution) result(ends)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), allocatable :: ends(:)
    real(wp), allocatable :: x(:, :), depth(:, :)
    integer, allocatable :: closed(:, :)
    integer :: g

    allocate (ends(0))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        if (faces_itself(scene, group)) cycle
        call states_of_points(group, solution%groups(g)%committed, closed, depth)
        x = present_coordinates(scene, solution)
        call find_contact_ends(group, g, present_die(scene%dies(group%die), x), solution%fields(pilot_field)%value(:, group%die), &
                               scene%mesh%coordinates, x, closed, depth, ends)
      end associate
    end do
  end function ends_now

  !> Status and depth of the points of a group; at a node on the axis, where points have no surface, those of the node itself, which
  !> are the state of a corner in its place (axis_contact).
  pure subroutine states_of_points(group, state, status, depth)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)            !! (component, npoint, nside) [unit of each component]
    integer, allocatable, intent(out) :: status(:, :)   !! (npoint, nside)
    real(wp), allocatable, intent(out) :: depth(:, :)   !! (npoint, nside) [length]
    real(wp), allocatable :: xi(:), weight(:)
    integer :: place, of_corner, depth_of_corner, p

    associate (variables => group%variables)
      status = nint(state(variables(find_variable(variables, 'contact_status'))%first, :, :))
      depth = state(variables(find_variable(variables, 'penetration'))%first, :, :)
      place = find_variable(variables, 'corner_place')
      if (place == 0 .or. group%pairs > 0) return
      place = variables(place)%first
      of_corner = variables(find_variable(variables, 'corner_contact_status'))%first
      depth_of_corner = variables(find_variable(variables, 'corner_penetration'))%first
    end associate
    call line_rule(group%rule, xi, weight)
    do p = 1, size(xi)
      if (abs(xi(p)) < 1) cycle
      where (nint(state(of_corner, p, :)) /= 0 .and. state(place, p, :)*xi(p) >= 1)
        status(p, :) = nint(state(of_corner, p, :))
        depth(p, :) = state(depth_of_corner, p, :)
      end where
    end do
  end subroutine states_of_points

  pure function is_due(step, every) result(due)
    integer, intent(in) :: step, every
    logical :: due

    due = .false.
    if (every > 0) due = mod(step, every) == 0
  end function is_due

  pure function at_end(scene, solution) result(reached)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: reached

    reached = solution%time >= scene%strategy%end_time*(1 - 64*eps)
  end function at_end

  pure function is_save_time(scene, solution) result(due)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: due

    due = .false.
    if (allocated(scene%strategy%save_times)) then
      due = any(abs(scene%strategy%save_times - solution%time) <= 64*eps*scene%strategy%end_time)
    end if
  end function is_save_time

end module run_record
