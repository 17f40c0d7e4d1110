!> Temperatures below absolute zero: more heat is taken than there is, as by a flux of the wrong sign or beyond its time. What a run
!> makes of it is no result, and laws of phases have no answer. Where cards say what absolute zero is in the deck the run stops;
!> others are warned of what is below that of any scale. So they are of what is hotter than where any metal boils.
module absolute_cold
  use errors, only: error_t, exit_no_convergence, fail
  use fields, only: field_t, find_field
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use loads, only: by_radiation
  use point_temperatures, only: temperature_field
  use scene, only: role_heat_contact, scene_t
  use solution, only: solution_t, start_fields
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: refuse_absolute_cold, warn_of_absolute_cold, warn_of_vapour

  !> Of freezing water [K].
  real(wp), parameter :: freezing = 273.15_wp
  !> Absolute zero in the scale in which it has the lowest number, degrees Fahrenheit.
  real(wp), parameter :: lowest_of_scales = -459.67_wp
  !> Where tungsten and rhenium boil, the last of all metals, 5930 degC or less (CRC Handbook of Chemistry and Physics), in degrees
  !> Fahrenheit, the scale of the highest numbers.
  real(wp), parameter :: all_boil = 1.1e4_wp
  !> Beside surroundings of 0 K temperatures of second order in the element may be below it by so much [temperature].
  real(wp), parameter :: slack = 1.0_wp

  character(len=*), parameter :: advice = 'more heat is taken than there is: Q of FLUX and HEATS is positive into the body, ' &
                                          //'and acts as long as its LIC says; or ZERO is not that of the deck'

contains

  !> An error where a node is colder than absolute zero. A deck that begins so has been warned of it.
  subroutine refuse_absolute_cold(scene, laws, solution, error)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)           !! (nlaw)
    type(solution_t), intent(in) :: solution     !! with the temperatures at the end of the step
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: words
    type(field_t), allocatable :: at_start(:)
    real(wp) :: zero

    zero = absolute_zero(scene, laws)
    words = colder_than(scene, solution, zero)
    if (len(words) == 0) return
    call start_fields(scene, 0.0_wp, at_start)
    if (.not. minval(at_start(find_field(scene%fields, temperature_field))%value(1, :)) < zero) &
      call fail(error, exit_no_convergence, 'step '//to_text(solution%step)//', time '//to_text(solution%time) &
                //': the temperature falls to '//words//', below absolute zero', advice)
  end subroutine refuse_absolute_cold

  !> A warning where the run ends below absolute zero of any scale.
  subroutine warn_of_absolute_cold(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)
    character(len=:), allocatable :: words

    words = colder_than(scene, solution, lowest_of_scales)
    if (len(words) > 0) &
      call add_text(warnings, 'the temperature is '//words//' at the end, below absolute zero of any scale: '//advice)
  end subroutine warn_of_absolute_cold

  !> A warning where the run has been hotter than where any metal boils.
  subroutine warn_of_vapour(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: hottest
    integer :: f

    f = find_field(scene%fields, temperature_field)
    if (f == 0) return
    if (.not. scene%fields(f)%declared) return
    hottest = maxval(solution%fields(f)%value(1, :))
    if (solution%heat%space_steps > 0) hottest = max(hottest, solution%heat%hottest)
    if (hottest > all_boil) call add_text(warnings, 'the temperature has been up to '//to_text(hottest, 4) &
      //', hotter than where any metal boils: power, flux or work in other units than heat capacities')
  end subroutine warn_of_vapour

  !> The coldest node and its place, nothing where it is no colder than a temperature, or temperatures are not solved for.
  function colder_than(scene, solution, temperature) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: temperature
    character(len=:), allocatable :: words
    integer :: f, node

    words = ''
    f = find_field(scene%fields, temperature_field)
    if (f == 0) return
    if (.not. scene%fields(f)%declared) return
    associate (values => solution%fields(f)%value(1, :))
      node = minloc(values, 1)
      if (values(node) < temperature) &
        words = to_text(values(node), 4)//' at '//to_text(scene%mesh%coordinates(1, node), 4)//' ' &
                //to_text(scene%mesh%coordinates(2, node), 4)
    end associate
  end function colder_than

  !> The lowest temperature that a deck can mean: by ZERO of its steels and of radiation and by TABS, the lowest where they differ;
  !> far below any where it has none of them.
  pure function absolute_zero(scene, laws) result(zero)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    real(wp) :: zero                     !! [temperature]
    integer :: k, p

    zero = huge(zero)
    do k = 1, size(scene%materials)
      associate (values => scene%materials(k)%values, law => laws(scene%materials(k)%law_id))
        p = find_parameter(law, 'ZERO')
        if (law%of_steel .and. p > 0) zero = min(zero, -freezing - values(p))
        p = find_parameter(law, 'TABS')
        if (p > 0) zero = min(zero, -values(p))
      end associate
    end do
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%role == role_heat_contact) then
          if (group%heat_contact%radiation > 0) zero = min(zero, -group%heat_contact%zero - slack)
        else if (group%exchange%kind == by_radiation) then
          zero = min(zero, -group%exchange%zero - slack)
        end if
      end associate
    end do
    if (zero > huge(zero)/2) zero = -huge(zero)
  end function absolute_zero

end module absolute_cold
