!> Materials and single points for the tests of laws and of what is built on them.
module law_cases
  use kinds, only: wp
  use law_api, only: driver_temperature, find_parameter, law_t
  use law_registry, only: list_laws
  use materials, only: material_t
  implicit none
  private
  public :: law_row, elastic_material, plastic_material, plastic_names, contact_material, set_value
  public :: material_of, at_temperatures
  public :: point_t, update_point, tangent_by_differences, von_mises, closed_form_yield
  public :: young, poisson, shear_modulus, step_of_differences, tolerance_of_differences

  !> Steel, in MPa.
  real(wp), parameter :: young = 200000.0_wp, poisson = 0.3_wp
  real(wp), parameter :: shear_modulus = young/(2*(1 + poisson))

  !> Forms of hardening tested, by name.
  character(len=*), parameter :: plastic_names(6) = [character(len=16) :: 'LINEAR', 'VOCE', 'SWIFT', 'TABLE', &
                                                     'TABLE, perfect', 'TABLE, softening']

  !> Step of central differences for a function that changes over strains of 1e-3 (yield): the cube
  !> root of round-off makes truncation and round-off alike, eps**(2/3) = 4e-11 of the stress.
  real(wp), parameter :: step_of_differences = 6.0e-6_wp*1.0e-3_wp
  !> Stresses of strains up to 1 lose 1e3 of those digits (E against the yield stress); one more is slack.
  real(wp), parameter :: tolerance_of_differences = 1.0e-6_wp

  !> What a law answers for one point.
  type :: point_t
    real(wp) :: stress(4) = 0.0_wp, elastic(4) = 0.0_wp, tangent(4, 4) = 0.0_wp
    real(wp), allocatable :: history(:)
    integer :: status = 0
  end type point_t

contains

  !> A law of the registry, by name. The list is made once: it is of some thousand texts.
  function law_row(name) result(row)
    character(len=*), intent(in) :: name
    type(law_t) :: row
    type(law_t), allocatable, save :: laws(:)
    integer :: i

    if (.not. allocated(laws)) call list_laws(laws)
    do i = 1, size(laws)
      if (laws(i)%name == name) row = laws(i)
    end do
  end function law_row

  function elastic_material() result(material)
    type(material_t) :: material

    material%name = 'steel'
    material%law = 'ELA'
    allocate (material%values, source=[young, poisson])
    allocate (material%curve(2, 0))
  end function elastic_material

  !> Steel with the k-th form of hardening (`plastic_names`).
  function plastic_material(k) result(material)
    integer, intent(in) :: k
    type(material_t) :: material
    real(wp), parameter :: linear(2) = [700.0_wp, 300.0_wp]
    real(wp), parameter :: voce(4) = [300.0_wp, 200.0_wp, 12.0_wp, 50.0_wp]
    real(wp), parameter :: swift(3) = [800.0_wp, 0.002_wp, 0.2_wp]

    material%name = 'steel'
    material%law = 'EPLA'
    select case (k)
    case (4)
      allocate (material%curve, source=reshape([0.0_wp, 300.0_wp, 0.1_wp, 450.0_wp, 0.5_wp, 600.0_wp, 1.0_wp, 650.0_wp], [2, 4]))
    case (5)
      allocate (material%curve, source=reshape([0.0_wp, 400.0_wp], [2, 1]))
    case (6)
      allocate (material%curve, source=reshape([0.0_wp, 500.0_wp, 0.05_wp, 450.0_wp, 0.2_wp, 350.0_wp], [2, 3]))
    case default
      allocate (material%curve(2, 0))
    end select
    allocate (material%values, source=[young, poisson, real(min(k, 4), wp), linear, voce, swift, &
                                     real(size(material%curve, 2), wp), spread(0.0_wp, 1, 4)])
  end function plastic_material

  !> A material of any law, by its values.
  function material_of(law, values) result(material)
    character(len=*), intent(in) :: law
    real(wp), intent(in) :: values(:)
    type(material_t) :: material

    material%name = 'any'
    material%law = law
    allocate (material%values, source=values)
    allocate (material%curve(2, 0))
  end function material_of

  !> One material from its numbers at two temperatures.
  function at_temperatures(first, t1, second, t2) result(material)
    type(material_t), intent(in) :: first, second
    real(wp), intent(in) :: t1, t2
    type(material_t) :: material

    material = first
    allocate (material%temperatures, source=[t1, t2])
    allocate (material%values_by_temperature, source=reshape([first%values, second%values], [size(first%values), 2]))
    allocate (material%curves, source=reshape([first%curve, second%curve], [2, size(first%curve, 2), 2]))
  end function at_temperatures

  !> COUL2D with given penalties.
  function contact_material(akp, aktau, phi, cohesion, tau_max) result(material)
    real(wp), intent(in) :: akp, aktau, phi
    real(wp), intent(in), optional :: cohesion, tau_max
    type(material_t) :: material

    material%name = 'rough'
    material%law = 'COUL2D'
    allocate (material%values, source=[0.0_wp, akp, aktau, 0.0_wp, phi, 0.0_wp, huge(1.0_wp), huge(1.0_wp)])
    if (present(cohesion)) material%values(6) = cohesion
    if (present(tau_max)) material%values(7) = tau_max
    allocate (material%curve(2, 0))
  end function contact_material

  !> Change a number of a material by its name on the card.
  subroutine set_value(material, name, value)
    type(material_t), intent(inout) :: material
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value

    material%values(find_parameter(law_row(material%law), name)) = value
  end subroutine set_value

  !> The curves of `plastic_material`, written once more.
  pure function closed_form_yield(k, p) result(sy)
    integer, intent(in) :: k
    real(wp), intent(in) :: p
    real(wp) :: sy

    select case (k)
    case (1)
      sy = 700 + 300*p
    case (2)
      sy = 500 - 200*exp(-12*p) + 50*p
    case (3)
      sy = 800*exp(0.2_wp*log(0.002_wp + p))
    case (4)
      sy = min(300 + 1500*p, 450 + 375*(p - 0.1_wp), 600 + 100*(p - 0.5_wp), 650.0_wp)
    case (5)
      sy = 400
    case default
      sy = max(500 - 1000*p, 450 - 100*(p - 0.05_wp)/0.15_wp, 350.0_wp)
    end select
  end function closed_form_yield

  !> Call a solid law for one point.
  subroutine update_point(row, material, trial, committed, point, dt, temperature)
    type(law_t), intent(in) :: row
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: trial(4), committed(:)
    type(point_t), intent(out) :: point
    real(wp), intent(in), optional :: dt, temperature(2)
    real(wp) :: strain(4, 1), before(size(committed), 1), stress(4, 1), elastic(4, 1), after(size(committed), 1), tangent(4, 4, 1)
    real(wp) :: step, drivers(1, 2, 1)
    integer :: status(1)

    step = 1
    if (present(dt)) step = dt
    drivers = 0
    if (present(temperature)) drivers(driver_temperature, :, 1) = temperature
    strain(:, 1) = trial
    before(:, 1) = committed
    call row%update(material, step, drivers, strain, before, stress, elastic, after, tangent, status)
    point%stress = stress(:, 1)
    point%elastic = elastic(:, 1)
    point%history = after(:, 1)
    point%tangent = tangent(:, :, 1)
    point%status = status(1)
  end subroutine update_point

  !> d stress / d trial strain by central differences.
  subroutine tangent_by_differences(row, material, trial, committed, tangent, dt, temperature)
    type(law_t), intent(in) :: row
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: trial(4), committed(:)
    real(wp), intent(out) :: tangent(4, 4)
    real(wp), intent(in), optional :: dt, temperature(2)
    type(point_t) :: plus, minus
    real(wp) :: forward(4), backward(4)
    integer :: j

    do j = 1, 4
      forward = trial
      forward(j) = forward(j) + step_of_differences
      backward = trial
      backward(j) = backward(j) - step_of_differences
      call update_point(row, material, forward, committed, plus, dt, temperature)
      call update_point(row, material, backward, committed, minus, dt, temperature)
      tangent(:, j) = (plus%stress - minus%stress)/(forward(j) - backward(j))
    end do
  end subroutine tangent_by_differences

  pure function von_mises(s) result(q)
    real(wp), intent(in) :: s(4)
    real(wp) :: q

    q = sqrt(0.5_wp*((s(1) - s(2))**2 + (s(2) - s(4))**2 + (s(4) - s(1))**2) + 3*s(3)**2)
  end function von_mises

end module law_cases
