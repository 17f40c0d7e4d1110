!> A side of one body against a curve of sides of another, for the tests of CNTDF. Nodes 1 to 3 are the
!> side's; motions are those of all nodes, forces and matrices too, x then y of each, and in generalised
!> plane strain of the section at last.
module pair_cases
  use contact_state, only: at_piece
  use dies, only: place_edges, place_on_nodes
  use elem_api, only: elem_t, instant_t, report_t
  use element_cases, only: elem_row, kinematics_row, step_of_differences
  use element_fields, only: layout_of
  use fields, only: mechanical_fields
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use law_cases, only: law_row
  use materials, only: material_t
  use pairs, only: most_pieces, paired_nodes, start_pairs
  use quadrature, only: rule_of_number
  use scene, only: axisymmetric, generalised_plane_strain, role_contact, scene_t
  use state_variables, only: total_components
  implicit none
  private
  public :: pair_case_t, new_pair_case, evaluate_pair, accept_pair, pair_differences, rigid_motion, parabola, wedge

  type :: pair_case_t
    type(scene_t) :: scene
    type(elem_t) :: elem
    type(law_t) :: law
    type(kinematics_t) :: kinematics
    type(instant_t) :: instant
    !> Places of the nodes at the start of the step (2, nnode) [length].
    real(wp), allocatable :: x(:, :), committed(:, :, :)
    !> Unknowns of the section, and their motion in the step.
    integer :: nsection = 0
    real(wp) :: thickening(3) = 0.0_wp
  end type pair_case_t

contains

  !> Nodes 4 and on are those of the die, in the sense of its walk.
  subroutine new_pair_case(plane_state, material, npoint, x, case)
    integer, intent(in) :: plane_state, npoint
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: x(:, :)
    type(pair_case_t), intent(out) :: case
    integer :: k

    case%elem = elem_row('CNTDF')
    case%kinematics = kinematics_row('LOG')
    case%law = law_row(material%law)
    case%x = x
    case%instant%dt = 1
    associate (scene => case%scene)
      scene%plane_state = plane_state
      scene%fields = mechanical_fields()
      scene%section = merge([0.0_wp, 1.0_wp, 0.0_wp], [1.0_wp, 0.0_wp, 0.0_wp], plane_state == axisymmetric)
      if (plane_state == generalised_plane_strain) then
        case%nsection = 3
        case%thickening = [0.01_wp, 0.002_wp, -0.003_wp]
        scene%section = [1.3_wp, 0.05_wp, -0.02_wp]
      end if
      case%instant%section = scene%section
      scene%mesh%coordinates = x
      allocate (scene%materials(1), source=[material])
      allocate (scene%dies(1), scene%groups(1))
      scene%dies(1)%nodes = reshape([([k, k + 1, k + 2], k=4, size(x, 2) - 2, 2)], [3, (size(x, 2) - 4)/2])
      allocate (scene%dies(1)%pieces(2, 3, size(scene%dies(1)%nodes, 2)))
      scene%groups(1)%rule = rule_of_number(npoint)
      scene%groups(1)%role = role_contact
      scene%groups(1)%connectivity = reshape([1, 2, 3], [3, 1])
      scene%groups(1)%die = 1
      scene%groups(1)%pairs = 1
      scene%groups(1)%material = 1
      call case%elem%variables(case%law, plane_state, scene%groups(1)%variables)
      allocate (case%committed(total_components(scene%groups(1)%variables), abs(npoint), 1), source=0.0_wp)
      call start_pairs(scene, case%instant%pairs)
    end associate
  end subroutine new_pair_case

  !> Forces, matrix and trial state at a motion (2, nnode); pairs are renewed as the program does.
  subroutine evaluate_pair(case, du, force, stiffness, trial, report)
    type(pair_case_t), intent(inout) :: case
    real(wp), intent(in) :: du(:, :)
    real(wp), intent(out) :: force(:), stiffness(:, :)
    real(wp), allocatable, intent(out) :: trial(:, :, :)
    type(report_t), intent(out) :: report
    real(wp), allocatable :: x(:, :, :), motion(:, :), f(:, :), k(:, :, :)
    integer, allocatable :: nodes(:), dof(:)
    real(wp) :: none(0, 1), drivers(2, 2, size(case%committed, 2), 1)
    integer :: i, j

    drivers = 0

    case%instant%dies = case%scene%dies
    call place_on_nodes(case%x + du, case%instant%dies(1))
    call place_edges(case%scene%mesh%coordinates, case%instant%dies(1))
    allocate (trial(size(case%committed, 1), size(case%committed, 2), 1))
    allocate (nodes(0), dof(0))
    do
      nodes = paired_nodes(case%scene%dies(1), [1, 2, 3], case%instant%pairs(1)%piece(:, 1), &
                           most_pieces(case%scene%dies(1), case%instant%pairs(1)%piece))
      dof = [2*nodes - 1, 2*nodes, (size(du) + i, i=1, case%nsection)]
      x = reshape(case%x(:, nodes), [2, size(nodes), 1])
      motion = reshape([du(1, nodes), du(2, nodes), case%thickening(:case%nsection)], [size(dof), 1])
      if (allocated(f)) deallocate (f, k)
      allocate (f(size(dof), 1), k(size(dof), size(dof), 1), source=0.0_wp)
      call case%elem%compute(case%scene, case%scene%groups(1), case%kinematics, case%law, case%instant, &
                             layout_of(case%elem, size(nodes), 0, case%scene%plane_state, case%scene%fields), 1, x, motion, &
                             none, drivers, case%committed, trial, f, k, report)
      if (.not. report%unpaired) exit
      case%instant%pairs(1)%piece = nint(trial(at_piece, :, :))
    end do
    force = 0
    stiffness = 0
    do j = 1, size(dof)
      force(dof(j)) = force(dof(j)) + f(j, 1)
      do i = 1, size(dof)
        stiffness(dof(i), dof(j)) = stiffness(dof(i), dof(j)) + k(i, j, 1)
      end do
    end do
  end subroutine evaluate_pair

  !> Take the motion du: the case stands at the end of the step.
  subroutine accept_pair(case, du)
    type(pair_case_t), intent(inout) :: case
    real(wp), intent(in) :: du(:, :)
    real(wp) :: force(size(du) + case%nsection), stiffness(size(du) + case%nsection, size(du) + case%nsection)
    real(wp), allocatable :: trial(:, :, :)
    type(report_t) :: report

    call evaluate_pair(case, du, force, stiffness, trial, report)
    case%committed = trial
    case%x = case%x + du
    case%instant%section = case%instant%section + case%thickening
  end subroutine accept_pair

  !> d force / d du by differences of fourth order.
  subroutine pair_differences(case, du, matrix)
    type(pair_case_t), intent(inout) :: case
    real(wp), intent(in) :: du(:, :)
    real(wp), intent(out) :: matrix(:, :)
    real(wp), dimension(size(matrix, 1)) :: moved, start
    real(wp) :: force(size(moved), -2:2), unused(size(moved), size(moved))
    real(wp), allocatable :: trial(:, :, :)
    type(report_t) :: report
    integer :: j, k

    start = [du, case%thickening(:case%nsection)]
    do j = 1, size(moved)
      force = 0
      do k = -2, 2
        if (k == 0) cycle
        moved = start
        moved(j) = moved(j) + k*step_of_differences
        case%thickening(:case%nsection) = moved(size(du) + 1:)
        call evaluate_pair(case, reshape(moved(:size(du)), shape(du)), force(:, k), unused, trial, report)
      end do
      matrix(:, j) = (8*(force(:, 1) - force(:, -1)) - (force(:, 2) - force(:, -2)))/(12*step_of_differences)
    end do
    case%thickening(:case%nsection) = start(size(du) + 1:)
  end subroutine pair_differences

  !> Motion that turns places by an angle about a point of the plane and shifts them.
  pure function rigid_motion(x, angle, shift) result(du)
    real(wp), intent(in) :: x(:, :), angle, shift(2)
    real(wp) :: du(size(x, 1), size(x, 2))
    integer :: k

    do k = 1, size(x, 2)
      du(:, k) = [cos(angle)*x(1, k) - sin(angle)*x(2, k), sin(angle)*x(1, k) + cos(angle)*x(2, k)] + shift - x(:, k)
    end do
  end function rigid_motion

  !> Side over a die on the parabola y = bend (x - 3)**2, of three pieces from x = 0 to 6; the side from 2.2 to 3.8, its ends
  !> at a height over the die, its middle a little more.
  pure function parabola(bend, height) result(x)
    real(wp), intent(in) :: bend, height
    real(wp) :: x(2, 10)
    integer :: k

    x(1, :) = [2.2_wp, 3.0_wp, 3.8_wp, (real(k, wp), k=0, 6)]
    x(2, :) = bend*(x(1, :) - 3)**2
    x(2, 1:3) = x(2, 1:3) + height + [0.0_wp, 0.002_wp, 0.0_wp]
  end function parabola

  !> A side of length 0.02, `height` over the corner at (2, 0) of a die of two segments, whose arms rise by a slope to both ends.
  pure function wedge(slope, height) result(x)
    real(wp), intent(in) :: slope, height
    real(wp) :: x(2, 8)
    integer :: k

    x(1, :) = [1.99_wp, 2.0_wp, 2.01_wp, (0.5_wp*k, k=2, 6)]
    x(2, :) = slope*abs(x(1, :) - 2)
    x(2, 1:3) = height
  end function wedge

end module pair_cases
