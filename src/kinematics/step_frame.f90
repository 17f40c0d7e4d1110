!> The frame that turns with the step, for laws whose history holds tensors.
!>
!> With R the rotation of the step, f = R U, a law is called with R^T e R and the history as it was, and its response
!> is turned forward: for an isotropic law the same as turning the history first, and the tangent needs nothing but the
!> law's own: d tau = R L (R^T (de - W e + e W) R) R^T + W tau - tau W, W = dR R^T.
!> In the plane R turns by the angle atan2(f_yx - f_xy, f_xx + f_yy). In small steps a tensor turns with Jaumann's spin.
module step_frame
  use kinds, only: wp
  use law_api, only: is_needed, law_t, row_of_work
  use materials, only: material_t
  implicit none
  private
  public :: frame_t, frame_of_step, has_tensors, turned, turn_history, turn_answer

  !> Cosine and sine of the rotation, and the derivative of its angle by h = (xx, xy, yx, yy).
  type :: frame_t
    real(wp) :: cosine, sine, dangle(4)
  end type frame_t

contains

  pure function frame_of_step(f) result(frame)
    real(wp), intent(in) :: f(5)   !! components xx, xy, yx, yy, zz [-]
    type(frame_t) :: frame
    real(wp) :: n, d, r2

    n = f(3) - f(2)
    d = f(1) + f(4)
    r2 = n*n + d*d
    frame%cosine = d/sqrt(r2)
    frame%sine = n/sqrt(r2)
    frame%dangle = [-d*f(2) - n*f(1), -d*f(4) - n*f(3), d*f(1) - n*f(2), d*f(3) - n*f(4)]/r2
  end function frame_of_step

  !> The history of points of this material holds tensors.
  pure function has_tensors(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(law%history)
      if (law%history(k)%ncomp == 1) cycle
      yes = is_needed(law%history(k), material)
      if (yes) return
    end do
  end function has_tensors

  !> R t R^T of a tensor xx, yy, xy, zz; `back`: R^T t R. A strain with the engineering shear has `shear` = 2.
  pure function turned(frame, t, back, shear) result(u)
    type(frame_t), intent(in) :: frame
    real(wp), intent(in) :: t(4)   !! [of any unit]
    logical, intent(in), optional :: back
    real(wp), intent(in), optional :: shear
    real(wp) :: u(4)
    real(wp) :: c2, s2, mean, half, xy, scale

    scale = 1
    if (present(shear)) scale = shear
    c2 = frame%cosine**2 - frame%sine**2
    s2 = 2*frame%cosine*frame%sine
    if (present(back)) then
      if (back) s2 = -s2
    end if
    mean = 0.5_wp*(t(1) + t(2))
    half = 0.5_wp*(t(1) - t(2))
    xy = t(3)/scale
    u(1) = mean + c2*half - s2*xy
    u(2) = mean - c2*half + s2*xy
    u(3) = scale*(c2*xy + s2*half)
    u(4) = t(4)
  end function turned

  !> Turn all tensors of a history forward.
  pure subroutine turn_history(law, material, frame, history)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    type(frame_t), intent(in) :: frame
    real(wp), intent(inout) :: history(:)   !! (nhistory) [unit of each component]
    integer :: k, row

    row = 1
    do k = 1, size(law%history)
      if (.not. is_needed(law%history(k), material)) cycle
      if (law%history(k)%ncomp == 4) history(row:row + 3) = turned(frame, history(row:row + 3))
      row = row + law%history(k)%ncomp
    end do
  end subroutine turn_history

  !> Turn a law's response forward; `tangent` becomes d tau / d h (4 components of h) instead of the law's own.
  pure subroutine turn_answer(frame, e, de, law_tangent, tau, elastic, tangent, by_work)
    type(frame_t), intent(in) :: frame
    real(wp), intent(in) :: e(4)                !! trial strain in the fixed frame, engineering shear [-]
    real(wp), intent(in) :: de(4, 4)            !! its derivative by h [-]
    real(wp), intent(in) :: law_tangent(:, :)   !! (4, 4) [stress]; row_of_work where `by_work` is wanted
    real(wp), intent(inout) :: tau(4)           !! [stress]
    real(wp), intent(inout) :: elastic(4)       !! elastic strain with the engineering shear [-]
    real(wp), intent(out) :: tangent(4, 4)      !! [stress]
    real(wp), intent(out), optional :: by_work(4)   !! d(plastic work)/dh [stress]
    real(wp) :: spin_e(4), spin_tau(4), along(4)
    integer :: j

    tau = turned(frame, tau)
    elastic = turned(frame, elastic, shear=2.0_wp)
    spin_e = [-e(3), e(3), 2*(e(1) - e(2)), 0.0_wp]
    spin_tau = [-2*tau(3), 2*tau(3), tau(1) - tau(2), 0.0_wp]
    do j = 1, 4
      along = turned(frame, de(:, j) - frame%dangle(j)*spin_e, back=.true., shear=2.0_wp)
      tangent(:, j) = turned(frame, matmul(law_tangent(:4, :), along)) + frame%dangle(j)*spin_tau
      if (present(by_work)) by_work(j) = dot_product(law_tangent(row_of_work, :), along)
    end do
  end subroutine turn_answer

end module step_frame
