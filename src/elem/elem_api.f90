!> The ELEM family: what an element declares of itself and the interface by which the element loop calls it.
!>
!> Objects stop at the loop's door: an element gets plain arrays for a block of elements and answers
!> forces, matrices and the trial state. Local unknowns: x of all nodes, y of all nodes, then the
!> pilot of the die faced (x, y, angle) where the element has one, then the section (sections) in
!> generalised plane strain.
module elem_api
  use dies, only: die_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use materials, only: material_t
  use pairs, only: pairs_t
  use scene, only: generalised_plane_strain, group_t, scene_t
  use state_variables, only: state_variable_t
  implicit none
  private
  public :: elem_t, instant_t, report_t, totals_t, elem_compute_i, elem_variables_i, elem_measure_i, elem_augment_i
  public :: block_done, block_inverted, block_law_failed
  public :: add_totals, group_temperature, section_motion

  !> Answers of a block.
  integer, parameter :: block_done = 0
  integer, parameter :: block_inverted = 1     !! an element has turned inside out
  integer, parameter :: block_law_failed = 2   !! a law gave up

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
    !> Multipliers at the start and at the end of the step.
    real(wp), allocatable :: multipliers_before(:), multipliers(:)
    !> Matrices are wanted.
    logical :: tangent = .true.
  end type instant_t

  !> What a block has to say: its answer, the element at fault, the largest strain increment.
  type :: report_t
    integer :: status = block_done
    integer :: element = 0
    !> Filled in by the element loop.
    integer :: group = 0
    real(wp) :: strain = 0.0_wp
    !> Share of the step after which contact begins somewhere, with little overlap; 1 when it need not be shortened.
    real(wp) :: event = 1.0_wp
    !> A point meets a piece of a deformable die that it is not paired with: its contact is missing.
    logical :: unpaired = .false.
    !> Largest change of penetration at a point already in contact, over the side.
    real(wp) :: jump = 0.0_wp
  end type report_t

  !> Sums over a group at an accepted instant (per radian when axisymmetric), and extremes.
  type :: totals_t
    real(wp) :: volume = 0.0_wp
    !> What the volume would be without elastic strain.
    real(wp) :: unloaded_volume = 0.0_wp
    real(wp) :: elastic_energy = 0.0_wp
    real(wp) :: plastic_work = 0.0_wp
    real(wp) :: friction_work = 0.0_wp
    !> Least increment of dissipated work at any point since the instant before.
    real(wp) :: least_dissipation = 0.0_wp
    !> Largest penetration, and the largest over what its side allows.
    real(wp) :: max_penetration = 0.0_wp
    real(wp) :: penetration_ratio = 0.0_wp
    integer :: open = 0, stick = 0, slip = 0
  end type totals_t

  type :: elem_t
    character(len=:), allocatable :: name, purpose
    integer :: nnode = 0
    !> Uses a law of this kind (law_api), or none (0).
    integer :: law_kind = 0
    !> Has the pilot of a die among its unknowns.
    logical :: pilot = .false.
    !> Works on the present geometry even where kinematics are SMALL.
    logical :: follows = .false.
    !> Its matrix is symmetric when the law's is.
    logical :: symmetric = .true.
    !> Effect its time is booked under (page 6).
    character(len=:), allocatable :: effect
    procedure(elem_variables_i), nopass, pointer :: variables => null()
    procedure(elem_compute_i), nopass, pointer :: compute => null()
    !> Not associated for elements without state.
    procedure(elem_measure_i), nopass, pointer :: measure => null()
    !> Associated for elements with penalties that can be augmented (Uzawa).
    procedure(elem_augment_i), nopass, pointer :: augment => null()
  end type elem_t

  abstract interface
    !> State of a point of this element with this law in a plane state (scene).
    pure subroutine elem_variables_i(law, plane_state, variables)
      import :: law_t, state_variable_t
      type(law_t), intent(in) :: law
      integer, intent(in) :: plane_state
      type(state_variable_t), allocatable, intent(out) :: variables(:)
    end subroutine elem_variables_i

    !> Forces, matrices and trial state of elements first ... first + nb - 1 of a group.
    subroutine elem_compute_i(scene, group, kinematics, law, instant, first, x, du, committed, trial, force, stiffness, report)
      import :: group_t, instant_t, kinematics_t, law_t, report_t, scene_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      type(kinematics_t), intent(in) :: kinematics
      type(law_t), intent(in) :: law
      type(instant_t), intent(in) :: instant
      integer, intent(in) :: first
      real(wp), intent(in) :: x(:, :, :)              !! (2, nnode, nb) at the start of the step [length]
      real(wp), intent(in) :: du(:, :)                !! (ndof, nb) motion of the step
      real(wp), intent(in), contiguous :: committed(:, :, :)   !! (nstate, npoint, nb)
      real(wp), intent(inout), contiguous :: trial(:, :, :)
      real(wp), intent(out) :: force(:, :)            !! (ndof, nb) [force, per radian when axisymmetric]
      real(wp), intent(inout) :: stiffness(:, :, :)   !! (ndof, ndof, nb), written when instant%tangent
      type(report_t), intent(out) :: report
    end subroutine elem_compute_i

    !> After equilibrium: carry the reached pressures into the committed multipliers where penetrations
    !> are above the allowed, at most so many `times` in a step. `changed` asks for equilibrium again.
    subroutine elem_augment_i(scene, group, times, committed, trial, changed)
      import :: group_t, scene_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      integer, intent(in) :: times
      real(wp), intent(inout) :: committed(:, :, :)
      real(wp), intent(in) :: trial(:, :, :)
      logical, intent(out) :: changed
    end subroutine elem_augment_i

    !> Sums over a group at an accepted instant; x (2, nnode, nelem) and the section are the geometry then.
    subroutine elem_measure_i(scene, group, law, section, x, state, before, totals)
      import :: group_t, law_t, scene_t, totals_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      type(law_t), intent(in) :: law
      real(wp), intent(in) :: section(3), x(:, :, :)
      real(wp), intent(in) :: state(:, :, :), before(:, :, :)  !! at the accepted instant, and one step before
      type(totals_t), intent(out) :: totals
    end subroutine elem_measure_i
  end interface

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

  !> Motion of the section in the step: the last three local unknowns in generalised plane strain, none otherwise.
  pure function section_motion(scene, du) result(motion)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: du(:)   !! local unknowns of an element
    real(wp) :: motion(3)

    motion = 0
    if (scene%plane_state == generalised_plane_strain) motion = du(size(du) - 2:)
  end function section_motion

  !> Add what one group says to the totals of the scene.
  pure subroutine add_totals(sum, part)
    type(totals_t), intent(inout) :: sum
    type(totals_t), intent(in) :: part

    sum%volume = sum%volume + part%volume
    sum%unloaded_volume = sum%unloaded_volume + part%unloaded_volume
    sum%elastic_energy = sum%elastic_energy + part%elastic_energy
    sum%plastic_work = sum%plastic_work + part%plastic_work
    sum%friction_work = sum%friction_work + part%friction_work
    sum%least_dissipation = min(sum%least_dissipation, part%least_dissipation)
    sum%max_penetration = max(sum%max_penetration, part%max_penetration)
    sum%penetration_ratio = max(sum%penetration_ratio, part%penetration_ratio)
    sum%open = sum%open + part%open
    sum%stick = sum%stick + part%stick
    sum%slip = sum%slip + part%slip
  end subroutine add_totals

end module elem_api
