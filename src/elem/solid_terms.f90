!> Terms of the force and matrix of PL8LS that some scenes have: unknowns of the section, mean dilatation.
!>
!> They are written with the whole G (5, 19), which takes the local unknowns to h = d(du)/dx (xx, xy, yx, yy, zz); see elem_pl8ls.
module solid_terms
  use kinds, only: wp
  use mean_dilatation, only: add_mean_matrix, dilatation_t, find_fields, share_pressure
  use quad8_geometry, only: derivatives, quad8_rule_t
  use scene, only: scene_t
  use sections, only: thickness_at
  implicit none
  private
  public :: add_section, first_element, mean_element, geometric, local_gradient

contains

  !> What the unknowns of the section add to force and matrix in generalised plane strain, and the tilt of the section
  !> (a3) to the nodal ones. With G (5, 19) complete, K = sum G^T M G dv replaces the matrix of the nodes; h_zz dt = dt
  !> being bilinear in position and tilt, sigma_zz dA d(da2) dx and d(da3) dy come on top.
  pure subroutine add_section(finite, wanted, rule, section, x, du, nx, ny, dv, stress, counted, tangent, force, stiffness)
    logical, intent(in) :: finite, wanted
    type(quad8_rule_t), intent(in) :: rule
    real(wp), intent(in) :: section(3, 2)          !! thickness [length] and slopes [-]: of the geometry, and their motion
    real(wp), intent(in) :: x(2, 8)                !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)                  !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(in) :: nx(:, :), ny(:, :)     !! (8, npoint) [1/length]
    real(wp), intent(in) :: dv(:)                  !! (npoint) [volume]
    real(wp), intent(in) :: stress(:, :)           !! (4, npoint) [stress]
    real(wp), intent(in) :: counted(:, :)          !! (4, npoint) that of the geometric part [stress]
    real(wp), intent(in) :: tangent(:, :, :)       !! (4, 5, npoint) [stress]
    real(wp), intent(inout) :: force(19)           !! [residual]
    real(wp), intent(inout) :: stiffness(19, 19)   !! [residual/unknown]
    real(wp) :: g(5, 19), m(5, 5)
    integer :: p

    force(17:19) = 0
    if (wanted) stiffness = 0
    do p = 1, size(dv)
      g = local_gradient(rule, p, section(:, 1), finite, x, du, nx(:, p), ny(:, p))
      force(9:16) = force(9:16) + stress(4, p)*dv(p)*g(5, 9:16)
      force(17:19) = force(17:19) + stress(4, p)*dv(p)*g(5, 17:19)
      if (.not. wanted) cycle
      m = tangent([1, 3, 3, 2, 4], :, p)
      if (finite) m = m + geometric(counted(:, p))
      stiffness = stiffness + matmul(transpose(g), matmul(m*dv(p), g))
      if (.not. finite) cycle
      call add_tilt(counted(4, p)*dv(p)*g(5, 17)*rule%phi(:, p), stiffness)
    end do
  end subroutine add_section

  !> Forces and matrix of an element with mean dilatation.
  pure subroutine mean_element(finite, wanted, rule, section, own, x, du, nx, ny, dv, stress, counted, tangent, force, &
                               stiffness)
    logical, intent(in) :: finite, wanted
    type(quad8_rule_t), intent(in) :: rule
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: section(3, 2)        !! thickness [length] and slopes [-]: of the geometry, and their motion
    real(wp), intent(in) :: x(2, 8)              !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)                !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(in) :: nx(:, :), ny(:, :)   !! (8, npoint) [1/length]
    real(wp), intent(in) :: dv(:)                !! (npoint) [volume]
    real(wp), intent(in) :: stress(:, :)         !! (4, npoint) [stress]
    real(wp), intent(in) :: counted(:, :)        !! (4, npoint) that of the geometric part [stress]
    real(wp), intent(in) :: tangent(:, :, :)     !! (4, 5, npoint) [stress]
    real(wp), intent(out) :: force(:)            !! (ndof) [residual]
    real(wp), intent(inout) :: stiffness(:, :)   !! (ndof, ndof) [residual/unknown]
    real(wp) :: g(5, 19, size(dv)), geometry(5, 5, size(dv)), m(size(dv)), shared(4, size(dv))
    integer :: p, n

    n = size(force)
    call share_pressure(own, dv, stress, m, shared)
    force = 0
    do p = 1, size(dv)
      g(:, :, p) = local_gradient(rule, p, section(:, 1), finite, x, du, nx(:, p), ny(:, p))
      force = force + matmul(shared([1, 3, 3, 2, 4], p)*dv(p), g(:, :n, p))
    end do
    if (.not. wanted) return
    stiffness = 0
    call share_pressure(own, dv, counted, m, shared)
    do p = 1, size(dv)
      geometry(:, :, p) = geometric(shared(:, p))
    end do
    call add_mean_matrix(finite, own, g(:, :n, :), dv, m, tangent, geometry, stiffness)
    if (n < 19 .or. .not. finite) return
    do p = 1, size(dv)
      call add_tilt(shared(4, p)*dv(p)*g(5, 17, p)*rule%phi(:, p), stiffness)
    end do
  end subroutine mean_element

  !> What the mean dilatation of an element wants to know of the first geometry of the mesh.
  pure subroutine first_element(scene, rule, nodes, own)
    type(scene_t), intent(in) :: scene
    type(quad8_rule_t), intent(in) :: rule
    integer, intent(in) :: nodes(8)
    type(dilatation_t), intent(out) :: own
    real(wp) :: x(2, 8), here(2, rule%npoint), dv(rule%npoint), nx(8), ny(8), detj
    integer :: p

    x = scene%mesh%coordinates(:, nodes)
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      here(:, p) = matmul(x, rule%phi(:, p))
      dv(p) = detj*rule%weight(p)*thickness_at(scene%section, here(:, p))
    end do
    call find_fields(dv, here, own)
  end subroutine first_element

  !> h = G u at one point, with the unknowns of the section last: they count in generalised plane strain only.
  pure function local_gradient(rule, p, section, finite, x, du, nx, ny) result(g)
    type(quad8_rule_t), intent(in) :: rule
    integer, intent(in) :: p                !! point
    real(wp), intent(in) :: section(3)      !! thickness [length] and slopes [-] of the geometry
    logical, intent(in) :: finite
    real(wp), intent(in) :: x(2, 8)         !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)           !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(in) :: nx(8), ny(8)    !! [1/length]
    real(wp) :: g(5, 19)                    !! h (xx, xy, yx, yy, zz) by the unknowns [1/length], of the section [1/unknown]
    real(wp) :: here(2)

    here = matmul(x, rule%phi(:, p))
    if (finite) here = here + [dot_product(rule%phi(:, p), du(1:8)), dot_product(rule%phi(:, p), du(9:16))]
    g = 0
    g(1, 1:8) = nx
    g(2, 1:8) = ny
    g(3, 9:16) = nx
    g(4, 9:16) = ny
    g(5, :) = [section(2)*rule%phi(:, p), section(3)*rule%phi(:, p), 1.0_wp, here]/thickness_at(section, here)
  end function local_gradient

  !> The second derivative of the thickness along a position (`pull` at the nodes) and a tilt of the section.
  pure subroutine add_tilt(pull, stiffness)
    real(wp), intent(in) :: pull(8)
    real(wp), intent(inout) :: stiffness(19, 19)

    stiffness(1:8, 18) = stiffness(1:8, 18) + pull
    stiffness(18, 1:8) = stiffness(18, 1:8) + pull
    stiffness(9:16, 19) = stiffness(9:16, 19) + pull
    stiffness(19, 9:16) = stiffness(19, 9:16) + pull
  end subroutine add_tilt

  !> sigma tr h - sigma h^T as a matrix on h = (xx, xy, yx, yy, zz).
  pure function geometric(s) result(m)
    real(wp), intent(in) :: s(4)   !! [stress]
    real(wp) :: m(5, 5)

    m(:, 1) = [0.0_wp, s(3), 0.0_wp, s(2), s(4)]
    m(:, 2) = [-s(3), 0.0_wp, -s(2), 0.0_wp, 0.0_wp]
    m(:, 3) = [0.0_wp, -s(1), 0.0_wp, -s(3), 0.0_wp]
    m(:, 4) = [s(1), 0.0_wp, s(3), 0.0_wp, s(4)]
    m(:, 5) = [s(1), s(3), s(3), s(2), 0.0_wp]
  end function geometric

end module solid_terms
