!> The instant at which elements are computed, and what is asked of them there.
module element_instant
  use dies, only: die_t
  use kinds, only: wp
  use pairs, only: pairs_t
  use scene, only: group_t
  implicit none
  private
  public :: flow_rule_t, instant_t, goes_on, group_temperature
  public :: mode_advance, mode_error, mode_restore

  !> Mode of the elements: to advance by a step; to restore equilibrium on a new mesh at fixed time, without flow of
  !> material or heat; or to measure an error of the heat content, given as that of the temperatures it belongs to.
  integer, parameter :: mode_advance = 1, mode_restore = 2, mode_error = 3

  !> How a step is made of instants in the balance of heat: flows count with a weight each, at a share of the step.
  type :: flow_rule_t
    integer :: n = 1
    real(wp) :: weight(2) = [1.0_wp, 0.0_wp], share(2) = [1.0_wp, 0.0_wp]
    !> Multipliers at these instants (nmultiplier, n); and those of heat that a deck states (FLUX, HEATS), of which a step takes the
    !> mean, so that its heat is the stated one.
    real(wp), allocatable :: multipliers(:, :), stated(:, :)
    !> The instants (n), the factors of the sources of torches there (nsource, n), and where nodes (2, nnode, n) [length] and the
    !> section (3, n) are then; not allocated where there is none.
    real(wp), allocatable :: times(:), source_factors(:, :), places(:, :, :), sections(:, :)
  end type flow_rule_t

  !> The instant at which a block is computed.
  type :: instant_t
    !> End of the step and its length [time].
    real(wp) :: time = 0.0_wp, dt = 0.0_wp
    !> Pilots at the start of the step (x, y, angle; ndie).
    real(wp), allocatable :: pilots(:, :)
    !> Dies at the end of the step where they are deformable, and pairs; not allocated where none is.
    type(die_t), allocatable :: dies(:)
    type(pairs_t), allocatable :: pairs(:)
    !> Section at the start of the step (sections).
    real(wp) :: section(3) = 0.0_wp
    !> Newton's iteration: the motion is a prediction; or a correction brought it about, which began at these displacements in the
    !> step (2, nnode) and this motion of the section. Otherwise it has converged, or nothing is known of it.
    logical :: predicted = .false.
    !> Points in contact at the start of the step are kept there: their law is linearised at the depth they had then.
    logical :: kept = .false.
    !> But not with these dies, which turn back (ndie): what touches them goes back anyway, and its jump does not count.
    logical, allocatable :: turning(:)
    real(wp), allocatable :: corrected_from(:, :)
    real(wp) :: section_from(3) = 0.0_wp
    !> Share of the penalties that follow from an allowed penetration (soft_penalties) [-].
    real(wp) :: lasting_share = 1.0_wp
    !> Share of the penalties with which points that had no pressure at the start of the step press (soft_contact) [-].
    real(wp) :: penalty_share = 1.0_wp
    !> Sides press on dies at their points alone, not between them (contact_between).
    logical :: points_alone = .false.
    !> Values of all unknowns at the start of the step (ndof); not allocated where mechanics is all there is.
    real(wp), allocatable :: values(:)
    !> Multipliers at the start and at the end of the step.
    real(wp), allocatable :: multipliers_before(:), multipliers(:)
    !> Instants at which heat flows.
    type(flow_rule_t) :: flow
    !> Heat taken up and released counts; otherwise flows alone.
    logical :: content = .true.
    !> The length over the time since the start of the step: less than 1 in the stages of a step, where the length divides changes
    !> of the heat content alone.
    real(wp) :: share = 1.0_wp
    !> Share of the step after which the instant is, where the drivers that other formulations give have only come so far.
    real(wp) :: reach = 1.0_wp
    !> Heat flows from warmer to colder nodes alone (PL8TM).
    logical :: monotone = .false.
    !> Matrices are wanted.
    logical :: tangent = .true.
    integer :: mode = mode_advance
    !> Fields solved for now (nfield): derivatives along others are not needed.
    logical, allocatable :: solved(:)
  end type instant_t

contains

  !> Temperature of a body at the start and at the end of the step; 0 where the scene knows none.
  pure function group_temperature(group, instant) result(temperature)
    type(group_t), intent(in) :: group
    type(instant_t), intent(in) :: instant
    real(wp) :: temperature(2)

    temperature = 0
    if (group%temperature_multiplier == 0) return
    temperature = group%temperature_amplitude*[instant%multipliers_before(group%temperature_multiplier), &
                                               instant%multipliers(group%temperature_multiplier)]
  end function group_temperature

  !> Contact with a die is not with one that turns back.
  pure function goes_on(instant, die)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: die   !! number of the die
    logical :: goes_on

    goes_on = .true.
    if (allocated(instant%turning)) goes_on = .not. instant%turning(die)
  end function goes_on

end module element_instant
