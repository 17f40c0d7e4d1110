!> A steel made ready: numbers that follow from the composition, the temperatures of its sub-steps, and what is missing.
module steel_build
  use avrami, only: fading
  use critical_temperatures, only: andrews_ae1, andrews_ae3, lever_rule_ferrite, li_bs, van_bohemen_ms, van_bohemen_rate
  use kinds, only: wp
  use latent_heat, only: lacks_latent
  use li_kinetics, only: li_power, li_speed, li_table
  use phases_there, only: phases_that_form
  use steels, only: bainite, expansion_none, ferrite, first_diffusive, kinetics_avrami, kinetics_li, kinetics_none, &
                    last_diffusive, martensite, pearlite, phase_count, phase_names, plasticity_none, &
                    prop_plasticity, prop_rise, prop_saturation, property_count, steel_t, unknown_temperature
  use temperature_curves, only: curve_table, is_given, temperature_curve_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: complete_from_composition, use_li, set_nodes, check_steel

  !> Intervals of the table of Li's S (its error is below 1e-9, tests/phases), and of a lever rule's.
  integer, parameter :: li_intervals = 200, lever_intervals = 100
  !> What goes on at any temperature (tempering, growth of grains) is followed in sub-steps between these [degC].
  real(wp), parameter :: coldest = -200.0_wp, hottest = 1600.0_wp

contains

  !> Temperatures and the rate of martensite which the file leaves out, where there is a composition.
  pure subroutine complete_from_composition(steel)
    type(steel_t), intent(inout) :: steel

    if (.not. steel%composition%given) return
    if (steel%ae1 <= unknown_temperature) steel%ae1 = andrews_ae1(steel%composition)
    if (steel%ae3 <= unknown_temperature) steel%ae3 = andrews_ae3(steel%composition)
    if (steel%bs <= unknown_temperature) steel%bs = li_bs(steel%composition)
    if (steel%ms <= unknown_temperature) steel%ms = van_bohemen_ms(steel%composition)
    if (.not. steel%beta > 0) steel%beta = van_bohemen_rate(steel%composition)
  end subroutine complete_from_composition

  !> Li's kinetics for the phases that have none of their own: ferrite from Ae3 and pearlite from Ae1 down to Bs, bainite from there
  !> to Ms.
  subroutine use_li(steel)
    type(steel_t), intent(inout) :: steel
    real(wp) :: t
    integer :: i, k

    call li_table(li_intervals, steel%li_sum, steel%li_slope)
    do i = first_diffusive, last_diffusive
      associate (kinetics => steel%kinetics(i))
        if (kinetics%kind /= kinetics_none) cycle
        kinetics%kind = kinetics_li
        kinetics%speed = li_speed(i, steel%composition, steel%grain_number)
        kinetics%power = li_power(i)
        select case (i)
        case (ferrite)
          kinetics%low = steel%bs
          kinetics%high = steel%ae3
        case (pearlite)
          kinetics%low = steel%bs
          kinetics%high = steel%ae1
        case (bainite)
          kinetics%low = steel%ms
          kinetics%high = steel%bs
        end select
      end associate
    end do
    associate (limit => steel%kinetics(ferrite)%limit, low => steel%kinetics(ferrite)%low, high => steel%kinetics(ferrite)%high)
      if (steel%kinetics(ferrite)%kind /= kinetics_li .or. low >= high) return
      limit%form = curve_table
      allocate (limit%t(lever_intervals + 1), limit%v(lever_intervals + 1))
      do k = 0, lever_intervals
        t = low + k*(high - low)/lever_intervals
        limit%t(k + 1) = t
        limit%v(k + 1) = lever_rule_ferrite(steel%composition, steel%ae3, t)
      end do
    end associate
  end subroutine use_li

  !> Temperatures at which sub-steps end: multiples of their width over the range of all data, and where data begin, end or bend.
  !> Tempering goes on beyond that range, and grains grow above it.
  subroutine set_nodes(steel)
    type(steel_t), intent(inout) :: steel
    real(wp), allocatable :: breaks(:), grid(:)
    real(wp) :: low, high
    integer :: i, j, k, first, last
    logical :: tempers

    allocate (breaks, source=[steel%ae1, steel%ae3, steel%ac1, steel%ac3, steel%bs, steel%ms])
    do i = first_diffusive, last_diffusive
      associate (kinetics => steel%kinetics(i))
        if (kinetics%kind == kinetics_none) cycle
        breaks = [breaks, kinetics%low, kinetics%high]
        if (kinetics%kind == kinetics_avrami) breaks = [breaks, kinetics%high - fading]
        call add_table(kinetics%start)
        call add_table(kinetics%finish)
        call add_table(kinetics%log_rate)
        call add_table(kinetics%exponent)
        if (kinetics%kind /= kinetics_li) call add_table(kinetics%limit)
      end associate
    end do
    do i = 1, phase_count
      do j = 1, property_count
        call add_table(steel%properties(j, i))
      end do
    end do
    if (steel%cct%n > 0) breaks = [breaks, steel%cct%hottest, steel%cct%coldest]
    breaks = pack(breaks, breaks > unknown_temperature)
    tempers = any(steel%temper_rate > 0)
    if (size(breaks) == 0 .and. tempers) breaks = [coldest]
    if (size(breaks) == 0) then   ! nothing changes at any temperature
      allocate (steel%nodes(0))
      return
    end if
    call sort(breaks)
    breaks = pack(breaks, [.true., breaks(2:) > breaks(:size(breaks) - 1)])
    low = breaks(1)
    high = breaks(size(breaks))
    steel%data_end = high
    if (tempers) low = min(low, coldest)
    if (tempers .or. steel%lambda0 > 0) high = max(high, hottest)
    first = -ceiling((breaks(1) - low)/steel%substep)
    last = ceiling((high - breaks(1))/steel%substep)
    ! those that are nearer to a break than a hundredth of their distance are left out, never the breaks
    grid = [(breaks(1) + k*steel%substep, k=first, last)]
    grid = pack(grid, [(minval(abs(grid(k) - breaks)) > 0.01_wp*steel%substep, k=1, size(grid))])
    steel%nodes = [breaks, grid]
    call sort(steel%nodes)

  contains

    subroutine add_table(curve)
      type(temperature_curve_t), intent(in) :: curve

      if (curve%form == curve_table) breaks = [breaks, curve%t]
    end subroutine add_table

  end subroutine set_nodes

  !> Ascending, by insertion.
  pure subroutine sort(x)
    real(wp), intent(inout) :: x(:)
    real(wp) :: one
    integer :: i, j

    do i = 2, size(x)
      one = x(i)
      do j = i - 1, 1, -1
        if (x(j) <= one) exit
        x(j + 1) = x(j)
      end do
      x(j + 1) = one
    end do
  end subroutine sort

  !> What does not go together, a line each.
  pure subroutine check_steel(steel, problems)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem)
    logical, parameter :: not_austenite(phase_count) = [.false., .true., .true., .true., .true., .true.]
    integer :: i

    allocate (problems(0))
    if (steel%ms > unknown_temperature .and. .not. steel%beta > 0) &
      call add_text(problems, 'MS is given without MARTEN BETA, the rate of martensite')
    if (steel%beta > 0 .and. .not. steel%ms > unknown_temperature) &
      call add_text(problems, 'MARTEN needs MS, on the card TEMPS or from COMPO')
    if (steel%tau1 > 0 .and. .not. (steel%ac1 > unknown_temperature .and. steel%ac3 > unknown_temperature)) &
      call add_text(problems, 'AUSTEN needs AC1 and AC3 on the card TEMPS')
    if (steel%lambda0 > 0 .and. .not. steel%ac1 > unknown_temperature) &
      call add_text(problems, 'GRAIN with LAMBDA needs AC1 on the card TEMPS')
    if (steel%ac1 > unknown_temperature .and. steel%ac3 > unknown_temperature .and. .not. steel%ac3 > steel%ac1) &
      call add_text(problems, 'AC3 must be above AC1')
    if (steel%ms > unknown_temperature .and. steel%ac1 > unknown_temperature .and. .not. steel%ms < steel%ac1) &
      call add_text(problems, 'MS must be below AC1: what is martensite there would be austenite')
    if (steel%maynier .and. .not. steel%composition%given) &
      call add_text(problems, 'HARDN MAYNIER needs the composition: COMPO')
    if (is_given(steel%tempered_hardness) .and. .not. any(steel%temper_rate > 0)) &
      call add_text(problems, 'TEMPER with HV needs a row MARTENSITE or BAINITE: nothing is tempered')
    if (lacks_latent(steel)) &
      call add_text(problems, 'PHASE TEMPERED needs LATENT: martensite and bainite are tempered, whose LATENT are not ' &
                    //'the same, and become austenite again (AUSTEN)')
    if (any(is_given(steel%properties(prop_rise, :)) .neqv. is_given(steel%properties(prop_saturation, :)))) &
      call add_text(problems, 'QV and BV of a phase go together')
    if (any(is_given(steel%properties(prop_plasticity, :))) .and. steel%plasticity == plasticity_none) &
      call add_text(problems, 'KTP needs a card TRIP, the form of transformation plasticity')
    do i = first_diffusive, last_diffusive
      if (.not. any(abs([steel%isig%shift(:, i), steel%isig%haste(:, i)]) > 0) .or. steel%kinetics(i)%kind /= kinetics_none) cycle
      call add_text(problems, 'ISIG of '//trim(phase_names(i))//' needs its TTT, AVRAMI or LI')
    end do
    if (any(abs(steel%isig%shift(:, martensite)) > 0) .and. .not. steel%ms > unknown_temperature) &
      call add_text(problems, 'ISIG of MARTENSITE needs MS')
    ! what has mechanics may stay as it is
    if (steel%expansion /= expansion_none .and. .not. any(phases_that_form(steel) .and. not_austenite)) return
    if (all(steel%kinetics%kind == kinetics_none) .and. steel%cct%n == 0 .and. .not. steel%ms > unknown_temperature) &
      call add_text(problems, 'the steel has no kinetics: expected TTT, AVRAMI, LI, CCT or MARTEN')
    if (.not. any([steel%ae1, steel%ae3, steel%ac1, steel%ac3, steel%bs, steel%ms] > unknown_temperature) &
        .and. all(steel%kinetics%kind == kinetics_none) .and. steel%cct%n == 0) &
      call add_text(problems, 'the steel has no temperatures: expected TEMPS or COMPO')
  end subroutine check_steel

end module steel_build
