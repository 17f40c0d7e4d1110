!> The LAW family: what a law declares of itself and the one interface by which elements call it.
!>
!> A law is written for small strains, `stress = law(elastic trial strain, history)`; kinematics
!> (src/kinematics) wrap it into large strains.
!>
!> External drivers of a point are given at the start and at the end of the step: the temperature first, then what
!> the law declares by name (`drivers`): a field of the scene, a state variable of another formulation on the same body, or for
!> contact the `flow_stress` of the body behind the side.
!>
!> Beside its own it hands on what every law needs: the lines of its card, and the interfaces of its procedures.
module law_api
  use law_card, only: law_line, law_line_t, line_choice, line_pairs, line_values, parameter, parameter_t
  use law_interfaces, only: contact_open, contact_slip, contact_stick, driver_temperature, law_bends_i, law_check_i, &
                            law_conduct_i, law_done, law_elastic_i, law_flow_i, law_friction_i, law_not_converged, &
                            law_phases_i, law_release_i, law_slide_i, law_store_i, law_swell_i, law_update_i, row_of_volume, &
                            row_of_work
  use materials, only: has_number, material_t
  use state_variables, only: state_variable_t
  implicit none
  private
  public :: law_t, law_line_t, parameter_t, driver_t
  public :: law_update_i, law_slide_i, law_flow_i, law_check_i, law_elastic_i, law_conduct_i
  public :: law_store_i, law_swell_i, law_release_i, law_friction_i
  public :: parameter, law_line, find_parameter, law_of_material, asks_for, is_complete, is_needed, number_count
  public :: has_symmetric_tangent, tangent_rows
  public :: driver_count, driver_temperature
  public :: row_of_volume, row_of_work
  public :: law_done, law_not_converged
  public :: contact_open, contact_stick, contact_slip
  public :: solid_law, contact_law, heat_law, kind_names
  public :: line_values, line_choice, line_pairs

  !> Kinds of law: for solid elements, for contact elements, for the conduction of heat.
  integer, parameter :: solid_law = 1
  integer, parameter :: contact_law = 2
  integer, parameter :: heat_law = 3
  character(len=7), parameter :: kind_names(3) = ['solids ', 'contact', 'heat   ']

  !> A driver of a law, by name.
  type :: driver_t
    character(len=:), allocatable :: name
    !> Index of the number of a material without which it is not needed, and 0; 0: always.
    integer :: needs = 0
  end type driver_t

  type :: law_t
    character(len=:), allocatable :: name
    !> LAGAMINE's number (ITYPE).
    integer :: number = 0
    integer :: kind = solid_law
    character(len=:), allocatable :: purpose, source
    type(law_line_t), allocatable :: lines(:)
    !> Its card names a steel, on a row STEEL before all others.
    logical :: of_steel = .false.
    !> History of a point beside stress and elastic strain, or beside what contact keeps. What a material does not need comes
    !> last and is left out.
    type(state_variable_t), allocatable :: history(:)
    !> Its drivers after the temperature; not allocated where it has none.
    type(driver_t), allocatable :: drivers(:)
    !> Contact that has begun lasts: it pulls where the gap opens.
    logical :: lasts = .false.
    !> Its tangent is symmetric.
    logical :: symmetric = .true.
    !> It is so also where its numbers depend on the temperature and that is an unknown.
    logical :: symmetric_by_temperature = .true.
    !> Index of the number of a material with which the volume free of stress depends on the stress: the tangent is not symmetric
    !> then and has a fifth row where there is room, d tr(elastic strain)/d trial strain; 0: none. Its history holds no tensors.
    integer :: swells_with = 0
    !> Effects it needs, names separated by blanks (module effects).
    character(len=:), allocatable :: effects
    procedure(law_update_i), nopass, pointer :: update => null()
    procedure(law_slide_i), nopass, pointer :: slide => null()
    !> Not associated for laws of contact whose friction is no share of the pressure.
    procedure(law_friction_i), nopass, pointer :: friction_coefficient => null()
    !> Not associated for laws without flow.
    procedure(law_flow_i), nopass, pointer :: flow_stress => null()
    !> Not associated for laws without isotropic elasticity.
    procedure(law_elastic_i), nopass, pointer :: elastic => null()
    !> Of laws for the conduction of heat.
    procedure(law_conduct_i), nopass, pointer :: conduct => null()
    procedure(law_store_i), nopass, pointer :: store => null()
    !> Not associated where the capacity bends at the temperatures of the card alone.
    procedure(law_bends_i), nopass, pointer :: bends => null()
    procedure(law_swell_i), nopass, pointer :: swell => null()
    !> Heat that a point releases, of laws for the conduction of heat; not associated where there is none.
    procedure(law_release_i), nopass, pointer :: release => null()
    !> Relations between the numbers of a card; not associated where there are none.
    procedure(law_check_i), nopass, pointer :: check => null()
    !> What phases need that are there at the start; not associated where there are none.
    procedure(law_phases_i), nopass, pointer :: check_phases => null()
  end type law_t

contains

  !> Index of a parameter of a line among all values of a material, 0 when unknown.
  !>
  !> Values are laid out line after line; a group of choice lines takes one value for the choice
  !> (1, 2, ...) followed by the parameters of every line of the group.
  pure function find_parameter(law, name, word) result(k)
    type(law_t), intent(in) :: law
    character(len=*), intent(in) :: name
    character(len=*), intent(in), optional :: word
    integer :: k
    integer :: i, p
    logical :: choosing

    k = 0
    choosing = .false.
    do i = 1, size(law%lines)
      if (law%lines(i)%kind == line_choice .and. .not. choosing) k = k + 1
      choosing = law%lines(i)%kind == line_choice
      do p = 1, size(law%lines(i)%parameters)
        k = k + 1
        if (law%lines(i)%parameters(p)%name /= name) cycle
        if (.not. present(word)) return
        if (law%lines(i)%word == word) return
      end do
    end do
    k = 0
  end function find_parameter

  !> Numbers that a card of the law gives: its parameters, and one for each choice among lines.
  pure function number_count(law) result(n)
    type(law_t), intent(in) :: law
    integer :: n, i
    logical :: choosing

    n = 0
    choosing = .false.
    do i = 1, size(law%lines)
      if (law%lines(i)%kind == line_choice .and. .not. choosing) n = n + 1
      choosing = law%lines(i)%kind == line_choice
      n = n + size(law%lines(i)%parameters)
    end do
  end function number_count

  !> A material has all the numbers of its law, and the steel of a law that has one: its card was read without mistakes.
  pure function is_complete(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes

    yes = size(material%values) == number_count(law) .and. (allocated(material%steel) .or. .not. law%of_steel)
  end function is_complete

  !> Drivers of a law, the temperature among them.
  pure function driver_count(law) result(n)
    type(law_t), intent(in) :: law
    integer :: n

    n = 1
    if (allocated(law%drivers)) n = 1 + size(law%drivers)
  end function driver_count

  !> A law needs an effect.
  pure function asks_for(law, effect) result(yes)
    type(law_t), intent(in) :: law
    character(len=*), intent(in) :: effect
    logical :: yes

    yes = index(' '//law%effects//' ', ' '//effect//' ') > 0
  end function asks_for

  !> A law as a material uses it: without the history that its points do not need.
  pure function law_of_material(law, material) result(own)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    type(law_t) :: own
    logical :: there(size(law%history))
    integer :: k

    do k = 1, size(law%history)
      there(k) = is_needed(law%history(k), material)
    end do
    own = law
    deallocate (own%history)
    allocate (own%history, source=pack(law%history, there))
  end function law_of_material

  !> The points of a material have this part of its law's history.
  pure function is_needed(variable, material) result(yes)
    type(state_variable_t), intent(in) :: variable
    type(material_t), intent(in) :: material
    logical :: yes

    yes = variable%needs == 0
    if (.not. yes) yes = has_number(material, variable%needs)
    if (.not. yes .and. variable%or_needs > 0) yes = has_number(material, variable%or_needs)
  end function is_needed

  !> Rows of the tangent of a law with the numbers of a material: 4, with row_of_volume, or with all.
  pure function tangent_rows(law, material, with_work) result(rows)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in), optional :: with_work   !! room for row_of_work
    integer :: rows

    rows = 4
    if (law%swells_with > 0) rows = merge(row_of_volume, 4, has_number(material, law%swells_with))
    if (.not. present(with_work)) return
    if (with_work) rows = row_of_work
  end function tangent_rows

  !> The tangent of a law with the numbers of a material is symmetric.
  pure function has_symmetric_tangent(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes

    yes = law%symmetric .and. (law%symmetric_by_temperature &
                               .or. .not. (allocated(material%temperatures) .or. allocated(material%steel)))
    if (yes) yes = tangent_rows(law, material) == 4
  end function has_symmetric_tangent

end module law_api
