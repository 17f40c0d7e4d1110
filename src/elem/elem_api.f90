!> The ELEM family: what an element declares of itself and the interface by which the element loop calls it.
!>
!> The interface has plain arrays: an element gets those of a block of elements and returns forces, matrices and the trial state.
!> Beside its own it hands on what every element needs: its unknowns, the instant, the report.
module elem_api
  use element_instant, only: flow_rule_t, goes_on, group_temperature, instant_t, mode_advance, mode_error, mode_restore
  use element_report, only: add_totals, block_done, block_inverted, block_law_failed, block_without_source, report_t, totals_t
  use element_unknowns, only: applies, field_nodes, first_unknown, layout_t, most_components, of_displacement, of_pilot, &
                              of_section, section_motion, that_reads, unknown_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use scene, only: group_t, scene_t
  use state_variables, only: state_variable_t
  use text, only: string_t
  implicit none
  private
  public :: elem_t, has_option, no_variables
  public :: elem_compute_i, elem_variables_i, elem_measure_i, elem_augment_i
  public :: flow_rule_t, instant_t, goes_on, group_temperature, mode_advance, mode_error, mode_restore
  public :: add_totals, report_t, totals_t, block_done, block_inverted, block_law_failed, block_without_source
  public :: layout_t, unknown_t, applies, field_nodes, first_unknown, most_components, of_displacement, of_pilot, of_section
  public :: section_motion, that_reads

  !> A member of the family.
  type :: elem_t
    character(len=:), allocatable :: name, purpose
    integer :: nnode = 0
    !> What a group of it is (scene), and the kind of law it uses (law_api), 0 for none.
    integer :: role = 0, law_kind = 0
    !> Words that a card may end with, each an option.
    type(string_t), allocatable :: options(:)
    !> Its unknowns, in the order of its local ones.
    type(unknown_t), allocatable :: unknowns(:)
    !> Works on the present geometry even where kinematics are SMALL.
    logical :: follows = .false.
    !> Springs between a body and where it is on the first geometry.
    logical :: is_spring = .false.
    !> A load that goes with the square of its multiplier.
    logical :: squares_multiplier = .false.
    !> Its matrix is symmetric when the law's is; not with this option in large strain (-1: with any).
    logical :: symmetric = .true.
    integer :: unsymmetric_option = -1
    !> Effect to which its time is added (module effects).
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
      type(state_variable_t), allocatable, intent(out) :: variables(:)   !! (nvariable)
    end subroutine elem_variables_i

    !> Forces, matrices and trial state of elements first ... first + nb - 1 of a group.
    subroutine elem_compute_i(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                              force, stiffness, report)
      import :: group_t, instant_t, kinematics_t, law_t, layout_t, report_t, scene_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      type(kinematics_t), intent(in) :: kinematics
      type(law_t), intent(in) :: law
      type(instant_t), intent(in) :: instant
      type(layout_t), intent(in) :: layout
      integer, intent(in) :: first
      real(wp), intent(in) :: x(:, :, :)    !! (2, nnode, nb) at the start of the step [length]
      real(wp), intent(in) :: du(:, :)      !! (ndof, nb) motion of the step [unknown]
      real(wp), intent(in) :: start(:, :)   !! (ndof, nb) values at the start of the step; (0, nb) in mechanics alone [unknown]
      !> (ndriver, 2, npoint, nb) of the law at both ends of the step, the temperature first; no rows where the law asks for none
      !> [unit of each driver].
      real(wp), intent(in) :: drivers(:, :, :, :)
      real(wp), intent(in), contiguous :: committed(:, :, :)   !! (nstate, npoint, nb) [unit of each component]
      !> (nstate, npoint, nb) [unit of each component]; of an element of heat it may have as many rows again, for the derivatives of
      !> the state by the temperature of the point at the end of the step.
      real(wp), intent(inout), contiguous :: trial(:, :, :)
      real(wp), intent(out) :: force(:, :)                     !! (ndof, nb) per radian when axisymmetric [residual]
      real(wp), intent(inout) :: stiffness(:, :, :)            !! (ndof, ndof, nb), written when instant%tangent [residual/unknown]
      type(report_t), intent(out) :: report
    end subroutine elem_compute_i

    !> After equilibrium: carry the reached pressures into the committed multipliers where penetrations
    !> are above the allowed, at most so many `times` in a step. `changed`: equilibrium must be found again.
    subroutine elem_augment_i(scene, group, times, committed, trial, changed)
      import :: group_t, scene_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      integer, intent(in) :: times
      real(wp), intent(inout) :: committed(:, :, :)   !! (nstate, npoint, nelem) [unit of each component]
      real(wp), intent(in) :: trial(:, :, :)          !! (nstate, npoint, nelem) [unit of each component]
      logical, intent(out) :: changed
    end subroutine elem_augment_i

    !> Sums over a group at an accepted instant; x and the section are the geometry then.
    subroutine elem_measure_i(scene, group, law, section, penalty_share, x, state, before, totals)
      import :: group_t, law_t, scene_t, totals_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      type(law_t), intent(in) :: law
      real(wp), intent(in) :: section(3)        !! thickness at the origin [length], and its slopes [-]
      real(wp), intent(in) :: penalty_share     !! of penalties of contact that follow from an allowed penetration [-]
      real(wp), intent(in) :: x(:, :, :)        !! (2, nnode, nelem) [length]
      real(wp), intent(in) :: state(:, :, :)    !! (nstate, npoint, nelem) at the accepted instant [unit of each component]
      real(wp), intent(in) :: before(:, :, :)   !! (nstate, npoint, nelem) one step before [unit of each component]
      type(totals_t), intent(out) :: totals
    end subroutine elem_measure_i
  end interface

contains

  !> State of the points of elements that keep none.
  pure subroutine no_variables(law, plane_state, variables)
    type(law_t), intent(in) :: law
    integer, intent(in) :: plane_state
    type(state_variable_t), allocatable, intent(out) :: variables(:)   !! (0)

    allocate (variables(0))
  end subroutine no_variables

  !> A group has the option of this name.
  pure function has_option(elem, group, name) result(yes)
    type(elem_t), intent(in) :: elem       !! of the group
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: name   !! of the option
    logical :: yes

    yes = group%option > 0
    if (yes) yes = elem%options(group%option)%s == name
  end function has_option

end module elem_api
