!> What PL8LS computes for every element in every iteration: motion of its points, internal force and matrix of its nodes. The
!> formulas stand in elem_pl8ls. Loops over nodes have a fixed length, which lets the compiler use vector instructions.
module solid_kernels
  use kinds, only: wp
  use quad8_geometry, only: max_points, places, quad8_rule_t, slopes
  use sections, only: thickness_at
  implicit none
  private
  public :: motion, internal_force, tangent_matrix

contains

  !> Derivatives of the shape functions, volume, gradient f of the step at the points, and the largest strain increment. `valid` is
  !> false where an element is turned inside out. `zx` = d h_zz / d(ux of the nodes). In plane stress f(5) comes later, and
  !> the volume is that of the thickness at the start.
  pure subroutine motion(rule, section, finite, x, du, nx, ny, zx, dv, f, strain, valid)
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: section(3, 2)   !! thickness [length] and slopes [-]: of the geometry, and their motion
    logical, intent(in) :: finite
    real(wp), intent(in) :: x(2, 8)         !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)           !! (ndof) motion of the local unknowns, x then y of the nodes first [unknown]
    real(wp), intent(out) :: nx(8, rule%npoint), ny(8, rule%npoint), zx(8, rule%npoint)   !! [1/length]
    real(wp), intent(out) :: dv(rule%npoint)      !! [volume]
    real(wp), intent(out) :: f(5, rule%npoint)    !! xx, xy, yx, yy, zz [-]
    real(wp), intent(out) :: strain               !! [-]
    logical, intent(out) :: valid
    real(wp), dimension(8) :: y1, y2
    real(wp), dimension(max_points, 4) :: jacobian, parent
    real(wp), dimension(max_points, 2) :: here, before
    real(wp) :: g(4), detj, inverse, thickness, det
    integer :: p, i

    y1 = x(1, :)
    y2 = x(2, :)
    if (finite) then
      call places(rule, y1, y2, before)
      y1 = y1 + du(1:8)
      y2 = y2 + du(9:16)
    end if
    call slopes(rule, y1, y2, jacobian)
    call slopes(rule, du(1:8), du(9:16), parent)
    call places(rule, y1, y2, here)
    strain = 0
    valid = .false.
    do p = 1, rule%npoint
      detj = jacobian(p, 1)*jacobian(p, 4) - jacobian(p, 2)*jacobian(p, 3)
      thickness = thickness_at(section(:, 1), here(p, :))
      if (.not. (detj > 0 .and. thickness > 0)) return
      inverse = 1/detj
      do i = 1, 8
        nx(i, p) = (jacobian(p, 4)*inverse)*rule%dphi(1, i, p) - (jacobian(p, 2)*inverse)*rule%dphi(2, i, p)
        ny(i, p) = (jacobian(p, 1)*inverse)*rule%dphi(2, i, p) - (jacobian(p, 3)*inverse)*rule%dphi(1, i, p)
      end do
      g(1) = (jacobian(p, 4)*parent(p, 1) - jacobian(p, 2)*parent(p, 3))*inverse
      g(2) = (jacobian(p, 1)*parent(p, 3) - jacobian(p, 3)*parent(p, 1))*inverse
      g(3) = (jacobian(p, 4)*parent(p, 2) - jacobian(p, 2)*parent(p, 4))*inverse
      g(4) = (jacobian(p, 1)*parent(p, 4) - jacobian(p, 3)*parent(p, 2))*inverse
      dv(p) = detj*rule%weight(p)*thickness
      zx(:, p) = (section(2, 1)/thickness)*rule%phi(:, p)
      if (finite) then
        f(5, p) = thickness/thickness_at(section(:, 1) - section(:, 2), before(p, :))
      else
        f(5, p) = 1 + dot_product(zx(:, p), du(1:8)) + (section(3, 1)*dot_product(rule%phi(:, p), du(9:16)) &
                                                        + thickness_at(section(:, 2), here(p, :)))/thickness
      end if
      strain = max(strain, sqrt(g(1)**2 + g(4)**2 + 0.5_wp*(g(2) + g(3))**2 + (f(5, p) - 1)**2))
      if (finite) then
        ! dx(n)/dx(n+1) = 1 - g; f is its inverse
        det = (1 - g(1))*(1 - g(4)) - g(2)*g(3)
        if (.not. det > 0) return
        f(1, p) = (1 - g(4))/det
        f(2, p) = g(2)/det
        f(3, p) = g(3)/det
        f(4, p) = (1 - g(1))/det
      else
        f(1:4, p) = [1 + g(1), g(2), g(3), 1 + g(4)]
      end if
    end do
    valid = .true.
  end subroutine motion

  !> F_i = sum B_i^T sigma dv.
  pure subroutine internal_force(nx, ny, zx, dv, stress, force)
    real(wp), intent(in), contiguous :: dv(:)   !! (npoint) [volume]
    real(wp), intent(in) :: nx(8, size(dv)), ny(8, size(dv)), zx(8, size(dv))   !! [1/length]
    real(wp), intent(in) :: stress(:, :)        !! (4, npoint) [stress]
    real(wp), intent(out) :: force(16)          !! [force]
    real(wp) :: along(8), across(8), s1, s2, s3, s4
    integer :: p, i

    along = 0
    across = 0
    do p = 1, size(dv)
      s1 = stress(1, p)*dv(p)
      s2 = stress(2, p)*dv(p)
      s3 = stress(3, p)*dv(p)
      s4 = stress(4, p)*dv(p)
      do i = 1, 8
        along(i) = along(i) + s1*nx(i, p) + s3*ny(i, p) + s4*zx(i, p)
        across(i) = across(i) + s3*nx(i, p) + s2*ny(i, p)
      end do
    end do
    force(1:8) = along
    force(9:16) = across
  end subroutine internal_force

  !> K = sum G^T M G dv without the section. Rows of M: the factors of nx (in Fx), ny (Fx), nx (Fy), ny (Fy), zx (Fx). A column of
  !> K is summed over the points before it is stored.
  pure subroutine tangent_matrix(condense, finite, nx, ny, zx, dv, stress, tangent, stiffness)
    logical, intent(in) :: condense, finite
    real(wp), intent(in), contiguous :: dv(:)   !! (npoint) [volume]
    real(wp), intent(in) :: nx(8, size(dv)), ny(8, size(dv)), zx(8, size(dv))   !! [1/length]
    real(wp), intent(in) :: stress(:, :)        !! (4, npoint) [stress]
    real(wp), intent(in) :: tangent(4, 5, size(dv))   !! [stress]
    real(wp), intent(out) :: stiffness(16, 16)        !! [force/length]
    real(wp) :: m(5, 5, max_points), along(8), across(8), a, b, c, q1, q2, q3, q4, q5
    integer :: p, i, j

    do p = 1, size(dv)
      call moduli_of_gradient(condense, finite, dv(p), stress(:, p), tangent(:, :, p), m(:, :, p))
    end do
    do j = 1, 8
      along = 0
      across = 0
      do p = 1, size(dv)
        a = nx(j, p)
        b = ny(j, p)
        c = zx(j, p)
        q1 = m(1, 1, p)*a + m(1, 2, p)*b + m(1, 5, p)*c
        q2 = m(2, 1, p)*a + m(2, 2, p)*b + m(2, 5, p)*c
        q3 = m(3, 1, p)*a + m(3, 2, p)*b + m(3, 5, p)*c
        q4 = m(4, 1, p)*a + m(4, 2, p)*b + m(4, 5, p)*c
        q5 = m(5, 1, p)*a + m(5, 2, p)*b + m(5, 5, p)*c
        do i = 1, 8
          along(i) = along(i) + q1*nx(i, p) + q2*ny(i, p) + q5*zx(i, p)
          across(i) = across(i) + q3*nx(i, p) + q4*ny(i, p)
        end do
      end do
      stiffness(1:8, j) = along
      stiffness(9:16, j) = across
      along = 0
      across = 0
      do p = 1, size(dv)
        a = nx(j, p)
        b = ny(j, p)
        q1 = m(1, 3, p)*a + m(1, 4, p)*b
        q2 = m(2, 3, p)*a + m(2, 4, p)*b
        q3 = m(3, 3, p)*a + m(3, 4, p)*b
        q4 = m(4, 3, p)*a + m(4, 4, p)*b
        q5 = m(5, 3, p)*a + m(5, 4, p)*b
        do i = 1, 8
          along(i) = along(i) + q1*nx(i, p) + q2*ny(i, p) + q5*zx(i, p)
          across(i) = across(i) + q3*nx(i, p) + q4*ny(i, p)
        end do
      end do
      stiffness(1:8, j + 8) = along
      stiffness(9:16, j + 8) = across
    end do
  end subroutine tangent_matrix

  !> M dv: the derivatives of the stress, and sigma tr h - sigma h^T of the geometric part (`geometric` of solid_terms).
  pure subroutine moduli_of_gradient(condense, finite, dv, s, tangent, m)
    logical, intent(in) :: condense, finite
    real(wp), intent(in) :: dv, s(4), tangent(4, 5)
    real(wp), intent(out) :: m(5, 5)
    integer :: j

    do j = 1, 5
      m(1, j) = tangent(1, j)
      m(2, j) = tangent(3, j)
      m(3, j) = tangent(3, j)
      m(4, j) = tangent(2, j)
      m(5, j) = tangent(4, j)
    end do
    if (finite) then
      m(2, 1) = m(2, 1) + s(3)
      m(4, 1) = m(4, 1) + s(2)
      m(5, 1) = m(5, 1) + s(4)
      m(1, 2) = m(1, 2) - s(3)
      m(3, 2) = m(3, 2) - s(2)
      m(2, 3) = m(2, 3) - s(1)
      m(4, 3) = m(4, 3) - s(3)
      m(1, 4) = m(1, 4) + s(1)
      m(3, 4) = m(3, 4) + s(3)
      m(5, 4) = m(5, 4) + s(4)
      m(1, 5) = m(1, 5) + s(1)
      m(2, 5) = m(2, 5) + s(3)
      m(3, 5) = m(3, 5) + s(3)
      m(4, 5) = m(4, 5) + s(2)
    end if
    if (condense) then
      do j = 1, 4
        m(1:4, j) = m(1:4, j) - m(1:4, 5)*(tangent(4, j)/tangent(4, 5))
      end do
    end if
    m = m*dv
  end subroutine moduli_of_gradient

end module solid_kernels
