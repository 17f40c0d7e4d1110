!> BSPRG: weak springs spread over the volume of a body, between where it is and where it is on the first geometry of the mesh.
!>
!> Force -k u on a volume of the first geometry along one component, u the whole displacement since then, k the stiffness of all
!> springs over the volume: a rigid translation by u takes k V u, and a turn is held where both components are. They hold a body
!> before dies do. Linear, symmetric, no state.
module elem_body_springs
  use elem_api, only: elem_t, instant_t, layout_t, no_variables, of_displacement, report_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: group_t, role_volume_load, scene_t
  use sections, only: thickness_at
  implicit none
  private
  public :: elem_bsprg_row, mass_matrix, pull_of_springs, springs_of_body, volume_of_body

  !> Gauss points of an element: exact where sides are straight.
  integer, parameter :: npoint = 9

contains

  function elem_bsprg_row() result(row)
    type(elem_t) :: row

    row%name = 'BSPRG'
    row%purpose = 'weak springs of a body'
    row%nnode = 8
    row%role = role_volume_load
    allocate (row%unknowns, source=[of_displacement()])
    row%effect = 'body force'
    row%is_spring = .true.
    row%follows = .true.
    allocate (row%options(0))
    row%variables => no_variables
    row%compute => compute
  end function elem_bsprg_row

  subroutine compute(scene, group, kinematics, law, instant, layout, first, x, du, start, drivers, committed, trial, &
                     force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :), start(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report  !! a spring never fails
    real(wp) :: origin(2, 8), matrix(8, 8)
    integer :: e, d

    d = 8*(group%direction - 1)
    force = 0
    do e = 1, size(x, 3)
      origin = scene%mesh%coordinates(:, group%connectivity(:, first + e - 1))
      matrix = group%stiffness*mass_matrix(scene%section, origin)
      force(d + 1:d + 8, e) = matmul(matrix, x(group%direction, :, e) - origin(group%direction, :) + du(d + 1:d + 8, e))
      if (.not. instant%tangent) cycle
      stiffness(:, :, e) = 0
      stiffness(d + 1:d + 8, d + 1:d + 8, e) = matrix
    end do
  end subroutine compute

  !> Integrals of phi_i phi_j over the volume of an element, per radian when axisymmetric.
  pure function mass_matrix(section, x) result(matrix)
    real(wp), intent(in) :: section(3)   !! at the start (sections)
    real(wp), intent(in) :: x(2, 8)      !! nodes [length]
    real(wp) :: matrix(8, 8)             !! [volume]
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8), ny(8), detj, dv
    integer :: p, j

    matrix = 0
    call quad8_rule(npoint, rule)
    do p = 1, npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      associate (phi => rule%phi(:, p))
        dv = detj*rule%weight(p)*thickness_at(section, matmul(x, phi))
        do j = 1, 8
          matrix(:, j) = matrix(:, j) + dv*phi(j)*phi
        end do
      end associate
    end do
  end function mass_matrix

  !> Volume of a body on the first geometry, per radian when axisymmetric [volume].
  pure function volume_of_body(scene, connectivity) result(volume)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    real(wp) :: volume
    integer :: e

    volume = 0
    do e = 1, size(connectivity, 2)
      volume = volume + sum(mass_matrix(scene%section, scene%mesh%coordinates(:, connectivity(:, e))))
    end do
  end function volume_of_body

  !> What the springs of a group do: the resultant of their forces on the body, and their energy, per radian when axisymmetric.
  pure subroutine springs_of_body(scene, group, displacement, force, energy)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) [length]
    real(wp), intent(out) :: force               !! along the direction of the group [force]
    real(wp), intent(out) :: energy              !! [energy]
    real(wp) :: pull(size(displacement, 2))

    pull = pull_of_springs(scene, group, displacement)
    force = -sum(pull)
    energy = 0.5_wp*dot_product(pull, displacement(group%direction, :))
  end subroutine springs_of_body

  !> Internal force of the springs of a group on the nodes, along the direction of the group, per radian when axisymmetric [force].
  pure function pull_of_springs(scene, group, displacement) result(pull)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) [length]
    real(wp) :: pull(size(displacement, 2))
    integer :: e

    pull = 0
    do e = 1, size(group%connectivity, 2)
      associate (nodes => group%connectivity(:, e))
        pull(nodes) = pull(nodes) + group%stiffness*matmul(mass_matrix(scene%section, scene%mesh%coordinates(:, nodes)), &
                                                           displacement(group%direction, nodes))
      end associate
    end do
  end function pull_of_springs

end module elem_body_springs
