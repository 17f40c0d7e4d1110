!> LOG: logarithmic elastic strain, e = ln(b)/2, trial b = f exp(2 e) f^T, stress = tau/J.
!>
!> The small-strain law acts between e and the Kirchhoff stress tau; a rigid rotation changes nothing.
!> J is the elastic volume ratio exp(tr e), without thermal strain. Where the history holds tensors, the law is called in
!> the frame that turns with the step (step_frame). Source: A. Cuitino, M. Ortiz, Eng. Comput. 9 (1992) 437-451;
!> J.C. Simo, CMAME 99 (1992) 61-112.
module kinematics_log
  use kinds, only: wp
  use kinematics_api, only: first_history, kinematics_t
  use law_api, only: law_t, row_of_volume, row_of_work, tangent_rows
  use materials, only: material_t
  use plane_tensors, only: exp_twice, half_log
  use step_frame, only: frame_of_step, frame_t, has_tensors, turn_answer, turn_history, turned
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

  pure subroutine update(law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, by_work)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: dt
    integer, intent(in) :: n, nstate
    real(wp), intent(in) :: drivers(:, :, :), f(5, n), committed(nstate, n)
    real(wp), intent(out) :: trial(nstate, n), tangent(4, 5, n)
    integer, intent(out) :: status(n)
    real(wp), intent(out), optional :: by_work(5, n)
    real(wp) :: e(4, n), de(4, 5, n), tau(4, n), elastic(4, n), history(nstate - first_history + 1, n)
    real(wp), allocatable :: law_tangent(:, :, :)   ! (4 or more, 4, n)
    type(frame_t) :: frame(n)
    real(wp) :: fixed(4, n), less
    logical :: turning, swelling
    integer :: i, j, k

    allocate (law_tangent(tangent_rows(law, material, present(by_work)), 4, n))
    do i = 1, n
      call half_log(push_forward(f(:, i), exp_twice(committed(5:8, i))), e(:, i), de(:, :, i))
      e(3, i) = 2*e(3, i)
    end do
    turning = has_tensors(law, material)
    swelling = tangent_rows(law, material) >= row_of_volume
    if (turning) then
      fixed = e
      do i = 1, n
        frame(i) = frame_of_step(f(:, i))
        e(:, i) = turned(frame(i), e(:, i), back=.true., shear=2.0_wp)
      end do
    end if
    call law%update(material, dt, drivers, e, committed(first_history:, :), tau, elastic, history, law_tangent, status)
    do i = 1, n
      if (turning) then
        call turn_history(law, material, frame(i), history(:, i))
        if (present(by_work)) then
          call turn_answer(frame(i), fixed(:, i), de(:, 1:4, i), law_tangent(:, :, i), tau(:, i), elastic(:, i), &
                           tangent(:, 1:4, i), by_work(:4, i))
        else
          call turn_answer(frame(i), fixed(:, i), de(:, 1:4, i), law_tangent(:, :, i), tau(:, i), elastic(:, i), &
                           tangent(:, 1:4, i))
        end if
        law_tangent(:4, 4, i) = turned(frame(i), law_tangent(:4, 4, i))
      end if
      ! 1/J
      less = exp(-elastic(1, i) - elastic(2, i) - elastic(4, i))
      trial(1:4, i) = tau(:, i)*less
      trial(5:8, i) = [elastic(1, i), elastic(2, i), 0.5_wp*elastic(3, i), elastic(4, i)]
      trial(first_history:, i) = history(:, i)
      if (turning) then
        tangent(:, 1:4, i) = tangent(:, 1:4, i)*less
      else
        if (present(by_work)) by_work(:4, i) = matmul(law_tangent(row_of_work, :3, i), de(:3, 1:4, i))
        do j = 1, 4
          do k = 1, 4
            tangent(k, j, i) = (law_tangent(k, 1, i)*de(1, j, i) + law_tangent(k, 2, i)*de(2, j, i) &
                                + law_tangent(k, 3, i)*de(3, j, i))*less
          end do
        end do
      end if
      tangent(:, 5, i) = law_tangent(:4, 4, i)*less
      if (present(by_work)) by_work(5, i) = law_tangent(row_of_work, 4, i)
      if (swelling) then
        ! the elastic volume depends on the stress
        do j = 1, 4
          tangent(:, j, i) = tangent(:, j, i) - trial(1:4, i)*dot_product(law_tangent(row_of_volume, 1:3, i), de(1:3, j, i))
        end do
        tangent(:, 5, i) = tangent(:, 5, i) - trial(1:4, i)*law_tangent(row_of_volume, 4, i)
        cycle
      end if
      tangent(:, 5, i) = tangent(:, 5, i) - trial(1:4, i)
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
