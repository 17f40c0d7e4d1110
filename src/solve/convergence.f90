!> Norms of forces and motions, and what is small against them. No number here has a unit.
module convergence
  use equations, only: equations_t
  use kinds, only: wp
  implicit none
  private
  public :: relative_residual, relative_motion, free_force, pilots_in_equilibrium

  !> Motions below this share of the mesh's size are round-off of coordinates.
  real(wp), parameter :: least_motion = 1.0e-10_wp

  !> A free pilot is in equilibrium when its residual is below this share of the forces that act on it.
  real(wp), parameter :: pilot_tolerance = 1.0e-8_wp

contains

  !> The few unknowns that carry the force of a whole die are held to a norm of their own.
  pure function pilots_in_equilibrium(equations, force_floor, external, residual) result(in_equilibrium)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: force_floor, external(:), residual(:)
    logical :: in_equilibrium
    integer :: k, c, d

    in_equilibrium = .true.
    do k = 1, size(equations%dofs%pilot, 2)
      do c = 1, 3
        d = equations%dofs%pilot(c, k)
        if (d == 0) cycle
        if (equations%dofs%equation(d) == 0) cycle
        in_equilibrium = in_equilibrium .and. abs(residual(d)) &
                         <= max(pilot_tolerance*max(abs(external(d)), equations%magnitude(d)), &
                                force_floor*merge(equations%size, 1.0_wp, equations%dofs%is_angle(d)))
      end do
    end do
  end function pilots_in_equilibrium

  !> Residual of the free unknowns over the largest of external force, reactions and element forces; 0 when it is
  !> round-off. Moments on pilots depend on where the pilot stands: they are no measure of the forces.
  pure function relative_residual(equations, force_floor, external, residual, du) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: force_floor, external(:), residual(:), du(:)
    real(wp) :: norm
    real(wp) :: reference, round_off

    norm = free_force(equations, residual)
    reference = max(force_norm(equations, external), force_norm(equations, residual), force_norm(equations, equations%magnitude))
    round_off = force_floor*max(1.0_wp, force_norm(equations, du)/equations%size)
    if (norm <= round_off) then
      norm = 0
    else if (reference > 0) then
      norm = norm/reference
    end if
  end function relative_residual

  !> Correction over the motion of the step, angles of pilots left out.
  pure function relative_motion(equations, correction, du) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:), du(:)
    real(wp) :: norm

    norm = free_norm(equations, correction, equations%size)/max(force_norm(equations, du), least_motion*equations%size)
  end function relative_motion

  !> Euclidean norm over displacements and forces, without angles and moments.
  pure function force_norm(equations, v) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:)
    real(wp) :: norm

    norm = sqrt(sum(v**2, mask=.not. equations%dofs%is_angle))
  end function force_norm

  !> Norm of forces on the free unknowns; moments count as forces at the distance of the mesh's size.
  pure function free_force(equations, v) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:)
    real(wp) :: norm

    norm = free_norm(equations, v, 1/equations%size)
  end function free_force

  !> Euclidean norm over the free unknowns, those that are angles times `lever`.
  pure function free_norm(equations, v, lever) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:), lever
    real(wp) :: norm
    integer :: d

    norm = 0
    do d = 1, size(v)
      if (equations%dofs%equation(d) > 0) norm = norm + merge(lever*v(d), v(d), equations%dofs%is_angle(d))**2
    end do
    norm = sqrt(norm)
  end function free_norm

end module convergence
