!> The kinematics family: wraps small-strain laws into large (or small) displacements.
!>
!> State of a point, for every member: Cauchy stress (1:4), elastic strain (5:8; logarithmic for
!> large strains), then the history of the law. Tensors are stored as xx, yy, xy, zz with the
!> tensor shear. Never a total deformation: a new mesh starts from this state.
module kinematics_api
  use kinds, only: wp
  use law_api, only: law_t
  use materials, only: material_t
  use state_variables, only: state_variable, state_variable_t, transfer_tensor
  implicit none
  private
  public :: kinematics_t, kinematics_update_i, solid_variables
  public :: first_stress, first_strain, first_history

  integer, parameter :: first_stress = 1
  integer, parameter :: first_strain = 5
  integer, parameter :: first_history = 9

  type :: kinematics_t
    character(len=:), allocatable :: name, purpose
    !> The geometry follows the displacements, and the geometric matrix is on.
    logical :: finite = .true.
    !> With a law of symmetric tangent the matrix of a solid is symmetric.
    logical :: symmetric = .true.
    !> Stress depends on the way to a motion, even where nothing flows: long ways must be made in short steps.
    logical :: hypoelastic = .false.
    procedure(kinematics_update_i), nopass, pointer :: update => null()
  end type kinematics_t

  abstract interface
    !> Stress of a block of n points from the motion of the step.
    !>
    !> `f` = dx(n+1)/dx(n) with the components xx, xy, yx, yy, zz. `tangent` = d stress / d h with
    !> h = d(du)/dx(n+1) in the same order, the exact derivative of this update. `by_work` may be asked for where the history
    !> of the law has `plastic_work`.
    pure subroutine kinematics_update_i(law, material, dt, n, nstate, drivers, f, committed, trial, tangent, status, by_work)
      import :: law_t, material_t, wp
      type(law_t), intent(in) :: law
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt
      integer, intent(in) :: n, nstate
      real(wp), intent(in) :: drivers(:, :, :)       !! (ndriver, 2, n) of the law at both ends of the step [unit of each driver]
      real(wp), intent(in) :: f(5, n)                !! [-]
      real(wp), intent(in) :: committed(nstate, n)   !! [unit of each component]
      real(wp), intent(out) :: trial(nstate, n)      !! [unit of each component]
      real(wp), intent(out) :: tangent(4, 5, n)      !! [stress]
      integer, intent(out) :: status(n)              !! answers of the law
      real(wp), intent(out), optional :: by_work(5, n)   !! d(plastic work)/dh [stress]
    end subroutine kinematics_update_i
  end interface

contains

  !> State of a solid point made of a law: stress, elastic strain, history, with their components filled in.
  pure subroutine solid_variables(law, variables)
    type(law_t), intent(in) :: law
    type(state_variable_t), allocatable, intent(out) :: variables(:)   !! (nvariable)
    integer :: k, next

    variables = [state_variable('stress', 'stress', transfer_tensor, 4), &
                 state_variable('elastic_strain', '-', transfer_tensor, 4), law%history]
    next = 1
    do k = 1, size(variables)
      variables(k)%first = next
      next = next + variables(k)%ncomp
    end do
  end subroutine solid_variables

end module kinematics_api
