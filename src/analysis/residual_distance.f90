!> How far a carried state is from equilibrium, in the norm of energy.
module residual_distance
  use corrections, only: solve_correction
  use elem_body_springs, only: pull_of_springs
  use equations, only: equations_t
  use errors, only: error_t
  use fields, only: displacement_field
  use kinds, only: wp
  use linear_solver, only: return_to_chosen
  use scene, only: scene_t
  use spring_check, only: has_body_springs
  implicit none
  private
  public :: relative_distance, work_of_correction

contains

  !> Twice the elastic energy of the linear correction of a residual: r . K^-1 r. Springs of bodies start without force on a new
  !> mesh and carry what they carried when they are pulled again, which is no error of the stress: what they take of the correction
  !> is taken out of the residual.
  subroutine work_of_correction(scene, equations, residual, work)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: residual(:)   !! (ndof) [residual]
    real(wp), intent(out) :: work         !! per radian when axisymmetric [energy]
    real(wp), dimension(size(residual)) :: correction, rest
    type(error_t), allocatable :: error

    work = 0
    if (.not. any(abs(residual) > 0)) return
    call return_to_chosen(equations%solves(equations%now)%solver)
    call solve_correction(equations, residual, correction, error)
    rest = residual
    if (has_body_springs(scene) .and. .not. allocated(error)) then
      call take_out_springs(scene, equations, correction, rest)
      call solve_correction(equations, rest, correction, error, at_hand=.true.)
    end if
    work = abs(dot_product(rest, correction))
    ! a residual that no linear correction removes counts as the largest; Newton's method then shows more
    if (allocated(error)) work = huge(work)
  end subroutine work_of_correction

  !> Take the forces of springs of bodies along a correction out of a residual.
  subroutine take_out_springs(scene, equations, correction, residual)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:)     !! (ndof) [unknown]
    real(wp), intent(inout) :: residual(:)    !! (ndof) [residual]
    real(wp) :: motion(2, size(scene%mesh%coordinates, 2)), pull(size(scene%mesh%coordinates, 2))
    integer :: g, k, c

    associate (number => equations%dofs%fields(displacement_field)%number)
      motion = 0
      do k = 1, size(motion, 2)
        do c = 1, 2
          if (number(c, k) > 0) motion(c, k) = correction(number(c, k))
        end do
      end do
      do g = 1, size(scene%groups)
        if (.not. scene%groups(g)%is_spring) cycle
        pull = pull_of_springs(scene, scene%groups(g), motion)
        do k = 1, size(pull)
          associate (d => number(scene%groups(g)%direction, k))
            if (d == 0) cycle
            if (equations%solves(equations%now)%equation(d) > 0) residual(d) = residual(d) - pull(k)
          end associate
        end do
      end do
    end associate
  end subroutine take_out_springs

  !> Distance from equilibrium in the norm of energy, as errors of the stress are measured (page on errors; Zienkiewicz and Zhu,
  !> Int. J. Num. Meth. Eng. 24 (1987) 337-357): sqrt(r . K^-1 r/2 over the elastic energy). Unlike a norm of forces it does not
  !> depend on how fine the mesh is, nor on how few nodes carry the load.
  pure function relative_distance(work, energy) result(distance)
    real(wp), intent(in) :: work     !! of work_of_correction [energy]
    real(wp), intent(in) :: energy   !! elastic energy of the state [energy]
    real(wp) :: distance

    distance = 0
    if (work > 0) distance = sqrt(0.5_wp*min(work/max(energy, tiny(energy)), huge(energy)))
  end function relative_distance

end module residual_distance
