!> Mean dilatation: all points of an element share one change of volume, so that nothing locks where volume cannot change.
!>
!> In a step the volume v of the element changes by j = v(n+1)/v(n), and the points see f_bar = f (j/det f)^(1/3), in small
!> strain the strain with the mean trace. The work of the element is the sum of V0/J times that of the stress tau on h_bar,
!> V0 being volumes of the first geometry of the mesh: with the shares w = V0/sum V0 the stress sigma of a point counts for
!> the volume m = w v, and F = sum G^T s dv with s = (m/dv) dev sigma + P 1, P = sum w p: the deviator, and one pressure.
!> K is the exact derivative, d tr h_bar = theta = sum dv tr h/v:
!> K = sum G_bar^T (A + sigma tr) G_bar m + sum G^T (-s h^T + P 1 tr) G dv - P v theta theta^T, symmetric where the law is.
!> Source: J.C. Simo, R.L. Taylor, K.S. Pister, CMAME 51 (1985) 177-208; J.C. Nagtegaal, D.M. Parks, J.R. Rice, CMAME 4
!> (1974) 153-177.
module mean_dilatation
  use kinds, only: wp
  implicit none
  private
  public :: share_dilatation, share_pressure, add_mean_matrix

  !> Trace of h = (xx, xy, yx, yy, zz), and of a stress xx, yy, xy, zz.
  real(wp), parameter :: trace_h(5) = [1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, 1.0_wp]
  real(wp), parameter :: trace_s(4) = [1.0_wp, 1.0_wp, 0.0_wp, 1.0_wp]

contains

  !> Give all points of an element the mean change of volume of the step.
  pure subroutine share_dilatation(finite, dv, f)
    logical, intent(in) :: finite
    real(wp), intent(in) :: dv(:)         !! volumes at the end of the step, in small strain those of the start
    real(wp), intent(inout) :: f(:, :)    !! (5, npoint)
    real(wp) :: change(size(dv)), mean
    integer :: p

    if (finite) then
      change = (f(1, :)*f(4, :) - f(2, :)*f(3, :))*f(5, :)
      mean = sum(dv)/sum(dv/change)
      do p = 1, size(dv)
        f(:, p) = f(:, p)*(mean/change(p))**(1.0_wp/3)
      end do
    else
      change = f(1, :) + f(4, :) + f(5, :)
      mean = dot_product(dv, change)/sum(dv)
      f([1, 4, 5], :) = f([1, 4, 5], :) + spread((mean - change)/3, 1, 3)
    end if
  end subroutine share_dilatation

  !> Volumes for which the stresses of the points count, and the stress s that makes the forces with the volumes dv.
  pure subroutine share_pressure(finite, first_dv, dv, stress, m, shared)
    logical, intent(in) :: finite
    real(wp), intent(in) :: first_dv(:)                 !! volumes on the first geometry of the mesh
    real(wp), intent(in) :: dv(:), stress(:, :)         !! (4, npoint)
    real(wp), intent(out) :: m(:), shared(:, :)         !! (npoint), (4, npoint)
    real(wp) :: pressure(size(dv)), mean
    integer :: p

    m = dv
    if (finite) m = first_dv*(sum(dv)/sum(first_dv))
    pressure = matmul(trace_s, stress)/3
    mean = dot_product(m, pressure)/sum(dv)
    do p = 1, size(dv)
      shared(:, p) = (m(p)/dv(p))*(stress(:, p) - pressure(p)*trace_s) + mean*trace_s
    end do
  end subroutine share_pressure

  !> K of the element. `g` takes the local unknowns to h at each point.
  pure subroutine add_mean_matrix(finite, g, dv, m, stress, shared, tangent, geometric, stiffness)
    logical, intent(in) :: finite
    real(wp), intent(in) :: g(:, :, :), dv(:), m(:)              !! (5, ndof, npoint), (npoint), (npoint)
    real(wp), intent(in) :: stress(:, :), shared(:, :)           !! of the law, and that of the forces (4, npoint)
    real(wp), intent(in) :: tangent(:, :, :)                     !! d stress/d h_bar (4, 5, npoint)
    real(wp), intent(in) :: geometric(:, :, :)                   !! s tr h - s h^T as a matrix on h (5, 5, npoint)
    real(wp), intent(inout) :: stiffness(:, :)
    real(wp) :: t(size(g, 2), size(dv)), theta(size(g, 2)), g_bar(5, size(g, 2)), a(5, 5), mean
    integer :: p, k

    do p = 1, size(dv)
      t(:, p) = g(1, :, p) + g(4, :, p) + g(5, :, p)
    end do
    theta = matmul(t, dv)/sum(dv)
    mean = dot_product(dv, matmul(trace_s, shared))/(3*sum(dv))
    do p = 1, size(dv)
      g_bar = g(:, :, p)
      g_bar([1, 4, 5], :) = g_bar([1, 4, 5], :) + spread((theta - t(:, p))/3, 1, 3)
      a = tangent([1, 3, 3, 2, 4], :, p)
      if (finite) then
        do k = 1, 5
          a(:, k) = a(:, k) + stress([1, 3, 3, 2, 4], p)*trace_h(k)
        end do
      end if
      stiffness = stiffness + matmul(transpose(g_bar), matmul(m(p)*a, g_bar))
      if (.not. finite) cycle
      a = geometric(:, :, p)
      do k = 1, 5
        a(:, k) = a(:, k) + (mean*trace_h - shared([1, 3, 3, 2, 4], p))*trace_h(k)
      end do
      stiffness = stiffness + matmul(transpose(g(:, :, p)), matmul(dv(p)*a, g(:, :, p)))
    end do
    if (.not. finite) return
    do k = 1, size(theta)
      stiffness(:, k) = stiffness(:, k) - mean*sum(dv)*theta(k)*theta
    end do
  end subroutine add_mean_matrix

end module mean_dilatation
