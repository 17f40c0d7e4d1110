!> Steels of a CCT diagram (card CCT) that are held, or cool more slowly than its slowest history: a diagram of coolings says
!> nothing of time at one temperature, and nothing forms then.
!>
!> Reported is what the histories would have formed in the time: the largest growth per second at that temperature of those that
!> form more in the end than would be there. By Scheil's rule of additivity this is the growth in a hold, where the growth of the
!> history depends on the temperature and the fractions alone (E. Scheil, Arch. Eisenhuettenwes. 8 (1935) 565).
module held_steels
  use cct_histories, only: cct_increments
  use dual_numbers, only: dual_t
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use martensite_kinetics, only: martensite_start
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use steels, only: austenite, bainite, ferrite, kinetics_none, phase_count, steel_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: note_held_steels, warn_of_held_steels

  !> Less than this share is reported by nobody: a diagram is no better known.
  real(wp), parameter :: expected_share = 0.05_wp
  integer, parameter :: ncorner = 4
  !> Temperatures over which the growth of a history is measured [K].
  real(wp), parameter :: width = 1.0_wp

contains

  !> To what is missing so far comes the largest share of an element that the step just accepted should have formed and has not; no
  !> more is missing than what the histories form more in the end than there is by now, as what forms late in a slow cooling is
  !> there after all. Elements count by the means of their corners and of their points.
  pure subroutine note_held_steels(scene, laws, solution)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(inout) :: solution
    real(wp) :: zero, seconds, most, lacking, state(phase_count + 1)
    integer :: g, e, f

    f = find_field(scene%fields, 'temperature')
    if (f == 0) return
    if (.not. scene%fields(f)%declared) return
    most = 0
    lacking = 0
    do g = 1, size(scene%groups)
      if (.not. of_histories_alone(scene, g)) cycle
      associate (group => scene%groups(g), material => scene%materials(scene%groups(g)%material), &
                 temperature => solution%fields(f)%value(1, :), change => solution%fields(f)%last_increment(1, :))
        zero = material%values(find_parameter(laws(material%law_id), 'ZERO'))
        seconds = solution%last_step*material%values(find_parameter(laws(material%law_id), 'TIME'))
        do e = 1, size(group%connectivity, 2)
          associate (corners => group%connectivity(:ncorner, e), points => solution%groups(g)%committed(:, :, e))
            state = state_of(group, points)
            most = max(most, missing_in(material%steel, seconds, sum(temperature(corners))/ncorner + zero, &
                                        sum(change(corners))/ncorner, solution%held_growth, state))
            lacking = max(lacking, most_of_histories(material%steel) - sum(state(ferrite:bainite)))
          end associate
        end do
      end associate
    end do
    solution%held_growth = min(solution%held_growth + most, lacking)
  end subroutine note_held_steels

  !> A group with phases of a steel whose diffusive phases form by the histories of a CCT diagram, and by nothing else.
  pure function of_histories_alone(scene, g) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    logical :: yes

    associate (group => scene%groups(g))
      yes = group%material > 0
      if (yes) yes = allocated(scene%materials(group%material)%steel)
      if (yes) yes = find_variable(group%variables, 'austenite') > 0
      if (.not. yes) return
      associate (steel => scene%materials(group%material)%steel)
        yes = steel%cct%n > 0 .and. all(steel%kinetics%kind == kinetics_none)
      end associate
    end associate
  end function of_histories_alone

  !> What the history that forms the most has formed in the end.
  pure function most_of_histories(steel) result(most)
    type(steel_t), intent(in) :: steel
    real(wp) :: most   !! [-]
    integer :: k

    most = 0
    do k = 1, steel%cct%n
      most = max(most, sum(steel%cct%z(:, steel%cct%first(k + 1) - 1)))
    end do
  end function most_of_histories

  !> Fractions of the phases and the size of grains of an element, means of its points.
  pure function state_of(group, points) result(state)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: points(:, :)      !! (component, point)
    real(wp) :: state(phase_count + 1)        !! [-], last [um]
    integer :: first, grain

    first = group%variables(find_variable(group%variables, 'austenite'))%first
    grain = group%variables(find_variable(group%variables, 'grain_size'))%first
    state(:phase_count) = sum(points(first:first + phase_count - 1, :), dim=2)/size(points, 2)
    state(phase_count + 1) = sum(points(grain, :))/size(points, 2)
  end function state_of

  !> What the histories would have formed above Ms in the part of a step that was too slow for the slowest of them.
  pure function missing_in(steel, seconds, temperature, change, before, state) result(missing)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: seconds       !! length of the step [s]
    real(wp), intent(in) :: temperature   !! at its end [degC]
    real(wp), intent(in) :: change        !! of the temperature in the step [K]
    real(wp), intent(in) :: before        !! what is missing so far [-]
    real(wp), intent(in) :: state(:)      !! (phase_count + 1)
    real(wp) :: missing                   !! [-]
    type(dual_t) :: ms, formed(3), z(3)
    real(wp) :: rates(steel%cct%n), idle, left
    integer :: k

    missing = 0
    associate (cct => steel%cct, grain => state(phase_count + 1))
      rates = cct%rate*exp(-cct%grain_factor*(grain - cct%grain_reference))
      idle = seconds - max(0.0_wp, -change)/rates(1)
      ms = martensite_start(steel, dual_t(sum(state(ferrite:bainite))))
      if (.not. (idle > 0 .and. state(austenite) > 0 .and. temperature > ms%value)) return
      z%value = state(ferrite:bainite)
      do k = 1, cct%n
        left = sum(cct%z(:, cct%first(k + 1) - 1)) - sum(z%value) - before
        if (.not. left > 0) cycle
        call cct_increments(cct, dual_t(width/rates(k)), dual_t(temperature + 0.5_wp*width), dual_t(temperature - 0.5_wp*width), &
                            dual_t(grain), z, formed)
        missing = max(missing, min(sum(formed%value)*rates(k)/width*idle, left, state(austenite)))
      end do
    end associate
  end function missing_in

  !> A line for all of them, added to the warnings of a run at its end.
  subroutine warn_of_held_steels(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    integer :: g

    if (.not. solution%held_growth > expected_share) return
    do g = 1, size(scene%groups)
      if (.not. of_histories_alone(scene, g)) cycle
      associate (steel => scene%materials(scene%groups(g)%material)%steel)
        call add_text(warnings, scene%groups(g)%name//': it was held, or cooled more slowly than the slowest history of the ' &
                      //'CCT diagram of the steel '//steel%name//' ('//to_text(steel%cct%rate(1), 3)//' K/s): by such a diagram ' &
                      //'nothing forms at one temperature, and up to '//to_text(100*solution%held_growth, 2)//' % that its ' &
                      //'histories form in the time have not: holds need TTT, AVRAMI or LI')
      end associate
      return
    end do
  end subroutine warn_of_held_steels

end module held_steels
