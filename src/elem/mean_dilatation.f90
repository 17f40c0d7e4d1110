!> Mean dilatation: the points of an element share few values of the change of volume, so that nothing locks where volume
!> cannot change.
!>
!> The volume ratio J = dv/dv0 of the points, dv0 on the first geometry of the mesh, is projected on fields linear in the
!> first place of the points, in the mean over the element: Jm = Pi J. In a step points see f_bar = f (jm/j)^(1/3), jm and j
!> being the changes of Jm and J; in small strain the strain with the projected trace.
!> Pressures work on the change of Jm, m = Jm dv0 being the volume, and deviators on that of the shape of the present
!> elements: F = sum G^T s dv, s = dev sigma + P 1, P = Pi p. With theta = d Jm/Jm = Pi (J tr h)/Jm, which is tr h_bar,
!> K = sum G_star^T A G_bar dv + sum G^T (s tr h - s h^T) G dv exactly, where G_star has the trace (m/dv) theta.
!>
!> tr h - theta is what the projection hides. Were the work of the deviators that on the volumes m (a potential, and K
!> symmetric), s would have (m/dv) dev sigma, which falls where hidden volume grows, and K -(dev sigma : h)(tr h - theta) more. In
!> a motion h = a n^T the geometric part above is 0, and that term -(n dev sigma a)(n a): -2/3 sigma where an element
!> stretches along a pull sigma. Against it stand hardening, in a body of revolution 4/9 of it, and the shear between neighbours,
!> which is small in flat elements: they saw, middle nodes of vertical sides up and down. With an inner node 8/3 becomes 9/3,
!> which is stable by the inf-sup condition (8/3 is not), but hides more and saws as well, and so does a constant. As F
!> stands K loses nothing by what is hidden, whatever the stress, in tension as in compression.
!> Source: J.C. Simo, R.L. Taylor, K.S. Pister, CMAME 51 (1985) 177-208, where Pi is general; linear fields in physical
!> coordinates keep the order of quadratic displacements: D.N. Arnold, D. Boffi, R.S. Falk, Math. Comp. 71 (2002) 909-922;
!> forces of the Cauchy stress of f_bar on the present elements, and the unsymmetric K: E.A. de Souza Neto, D. Peric, M. Dutko,
!> D.R.J. Owen, Int. J. Solids Struct. 33 (1996) 3277-3296; that mixed elements stable by the inf-sup condition may be unstable
!> in tension: F. Auricchio, L. Beirao da Veiga, C. Lovadina, A. Reali, CMAME 199 (2010) 314-323.
module mean_dilatation
  use kinds, only: wp
  implicit none
  private
  public :: dilatation_t, mean_option, mean_word
  public :: find_fields, hidden_change, mean_volumes, share_dilatation, share_pressure, add_mean_matrix

  !> The option of an element that has it, and its place among those of PL8LS.
  character(len=*), parameter :: mean_word = 'MEAN'
  integer, parameter :: mean_option = 1

  !> Fields of the dilatation in an element.
  integer, parameter :: nfield = 3, max_points = 9
  !> Trace of h = (xx, xy, yx, yy, zz), and of a stress xx, yy, xy, zz.
  real(wp), parameter :: trace_h(5) = [1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp]
  real(wp), parameter :: trace_s(4) = [1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp]

  !> An element's volumes on the first geometry, and orthonormal linear fields there, at its points.
  type :: dilatation_t
    integer :: npoint = 0
    real(wp) :: dv(max_points) = 0.0_wp, fields(max_points, nfield) = 0.0_wp
  end type dilatation_t

contains

  !> 1, x and y made orthonormal in the mean over the element.
  pure subroutine find_fields(dv, x, own)
    real(wp), intent(in) :: dv(:)     !! (npoint) [volume]
    real(wp), intent(in) :: x(:, :)   !! (2, npoint) positions of the points [length]
    type(dilatation_t), intent(out) :: own
    integer :: k, l, n

    n = size(dv)
    own%npoint = n
    own%dv(:n) = dv
    do k = 1, nfield
      own%fields(:n, k) = 1
      if (k > 1) own%fields(:n, k) = x(k - 1, :)
      do l = 1, k - 1
        own%fields(:n, k) = own%fields(:n, k) - sum(dv*own%fields(:n, l)*own%fields(:n, k))*own%fields(:n, l)
      end do
      own%fields(:n, k) = own%fields(:n, k)/sqrt(sum(dv*own%fields(:n, k)**2))
    end do
  end subroutine find_fields

  !> Pi: the linear field nearest to values at the points.
  pure function projected(own, values) result(field)
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: values(:)
    real(wp) :: field(size(values))
    integer :: k

    field = 0
    do k = 1, nfield
      associate (shape => own%fields(:own%npoint, k))
        field = field + sum(own%dv(:own%npoint)*shape*values)*shape
      end associate
    end do
  end function projected

  !> tr h - theta: what of a change of volume, given at the points, the projection hides.
  pure function hidden_change(own, dv, change) result(hidden)
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: dv(:)                !! (npoint) present volumes [volume]
    real(wp), intent(in) :: change(:)            !! (npoint) tr h [-]
    real(wp) :: hidden(size(dv))

    associate (first_dv => own%dv(:own%npoint))
      hidden = change - projected(own, change*dv/first_dv)/projected(own, dv/first_dv)
    end associate
  end function hidden_change

  !> Give the points of an element the projected change of volume of the step. It is not `valid` when a volume vanishes.
  pure subroutine share_dilatation(finite, own, dv, f, valid)
    logical, intent(in) :: finite
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: dv(:)        !! (npoint) at the end of the step [volume]
    real(wp), intent(inout) :: f(:, :)   !! (5, npoint) [-]
    logical, intent(out) :: valid
    real(wp), dimension(size(dv)) :: change, before, after
    integer :: p

    valid = .true.
    if (finite) then
      change = (f(1, :)*f(4, :) - f(2, :)*f(3, :))*f(5, :)
      before = projected(own, dv/change/own%dv(:size(dv)))
      after = projected(own, dv/own%dv(:size(dv)))
      valid = all(before > 0 .and. after > 0)
      if (.not. valid) return
      do p = 1, size(dv)
        f(:, p) = f(:, p)*(after(p)/before(p)/change(p))**(1.0_wp/3)
      end do
    else
      change = f(1, :) + f(4, :) + f(5, :)
      f([1, 4, 5], :) = f([1, 4, 5], :) + spread((projected(own, change) - change)/3, 1, 3)
    end if
  end subroutine share_dilatation

  !> Volumes Jm dv0 of the points.
  pure function mean_volumes(own, dv) result(m)
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: dv(:)   !! (npoint) present volumes [volume]
    real(wp) :: m(size(dv))

    associate (first_dv => own%dv(:own%npoint))
      m = projected(own, dv/first_dv)*first_dv
    end associate
  end function mean_volumes

  !> Volumes m for which the pressures of the points count, and the stress s that makes the forces with the volumes dv.
  pure subroutine share_pressure(own, dv, stress, m, shared)
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: dv(:)           !! (npoint) [volume]
    real(wp), intent(in) :: stress(:, :)    !! (4, npoint) [stress]
    real(wp), intent(out) :: m(:)           !! (npoint) [volume]
    real(wp), intent(out) :: shared(:, :)   !! (4, npoint) [stress]
    real(wp) :: pressure(size(dv)), field(size(dv))

    m = mean_volumes(own, dv)
    pressure = matmul(trace_s, stress)/3
    field = projected(own, pressure)
    shared = stress + spread(trace_s, 2, size(dv))*spread(field - pressure, 1, 4)
  end subroutine share_pressure

  !> K of the element. `g` takes the local unknowns to h at each point.
  pure subroutine add_mean_matrix(finite, own, g, dv, m, tangent, geometric, stiffness)
    logical, intent(in) :: finite
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: g(:, :, :)           !! (5, ndof, npoint) [1/length]
    real(wp), intent(in) :: dv(:), m(:)          !! (npoint) [volume]
    real(wp), intent(in) :: tangent(:, :, :)     !! (4, 5, npoint) d stress/d h_bar [stress]
    real(wp), intent(in) :: geometric(:, :, :)   !! (5, 5, npoint) s tr h - s h^T as a matrix on h [stress]
    real(wp), intent(inout) :: stiffness(:, :)   !! (ndof, ndof) [force/length]
    real(wp), dimension(size(g, 2), size(dv)) :: t, theta
    real(wp), dimension(size(g, 2)) :: bar, star, row, column
    real(wp) :: gt(size(g, 2), 5), a(5, 5), q(5), both
    integer :: p, j, k, n

    n = size(dv)
    t = g(1, :, :) + g(4, :, :) + g(5, :, :)
    theta = 0
    do k = 1, nfield
      associate (shape => own%fields(:n, k))
        theta = theta + spread(matmul(t, dv*shape), 2, n)*spread(shape*own%dv(:n)/m, 1, size(t, 1))
      end associate
    end do
    do p = 1, n
      gt = transpose(g(:, :, p))
      a = tangent([1, 3, 3, 2, 4], :, p)*dv(p)
      ! G_bar = G + 1 bar^T, G_star = G + 1 star^T: what the second parts add to G^T a G
      bar = (theta(:, p) - t(:, p))/3
      star = (theta(:, p)*(m(p)/dv(p)) - t(:, p))/3
      row = matmul(gt, matmul(trace_h, a))
      column = matmul(gt, matmul(a, trace_h))
      both = dot_product(trace_h, matmul(a, trace_h))
      if (finite) a = a + dv(p)*geometric(:, :, p)
      do j = 1, size(gt, 1)
        q = matmul(a, g(:, j, p))
        stiffness(:, j) = stiffness(:, j) + q(1)*gt(:, 1) + q(2)*gt(:, 2) + q(3)*gt(:, 3) + q(4)*gt(:, 4) + q(5)*gt(:, 5) &
                          + (row(j) + both*bar(j))*star + bar(j)*column
      end do
    end do
  end subroutine add_mean_matrix

end module mean_dilatation
