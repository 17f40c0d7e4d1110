!> JAUMANN: hypoelastic, the elastic strain turns with the material spin and grows by the strain of the step.
!>
!> Mid-step gradient g = d(du)/dx(n+1/2) = 2 (f - 1)(f + 1)^-1 with strain d and spin w, its parts. The rotation of
!> the step is (1 - w/2)^-1 (1 + w/2), in the plane by the angle 2 atan(w/2): exact for a rigid turn. The elastic strain
!> makes the whole turn, the strain of the step, known at mid-step, the second half of it: second order in the step.
!> The small-strain law acts between elastic strain and Cauchy stress; where the history holds tensors it is called in
!> the frame that turns with the step (step_frame). Sources: T.J.R. Hughes, J. Winget,
!> Int. J. Numer. Meth. Eng. 15 (1980) 1862-1867 (rotation, mid-step gradient); J.C. Simo, T.J.R. Hughes,
!> Computational Inelasticity, Springer 1998, ch. 8 (increment carried from mid-step to the end).
module kinematics_jaumann
  use kinds, only: wp
  use kinematics_api, only: first_history, kinematics_t
  use law_api, only: law_not_converged, law_t
  use materials, only: material_t
  use step_frame, only: frame_t, has_tensors, turn_answer, turn_history, turned
  implicit none
  private
  public :: kinematics_jaumann_row

contains

  function kinematics_jaumann_row() result(row)
    type(kinematics_t) :: row

    row%name = 'JAUMANN'
    row%purpose = 'large strain, hypoelastic, Hughes-Winget rotation'
    row%finite = .true.
    row%symmetric = .false.
    row%update => update
  end function kinematics_jaumann_row

  pure subroutine update(law, material, dt, n, nstate, temperature, f, committed, trial, tangent, status)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: temperature(2, n), f(5, n), committed(nstate, n)
    real(wp), intent(out) :: trial(nstate, n), tangent(4, 5, n)
    integer, intent(out) :: status(n)
    real(wp) :: e(4, n), de(4, 5, n), stress(4, n), elastic(4, n), history(nstate - first_history + 1, n), law_tangent(4, 4, n)
    real(wp), parameter :: engineering(4) = [1.0_wp, 1.0_wp, 2.0_wp, 1.0_wp]
    type(frame_t) :: frame(n)
    real(wp) :: fixed(4)
    logical :: no_middle(n), turning
    integer :: i

    turning = has_tensors(law, material)
    do i = 1, n
      ! det(1 + f), zero for half a turn: there is no mid-step
      no_middle(i) = .not. 1 + f(1, i) + f(4, i) + f(1, i)*f(4, i) - f(2, i)*f(3, i) > 0
      if (no_middle(i)) then
        e(:, i) = committed(5:8, i)
        de(:, :, i) = 0
        frame(i) = frame_t(1.0_wp, 0.0_wp, 0.0_wp)
      else
        call carry(f(:, i), committed(5:8, i), e(:, i), de(:, :, i), frame(i))
      end if
      e(:, i) = engineering*e(:, i)
      de(:, :, i) = spread(engineering, 2, 5)*de(:, :, i)
      if (turning) e(:, i) = turned(frame(i), e(:, i), back=.true., shear=2.0_wp)
    end do
    call law%update(material, dt, temperature, e, committed(first_history:, :), stress, elastic, history, law_tangent, status)
    do i = 1, n
      if (turning) then
        fixed = turned(frame(i), e(:, i), shear=2.0_wp)
        call turn_history(law, material, frame(i), history(:, i))
        call turn_answer(frame(i), fixed, de(:, 1:4, i), law_tangent(:, :, i), stress(:, i), elastic(:, i), tangent(:, 1:4, i))
        tangent(:, 5, i) = turned(frame(i), law_tangent(:, 4, i))*de(4, 5, i)
      else
        tangent(:, :, i) = matmul(law_tangent(:, :, i), de(:, :, i))
      end if
      trial(1:4, i) = stress(:, i)
      trial(5:8, i) = elastic(:, i)/engineering
      trial(first_history:, i) = history(:, i)
    end do
    where (no_middle) status = law_not_converged
  end subroutine update

  !> Elastic trial strain at the end of a step without flow, de(4,5), its derivative along df = h f, and the turn of the step.
  pure subroutine carry(f, before, e, de, frame)
    real(wp), intent(in) :: f(5), before(4)
    real(wp), intent(out) :: e(4), de(4, 5)
    type(frame_t), intent(out) :: frame
    type(frame_t) :: half
    real(wp) :: g(2, 2), a(2, 2), b(2, 2), dg(2, 2), mid(4), strain(4), across, det, spin
    real(wp), parameter :: one(2, 2) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])
    integer :: j, row, column

    det = (1 + f(1))*(1 + f(4)) - f(2)*f(3)
    g(:, 1) = [(f(1) - 1)*(1 + f(4)) - f(2)*f(3), 2*f(3)]*(2/det)
    g(:, 2) = [2*f(2), (f(4) - 1)*(1 + f(1)) - f(2)*f(3)]*(2/det)
    across = 2*(f(5) - 1)/(f(5) + 1)
    spin = 0.25_wp*(g(2, 1) - g(1, 2))   ! tangent of half the angle
    half%cosine = 1/sqrt(1 + spin**2)
    half%sine = half%cosine*spin
    mid = turned(half, before)
    strain = mid + [g(1, 1), g(2, 2), 0.5_wp*(g(1, 2) + g(2, 1)), across]
    e = turned(half, strain)
    frame%cosine = half%cosine**2 - half%sine**2
    frame%sine = 2*half%cosine*half%sine

    ! dg = (1 - g/2) h (1 + g/2)
    a = one - 0.5_wp*g
    b = one + 0.5_wp*g
    do j = 1, 4
      row = merge(1, 2, j <= 2)
      column = merge(1, 2, mod(j, 2) == 1)
      dg = spread(a(:, row), 2, 2)*spread(b(column, :), 1, 2)
      half%dangle(j) = 0.25_wp*half%cosine**2*(dg(2, 1) - dg(1, 2))
      de(:, j) = turned(half, half%dangle(j)*turning(mid + strain) &
                        + [dg(1, 1), dg(2, 2), 0.5_wp*(dg(1, 2) + dg(2, 1)), 0.0_wp])
    end do
    frame%dangle = 2*half%dangle
    de(:, 5) = [0.0_wp, 0.0_wp, 0.0_wp, 1 - 0.25_wp*across**2]
  end subroutine carry

  !> Derivative of `turned` by the angle, at no turn.
  pure function turning(t) result(r)
    real(wp), intent(in) :: t(4)
    real(wp) :: r(4)

    r = [-2*t(3), 2*t(3), t(1) - t(2), 0.0_wp]
  end function turning

end module kinematics_jaumann
