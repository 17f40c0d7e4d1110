!> Variables of the state of a point: names, units, and how a remesh may carry each part over.
!> Elements and laws declare their variables here; files and REMDATA read nothing else.
module state_variables
  use kinds, only: wp
  use text, only: string_t
  implicit none
  private
  public :: state_variable_t, state_variable, component_names, find_variable, is_transfer_kind, total_components
  public :: name_of_heat_due, name_of_ratio
  public :: transfer_scalar, transfer_tensor, transfer_fraction, transfer_contact, transfer_recompute

  character(len=*), parameter :: transfer_scalar = 'scalar'
  character(len=*), parameter :: transfer_tensor = 'tensor'
  character(len=*), parameter :: transfer_fraction = 'fraction'
  character(len=*), parameter :: transfer_contact = 'contact'
  !> Name of a variable of bodies that conduct heat: volume at the start of the mesh over that of the same mass at the start of the
  !> scene. REMDATA multiplies it by what the volume has changed on a mesh.
  character(len=*), parameter :: name_of_ratio = 'volume_ratio'
  !> Name of another one: heat per volume at the start of the scene that an operation has left, to be released in the next step.
  character(len=*), parameter :: name_of_heat_due = 'heat_due'
  character(len=*), parameter :: transfer_recompute = 'recompute'

  !> One declared part of the state. Units are words: `stress`, `length`, `-`, ... since decks are free in their units.
  type :: state_variable_t
    character(len=:), allocatable :: name
    character(len=:), allocatable :: unit
    character(len=:), allocatable :: transfer
    !> Number of components: 1, or 4 for a tensor in the order xx, yy, xy, zz.
    integer :: ncomp = 1
    !> First component in the state array of the group.
    integer :: first = 0
    !> Value at the start of a scene.
    real(wp) :: initial = 0.0_wp
    !> Index of the number of a material without which this part of a law's history is not there; 0: always there.
    integer :: needs = 0
    !> Index of another number that asks for it as well; 0: none.
    integer :: or_needs = 0
  end type state_variable_t

contains

  !> A declaration in one line.
  pure function state_variable(name, unit, transfer, ncomp, needs, or_needs) result(variable)
    character(len=*), intent(in) :: name, unit, transfer
    integer, intent(in), optional :: ncomp, needs, or_needs
    type(state_variable_t) :: variable

    variable%name = name
    variable%unit = unit
    variable%transfer = transfer
    if (present(ncomp)) variable%ncomp = ncomp
    if (present(needs)) variable%needs = needs
    if (present(or_needs)) variable%or_needs = or_needs
  end function state_variable

  !> Components of all variables together.
  pure function total_components(variables) result(n)
    type(state_variable_t), intent(in) :: variables(:)   !! (nvariable)
    integer :: n

    n = sum(variables%ncomp)
  end function total_components

  !> Position of a variable in the list, 0 when it is not declared.
  pure function find_variable(variables, name) result(k)
    type(state_variable_t), intent(in) :: variables(:)   !! (nvariable)
    character(len=*), intent(in) :: name
    integer :: k

    do k = 1, size(variables)
      if (variables(k)%name == name) return
    end do
    k = 0
  end function find_variable

  !> Is this one of the kinds of transfer?
  pure function is_transfer_kind(word) result(yes)
    character(len=*), intent(in) :: word
    logical :: yes

    select case (word)
    case (transfer_scalar, transfer_tensor, transfer_fraction, transfer_contact, transfer_recompute)
      yes = .true.
    case default
      yes = .false.
    end select
  end function is_transfer_kind

  !> Names of all components in order: `plastic_strain`, `stress_xx`, `stress_yy`, ...
  pure subroutine component_names(variables, names)
    type(state_variable_t), intent(in) :: variables(:)     !! (nvariable)
    type(string_t), allocatable, intent(out) :: names(:)   !! (ncomponent)
    character(len=2), parameter :: suffix(4) = ['xx', 'yy', 'xy', 'zz']
    integer :: i, c, n

    allocate (names(total_components(variables)))
    n = 0
    do i = 1, size(variables)
      do c = 1, variables(i)%ncomp
        n = n + 1
        names(n)%s = variables(i)%name
        if (variables(i)%ncomp > 1) names(n)%s = variables(i)%name//'_'//suffix(c)
      end do
    end do
  end subroutine component_names

end module state_variables
