!> Errors of phases and of hardness that come of those of temperatures in space, at the end of a run (space_phases).
module phases_in_space
  use hardness, only: has_hardness
  use kinds, only: wp
  use phase_state, only: at_hardness, state_names
  use point_volumes, only: volumes_of_points
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use steels, only: phase_count
  use text, only: to_text
  implicit none
  private
  public :: phase_errors_t, errors_of_phases, words_of_phases

  type :: phase_errors_t
    !> Phases err that were followed, from the last new mesh on where there was one; so was a hardness.
    logical :: followed = .false., since_mesh = .false., hard = .false.
    !> The phase that errs most in the mean square of the volume, largest error of its fraction and that mean [-].
    character(len=len(state_names)) :: phase = ''
    real(wp) :: largest = 0.0_wp, mean = 0.0_wp
    !> The same of the hardness [HV].
    real(wp) :: hardness = 0.0_wp, hardness_mean = 0.0_wp
  end type phase_errors_t

  !> A fraction that errs by no more than that is a sum of round-off.
  real(wp), parameter :: round_off = 1.0e-9_wp

contains

  !> What the state at the end errs.
  subroutine errors_of_phases(scene, solution, errors)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(phase_errors_t), intent(out) :: errors
    type(quad8_rule_t) :: rule
    real(wp) :: volumes(9), whole, of_hard, square(phase_count), largest(phase_count), hard_square
    integer :: rows(phase_count), at, g, e, i, n

    whole = 0
    of_hard = 0
    square = 0
    largest = 0
    hard_square = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), error => solution%groups(g)%space_error)
        if (size(error) == 0) cycle
        errors%followed = .true.
        n = group%rule%n
        call quad8_rule(n, rule)
        rows = [(row_of(group, i), i=1, phase_count)]
        at = 0
        if (has_hardness(scene%materials(group%material)%steel)) at = row_of(group, at_hardness)
        errors%hard = errors%hard .or. at > 0
        do e = 1, size(error, 3)
          volumes(:n) = volumes_of_points(scene, solution, rule, group%connectivity(:8, e))
          whole = whole + sum(volumes(:n))
          do i = 1, phase_count
            square(i) = square(i) + dot_product(volumes(:n), error(rows(i), :, e)**2)
            largest(i) = max(largest(i), maxval(abs(error(rows(i), :, e))))
          end do
          if (at == 0) cycle
          of_hard = of_hard + sum(volumes(:n))
          hard_square = hard_square + dot_product(volumes(:n), error(at, :, e)**2)
          errors%hardness = max(errors%hardness, maxval(abs(error(at, :, e))))
        end do
      end associate
    end do
    errors%followed = any(largest > round_off)
    if (.not. errors%followed) return
    errors%since_mesh = scene%generation > max(scene%operation, 1)
    i = maxloc(square, 1)
    errors%phase = state_names(i)
    errors%largest = largest(i)
    errors%mean = sqrt(square(i)/whole)
    if (errors%hard) errors%hardness_mean = sqrt(hard_square/of_hard)
  end subroutine errors_of_phases

  !> The errors in words.
  pure function words_of_phases(errors) result(words)
    type(phase_errors_t), intent(in) :: errors
    character(len=:), allocatable :: words

    words = ''
    if (errors%since_mesh) words = 'since the last mesh '
    words = words//trim(errors%phase)//' '//to_text(errors%largest, 2)//' at most (mean square '//to_text(errors%mean, 2)//')'
    if (errors%hard) words = words//', hardness '//to_text(errors%hardness, 2)//' HV ('//to_text(errors%hardness_mean, 2)//')'
  end function words_of_phases

  !> Row of a component of the state of a steel.
  pure integer function row_of(group, component)
    type(group_t), intent(in) :: group
    integer, intent(in) :: component   !! of phase_state

    row_of = group%variables(find_variable(group%variables, trim(state_names(component))))%first
  end function row_of

end module phases_in_space
