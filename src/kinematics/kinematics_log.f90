!> LOG: logarithmic elastic strain, e = ln(b)/2, trial b = f exp(2 e) f^T, stress = tau/J.
!>
!> The small-strain law acts between e and the Kirchhoff stress tau; a rigid rotation changes nothing.
!> J is the elastic volume ratio exp(tr e). Source: A. Cuitino, M. Ortiz, Eng. Comput. 9 (1992) 437-451;
!> J.C. Simo, CMAME 99 (1992) 61-112.
module kinematics_log
  use kinds, only: wp
  use kinematics_api, only: first_history, kinematics_t
  use law_api, only: law_t
  use materials, only: material_t
  use plane_tensors, only: exp_twice, half_log
  implicit none
  private
  public :: kinematics_log_row

contains

  function kinematics_log_row() result(row)
    type(kinematics_t) :: row

    row%name = 'LOG'
    row%purpose = 'large strain, logarithmic elastic strain'
    row%finite = .true.
    row%update => update
  end function kinematics_log_row

  pure subroutine update(law, material, dt, n, nstate, temperature, f, committed, trial, tangent, status)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: temperature(2, n), f(5, n), committed(nstate, n)
    real(wp), intent(out) :: trial(nstate, n), tangent(4, 5, n)
    integer, intent(out) :: status(n)
    real(wp) :: e(4, n), de(4, 5, n), tau(4, n), elastic(4, n), history(nstate - first_history + 1, n), law_tangent(4, 4, n)
    real(wp) :: volume
    integer :: i, j

    do i = 1, n
      call half_log(push_forward(f(:, i), exp_twice(committed(5:8, i))), e(:, i), de(:, :, i))
      e(3, i) = 2*e(3, i)
    end do
    call law%update(material, dt, temperature, e, committed(first_history:, :), tau, elastic, history, law_tangent, status)
    do i = 1, n
      volume = exp(e(1, i) + e(2, i) + e(4, i))
      trial(1:4, i) = tau(:, i)/volume
      trial(5:8, i) = elastic(:, i)*[1.0_wp, 1.0_wp, 0.5_wp, 1.0_wp]
      trial(first_history:, i) = history(:, i)
      do j = 1, 4
        tangent(:, j, i) = (law_tangent(:, 1, i)*de(1, j, i) + law_tangent(:, 2, i)*de(2, j, i) &
                            + law_tangent(:, 3, i)*de(3, j, i))/volume
      end do
      tangent(:, 5, i) = law_tangent(:, 4, i)/volume - trial(1:4, i)
      tangent(:, 1, i) = tangent(:, 1, i) - trial(1:4, i)
      tangent(:, 4, i) = tangent(:, 4, i) - trial(1:4, i)
    end do
  end subroutine update

  !> f b f^T.
  pure function push_forward(f, b) result(c)
    real(wp), intent(in) :: f(5), b(4)
    real(wp) :: c(4)
    real(wp) :: xx, xy, yx, yy

    xx = f(1)*b(1) + f(2)*b(3)
    xy = f(1)*b(3) + f(2)*b(2)
    yx = f(3)*b(1) + f(4)*b(3)
    yy = f(3)*b(3) + f(4)*b(2)
    c = [xx*f(1) + xy*f(2), yx*f(3) + yy*f(4), xx*f(3) + xy*f(4), f(5)*b(4)*f(5)]
  end function push_forward

end module kinematics_log
