!> The LAW family: what a law declares of itself and the one interface by which elements call it.
!>
!> A law is written for small strains, `stress = law(elastic trial strain, history)`; kinematics
!> (src/kinematics) wrap it into large strains. Strain and stress have the components xx, yy, xy, zz;
!> in this interface the shear strain is the engineering one (2 eps_xy), so tangents are symmetric
!> for associated laws. A block of points is treated in one call.
!>
!> External drivers of a point are given at the start and at the end of the step: the temperature first, then what
!> the law declares by name (`drivers`): a field of the scene, a state variable of another formulation on the same body, or for
!> contact the `flow_stress` of the body behind the side.
module law_api
  use kinds, only: wp
  use materials, only: has_number, material_t
  use state_variables, only: state_variable_t
  use text, only: string_t
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

  !> Status of a law at a point.
  integer, parameter :: law_done = 0
  integer, parameter :: law_not_converged = 1

  !> Kinds of law: for solid elements, for contact elements, for the conduction of heat.
  integer, parameter :: solid_law = 1
  integer, parameter :: contact_law = 2
  integer, parameter :: heat_law = 3
  character(len=7), parameter :: kind_names(3) = ['solids ', 'contact', 'heat   ']

  !> Contact states of a point.
  integer, parameter :: contact_open = 0
  integer, parameter :: contact_stick = 1
  integer, parameter :: contact_slip = 2

  !> Rows of the tangent of a law for solids below those of the stress, d()/d(trial strain): tr(elastic strain) of laws with
  !> `swells_with`, and the `plastic_work` of those whose history has it.
  integer, parameter :: row_of_volume = 5, row_of_work = 6

  !> The temperature is the first driver of every law.
  integer, parameter :: driver_temperature = 1

  !> One number of a law's card.
  type :: parameter_t
    character(len=:), allocatable :: name, unit, meaning
    !> Allowed range, bounds included unless `strict` (then the lower bound itself is refused).
    real(wp) :: lower = -huge(1.0_wp), upper = huge(1.0_wp)
    logical :: strict = .false.
    !> May be left out (only on lines of name-value pairs); then this value is taken.
    logical :: optional = .false.
    real(wp) :: default = 0.0_wp
    !> Must be a whole number.
    logical :: whole = .false.
    !> Above 0 it turns a part of the law on: at all temperatures of a card, or at none.
    logical :: turns_on = .false.
    !> Grows from each temperature of a card to the next: the card needs temperatures.
    logical :: rises = .false.
    !> Name of another number whose default is 0 where this one is given.
    character(len=:), allocatable :: replaces
  end type parameter_t

  !> A driver of a law, by name.
  type :: driver_t
    character(len=:), allocatable :: name
    !> Index of the number of a material without which it is not needed, and 0; 0: always.
    integer :: needs = 0
  end type driver_t

  !> Kinds of line: values in order; one of several lines chosen by its first word; name-value pairs in any order.
  integer, parameter :: line_values = 1
  integer, parameter :: line_choice = 2
  integer, parameter :: line_pairs = 3

  !> One line of a law's card.
  type :: law_line_t
    integer :: kind = line_values
    !> The word that chooses this line among its neighbours of kind `line_choice`.
    character(len=:), allocatable :: word
    type(parameter_t), allocatable :: parameters(:)
    !> Rows of two numbers follow (a curve), and what these are.
    logical :: curve = .false.
    character(len=:), allocatable :: abscissa, ordinate
  end type law_line_t

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
    !> Index of the number of a material with which the volume free of stress depends on the stress: the tangent is not symmetric
    !> then and has a fifth row where there is room, d tr(elastic strain)/d trial strain; 0: none. Its history holds no tensors.
    integer :: swells_with = 0
    !> It is so also where its numbers depend on the temperature and that is an unknown.
    logical :: symmetric_by_temperature = .true.
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
  end type law_t

  abstract interface
    !> Advance a block of n points from the committed history.
    !>
    !> `trial_strain` is the elastic strain if the step were elastic; on return `elastic_strain` is
    !> what is left of it after flow, `stress` follows from it, `history` is the trial history and
    !> `tangent` = d stress / d trial_strain. Rows of the history beyond the law's own are carried
    !> along. Pure: called by several threads.
    pure subroutine law_update_i(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, &
                                 status)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt                      !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :, :)        !! (ndriver, 2, n) at both ends of it, temperature first [unit of each driver]
      real(wp), intent(in) :: trial_strain(:, :)      !! (4, n) [-]
      real(wp), intent(in) :: committed(:, :)         !! (nhistory, n) [unit of each component]
      real(wp), intent(out) :: stress(:, :)           !! (4, n) [stress]
      real(wp), intent(out) :: elastic_strain(:, :)   !! (4, n) [-]
      real(wp), intent(out) :: history(:, :)          !! (nhistory, n) [unit of each component]
      real(wp), intent(out) :: tangent(:, :, :)       !! (4, 4, n) [stress]; where there is room also row_of_volume, row_of_work
      integer, intent(out) :: status(:)               !! (n) law_done or another answer
    end subroutine law_update_i

    !> Contact law at one point: pressure and friction from penetration and slip.
    !>
    !> Vectors have two tangential components, in the plane and across it (annex 3, eq. 1); `tangent` is
    !> d(pressure, tau)/d(penetration, slip). In zero time (dt = 0, equilibrium restored on a new mesh) the history does not change.
    pure subroutine law_slide_i(material, dt, drivers, penalty, augmentation, penetration, slip, tau_committed, committed, &
                                pressure, tau, history, tangent, status)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt                  !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :)       !! (ndriver, 2) at both ends of the step, temperature first [unit of each driver]
      real(wp), intent(in) :: penalty(2)          !! normal and tangential stiffness [stress/length]
      real(wp), intent(in) :: augmentation        !! multiplier carried from earlier augmentations [stress]
      real(wp), intent(in) :: penetration         !! d > 0 inside the die [length]
      real(wp), intent(in) :: slip(2)             !! relative slip of the step [length]
      real(wp), intent(in) :: tau_committed(2)    !! friction stress at the start of the step [stress]
      real(wp), intent(in) :: committed(:)        !! (nhistory) history at the start of the step [unit of each component]
      real(wp), intent(out) :: pressure, tau(2)   !! [stress]
      real(wp), intent(out) :: history(:)         !! (nhistory) [unit of each component]
      real(wp), intent(out) :: tangent(3, 3)      !! [stress/length]
      integer, intent(out) :: status              !! contact_open, contact_stick or contact_slip
    end subroutine law_slide_i

    !> Von Mises stress at which a point flows in its present state: it bounds the friction on it.
    pure function law_flow_i(material, drivers, history) result(flow)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: drivers(:)   !! (ndriver) as they are now, temperature first [unit of each driver]
      real(wp), intent(in) :: history(:)   !! (nhistory) of the law [unit of each component]
      real(wp) :: flow                     !! [stress]
    end function law_flow_i

    !> Coefficient of friction of a law of contact; `huge` where the limit of friction has other parts, or is 0.
    pure function law_friction_i(material) result(coefficient)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp) :: coefficient   !! [-]
    end function law_friction_i

    !> Isotropic elastic constants at a temperature.
    pure subroutine law_elastic_i(material, temperature, young, poisson)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: temperature
      real(wp), intent(out) :: young, poisson   !! [stress], [-]
    end subroutine law_elastic_i

    !> Conductivity of a block of n points, and its derivatives by the temperature and by the other drivers.
    pure subroutine law_conduct_i(material, drivers, conductivity, slope, by_driver)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: drivers(:, :)      !! (ndriver, n) as they are now, temperature first [unit of each driver]
      real(wp), intent(out) :: conductivity(:)   !! (n) [power/length/temperature]
      real(wp), intent(out) :: slope(:)          !! (n) [power/length/temperature^2]
      !> (ndriver, n) 0 for the temperature [power/length/temperature/unit of each driver]
      real(wp), intent(out), optional :: by_driver(:, :)
    end subroutine law_conduct_i

    !> Heat that a block of n points takes up from one state to another, and its derivative by the temperature at the end.
    pure subroutine law_store_i(material, before, now, taken, capacity)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: before(:, :), now(:, :)   !! (ndriver, n) drivers, temperature first [unit of each driver]
      real(wp), intent(out) :: taken(:)                 !! (n) [energy/length^3] per volume of the start
      real(wp), intent(out) :: capacity(:)              !! (n) [energy/length^3/temperature]
    end subroutine law_store_i

    !> Temperatures at which the heat capacity of `store` bends or jumps, ascending; none where it is a smooth function.
    pure subroutine law_bends_i(material, temperatures)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), allocatable, intent(out) :: temperatures(:)   !! (nbend)
    end subroutine law_bends_i

    !> Heat that a point releases in a step beside what flows, and its derivative by the temperature at the end.
    pure subroutine law_release_i(material, dt, drivers, committed, released, of_work, slope, history, surplus, changes)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt              !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) at both ends of the step, temperature first [unit of each driver]
      real(wp), intent(in) :: committed(:)    !! (nhistory) at the start of the step [unit of each component]
      real(wp), intent(out) :: released       !! [energy/length^3] per volume of the start
      real(wp), intent(out) :: of_work        !! by plastic work, beside it [energy/length^3] per volume that the work is per
      real(wp), intent(out) :: slope          !! [energy/length^3/temperature]
      real(wp), intent(out) :: history(:)     !! (nhistory) [unit of each component]
      !> Part of it that is no source: by how much `store` counts more than the point takes up [energy/length^3].
      real(wp), intent(out), optional :: surplus
      real(wp), intent(out), optional :: changes(:)   !! (nhistory) d(history)/d(temperature at the end)
    end subroutine law_release_i

    !> Heat taken up by a change of volume, per volume and unit of volume strain.
    pure function law_swell_i(material, temperature) result(heat)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: temperature   !! at the start of the step
      real(wp) :: heat   !! [energy/length^3]
    end function law_swell_i

    !> Message on a wrong combination of the numbers of a card, beyond the range of each.
    pure subroutine law_check_i(material, problems)
      import :: material_t, string_t
      type(material_t), intent(in) :: material                  !! at one temperature
      type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem) a line each, none where all is well
    end subroutine law_check_i
  end interface

contains

  !> A parameter in one line; `above` is a lower bound that is itself refused.
  pure function parameter(name, unit, meaning, lower, above, upper, default, whole, turns_on, rises, replaces) result(p)
    character(len=*), intent(in) :: name, unit, meaning
    real(wp), intent(in), optional :: lower, above, upper, default
    logical, intent(in), optional :: whole, turns_on, rises
    character(len=*), intent(in), optional :: replaces
    type(parameter_t) :: p

    p%name = name
    p%unit = unit
    p%meaning = meaning
    if (present(lower)) p%lower = lower
    if (present(above)) then
      p%lower = above
      p%strict = .true.
    end if
    if (present(upper)) p%upper = upper
    if (present(default)) then
      p%optional = .true.
      p%default = default
    end if
    if (present(whole)) p%whole = whole
    if (present(turns_on)) p%turns_on = turns_on
    if (present(rises)) p%rises = rises
    p%replaces = ''
    if (present(replaces)) p%replaces = replaces
  end function parameter

  !> A line of a card; with `word` it is one of several to choose from; with the two numbers of a curve its rows follow.
  pure function law_line(parameters, word, pairs, abscissa, ordinate) result(line)
    type(parameter_t), intent(in) :: parameters(:)   !! (nparameter)
    character(len=*), intent(in), optional :: word
    logical, intent(in), optional :: pairs
    character(len=*), intent(in), optional :: abscissa, ordinate
    type(law_line_t) :: line

    allocate (line%parameters, source=parameters)
    line%word = ''
    if (present(word)) then
      line%kind = line_choice
      line%word = word
    end if
    if (present(pairs)) then
      if (pairs) line%kind = line_pairs
    end if
    line%curve = present(abscissa) .and. present(ordinate)
    if (.not. line%curve) return
    line%abscissa = abscissa
    line%ordinate = ordinate
  end function law_line

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
