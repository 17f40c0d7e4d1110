!> Norms of forces and motions, and what is small against them. No number here has a unit.
module convergence
  use equations, only: equations_t
  use kinds, only: wp
  implicit none
  private
  public :: relative_residual, relative_motion, free_norm

  !> Motions below this share of the mesh's size are round-off of coordinates.
  real(wp), parameter :: least_motion = 1.0e-10_wp

contains

  !> Residual of the free unknowns over the largest of external force, reactions and element forces.
  pure function relative_residual(equations, force_floor, external, residual) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: force_floor, external(:), residual(:)
    real(wp) :: norm
    real(wp) :: reference, reactions

    norm = free_norm(equations, residual)
    reactions = sqrt(max(norm2(residual)**2 - norm**2, 0.0_wp))
    reference = max(norm2(external), reactions, norm2(equations%magnitude), force_floor)
    if (reference > 0) norm = norm/reference
  end function relative_residual

  !> Correction over the motion of the step.
  pure function relative_motion(equations, correction, du) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:), du(:)
    real(wp) :: norm

    norm = free_norm(equations, correction)/max(norm2(du), least_motion*equations%size)
  end function relative_motion

  !> Euclidean norm over the free unknowns.
  pure function free_norm(equations, v) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:)
    real(wp) :: norm
    integer :: d

    norm = 0
    do d = 1, size(v)
      if (equations%dofs%equation(d) > 0) norm = norm + v(d)**2
    end do
    norm = sqrt(norm)
  end function free_norm

end module convergence
