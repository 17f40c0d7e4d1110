!> Mean dilatation: the points of an element share few values of the change of volume, so that nothing locks where volume
!> cannot change.
!>
!> The volume ratio J = dv/dv0 of the points, dv0 on the first geometry of the mesh, is projected on fields linear in the
!> first place of the points, in the mean over the element: Jm = Pi J. In a step points see f_bar = f (jm/j)^(1/3), jm and j
!> being the changes of Jm and J; in small strain the strain with the projected trace. The work of the element is the sum of
!> dv0 times that of Jm sigma on h_bar. So a stress counts for the volume m = Jm dv0, and F = sum G^T s dv with
!> s = (m/dv) dev sigma + P 1, P = Pi p: the deviators, and a linear pressure.
!> K is the exact derivative; with d Jm/Jm = theta = Pi (J tr h)/Jm, which is tr h_bar,
!> K = sum G_bar^T (A + sigma tr) G_bar m + sum G^T (-s h^T + P 1 tr) G dv - sum theta p theta^T m, symmetric where the law is.
!> Source: J.C. Simo, R.L. Taylor, K.S. Pister, CMAME 51 (1985) 177-208, where Pi is general; linear fields in physical
!> coordinates keep the order of quadratic displacements: D.N. Arnold, D. Boffi, R.S. Falk, Math. Comp. 71 (2002) 909-922.
module mean_dilatation
  use kinds, only: wp
  implicit none
  private
  public :: dilatation_t, find_fields, share_dilatation, share_pressure, add_mean_matrix

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

  !> Volumes for which the stresses of the points count, and the stress s that makes the forces with the volumes dv.
  pure subroutine share_pressure(own, dv, stress, m, shared)
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: dv(:)           !! (npoint) [volume]
    real(wp), intent(in) :: stress(:, :)    !! (4, npoint) [stress]
    real(wp), intent(out) :: m(:)           !! (npoint) [volume]
    real(wp), intent(out) :: shared(:, :)   !! (4, npoint) [stress]
    real(wp) :: pressure(size(dv)), field(size(dv))
    integer :: p

    associate (first_dv => own%dv(:own%npoint))
      m = projected(own, dv/first_dv)*first_dv
    end associate
    pressure = matmul(trace_s, stress)/3
    field = projected(own, pressure)
    do p = 1, size(dv)
      shared(:, p) = (m(p)/dv(p))*(stress(:, p) - pressure(p)*trace_s) + field(p)*trace_s
    end do
  end subroutine share_pressure

  !> K of the element. `g` takes the local unknowns to h at each point.
  pure subroutine add_mean_matrix(finite, own, g, dv, m, stress, shared, tangent, geometric, stiffness)
    logical, intent(in) :: finite
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: g(:, :, :)           !! (5, ndof, npoint) [1/length]
    real(wp), intent(in) :: dv(:), m(:)          !! (npoint) [volume]
    real(wp), intent(in) :: stress(:, :)         !! (4, npoint) of the law [stress]
    real(wp), intent(in) :: shared(:, :)         !! (4, npoint) that of the forces [stress]
    real(wp), intent(in) :: tangent(:, :, :)     !! (4, 5, npoint) d stress/d h_bar [stress]
    real(wp), intent(in) :: geometric(:, :, :)   !! (5, 5, npoint) s tr h - s h^T as a matrix on h [stress]
    real(wp), intent(inout) :: stiffness(:, :)   !! (ndof, ndof) [force/length]
    real(wp), dimension(size(g, 2), size(dv)) :: t, theta
    real(wp), dimension(size(g, 2)) :: more, row, column
    real(wp) :: gt(size(g, 2), 5), a(5, 5), q(5), pressure, both
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
      a = tangent([1, 3, 3, 2, 4], :, p)
      if (finite) call add_trace(stress(:, p), a)
      a = m(p)*a
      ! G_bar = G + 1 more^T: what the second part adds to G^T a G
      more = (theta(:, p) - t(:, p))/3
      row = matmul(gt, matmul(trace_h, a))
      column = matmul(gt, matmul(a, trace_h))
      both = dot_product(trace_h, matmul(a, trace_h))
      pressure = 0
      if (finite) then
        pressure = m(p)*dot_product(trace_s, stress(:, p))/3
        a = a + dv(p)*geometric(:, :, p)
        call add_trace(dv(p)*(dot_product(trace_s, shared(:, p))/3*trace_s - shared(:, p)), a)
      end if
      do j = 1, size(gt, 1)
        q = matmul(a, g(:, j, p))
        stiffness(:, j) = stiffness(:, j) + q(1)*gt(:, 1) + q(2)*gt(:, 2) + q(3)*gt(:, 3) + q(4)*gt(:, 4) + q(5)*gt(:, 5) &
                          + (row(j) + both*more(j))*more + more(j)*column - pressure*theta(j, p)*theta(:, p)
      end do
    end do
  end subroutine add_mean_matrix

  !> Add stress (xx, yy, xy, zz) times tr h to a matrix on h.
  pure subroutine add_trace(stress, a)
    real(wp), intent(in) :: stress(4)
    real(wp), intent(inout) :: a(5, 5)
    integer :: k

    do k = 1, 5
      a(:, k) = a(:, k) + stress([1, 3, 3, 2, 4])*trace_h(k)
    end do
  end subroutine add_trace

end module mean_dilatation
