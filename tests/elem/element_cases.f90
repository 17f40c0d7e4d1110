!> Scenes of one element, built in code, for the tests of the ELEM family.
module element_cases
  use dies, only: die_t, finish_die
  use elem_api, only: elem_t, first_unknown, instant_t, layout_t, report_t, section_motion, totals_t
  use elem_registry, only: list_elems
  use element_fields, only: has_unknown, layout_of
  use fields, only: displacement_field, mechanical_fields
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use kinematics_registry, only: list_kinematics
  use law_api, only: driver_count, law_of_material, law_t
  use law_cases, only: elastic_material, law_row, material_of, plastic_material
  use loads, only: by_convection, by_radiation, exchange_t
  use materials, only: material_t
  use quadrature, only: rule_of_number
  use scene, only: axisymmetric, scene_t
  use state_variables, only: total_components
  implicit none
  private
  public :: case_t, solid_case, material_case, contact_case, pressure_case, body_force_case, heat_case, heat_side_case
  public :: evaluate, accept
  public :: add_temperature
  public :: difference_matrix, layout_of_case, totals_of
  public :: die_of, segment, shape_of_test, elem_row, kinematics_row
  public :: step_of_differences, tolerance_of_differences

  !> One element with all it needs: at the start of a step.
  type :: case_t
    type(scene_t) :: scene
    type(elem_t) :: elem
    type(law_t) :: law
    type(kinematics_t) :: kinematics
    type(instant_t) :: instant
    real(wp), allocatable :: x(:, :, :), committed(:, :, :)
    !> Values of the unknowns at the start of the step; none in mechanics alone.
    real(wp), allocatable :: start(:, :)
    !> Drivers of the law at the points.
    real(wp), allocatable :: drivers(:, :, :, :)
  end type case_t

  !> Differences of fourth order, steps h and 2h: truncation (h/l)**4, with l the length over which the
  !> answer changes: a size of 1 times a strain of 3e-3 (yield, or a penetration), makes 1e-10;
  !> round-off eps f/(h k), with forces f of 1e-1 k at most, 2e-12. Tolerance with a margin of 100.
  real(wp), parameter :: step_of_differences = 1.0e-5_wp
  real(wp), parameter :: tolerance_of_differences = 1.0e-8_wp

contains

  function elem_row(name) result(row)
    character(len=*), intent(in) :: name
    type(elem_t) :: row
    type(elem_t), allocatable :: rows(:)
    integer :: i

    call list_elems(rows)
    do i = 1, size(rows)
      if (rows(i)%name == name) row = rows(i)
    end do
  end function elem_row

  function kinematics_row(name) result(row)
    character(len=*), intent(in) :: name
    type(kinematics_t) :: row
    type(kinematics_t), allocatable :: rows(:)
    integer :: i

    call list_kinematics(rows)
    do i = 1, size(rows)
      if (rows(i)%name == name) row = rows(i)
    end do
  end function kinematics_row

  !> What all cases share: one group of one element on the nodes x.
  subroutine begin_case(elem, kinematics, plane_state, npoint, x, case)
    character(len=*), intent(in) :: elem, kinematics
    integer, intent(in) :: plane_state, npoint
    real(wp), intent(in) :: x(:, :)
    type(case_t), intent(out) :: case
    integer :: i

    case%elem = elem_row(elem)
    case%kinematics = kinematics_row(kinematics)
    case%scene%plane_state = plane_state
    case%scene%fields = mechanical_fields()
    case%scene%section = merge([0.0_wp, 1.0_wp, 0.0_wp], [1.0_wp, 0.0_wp, 0.0_wp], plane_state == axisymmetric)
    case%instant%section = case%scene%section
    case%scene%finite = case%kinematics%finite
    case%scene%mesh%coordinates = x
    allocate (case%x(2, size(x, 2), 1), case%scene%groups(1), case%scene%dies(0), case%instant%pilots(3, 0))
    case%x(:, :, 1) = x
    case%instant%dt = 1
    allocate (case%start(0, 1))
    allocate (case%instant%multipliers(1), source=1.0_wp)
    allocate (case%instant%flow%multipliers(1, 2), source=1.0_wp)
    case%instant%flow%stated = case%instant%flow%multipliers
    case%scene%groups(1)%rule = rule_of_number(npoint)
    allocate (case%drivers(0, 2, abs(npoint), 1))
    case%scene%groups(1)%role = case%elem%role
    case%scene%groups(1)%elem = elem
    case%scene%groups(1)%connectivity = reshape([(i, i=1, size(x, 2))], [size(x, 2), 1])
  end subroutine begin_case

  !> Give the case its law and its state at rest.
  subroutine add_law(case, material)
    type(case_t), intent(inout) :: case
    type(material_t), intent(in) :: material
    integer :: k

    case%law = law_of_material(law_row(material%law), material)
    allocate (case%scene%materials(1), source=[material])
    associate (group => case%scene%groups(1))
      group%material = 1
      call case%elem%variables(case%law, case%scene%plane_state, group%variables)
      allocate (case%committed(total_components(group%variables), group%rule%n, 1), source=0.0_wp)
      deallocate (case%drivers)
      allocate (case%drivers(driver_count(case%law), 2, group%rule%n, 1), source=0.0_wp)
      do k = 1, size(group%variables)
        if (group%variables(k)%ncomp == 1) case%committed(group%variables(k)%first, :, :) = group%variables(k)%initial
      end do
    end associate
  end subroutine add_law

  !> PL8LS; `hardening` as in `plastic_material`, 0 for ELA.
  function solid_case(plane_state, kinematics, hardening, npoint, x) result(case)
    integer, intent(in) :: plane_state, hardening, npoint
    character(len=*), intent(in) :: kinematics
    real(wp), intent(in) :: x(2, 8)
    type(case_t) :: case

    if (hardening == 0) then
      case = material_case(plane_state, kinematics, elastic_material(), npoint, x)
    else
      case = material_case(plane_state, kinematics, plastic_material(hardening), npoint, x)
    end if
  end function solid_case

  !> PL8LS of any material.
  function material_case(plane_state, kinematics, material, npoint, x) result(case)
    integer, intent(in) :: plane_state, npoint
    character(len=*), intent(in) :: kinematics
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: x(2, 8)
    type(case_t) :: case

    call begin_case('PL8LS', kinematics, plane_state, npoint, x, case)
    call add_law(case, material)
  end function material_case

  !> CNT2D on a die whose pilot stands at `pilot`; the die is given with its pilot at (0, 0, 0).
  function contact_case(plane_state, material, npoint, x, die, pilot) result(case)
    integer, intent(in) :: plane_state, npoint
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: x(2, 3)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3)
    type(case_t) :: case

    call begin_case('CNT2D', 'LOG', plane_state, npoint, x, case)
    deallocate (case%scene%dies, case%instant%pilots)
    allocate (case%scene%dies(1), source=[die])
    allocate (case%instant%pilots(3, 1), source=reshape(pilot, [3, 1]))
    case%scene%groups(1)%die = 1
    call add_law(case, material)
  end function contact_case

  !> PRES2D.
  function pressure_case(plane_state, npoint, x, pressure) result(case)
    integer, intent(in) :: plane_state, npoint
    real(wp), intent(in) :: x(2, 3), pressure
    type(case_t) :: case

    call begin_case('PRES2D', 'LOG', plane_state, npoint, x, case)
    case%scene%groups(1)%multiplier = 1
    case%scene%groups(1)%amplitude = pressure
    allocate (case%scene%materials(0), case%committed(0, abs(npoint), 1))
  end function pressure_case

  !> BFORC along a direction, or CENTR.
  function body_force_case(elem, plane_state, kinematics, x, amplitude, direction) result(case)
    character(len=*), intent(in) :: elem, kinematics
    integer, intent(in) :: plane_state, direction
    real(wp), intent(in) :: x(2, 8), amplitude
    type(case_t) :: case

    call begin_case(elem, kinematics, plane_state, 9, x, case)
    case%scene%groups(1)%multiplier = 1
    case%scene%groups(1)%amplitude = amplitude
    case%scene%groups(1)%direction = direction
    allocate (case%scene%materials(0), case%committed(0, 9, 1))
  end function body_force_case

  !> PL8TM with the numbers of HEAT, `moves` with displacements among its unknowns; all at the temperature 0.
  function heat_case(plane_state, kinematics, numbers, bilinear, moves, npoint, x) result(case)
    integer, intent(in) :: plane_state, npoint
    character(len=*), intent(in) :: kinematics
    real(wp), intent(in) :: numbers(3), x(2, 8)
    logical, intent(in) :: bilinear, moves
    type(case_t) :: case
    integer :: i

    call begin_case('PL8TM', kinematics, plane_state, npoint, x, case)
    call add_law(case, material_of('HEAT', numbers))
    case%scene%groups(1)%option = merge(1, 0, bilinear)
    call add_temperature(case, bilinear)
    case%scene%fields(displacement_field)%declared = moves
    case%start = spread([(0.0_wp, i=1, ndof_of(case))], 2, 1)
  end function heat_case

  !> A side that heat passes, FLUX, CONVE or RADIA, a volume that releases it, HEATS, or faces of a sheet, FACES, with displacements
  !> among its unknowns; all at the temperature 0.
  function heat_side_case(elem, plane_state, kinematics, exchange, at_corners, npoint, x) result(case)
    character(len=*), intent(in) :: elem, kinematics
    integer, intent(in) :: plane_state, npoint
    type(exchange_t), intent(in) :: exchange
    logical, intent(in) :: at_corners
    real(wp), intent(in) :: x(:, :)   !! (2, 3) or (2, 8)
    type(case_t) :: case

    call begin_case(elem, kinematics, plane_state, npoint, x, case)
    case%scene%groups(1)%exchange = exchange
    if (elem == 'CONVE') case%scene%groups(1)%exchange%kind = by_convection
    if (elem == 'RADIA') case%scene%groups(1)%exchange%kind = by_radiation
    allocate (case%committed(0, npoint, 1))
    call add_temperature(case, at_corners)
  end function heat_side_case

  !> The scene has temperatures among its fields, at corners only or at all nodes; all 0.
  subroutine add_temperature(case, at_corners)
    type(case_t), intent(inout) :: case
    logical, intent(in) :: at_corners
    type(elem_t) :: heat
    integer :: i

    heat = elem_row('PL8TM')
    case%scene%fields = [case%scene%fields, heat%unknowns(merge(2, 1, at_corners))%field]
    case%scene%fields(size(case%scene%fields))%declared = .true.
    allocate (case%instant%solved(size(case%scene%fields)), source=.true.)
    case%start = spread([(0.0_wp, i=1, ndof_of(case))], 2, 1)
  end subroutine add_temperature

  !> Number of local unknowns.
  pure function ndof_of(case) result(n)
    type(case_t), intent(in) :: case
    integer :: n
    type(layout_t) :: layout

    layout = layout_of_case(case)
    n = layout%ndof
  end function ndof_of

  !> Force, matrix and trial state at the motion du of the step.
  subroutine evaluate(case, du, force, stiffness, trial, report)
    type(case_t), intent(in) :: case
    real(wp), intent(in) :: du(:)
    real(wp), intent(out) :: force(:), stiffness(:, :)
    real(wp), allocatable, intent(out) :: trial(:, :, :)
    type(report_t), intent(out) :: report
    real(wp) :: motion(size(du), 1), f(size(du), 1), k(size(du), size(du), 1)

    motion(:, 1) = du
    k = 0
    allocate (trial(size(case%committed, 1), size(case%committed, 2), 1))
    call case%elem%compute(case%scene, case%scene%groups(1), case%kinematics, case%law, case%instant, layout_of_case(case), 1, &
                           case%x, motion, case%start, case%drivers, case%committed, trial, f, k, report)
    force = f(:, 1)
    stiffness = k(:, :, 1)
  end subroutine evaluate

  !> Where its local unknowns stand.
  pure function layout_of_case(case) result(layout)
    type(case_t), intent(in) :: case
    type(layout_t) :: layout

    layout = layout_of(case%elem, case%elem%nnode, case%scene%groups(1)%option, case%scene%plane_state, case%scene%fields)
  end function layout_of_case

  !> Take the motion du: the case stands at the end of the step.
  subroutine accept(case, du)
    type(case_t), intent(inout) :: case
    real(wp), intent(in) :: du(:)
    real(wp), allocatable :: trial(:, :, :)
    real(wp) :: force(size(du)), stiffness(size(du), size(du))
    type(report_t) :: report
    integer :: n, u

    call evaluate(case, du, force, stiffness, trial, report)
    case%committed = trial
    n = case%elem%nnode
    u = first_unknown(layout_of_case(case), displacement_field)
    if ((case%kinematics%finite .or. case%elem%follows) .and. u > 0) then
      case%x(1, :, 1) = case%x(1, :, 1) + du(u:u + n - 1)
      case%x(2, :, 1) = case%x(2, :, 1) + du(u + n:u + 2*n - 1)
    end if
    if (size(case%start) > 0) case%start(:, 1) = case%start(:, 1) + du
    if (has_unknown(case%elem, 'pilot')) case%instant%pilots(:, 1) = case%instant%pilots(:, 1) + du(2*n + 1:2*n + 3)
    case%instant%section = case%instant%section + section_motion(layout_of_case(case), du)
  end subroutine accept

  !> d force / d du by differences of fourth order.
  subroutine difference_matrix(case, du, matrix)
    type(case_t), intent(in) :: case
    real(wp), intent(in) :: du(:)
    real(wp), intent(out) :: matrix(:, :)
    real(wp) :: force(size(du), -2:2), unused(size(du), size(du)), moved(size(du))
    real(wp), allocatable :: trial(:, :, :)
    type(report_t) :: report
    integer :: j, k

    do j = 1, size(du)
      force = 0
      do k = -2, 2
        if (k == 0) cycle
        moved = du
        moved(j) = moved(j) + k*step_of_differences
        call evaluate(case, moved, force(:, k), unused, trial, report)
      end do
      matrix(:, j) = (8*(force(:, 1) - force(:, -1)) - (force(:, 2) - force(:, -2)))/(12*step_of_differences)
    end do
  end subroutine difference_matrix

  !> What the element measures at its committed state.
  function totals_of(case, before) result(totals)
    type(case_t), intent(in) :: case
    real(wp), intent(in), optional :: before(:, :, :)
    type(totals_t) :: totals

    if (present(before)) then
      call case%elem%measure(case%scene, case%scene%groups(1), case%law, case%scene%section, 1.0_wp, case%x, &
                             case%committed, before, totals)
    else
      call case%elem%measure(case%scene, case%scene%groups(1), case%law, case%scene%section, 1.0_wp, case%x, case%committed, &
                             case%committed, totals)
    end if
  end function totals_of

  !> Die of the pieces given, with its pilot at the origin.
  function die_of(pieces) result(die)
    real(wp), intent(in) :: pieces(:, :, :)
    type(die_t) :: die

    die%name = 'tool'
    allocate (die%pieces, source=pieces)
    call finish_die(die)
  end function die_of

  !> The three points of a straight piece.
  pure function segment(from, to) result(piece)
    real(wp), intent(in) :: from(2), to(2)
    real(wp) :: piece(2, 3, 1)

    piece(:, 1, 1) = from
    piece(:, 2, 1) = 0.5_wp*(from + to)
    piece(:, 3, 1) = to
  end function segment

  !> A unit quadrilateral, its nodes in the order of PL8LS, with sides bent and corners moved by up to `bend`;
  !> its left side stands at x = 2.
  pure function shape_of_test(bend) result(x)
    real(wp), intent(in) :: bend
    real(wp) :: x(2, 8)
    real(wp), parameter :: square(2, 8) = reshape([0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp, 1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp, &
                                                   0.5_wp, 0.0_wp, 1.0_wp, 0.5_wp, 0.5_wp, 1.0_wp, 0.0_wp, 0.5_wp], [2, 8])
    real(wp), parameter :: moves(2, 8) = reshape([0.3_wp, -0.8_wp, -0.5_wp, 0.4_wp, 0.9_wp, 0.7_wp, -1.0_wp, 0.2_wp, &
                                                  0.1_wp, 0.6_wp, 0.7_wp, -0.3_wp, -0.2_wp, -0.5_wp, 0.4_wp, 0.5_wp], [2, 8])

    x = square + bend*moves
    x(1, :) = x(1, :) + 2
  end function shape_of_test

end module element_cases
