!> PL8LS: 8-node quadrilateral, plane or axisymmetric, updated Lagrangian (annex 1, corrected).
!>
!> Internal force per radian, F_i = sum B_i^T sigma r |J| W, with the Cauchy stress in the present
!> configuration. Tangent K = sum G^T M G r|J|W, where G takes nodal motions to
!> h = d(du)/dx (xx, xy, yx, yy, zz) and M = A + geometric part. The geometric part is annex 1's
!> matrix, d(F) at frozen stress, written once for all nodes: d(sigma J f^-T) = J (sigma tr h - sigma h^T).
module elem_pl8ls
  use elem_api, only: block_inverted, block_law_failed, elem_t, instant_t, report_t, totals_t
  use kinds, only: wp
  use kinematics_api, only: first_history, first_strain, kinematics_t, solid_variables
  use law_api, only: law_done, law_t, solid_law
  use quad8_geometry, only: quad8_rule_t, quad8_rule, derivatives
  use scene, only: axisymmetric, group_t, scene_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: elem_pl8ls_row

contains

  function elem_pl8ls_row() result(row)
    type(elem_t) :: row

    row%name = 'PL8LS'
    row%purpose = '8-node quadrilateral, large strain'
    row%nnode = 8
    row%law_kind = solid_law
    row%effect = 'displacement'
    row%variables => solid_variables
    row%compute => compute
    row%measure => measure
  end function elem_pl8ls_row

  subroutine compute(scene, group, kinematics, law, instant, first, x, du, committed, trial, force, stiffness, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: law
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: first
    real(wp), intent(in) :: x(:, :, :), du(:, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(out) :: force(:, :)
    real(wp), intent(inout) :: stiffness(:, :, :)
    type(report_t), intent(out) :: report
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8, group%npoint, size(x, 3)), ny(8, group%npoint, size(x, 3)), nr(8, group%npoint, size(x, 3))
    real(wp) :: dv(group%npoint, size(x, 3)), f(5, group%npoint, size(x, 3)), tangent(4, 5, group%npoint, size(x, 3))
    integer :: status(group%npoint, size(x, 3))
    real(wp) :: strain
    logical :: valid, axisym
    integer :: e, p, nb

    nb = size(x, 3)
    axisym = scene%plane_state == axisymmetric
    call quad8_rule(group%npoint, rule)
    do e = 1, nb
      do p = 1, group%npoint
        call motion(rule, p, axisym, kinematics%finite, x(:, :, e), du(:, e), nx(:, p, e), ny(:, p, e), nr(:, p, e), &
                    dv(p, e), f(:, p, e), strain, valid)
        report%strain = max(report%strain, strain)
        if (.not. valid) then
          report%status = block_inverted
          report%element = first + e - 1
          force = 0
          return
        end if
      end do
    end do

    call kinematics%update(law, scene%materials(group%material), instant%dt, group%npoint*nb, size(committed, 1), &
                           f, committed, trial, tangent, status)

    do e = 1, nb
      if (any(status(:, e) /= law_done) .and. report%status == 0) then
        report%status = block_law_failed
        report%element = first + e - 1
      end if
      call internal_force(nx(:, :, e), ny(:, :, e), nr(:, :, e), dv(:, e), trial(1:4, :, e), force(:, e))
      if (instant%tangent) call tangent_matrix(kinematics%finite, nx(:, :, e), ny(:, :, e), nr(:, :, e), dv(:, e), &
                                               trial(1:4, :, e), tangent(:, :, :, e), stiffness(:, :, e))
    end do
  end subroutine compute

  !> Derivatives of the shape functions, volume, gradient f of the step at one point, and size of its strain increment.
  pure subroutine motion(rule, p, axisym, finite, x, du, nx, ny, nr, dv, f, strain, valid)
    type(quad8_rule_t), intent(in) :: rule
    integer, intent(in) :: p
    logical, intent(in) :: axisym, finite
    real(wp), intent(in) :: x(2, 8), du(16)
    real(wp), intent(out) :: nx(8), ny(8), nr(8), dv, f(5), strain
    logical, intent(out) :: valid
    real(wp) :: y(2, 8), g(4), detj, radius, det

    y = x
    if (finite) then
      y(1, :) = x(1, :) + du(1:8)
      y(2, :) = x(2, :) + du(9:16)
    end if
    call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
    dv = detj*rule%weight(p)
    g = [dot_product(nx, du(1:8)), dot_product(ny, du(1:8)), dot_product(nx, du(9:16)), dot_product(ny, du(9:16))]
    nr = 0
    f(5) = 1
    valid = detj > 0
    if (axisym) then
      radius = dot_product(rule%phi(:, p), y(1, :))
      valid = valid .and. radius > 0
      nr = rule%phi(:, p)/radius
      dv = dv*radius
      f(5) = 1 + dot_product(nr, du(1:8))
      if (finite) f(5) = radius/dot_product(rule%phi(:, p), x(1, :))
    end if
    strain = sqrt(g(1)**2 + g(4)**2 + 0.5_wp*(g(2) + g(3))**2 + (f(5) - 1)**2)
    if (finite) then
      ! dx(n)/dx(n+1) = 1 - g; f is its inverse
      det = (1 - g(1))*(1 - g(4)) - g(2)*g(3)
      valid = valid .and. det > 0
      f(1:4) = [1 - g(4), g(2), g(3), 1 - g(1)]/det
    else
      f(1:4) = [1 + g(1), g(2), g(3), 1 + g(4)]
    end if
  end subroutine motion

  !> F_i = sum B_i^T sigma dv.
  pure subroutine internal_force(nx, ny, nr, dv, stress, force)
    real(wp), intent(in) :: nx(:, :), ny(:, :), nr(:, :), dv(:), stress(:, :)
    real(wp), intent(out) :: force(16)
    real(wp) :: s(4)
    integer :: p

    force = 0
    do p = 1, size(dv)
      s = stress(:, p)*dv(p)
      force(1:8) = force(1:8) + s(1)*nx(:, p) + s(3)*ny(:, p) + s(4)*nr(:, p)
      force(9:16) = force(9:16) + s(3)*nx(:, p) + s(2)*ny(:, p)
    end do
  end subroutine internal_force

  !> K = sum G^T M G dv. Rows of M: the factors of nx (in Fx), ny (Fx), nx (Fy), ny (Fy), nr (Fx).
  pure subroutine tangent_matrix(finite, nx, ny, nr, dv, stress, tangent, stiffness)
    logical, intent(in) :: finite
    real(wp), intent(in) :: nx(:, :), ny(:, :), nr(:, :), dv(:), stress(:, :), tangent(:, :, :)
    real(wp), intent(out) :: stiffness(16, 16)
    real(wp) :: m(5, 5), qx(5), qy(5)
    integer :: p, j

    stiffness = 0
    do p = 1, size(dv)
      m = tangent([1, 3, 3, 2, 4], :, p)
      if (finite) m = m + geometric(stress(:, p))
      m = m*dv(p)
      do j = 1, 8
        qx = m(:, 1)*nx(j, p) + m(:, 2)*ny(j, p) + m(:, 5)*nr(j, p)
        qy = m(:, 3)*nx(j, p) + m(:, 4)*ny(j, p)
        stiffness(1:8, j) = stiffness(1:8, j) + qx(1)*nx(:, p) + qx(2)*ny(:, p) + qx(5)*nr(:, p)
        stiffness(9:16, j) = stiffness(9:16, j) + qx(3)*nx(:, p) + qx(4)*ny(:, p)
        stiffness(1:8, j + 8) = stiffness(1:8, j + 8) + qy(1)*nx(:, p) + qy(2)*ny(:, p) + qy(5)*nr(:, p)
        stiffness(9:16, j + 8) = stiffness(9:16, j + 8) + qy(3)*nx(:, p) + qy(4)*ny(:, p)
      end do
    end do
  end subroutine tangent_matrix

  !> sigma tr h - sigma h^T as a matrix on h = (xx, xy, yx, yy, zz).
  pure function geometric(s) result(m)
    real(wp), intent(in) :: s(4)
    real(wp) :: m(5, 5)

    m(:, 1) = [0.0_wp, s(3), 0.0_wp, s(2), s(4)]
    m(:, 2) = [-s(3), 0.0_wp, -s(2), 0.0_wp, 0.0_wp]
    m(:, 3) = [0.0_wp, -s(1), 0.0_wp, -s(3), 0.0_wp]
    m(:, 4) = [s(1), 0.0_wp, s(3), 0.0_wp, s(4)]
    m(:, 5) = [s(1), s(3), s(3), s(2), 0.0_wp]
  end function geometric

  !> Volume and energies. Work densities are per stress-free volume, dv/J with J = exp(tr e).
  subroutine measure(scene, group, law, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: x(:, :, :), state(:, :, :), before(:, :, :)
    type(totals_t), intent(out) :: totals
    type(quad8_rule_t) :: rule
    real(wp) :: nx(8), ny(8), detj, dv, stress(4), strain(4)
    integer :: e, p, k

    call quad8_rule(group%npoint, rule)
    k = find_variable(law%history, 'plastic_work')
    if (k > 0) k = group%variables(find_variable(group%variables, 'plastic_work'))%first
    do e = 1, size(x, 3)
      do p = 1, group%npoint
        call derivatives(rule%dphi(:, :, p), x(:, :, e), nx, ny, detj)
        dv = detj*rule%weight(p)
        if (scene%plane_state == axisymmetric) dv = dv*dot_product(rule%phi(:, p), x(1, :, e))
        totals%volume = totals%volume + dv
        stress = state(1:4, p, e)
        strain = state(first_strain:first_history - 1, p, e)
        totals%elastic_energy = totals%elastic_energy &
                                + 0.5_wp*dv*(dot_product(stress, strain) + stress(3)*strain(3))
        if (k == 0) cycle
        if (scene%finite) dv = dv*exp(-strain(1) - strain(2) - strain(4))
        totals%plastic_work = totals%plastic_work + state(k, p, e)*dv
        totals%least_dissipation = min(totals%least_dissipation, state(k, p, e) - before(k, p, e))
      end do
    end do
  end subroutine measure

end module elem_pl8ls
