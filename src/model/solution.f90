!> The state of a run at an accepted instant, and the trial state of the present step.
module solution
  use acceptance, only: probation_t
  use cuts, only: cut_record_t
  use fields, only: displacement_field, field_t, find_field, has_corners_only, on_nodes, on_pilots, pilot_field, section_field, &
                    start_field
  use confinement_record, only: confinement_record_t
  use heat_record, only: heat_record_t
  use kinds, only: wp
  use pace_record, only: pace_t
  use loads, only: multiplier_at, start_t
  use crossing_record, only: crossing_record_t
  use narrow_record, only: narrow_record_t
  use pairs, only: pairs_t, start_pairs
  use path_record, only: path_record_t, start_path
  use remesher_options, only: number_of_cuts
  use remeshing, only: estimate_t
  use run_warnings, only: warning_t
  use scene, only: group_t, is_solid, role_body, role_second, scene_t, solid_elements
  use shape_record, only: shape_record_t
  use state_variables, only: find_variable, total_components
  use work_books, only: work_t
  implicit none
  private
  public :: solution_t, group_state_t, start_fields, start_solution, present_coordinates

  !> State of the points of a group (component, point, element).
  type :: group_state_t
    real(wp), allocatable :: committed(:, :, :)
    real(wp), allocatable :: trial(:, :, :)
    !> Error of the committed state that comes of the path within steps, or of phases that come of that of the temperatures; of no
    !> elements where it is not estimated.
    real(wp), allocatable :: error(:, :, :)
    !> States of points with phases that temperatures without their error in space would make, less the committed ones
    !> (space_phases); of no elements where they are not followed.
    real(wp), allocatable :: space_error(:, :, :)
    !> Displacements of its nodes when it came, of a body that was laid down (ASLEEP) where strains are small (2, node, element);
    !> not allocated, or of no elements, where it was there from the start [length].
    real(wp), allocatable :: laid(:, :, :)
    !> Largest difference so far of the strain of temperature and phases across each element, of steels whose mechanics follow them
    !> (strain_spans); of no elements in others [-].
    real(wp), allocatable :: span(:)
  end type group_state_t

  type :: solution_t
    !> Time reached and number of accepted steps.
    real(wp) :: time = 0.0_wp
    integer :: step = 0
    !> Length of the last accepted step, of the one before it (0: none since the mesh began), and of the one proposed next [time].
    real(wp) :: last_step = 0.0_wp, older_step = 0.0_wp, next_step = 0.0_wp
    !> Unknowns: displacement of the nodes since the mesh began, pilots of the dies, section (sections), and what else the
    !> elements of the scene declare (as `scene%fields`).
    type(field_t), allocatable :: fields(:)
    type(group_state_t), allocatable :: groups(:)
    !> Pairs the equations are set up for, of the groups that face deformable dies.
    type(pairs_t), allocatable :: pairs(:)
    !> The state comes from another mesh (or from none): equilibrium has yet to be found.
    logical :: unbalanced = .false.
    !> Of a checkpoint: written as a signal stopped the run, where no save was due.
    logical :: between_saves = .false.
    !> Lengths of late steps, and of those of a mesh that is new.
    type(probation_t) :: probation
    !> The last step of a body through itself.
    type(crossing_record_t) :: crossing
    !> What short steps take.
    type(pace_t) :: pace
    !> Share of the penalties that follow from an allowed penetration with which contact presses: less than 1 where it bears little
    !> and could not be found with the whole, more where an elastic body bears much (soft_penalties) [-].
    real(wp) :: penalty_share = 1.0_wp
    !> Viscous force over velocity and volume in the step to come, 0 where it is not damped (damping) [force time/length^4].
    real(wp) :: damping = 0.0_wp
    !> Work of damping up to which it may be a release of elastic energy [energy, per radian when axisymmetric].
    real(wp) :: damping_bound = 0.0_wp
    !> Totals since the start.
    integer :: iterations = 0, cutbacks = 0
    !> Work done on the scene from outside, per radian when axisymmetric.
    real(wp) :: external_work = 0.0_wp
    !> Its parts, and where it went.
    type(work_t) :: work
    !> Work of friction since the start, and the part of it that is not in the state of a point of the present mesh; per radian when
    !> axisymmetric.
    real(wp) :: friction_work = 0.0_wp, friction_apart = 0.0_wp
    !> Heat since the start: taken up, come in through sides and imposed temperatures, released by sources; and what passed, the
    !> sum of the sizes of the last two by step. Per radian when axisymmetric.
    real(wp) :: heat_stored = 0.0_wp, heat_in = 0.0_wp, heat_released = 0.0_wp, heat_passed = 0.0_wp
    type(heat_record_t) :: heat
    !> Heat flows into the bodies in the last step, through each boundary and from each source (heat_flows) [power, per radian when
    !> axisymmetric].
    real(wp), allocatable :: heat_flows(:)
    !> Errors of the path within the steps.
    type(path_record_t) :: path
    !> Volume at the start, for the drift; 0 before it is measured.
    real(wp) :: initial_volume = 0.0_wp
    !> The group in whose rigid die the part began deepest as a later operation began, where that was not meant; 0 for none. How
    !> deep [length], 0 in the die's body altogether; and over the length of the side.
    integer :: sunk_group = 0
    real(wp) :: sunk_depth = 0.0_wp, sunk_share = 0.0_wp
    !> Worst values of all accepted steps so far.
    real(wp) :: worst_linear_residual = 0.0_wp, worst_penetration = 0.0_wp, worst_penetration_ratio = 0.0_wp
    real(wp) :: least_dissipation = 0.0_wp
    !> Largest share of the spurious mode in the motion of an element (spurious_mode), and the element.
    real(wp) :: worst_spurious = 0.0_wp
    integer :: spurious_group = 0, spurious_element = 0
    !> The last equilibrium is not stable, and no stable one was found (step_equilibrium): so it goes on.
    logical :: stays_unstable = .false.
    !> Steps whose equilibrium is not stable (stability), and the end of the first of them [time].
    integer :: unstable_steps = 0
    real(wp) :: unstable_from = 0.0_wp
    !> Steps of the operation in which heat and contact do not agree, and the largest share of the heat that is another then
    !> (unsettled_contact).
    integer :: unsettled_steps = 0
    real(wp) :: unsettled_share = 0.0_wp
    !> By how much fractions of phases have left [0, 1], or their sum 1.
    real(wp) :: worst_fraction = 0.0_wp
    !> Largest share of an element that should have become austenite on heating, of a steel without its kinetics (heated_steels).
    real(wp) :: missing_austenite = 0.0_wp
    !> Share that a steel of a CCT diagram alone should have formed in holds, by its histories (held_steels).
    real(wp) :: held_growth = 0.0_wp
    !> Parts without room to flow.
    type(confinement_record_t) :: confinement
    !> Dies that few sides of elements have borne.
    type(narrow_record_t) :: narrow
    !> Error of the shape that fronts of temperature and phases leave.
    type(shape_record_t) :: shape
    !> Largest depth of a side in a die anywhere along it, and over what the side allows.
    real(wp) :: worst_sample = 0.0_wp, worst_sample_ratio = 0.0_wp
    !> Largest force on a die so far where meshes are replaced, or on one made of sides; per radian when axisymmetric.
    real(wp) :: largest_force = 0.0_wp
    !> Errors of the mesh; of no elements where they are not needed.
    type(estimate_t) :: estimate
    !> What came of the cuts of the scene (ncut).
    type(cut_record_t), allocatable :: cuts(:)
    !> Warnings of earlier operations, and of new meshes (nwarning).
    type(warning_t), allocatable :: warnings(:)
  end type solution_t

contains

  !> Everything at rest: no displacement, pilots at their start, states at their declared values.
  pure subroutine start_solution(scene, solution, time)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(out) :: solution
    real(wp), intent(in), optional :: time   !! at which the scene begins, 0 where it is not given [time]
    integer :: f, g, v, c, n, npoint, nsolid, nheated, nwarm, nfiner

    if (present(time)) solution%time = time
    call start_fields(scene, solution%time, solution%fields)
    solution%next_step = scene%strategy%first_step
    call start_pairs(scene, solution%pairs)
    call start_path(scene, solution%path)
    f = find_field(scene%fields, 'temperature')
    nheated = 0
    if (f > 0) nheated = merge(size(scene%mesh%coordinates, 2), 0, scene%fields(f)%declared)
    f = find_field(scene%fields, 'die_temperature')
    nwarm = 0
    if (f > 0) nwarm = merge(size(scene%dies), 0, scene%fields(f)%declared)
    allocate (solution%heat%content_error(nheated), solution%heat%temperature_error(nheated), solution%heat%die_error(nwarm), &
              source=0.0_wp)
    f = find_field(scene%fields, 'temperature')
    nfiner = 0
    if (f > 0) then
      if (scene%fields(f)%declared .and. has_corners_only(scene%fields(f)) .and. .not. scene%fields(f)%given) then
        nfiner = nheated + solid_elements(scene)
      end if
    end if
    allocate (solution%heat%finer(nfiner), solution%heat%finer_content(nfiner), source=0.0_wp)
    allocate (solution%groups(size(scene%groups)))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g))
        npoint = group%rule%n
        allocate (state%committed(total_components(group%variables), npoint, size(group%connectivity, 2)), source=0.0_wp)
        do v = 1, size(group%variables)
          do c = group%variables(v)%first, group%variables(v)%first + group%variables(v)%ncomp - 1
            state%committed(c, :, :) = group%variables(v)%initial
          end do
        end do
        state%trial = state%committed
        n = 0
        if (any(group%role == [role_body, role_second]) .and. (scene%follows_path .or. has_phases(scene, group))) &
          n = size(group%connectivity, 2)
        allocate (state%error(size(state%committed, 1), npoint, n), source=0.0_wp)
        n = 0
        if (nfiner > 0 .and. has_phases(scene, group) .and. find_variable(group%variables, 'stress') == 0) &
          n = size(group%connectivity, 2)
        allocate (state%space_error(size(state%committed, 1), npoint, n), source=0.0_wp)
        n = 0
        if (find_variable(group%variables, 'transformation_plasticity') > 0) n = size(group%connectivity, 2)
        allocate (state%span(n), source=0.0_wp)
      end associate
    end do
    nsolid = 0
    do g = 1, size(scene%groups)
      if (scene%remesh%estimate .and. is_solid(scene%groups(g))) nsolid = nsolid + size(scene%groups(g)%connectivity, 2)
    end do
    allocate (solution%estimate%stress_of(nsolid), solution%estimate%strain_of(nsolid), &
              solution%estimate%strain_sums(2, nsolid), source=0.0_wp)
    allocate (solution%estimate%triggers(0))
    allocate (solution%cuts(number_of_cuts(scene%remesher)))
    allocate (solution%warnings(0))
  end subroutine start_solution

  !> A formulation in which phases form at temperatures that are solved for.
  pure function has_phases(scene, group) result(yes)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    logical :: yes
    integer :: f

    f = find_field(scene%fields, 'temperature')
    yes = f > 0 .and. find_variable(group%variables, 'austenite') > 0
    if (yes) yes = scene%fields(f)%declared
  end function has_phases

  !> All fields at rest: zero, the pilots and the section where the scene has them. A field on nodes that no element declares has
  !> no values; pilots and section have theirs in any case, since they place the dies and give the third direction.
  pure subroutine start_fields(scene, time, fields)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time   !! [time]
    type(field_t), allocatable, intent(out) :: fields(:)
    integer :: k, d

    allocate (fields, source=scene%fields)
    do k = 1, size(fields)
      select case (fields(k)%place)
      case (on_nodes)
        call start_field(merge(size(scene%mesh%coordinates, 2), 0, fields(k)%declared), fields(k))
      case (on_pilots)
        call start_field(size(scene%dies), fields(k))
      case default
        call start_field(1, fields(k))
      end select
    end do
    if (allocated(scene%starts)) then
      do k = 1, size(scene%starts)
        call start_on_body(scene, scene%starts(k), fields)
      end do
    end if
    do k = 1, size(scene%dies)
      fields(pilot_field)%value(:, k) = scene%dies(k)%pilot
    end do
    fields(section_field)%value(:, 1) = scene%section
    k = find_field(fields, 'die_temperature')
    if (k == 0 .or. .not. allocated(scene%die_heats)) return
    do d = 1, size(scene%die_heats)
      associate (heat => scene%die_heats(d))
        fields(k)%value(1, heat%die) = heat%temperature
        if (heat%multiplier > 0) fields(k)%value(1, heat%die) = heat%temperature*multiplier_at(scene%multipliers(heat%multiplier), &
                                                                                              time)
      end associate
    end do
  end subroutine start_fields

  !> The values of a field on the nodes of a body, or on all.
  pure subroutine start_on_body(scene, start, fields)
    type(scene_t), intent(in) :: scene
    type(start_t), intent(in) :: start
    type(field_t), intent(inout) :: fields(:)
    integer :: g, e, k

    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g)) .or. (scene%groups(g)%name /= start%body .and. len(start%body) > 0)) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, size(scene%groups(g)%connectivity, 1)
          associate (node => scene%groups(g)%connectivity(k, e))
            fields(start%field)%value(:, node) = start%values(node)
          end associate
        end do
      end do
    end do
  end subroutine start_on_body

  !> Nodes where they are now (2, nnode) [length].
  pure function present_coordinates(scene, solution) result(x)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))

    x = scene%mesh%coordinates
    if (scene%fields(displacement_field)%declared) x = x + solution%fields(displacement_field)%value
  end function present_coordinates

end module solution
