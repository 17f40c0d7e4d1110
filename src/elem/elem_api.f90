!> The ELEM family: what an element declares of itself and the interface by which the element loop calls it.
!>
!> The interface has plain arrays: an element gets those of a block of elements and returns
!> forces, matrices and the trial state. It declares its unknowns (unknown_t): which field, on which of
!> its nodes, pilot or section. Its local unknowns stand in the order of its declaration, each component
!> of a field contiguous: x of all nodes, y of all nodes, pilot (x, y, angle), section, ...; `layout_t`
!> says where each begins.
module elem_api
  use dies, only: die_t
  use fields, only: displacement_field, field_t, find_field, has_corners_only, mechanical_fields, on_nodes, pilot_field, &
                    section_field
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use pairs, only: pairs_t
  use scene, only: generalised_plane_strain, group_t, role_body, role_second, scene_t
  use state_variables, only: state_variable_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: elem_t, flow_rule_t, instant_t, layout_t, report_t, totals_t, unknown_t
  public :: elem_compute_i, elem_variables_i, elem_measure_i, elem_augment_i
  public :: block_done, block_inverted, block_law_failed, block_without_source
  public :: acts_on, add_totals, applies, body_acts_on, declare_fields, first_unknown, group_temperature, has_unknown, layout_of
  public :: field_nodes, goes_on, list_body_elems, no_variables, of_displacement, of_pilot, of_section, section_motion, that_reads
  public :: mode_advance, mode_error, mode_restore
  public :: most_components

  !> Answers of a block.
  integer, parameter :: block_done = 0
  integer, parameter :: block_inverted = 1     !! an element has turned inside out
  integer, parameter :: block_law_failed = 2   !! a law gave up
  integer, parameter :: block_without_source = 3   !! the ellipsoid of a torch is outside its bodies

  !> Mode of the elements: to advance by a step; to restore equilibrium on a new mesh at fixed time, without flow of
  !> material or heat; or to measure an error of the heat content, given as that of the temperatures it belongs to.
  integer, parameter :: mode_advance = 1, mode_restore = 2, mode_error = 3

  !> Most components of a field, and most fields among the unknowns of an element.
  integer, parameter :: most_components = 3, most_fields = 4

  !> A field among the unknowns of an element.
  type :: unknown_t
    type(field_t) :: field
    !> Option of the element with which alone it has it, -1 for any (0: without an option).
    integer :: option = -1
    !> Only where other elements of the scene have the field: what the element reads of other fields.
    logical :: optional = .false.
    !> Plane state in which alone the element has it, 0 for any.
    integer :: plane_state = 0
    !> The element acts on it (has forces, heat flows there); otherwise it only reads it.
    logical :: acts = .true.
  end type unknown_t

  !> Where the unknowns of an element stand among its local ones, in the order of the declaration.
  type :: layout_t
    integer :: ndof = 0, nfield = 0
    !> Place of each field in the scene's list.
    integer :: field(most_fields) = 0
    !> The element acts on the field.
    logical :: acts(most_fields) = .false.
    !> Local place of the first value of a component, and how many values a component has.
    integer :: first(most_components, most_fields) = 0, count(most_fields) = 0
  end type layout_t

  !> How a step is made of instants in the balance of heat: flows count with a weight each, at a share of the step.
  type :: flow_rule_t
    integer :: n = 1
    real(wp) :: weight(2) = [1.0_wp, 0.0_wp], share(2) = [1.0_wp, 0.0_wp]
    !> Multipliers at these instants (nmultiplier, n); and those of heat that a deck states (FLUX, HEATS), of which a step takes the
    !> mean, so that its heat is the stated one.
    real(wp), allocatable :: multipliers(:, :), stated(:, :)
    !> The instants (n), and the factors of the sources of torches there (nsource, n); not allocated where there is none.
    real(wp), allocatable :: times(:), source_factors(:, :)
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

  !> Report of a block: its status, the element that failed, the largest strain increment.
  type :: report_t
    integer :: status = block_done
    integer :: element = 0
    !> Filled in by the element loop.
    integer :: group = 0
    real(wp) :: strain = 0.0_wp
    !> Share of the step after which contact begins somewhere, with little overlap; 1 when it need not be shortened.
    real(wp) :: event = 1.0_wp
    !> Share of the step after which a side begins to go through a die unseen; 1 when none does.
    real(wp) :: passed = 1.0_wp
    !> A point meets a piece of a deformable die that it is not paired with: its contact is missing.
    logical :: unpaired = .false.
    !> Largest change of penetration at a point already in contact, over the side.
    real(wp) :: jump = 0.0_wp
    !> A side is in contact between its points.
    logical :: between = .false.
    !> Square of the norm of the sources within the elements, which the other terms of the elements balance [power^2].
    real(wp) :: source = 0.0_wp
    !> Heat that the elements took up in the step, and that sources released in them [energy].
    real(wp) :: heat_stored = 0.0_wp, heat_released = 0.0_wp
    !> In mode_error: integrals of the squares of the error of the heat content, over the least capacity, and of the temperature,
    !> and the volume [temperature^2 volume], [volume].
    real(wp) :: error_square = 0.0_wp, temperature_square = 0.0_wp, error_volume = 0.0_wp
  end type report_t

  !> Sums over a group at an accepted instant (per radian when axisymmetric), and extremes.
  type :: totals_t
    real(wp) :: volume = 0.0_wp
    !> What the volume would be without elastic strain.
    real(wp) :: unloaded_volume = 0.0_wp
    real(wp) :: elastic_energy = 0.0_wp
    !> What points carry of plastic work, over their volumes of now: of one instant, to compare the state of two meshes.
    real(wp) :: plastic_work = 0.0_wp
    real(wp) :: friction_work = 0.0_wp
    !> Since the instant before: what flow dissipated, what penalties and multipliers of contact took, and the sum over the points
    !> of the sizes of changes of elastic energy.
    real(wp) :: dissipated = 0.0_wp, contact_work = 0.0_wp, passed = 0.0_wp
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
      real(wp), intent(inout), contiguous :: trial(:, :, :)    !! (nstate, npoint, nb) [unit of each component]
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
    subroutine elem_measure_i(scene, group, law, section, x, state, before, totals)
      import :: group_t, law_t, scene_t, totals_t, wp
      type(scene_t), intent(in) :: scene
      type(group_t), intent(in) :: group
      type(law_t), intent(in) :: law
      real(wp), intent(in) :: section(3)        !! thickness at the origin [length], and its slopes [-]
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

  !> Motion of the section in the step, 0 where it is no unknown.
  pure function section_motion(layout, du) result(motion)
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the local unknowns of an element [unknown]
    real(wp) :: motion(3)
    integer :: first

    motion = 0
    first = first_unknown(layout, section_field)
    if (first > 0) motion = du(first:first + 2)
  end function section_motion

  !> Displacements of all nodes of an element.
  pure function of_displacement() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(displacement_field)
  end function of_displacement

  !> The pilot of the die that an element faces.
  pure function of_pilot() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(pilot_field)
  end function of_pilot

  !> The section, an unknown in generalised plane strain.
  pure function of_section() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(section_field)
    unknown%plane_state = generalised_plane_strain
  end function of_section

  !> A field that the element only reads, where the scene has it.
  pure function that_reads(name) result(unknown)
    character(len=*), intent(in) :: name   !! of the field
    type(unknown_t) :: unknown

    unknown%field%name = name
    unknown%optional = .true.
    unknown%acts = .false.
  end function that_reads

  pure function of_mechanics(k) result(unknown)
    integer, intent(in) :: k   !! place in the list of the fields of mechanics
    type(unknown_t) :: unknown
    type(field_t) :: list(3)

    list = mechanical_fields()
    unknown%field = list(k)
  end function of_mechanics

  !> An element acts on a field.
  pure function acts_on(elem, name) result(yes)
    type(elem_t), intent(in) :: elem
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(elem%unknowns)
      if (elem%unknowns(k)%acts) yes = yes .or. elem%unknowns(k)%field%name == name
    end do
  end function acts_on

  !> A group is a formulation on a body, and acts on a field.
  pure function body_acts_on(elems, group, name) result(yes)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes

    yes = any(group%role == [role_body, role_second])
    if (yes) yes = acts_on(elems(group%elem_id), name)
  end function body_acts_on

  !> Names of the elements that bodies are made of: all, or those that act on a field.
  pure subroutine list_body_elems(elems, names, field)
    type(elem_t), intent(in) :: elems(:)                   !! (nelem_row)
    type(string_t), allocatable, intent(out) :: names(:)   !! (n)
    character(len=*), intent(in), optional :: field        !! its name
    integer :: k

    allocate (names(0))
    do k = 1, size(elems)
      if (elems(k)%role /= role_body) cycle
      if (present(field)) then
        if (.not. acts_on(elems(k), field)) cycle
      end if
      call add_text(names, elems(k)%name)
    end do
  end subroutine list_body_elems

  !> An element has a field of the scene's list among its unknowns.
  pure function has_unknown(elem, name) result(yes)
    type(elem_t), intent(in) :: elem
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(elem%unknowns)
      yes = yes .or. elem%unknowns(k)%field%name == name
    end do
  end function has_unknown

  !> The element has this unknown in a plane state with an option.
  elemental function applies(unknown, plane_state, option) result(yes)
    type(unknown_t), intent(in) :: unknown
    integer, intent(in) :: plane_state, option
    logical :: yes

    yes = (unknown%plane_state == 0 .or. unknown%plane_state == plane_state) &
          .and. (unknown%option < 0 .or. unknown%option == option)
  end function applies

  !> Positions of the unknowns of an element of so many nodes.
  pure function layout_of(elem, nnode, option, plane_state, fields) result(layout)
    type(elem_t), intent(in) :: elem
    integer, intent(in) :: nnode    !! of the element, with those it is paired with
    integer, intent(in) :: option   !! of the group
    integer, intent(in) :: plane_state
    type(field_t), intent(in) :: fields(:)   !! (nfield) of the scene
    type(layout_t) :: layout
    integer :: u, c, n, f

    do u = 1, size(elem%unknowns)
      associate (unknown => elem%unknowns(u))
        if (.not. applies(unknown, plane_state, option)) cycle
        f = find_field(fields, unknown%field%name)
        if (unknown%optional) then
          if (f == 0) cycle
          if (.not. fields(f)%declared) cycle
        end if
        n = layout%nfield + 1
        layout%nfield = n
        layout%field(n) = f
        layout%acts(n) = unknown%acts
        layout%count(n) = 1
        if (fields(f)%place == on_nodes) layout%count(n) = size(field_nodes(fields(f), nnode))
        do c = 1, fields(f)%ncomp
          layout%first(c, n) = layout%ndof + 1
          layout%ndof = layout%ndof + layout%count(n)
        end do
      end associate
    end do
  end function layout_of

  !> Nodes of an element where a field has values of its own: all, or the corners of a quadrilateral and the ends of sides.
  pure function field_nodes(field, nnode) result(nodes)
    type(field_t), intent(in) :: field   !! on nodes
    integer, intent(in) :: nnode
    integer, allocatable :: nodes(:)
    integer :: k

    if (has_corners_only(field) .and. nnode == 8) then
      nodes = [1, 2, 3, 4]
    else if (has_corners_only(field) .and. mod(nnode, 3) == 0) then
      ! a side, and those that it is paired with
      nodes = [(3*(k/2) + merge(1, 0, mod(k, 2) == 1), k=1, 2*(nnode/3))]
    else
      nodes = [(k, k=1, nnode)]
    end if
  end function field_nodes

  !> Local place of the first unknown of a field, 0 where the element has none.
  pure function first_unknown(layout, field) result(first)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: field   !! position in the scene's list
    integer :: first
    integer :: k

    first = 0
    do k = 1, layout%nfield
      if (layout%field(k) == field) first = layout%first(1, k)
    end do
  end function first_unknown

  !> The fields that the elements of the groups of a scene have among their unknowns: those of mechanics first, declared where
  !> some element has them, then others in the order of the groups.
  pure subroutine declare_fields(elems, scene)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(scene_t), intent(inout) :: scene
    integer :: g, u, k

    if (.not. allocated(scene%fields)) scene%fields = mechanical_fields()
    scene%fields%declared = .false.
    do g = 1, size(scene%groups)
      associate (elem => elems(scene%groups(g)%elem_id))
        do u = 1, size(elem%unknowns)
          associate (unknown => elem%unknowns(u))
            if (unknown%optional .or. .not. applies(unknown, scene%plane_state, scene%groups(g)%option)) cycle
            k = find_field(scene%fields, unknown%field%name)
            if (k == 0) then
              scene%fields = [scene%fields, unknown%field]
              k = size(scene%fields)
            end if
            scene%fields(k)%declared = .true.
          end associate
        end do
      end associate
    end do
    if (.not. allocated(scene%histories)) return
    do k = 1, size(scene%histories)
      scene%fields(scene%histories(k)%field)%declared = .true.
    end do
  end subroutine declare_fields

  !> Add the measures of one group to the totals of the scene.
  pure subroutine add_totals(sum, part)
    type(totals_t), intent(inout) :: sum
    type(totals_t), intent(in) :: part

    sum%volume = sum%volume + part%volume
    sum%unloaded_volume = sum%unloaded_volume + part%unloaded_volume
    sum%elastic_energy = sum%elastic_energy + part%elastic_energy
    sum%plastic_work = sum%plastic_work + part%plastic_work
    sum%friction_work = sum%friction_work + part%friction_work
    sum%dissipated = sum%dissipated + part%dissipated
    sum%contact_work = sum%contact_work + part%contact_work
    sum%passed = sum%passed + part%passed
    sum%least_dissipation = min(sum%least_dissipation, part%least_dissipation)
    sum%max_penetration = max(sum%max_penetration, part%max_penetration)
    sum%penetration_ratio = max(sum%penetration_ratio, part%penetration_ratio)
    sum%open = sum%open + part%open
    sum%stick = sum%stick + part%stick
    sum%slip = sum%slip + part%slip
  end subroutine add_totals

  !> Contact with a die is not with one that turns back.
  pure function goes_on(instant, die)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: die   !! number of the die
    logical :: goes_on

    goes_on = .true.
    if (allocated(instant%turning)) goes_on = .not. instant%turning(die)
  end function goes_on

end module elem_api
