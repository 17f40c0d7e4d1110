!> The members of a solution, for writing, reading, describing or carrying them (visitors).
module visit_solution
  use acceptance, only: probation_steps, probation_t
  use confinement_record, only: confinement_record_t
  use crossing_record, only: crossing_record_t
  use heat_record, only: heat_record_t
  use kinds, only: wp
  use narrow_record, only: narrow_record_t
  use pairs, only: pairs_t
  use pace_record, only: pace_t
  use path_record, only: path_record_t
  use run_warnings, only: warning_t
  use shape_record, only: shape_errors_t, shape_record_t
  use solution, only: group_state_t, solution_t
  use visit_cuts, only: visit_cut_records
  use visit_estimate, only: visit_estimate_members
  use visit_field, only: visit_field_values
  use visit_work, only: visit_work_members
  use visitors, only: by_variable, kept, of_the_mesh, recomputed, visitor_t
  implicit none
  private
  public :: visit_solution_members

  !> Warnings of earlier operations and meshes at most.
  integer, parameter :: most_warnings = 10000

contains

  !> Lists and arrays are those of a solution that was started: none of them changes its extents.
  subroutine visit_solution_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(solution_t), intent(inout) :: self
    integer :: k, n

    call visitor%enter('progress')
    call visitor%member('time', self%time, kept, 'time', low=0.0_wp)
    call visitor%member('step', self%step, kept, low=0)
    call visitor%member('last_step', self%last_step, kept, 'time', low=0.0_wp)
    call visitor%member('older_step', self%older_step, recomputed, 'time', low=0.0_wp)
    call visitor%member('next_step', self%next_step, kept, 'time', low=0.0_wp)
    call visitor%member('unbalanced', self%unbalanced, recomputed)
    call visitor%member('between_saves', self%between_saves, recomputed)
    call visitor%member('penalty_share', self%penalty_share, kept, '-', low=0.0_wp)
    call visitor%member('damping', self%damping, kept, 'force time/length^4', low=0.0_wp)
    call visitor%member('damping_bound', self%damping_bound, kept, 'energy', low=0.0_wp)
    call visitor%member('iterations', self%iterations, kept, low=0)
    call visitor%member('cutbacks', self%cutbacks, kept, low=0)
    call visitor%member('external_work', self%external_work, kept, 'energy')
    call visitor%member('friction_work', self%friction_work, kept, 'energy')
    call visitor%member('friction_apart', self%friction_apart, recomputed, 'energy')
    call visitor%member('heat_stored', self%heat_stored, kept, 'energy')
    call visitor%member('heat_in', self%heat_in, kept, 'energy')
    call visitor%member('heat_released', self%heat_released, kept, 'energy')
    call visitor%member('heat_passed', self%heat_passed, kept, 'energy', low=0.0_wp)
    call visitor%derived('heat_flows', 'of the last step: for the row of history.csv that is written with it')
    call visitor%member('initial_volume', self%initial_volume, kept, 'volume', low=0.0_wp)
    call visitor%member('sunk_group', self%sunk_group, kept, low=0)
    call visitor%member('sunk_depth', self%sunk_depth, kept, 'length', low=0.0_wp)
    call visitor%member('sunk_share', self%sunk_share, kept, '-', low=0.0_wp)
    call visitor%member('worst_linear_residual', self%worst_linear_residual, kept, '-')
    call visitor%member('worst_penetration', self%worst_penetration, kept, 'length')
    call visitor%member('worst_penetration_ratio', self%worst_penetration_ratio, kept, '-')
    call visitor%member('least_dissipation', self%least_dissipation, kept, 'energy')
    call visitor%member('worst_spurious', self%worst_spurious, kept, '-')
    call visitor%member('stays_unstable', self%stays_unstable, kept)
    call visitor%member('unstable_steps', self%unstable_steps, kept, low=0)
    call visitor%member('unstable_from', self%unstable_from, kept, 'time')
    call visitor%member('unsettled_steps', self%unsettled_steps, kept, low=0)
    call visitor%member('unsettled_share', self%unsettled_share, kept, '-', low=0.0_wp)
    call visitor%member('worst_fraction', self%worst_fraction, kept, '-', low=0.0_wp)
    call visitor%member('missing_austenite', self%missing_austenite, kept, '-', low=0.0_wp)
    call visitor%member('held_growth', self%held_growth, kept, '-', low=0.0_wp, high=1.0_wp)
    call visitor%member('spurious_group', self%spurious_group, kept, low=0)
    call visitor%member('spurious_element', self%spurious_element, of_the_mesh, low=0)
    call visitor%member('worst_sample', self%worst_sample, kept, 'length')
    call visitor%member('worst_sample_ratio', self%worst_sample_ratio, kept, '-')
    call visitor%member('largest_force', self%largest_force, kept, 'force', low=0.0_wp)
    call visitor%leave('progress')
    call visitor%enter('work')
    call visit_work_members(visitor, self%work)
    call visitor%leave('work')
    call visitor%enter('heat')
    call visit_heat_record(visitor, self%heat)
    call visitor%leave('heat')
    call visitor%enter('confinement')
    call visit_confinement(visitor, self%confinement)
    call visitor%leave('confinement')
    call visitor%enter('narrow')
    call visit_narrow(visitor, self%narrow)
    call visitor%leave('narrow')
    call visitor%enter('shape')
    call visit_shape(visitor, self%shape)
    call visitor%leave('shape')
    call visitor%enter('path')
    call visit_path_record(visitor, self%path)
    call visitor%leave('path')
    call visitor%enter('probation')
    call visit_probation(visitor, self%probation)
    call visitor%leave('probation')
    call visitor%enter('crossing')
    call visit_crossing(visitor, self%crossing)
    call visitor%leave('crossing')
    call visitor%enter('pace')
    call visit_pace(visitor, self%pace)
    call visitor%leave('pace')
    call visitor%enter('estimate')
    call visit_estimate_members(visitor, self%estimate)
    call visitor%leave('estimate')
    call visit_cut_records(visitor, self%cuts)
    call visit_warnings(visitor, self%warnings)
    do k = 1, size(self%fields)
      call visitor%enter('fields/'//self%fields(k)%name)
      call visit_field_values(visitor, self%fields(k))
      call visitor%leave('fields')
    end do
    do k = 1, size(self%groups)
      call visitor%enter_item('groups', k)
      call visit_group_state(visitor, self%groups(k))
      call visitor%leave('groups')
    end do
    n = size(self%pairs)
    call visitor%list('pairs', n)
    do k = 1, size(self%pairs)
      call visitor%enter_item('pairs', k)
      call visit_pairs(visitor, self%pairs(k))
      call visitor%leave('pairs')
    end do
  end subroutine visit_solution_members

  subroutine visit_warnings(visitor, warnings)
    class(visitor_t), intent(inout) :: visitor
    type(warning_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: k, n

    n = 0
    if (allocated(warnings)) n = size(warnings)
    call visitor%list('warnings', n, most_warnings, carried=kept)
    if (allocated(warnings)) then
      if (size(warnings) /= n) deallocate (warnings)
    end if
    if (.not. allocated(warnings)) allocate (warnings(n))
    do k = 1, n
      call visitor%enter_item('warnings', k)
      call visit_warning(visitor, warnings(k))
      call visitor%leave('warnings')
    end do
  end subroutine visit_warnings

  subroutine visit_warning(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(warning_t), intent(inout) :: self

    call visitor%member('operation', self%operation, kept)
    call visitor%member('check', self%check, kept)
    call visitor%member('text', self%text, kept)
    call visitor%member('again', self%again, kept)
  end subroutine visit_warning

  subroutine visit_heat_record(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(heat_record_t), intent(inout) :: self

    call visitor%member('error_sum', self%error_sum, kept, 'temperature', low=0.0_wp)
    call visitor%member('error_worst', self%error_worst, kept, 'temperature', low=0.0_wp)
    call visitor%member('estimated', self%estimated, kept, low=0)
    call visitor%member('content_error', self%content_error, of_the_mesh, 'node', 'energy')
    call visitor%member('die_error', self%die_error, of_the_mesh, 'die', 'energy')
    call visitor%member('temperature_error', self%temperature_error, of_the_mesh, 'node', 'temperature')
    call visitor%member('error_of_mesh', self%error_of_mesh, of_the_mesh, 'temperature', low=0.0_wp)
    call visitor%member('error_now', self%error_now, kept, 'temperature', low=0.0_wp)
    call visitor%member('error_largest', self%error_largest, kept, 'temperature', low=0.0_wp)
    call visitor%member('stress_error', self%stress_error, kept, '-', low=0.0_wp)
    call visitor%member('finer', self%finer, of_the_mesh, 'node of the finer mesh', 'temperature')
    call visitor%member('finer_content', self%finer_content, of_the_mesh, 'node of the finer mesh', 'energy')
    call visitor%member('space_steps', self%space_steps, kept, low=0)
    call visitor%member('space_now', self%space_now, kept, 'temperature', low=0.0_wp)
    call visitor%member('space_largest', self%space_largest, kept, 'temperature', low=0.0_wp)
    call visitor%member('space_mean', self%space_mean, kept, 'temperature', low=0.0_wp)
    call visitor%member('space_mean_largest', self%space_mean_largest, kept, 'temperature', low=0.0_wp)
    call visitor%member('space_time', self%space_time, kept, 'time')
    call visitor%member('coldest', self%coldest, kept, 'temperature')
    call visitor%member('hottest', self%hottest, kept, 'temperature')
    call visitor%member('shortened', self%shortened, kept, low=0)
    call visitor%member('above', self%above, kept, low=0)
    call visitor%member('outside', self%outside, kept, low=0)
    call visitor%member('excess', self%excess, kept, 'temperature', low=0.0_wp)
    call visitor%member('fallbacks', self%fallbacks, kept, low=0)
  end subroutine visit_heat_record

  subroutine visit_confinement(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(confinement_record_t), intent(inout) :: self

    call visitor%member('group', self%group, kept, low=0)
    call visitor%member('since', self%since, kept, 'time', low=0.0_wp)
    call visitor%member('change', self%change, kept, '-')
    call visitor%member('over_stress', self%over_stress, kept, '-')
    call visitor%member('now', self%now, kept)
  end subroutine visit_confinement

  subroutine visit_narrow(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(narrow_record_t), intent(inout) :: self

    call visitor%member('die', self%die, kept, low=0)
    call visitor%member('force', self%force, kept, 'force', low=0.0_wp)
    call visitor%member('until', self%until, kept, 'time', low=0.0_wp)
    call visitor%member('across', self%across, kept, '-', low=0.0_wp)
    call visitor%member('error', self%error, kept, '-', low=0.0_wp)
  end subroutine visit_narrow

  subroutine visit_shape(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(shape_record_t), intent(inout) :: self

    call visitor%member('followed', self%followed, kept)
    call visitor%member('coldest', self%coldest, kept, 'temperature')
    call visitor%member('hottest', self%hottest, kept, 'temperature')
    call visitor%enter('errors')
    call visit_shape_errors(visitor, self%errors)
    call visitor%leave('errors')
  end subroutine visit_shape

  subroutine visit_shape_errors(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(shape_errors_t), intent(inout) :: self

    call visitor%member('known', self%known, of_the_mesh)
    call visitor%member('share', self%share, kept, '-', low=0.0_wp)
    call visitor%member('displacement', self%displacement, kept, 'length', low=0.0_wp)
    call visitor%member('of_displacement', self%of_displacement, kept, 'length', low=0.0_wp)
    call visitor%member('growth', self%growth, kept, '-', low=0.0_wp)
    call visitor%member('of_growth', self%of_growth, kept, '-')
    call visitor%member('curvature', self%curvature, kept, '1/length', low=0.0_wp)
    call visitor%member('of_curvature', self%of_curvature, kept, '1/length', low=0.0_wp)
  end subroutine visit_shape_errors

  subroutine visit_path_record(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(path_record_t), intent(inout) :: self

    call visitor%member('moved', self%moved, kept, 'length', low=0.0_wp)
    call visitor%member('moved_error', self%moved_error, kept, 'length', low=0.0_wp)
    call visitor%member('error', self%error, of_the_mesh, 'component, node', 'length')
    call visitor%member('stress_recent', self%stress_recent, kept, 'energy^0.5', low=0.0_wp)
    call visitor%member('stress_error', self%stress_error, kept, 'energy^0.5')
    call visitor%member('stress_worst', self%stress_worst, kept, '-', low=0.0_wp)
    call visitor%member('stress', self%stress, kept, 'energy^0.5', low=0.0_wp)
    call visitor%member('stress_whole', self%stress_whole, kept, 'energy^0.5', low=0.0_wp)
    call visitor%member('whole_before', self%whole_before, recomputed, 'energy^0.5', low=0.0_wp)
    call visitor%member('lost', self%lost, kept)
    call visitor%member('flow', self%flow, kept, 'energy^0.5', low=0.0_wp)
    call visitor%member('unknown', self%unknown, kept, '-', low=0.0_wp, high=1.0_wp)
    call visitor%member('estimated', self%estimated, kept, low=0)
    call visitor%member('shortened', self%shortened, kept, low=0)
    call visitor%member('above', self%above, kept, low=0)
    call visitor%member('unbounded', self%unbounded, kept, low=0)
    call visitor%member('patience', self%patience, kept, low=1)
    call visitor%member('quiet', self%quiet, kept, low=0)
    call visitor%member('quiet_length', self%quiet_length, kept, 'time', low=0.0_wp)
    call visitor%member('quiet_flow', self%quiet_flow, kept, 'stress', low=0.0_wp)
    call visitor%member('quiet_bend', self%quiet_bend, kept, '-', low=0.0_wp)
    call visitor%member('pending_time', self%pending_time, kept, 'time', low=0.0_wp)
    call visitor%member('pending_square', self%pending_square, kept, 'time^2', low=0.0_wp)
    call visitor%member('pending_motion', self%pending_motion, kept, 'length time', low=0.0_wp)
    call visitor%member('motion_rate', self%motion_rate, kept, '1/time', low=0.0_wp)
    call visitor%member('smooth_rate', self%smooth_rate, kept, '1/time')
    call visitor%member('stress_rate', self%stress_rate, kept, 'energy^0.5/time^2')
    call visitor%derived('tried_length', 'of an attempt at a step')
    call visitor%derived('tried_sizes', 'of an attempt at a step')
  end subroutine visit_path_record

  subroutine visit_probation(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(probation_t), intent(inout) :: self

    call visitor%fixed('recent_steps', self%recent, kept, 'time', low=0.0_wp)
    call visitor%member('left', self%left, kept, low=0, high=probation_steps)
    call visitor%member('before', self%before, kept, 'time', low=0.0_wp)
    call visitor%member('least', self%least, kept, 'time', low=0.0_wp)
  end subroutine visit_probation

  subroutine visit_crossing(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(crossing_record_t), intent(inout) :: self

    call visitor%member('length', self%length, kept, 'time', low=0.0_wp)
    call visitor%member('until', self%until, kept, 'time', low=0.0_wp)
    call visitor%member('thinned', self%thinned, kept)
    call visitor%member('remeshed', self%remeshed, kept)
  end subroutine visit_crossing

  subroutine visit_pace(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(pace_t), intent(inout) :: self

    call visitor%member('beyond_nopti', self%beyond_nopti, kept, low=0)
    call visitor%member('steps', self%steps, kept, low=0)
    call visitor%member('iterations', self%iterations, kept, '-', low=0.0_wp)
    call visitor%member('time', self%time, kept, 'time', low=0.0_wp)
    call visitor%member('cost', self%cost, kept, '1/time', low=0.0_wp)
    call visitor%member('settled', self%settled, kept)
  end subroutine visit_pace

  subroutine visit_group_state(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(group_state_t), intent(inout) :: self

    call visitor%member('state', self%committed, by_variable, 'component, point, element')
    call visitor%member('path_error', self%error, of_the_mesh, 'component, point, element')
    call visitor%member('space_error', self%space_error, of_the_mesh, 'component, point, element')
    call visitor%member('span', self%span, of_the_mesh, 'element', '-')
    call visitor%member('laid', self%laid, of_the_mesh, 'component, node, element', 'length')
    call visitor%derived('trial', 'every step begins it as the committed state')
  end subroutine visit_group_state

  !> They decide the order in which the matrix is eliminated: a run that goes on needs them, to the last bit.
  subroutine visit_pairs(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(pairs_t), intent(inout) :: self

    call visitor%member('piece', self%piece, of_the_mesh, 'point, element', low=0)
  end subroutine visit_pairs

end module visit_solution
