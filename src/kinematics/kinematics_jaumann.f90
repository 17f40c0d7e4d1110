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
  use law_api, only: law_not_converged, law_t, row_of_work, tangent_rows
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
    row%hypoelastic = .true.
    row%update => update
  end function kinematics_jaumann_row

  pure subroutine update(law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, by_work)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: drivers(:, :, :), f(5, n), committed(nstate, n)
    real(wp), intent(out) :: trial(nstate, n), tangent(4, 5, n)
    integer, intent(out) :: status(n)
    real(wp), intent(out), optional :: by_work(5, n)
    real(wp) :: e(4, n), de(4, 5, n), stress(4, n), elastic(4, n), history(nstate - first_history + 1, n)
    real(wp), allocatable :: law_tangent(:, :, :)   ! (4 or more, 4, n)
    real(wp), parameter :: engineering(4) = [1.0_wp, 1.0_wp, 2.0_wp, 1.0_wp]
    type(frame_t) :: frame(n)
    real(wp) :: fixed(4)
    logical :: no_middle(n), turning
    integer :: i, j

    allocate (law_tangent(tangent_rows(law, material, present(by_work)), 4, n))
    turning = has_tensors(law, material)
    do i = 1, n
      ! det(1 + f), zero for half a turn: there is no mid-step
      no_middle(i) = .not. 1 + f(1, i) + f(4, i) + f(1, i)*f(4, i) - f(2, i)*f(3, i) > 0
      if (no_middle(i)) then
        e(:, i) = engineering*committed(5:8, i)
        de(:, :, i) = 0
        frame(i) = frame_t(1.0_wp, 0.0_wp, 0.0_wp)
      else
        call carry(f(:, i), committed(5:8, i), e(:, i), de(:, :, i), frame(i))
      end if
      if (turning) e(:, i) = turned(frame(i), e(:, i), back=.true., shear=2.0_wp)
    end do
    call law%update(material, dt, drivers, e, committed(first_history:, :), stress, elastic, history, law_tangent, status)
    do i = 1, n
      if (turning) then
        fixed = turned(frame(i), e(:, i), shear=2.0_wp)
        call turn_history(law, material, frame(i), history(:, i))
        if (present(by_work)) then
          call turn_answer(frame(i), fixed, de(:, 1:4, i), law_tangent(:, :, i), stress(:, i), elastic(:, i), &
                           tangent(:, 1:4, i), by_work(:4, i))
        else
          call turn_answer(frame(i), fixed, de(:, 1:4, i), law_tangent(:, :, i), stress(:, i), elastic(:, i), tangent(:, 1:4, i))
        end if
        tangent(:, 5, i) = turned(frame(i), law_tangent(:4, 4, i))*de(4, 5, i)
      else
        if (present(by_work)) by_work(:4, i) = matmul(law_tangent(row_of_work, :3, i), de(:3, 1:4, i))
        do j = 1, 4
          tangent(:, j, i) = law_tangent(:4, 1, i)*de(1, j, i) + law_tangent(:4, 2, i)*de(2, j, i) &
                             + law_tangent(:4, 3, i)*de(3, j, i)
        end do
        tangent(:, 5, i) = law_tangent(:4, 4, i)*de(4, 5, i)
      end if
      if (present(by_work)) by_work(5, i) = law_tangent(row_of_work, 4, i)*de(4, 5, i)
      trial(1:4, i) = stress(:, i)
      trial(5:8, i) = elastic(:, i)/engineering
      trial(first_history:, i) = history(:, i)
    end do
    where (no_middle) status = law_not_converged
  end subroutine update

  !> Elastic trial strain at the end of a step without flow, de(4,5), its derivative along df = h f (both with the
  !> engineering shear), and the turn of the step.
  pure subroutine carry(f, before, e, de, frame)
    real(wp), intent(in) :: f(5), before(4)
    real(wp), intent(out) :: e(4), de(4, 5)
    type(frame_t), intent(out) :: frame
    real(wp) :: gxx, gxy, gyx, gyy, across, factor, spin, c, s, mid(3), strain(3), both(3), dspin
    real(wp) :: a(2, 2), b(2, 2)
    integer :: j, row, column

    factor = 2/((1 + f(1))*(1 + f(4)) - f(2)*f(3))
    gxx = ((f(1) - 1)*(1 + f(4)) - f(2)*f(3))*factor
    gxy = 2*f(2)*factor
    gyx = 2*f(3)*factor
    gyy = ((f(4) - 1)*(1 + f(1)) - f(2)*f(3))*factor
    across = 2*(f(5) - 1)/(f(5) + 1)
    ! half the turn has the tangent `spin`, the whole turn the cosine c and the sine s
    spin = 0.25_wp*(gyx - gxy)
    c = (1 - spin**2)/(1 + spin**2)
    s = 2*spin/(1 + spin**2)
    mid = half_turned(c, s, before(1:3))
    strain = mid + [gxx, gyy, 0.5_wp*(gxy + gyx)]
    e(1:3) = half_turned(c, s, strain)*[1, 1, 2]
    e(4) = before(4) + across

    ! dg = (1 - g/2) h (1 + g/2)
    a = 0.5_wp*reshape([2 - gxx, -gyx, -gxy, 2 - gyy], [2, 2])
    b = 0.5_wp*reshape([2 + gxx, gyx, gxy, 2 + gyy], [2, 2])
    both = mid + strain
    do j = 1, 4
      row = (j + 1)/2
      column = 2 - mod(j, 2)
      ! derivative of the angle of half the turn
      dspin = 0.25_wp*(a(2, row)*b(column, 1) - a(1, row)*b(column, 2))/(1 + spin**2)
      frame%dangle(j) = 2*dspin
      de(1:3, j) = half_turned(c, s, dspin*[-2*both(3), 2*both(3), both(1) - both(2)] &
                               + [a(1, row)*b(column, 1), a(2, row)*b(column, 2), &
                                  0.5_wp*(a(1, row)*b(column, 2) + a(2, row)*b(column, 1))])*[1, 1, 2]
      de(4, j) = 0
    end do
    de(:, 5) = [0.0_wp, 0.0_wp, 0.0_wp, 1 - 0.25_wp*across**2]
    frame%cosine = c
    frame%sine = s
  end subroutine carry

  !> A tensor xx, yy, xy turned by half the angle of cosine c and sine s.
  pure function half_turned(c, s, t) result(r)
    real(wp), intent(in) :: c, s, t(3)
    real(wp) :: r(3)
    real(wp) :: mean, q

    mean = 0.5_wp*(t(1) + t(2))
    q = 0.5_wp*(t(1) - t(2))
    r = [mean + c*q - s*t(3), mean - c*q + s*t(3), s*q + c*t(3)]
  end function half_turned

end module kinematics_jaumann
