!> When a new mesh is refused: limits of the restart on it, and the steps it is on probation for. (Chapter 12 of the thesis: slow
!> convergence and very short steps show that a remesh failed.)
module acceptance
  use kinds, only: wp
  implicit none
  private
  public :: acceptance_t, probation_t
  public :: begin_probation, end_probation, forget_cutbacks, is_first_step, is_on_probation, note_cutback, note_step
  public :: probation_steps, step_ratio

  !> Steps after a remesh that are compared with as many before it.
  integer, parameter :: probation_steps = 5

  !> Limits of the restart, all without units.
  type :: acceptance_t
    !> First residual in the norm of energy, over the stress. That of a sound transfer comes of the error of the stress on the old
    !> mesh, and is about as large (found: 0.001 to 0.37): where half of the stress has to change, the state is lost.
    real(wp) :: first_residual = 0.5_wp
    !> Iterations to equilibrium: about three steps' worth of a hard step.
    integer :: iterations = 40
    !> Change of the force of a die over the largest on any, and of the elastic energy, which goes with the square of forces.
    real(wp) :: force_change = 0.1_wp, energy_change = 0.2_wp
    !> The deck gives the limit of the force; otherwise it is the error of the stress on the old mesh where that is larger.
    logical :: force_is_given = .false.
    !> It gives the limit of the first residual.
    logical :: residual_is_given = .false.
    !> Change of the depth in a die, in the mean of its pressures, over the penetration the deck allows and a thousandth of the side
    !> (found: up to 0.3): above 1 the contour is another one than that which carried the pressures.
    real(wp) :: depth_change = 1.0_wp
    !> Least step on probation over the least before: seven cutbacks in a row are allowed (1/128), an eighth is not. (The first step
    !> returns to the yield surface what was carried past it, and finds the new points of contact; six cutbacks have been found on
    !> meshes that went well.)
    real(wp) :: step_ratio = 0.005_wp
  end type acceptance_t

  !> Lengths that the step strategy stood at: a step shortened to hit a time, or the moment when contact begins, says nothing about
  !> the mesh.
  type :: probation_t
    !> In the last steps accepted, the latest last; 0 before the first [time].
    real(wp) :: recent(probation_steps) = 0.0_wp
    !> Steps still on probation.
    integer :: left = 0
    !> Least length in the steps before the mesh, and since [time].
    real(wp) :: before = 0.0_wp, least = huge(1.0_wp)
  end type probation_t

contains

  !> A new mesh has been accepted by the restart. Where no step was made before there is nothing to compare its steps with.
  pure subroutine begin_probation(probation)
    type(probation_t), intent(inout) :: probation

    probation%before = 0
    probation%least = huge(1.0_wp)
    probation%left = 0
    if (.not. any(probation%recent > 0)) return
    probation%before = minval(probation%recent, mask=probation%recent > 0)
    probation%left = probation_steps
  end subroutine begin_probation

  !> A step was accepted at this length of the strategy.
  pure subroutine note_step(probation, length)
    type(probation_t), intent(inout) :: probation
    real(wp), intent(in) :: length   !! [time]

    probation%recent = [probation%recent(2:), length]
    if (probation%left == 0) return
    probation%least = min(probation%least, length)
    probation%left = probation%left - 1
  end subroutine note_step

  !> A step was cut back to this length.
  pure subroutine note_cutback(probation, length)
    type(probation_t), intent(inout) :: probation
    real(wp), intent(in) :: length   !! [time]

    if (probation%left > 0) probation%least = min(probation%least, length)
  end subroutine note_cutback

  !> Contact has been added that steps failed without: their lengths say nothing of the mesh.
  pure subroutine forget_cutbacks(probation)
    type(probation_t), intent(inout) :: probation

    probation%least = huge(1.0_wp)
  end subroutine forget_cutbacks

  pure subroutine end_probation(probation)
    type(probation_t), intent(inout) :: probation

    probation%left = 0
  end subroutine end_probation

  pure function is_on_probation(probation) result(yes)
    type(probation_t), intent(in) :: probation
    logical :: yes

    yes = probation%left > 0
  end function is_on_probation

  !> No step has been made on the new mesh.
  pure function is_first_step(probation) result(yes)
    type(probation_t), intent(in) :: probation
    logical :: yes

    yes = probation%left == probation_steps
  end function is_first_step

  !> Least length on the new mesh over the least before it; above 1 where steps grow.
  pure function step_ratio(probation) result(ratio)
    type(probation_t), intent(in) :: probation
    real(wp) :: ratio

    ratio = 1
    if (probation%before > 0 .and. probation%least < huge(1.0_wp)) ratio = probation%least/probation%before
  end function step_ratio

end module acceptance
