!> Cards of the mechanics of a steel's phases: EXPAND, TRIP, WEIGHT, and the ranges of properties on PHASE.
module steel_mechanics_cards
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use steel_curves, only: read_curve
  use steels, only: expansion_incremental, expansion_total, plasticity_names, prop_alpha, prop_consistency, &
                    prop_content, prop_hardening, prop_hardness, prop_lambda, prop_latent, prop_memory, prop_modulus, &
                    prop_plasticity, prop_poisson, prop_rate, prop_rhoc, prop_rise, prop_saturation, prop_softening, &
                    prop_strain, prop_yield, prop_young, property_names, property_units, steel_t
  use temperature_curves, only: curve_polynomial, curve_table, temperature_curve_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_expansion, read_transformation_plasticity, read_weight, check_range

contains

  !> `EXPAND TOTAL T0` or `EXPAND INCREM`.
  subroutine read_expansion(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: words(2)
    integer :: k

    words(1)%s = 'TOTAL'
    words(2)%s = 'INCREM'
    call cursor%name('TOTAL or INCREM, the form of the strains by temperature and phases', words, k)
    if (k == 0) return
    steel%expansion = merge(expansion_total, expansion_incremental, k == 1)
    if (k == 1) call cursor%real('the temperature of reference', steel%reference, unit='degC')
  end subroutine read_expansion

  !> `TRIP DESALOS|LEBLOND|TANAKA`.
  subroutine read_transformation_plasticity(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: words(size(plasticity_names))
    integer :: k

    do k = 1, size(words)
      words(k)%s = trim(plasticity_names(k))
    end do
    call cursor%name('the form of transformation plasticity', words, k)
    steel%plasticity = k
  end subroutine read_transformation_plasticity

  !> `WEIGHT TABLE z f ...`, from 0 0 to 1 1.
  subroutine read_weight(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    logical :: fits
    integer :: n

    call read_curve(cursor, 'the weight f(z) in the yield stress', steel%weight, abscissa='a fraction')
    if (cursor%failed()) return
    fits = steel%weight%form == curve_table
    if (fits) then
      associate (z => steel%weight%t, f => steel%weight%v)
        n = size(z)
        fits = .not. max(abs(z(1)), abs(f(1)), abs(z(n) - 1), abs(f(n) - 1)) > 0 .and. all(f(2:) >= f(:n - 1))
      end associate
    end if
    if (.not. fits) call cursor%fail('the weight must be a TABLE that grows from 0 0 to 1 1')
  end subroutine read_weight

  !> More than any metal has, by a factor of ten or so: numbers in other units are refused. They are fixed in a file of steels.
  pure function most_of(property) result(most)
    integer, intent(in) :: property
    real(wp) :: most   !! [unit of the property]

    select case (property)
    case (prop_lambda)
      most = 5.0e3_wp
    case (prop_rhoc)
      ! heat of melting within a few kelvin included
      most = 1.0e4_wp
    case (prop_content, prop_latent)
      most = 1.0e6_wp
    case (prop_hardness)
      most = 2.0e4_wp
    case (prop_young)
      most = 1.0e7_wp
    case (prop_yield, prop_saturation)
      most = 1.0e5_wp
    case (prop_modulus)
      most = 1.0e6_wp
    case (prop_alpha)
      most = 1.0e-3_wp
    case (prop_plasticity)
      most = 1.0e-2_wp
    case default
      most = huge(most)
    end select
  end function most_of

  !> A property that has a range must be within it, where it is a number or a table.
  subroutine check_range(cursor, property, curve)
    type(cursor_t), intent(inout) :: cursor
    integer, intent(in) :: property
    type(temperature_curve_t), intent(in) :: curve
    real(wp) :: worst

    if (cursor%failed() .or. curve%form == curve_polynomial) return
    select case (property)
    case (prop_young, prop_yield, prop_consistency)
      worst = minval(curve%v)
      if (.not. worst > 0) call fail('must be above 0')
    case (prop_poisson)
      worst = minval(curve%v)
      if (worst < 0) call fail('must be at least 0')
      worst = maxval(curve%v)
      if (.not. worst < 0.5_wp) call fail('must be below 0.5')
    case (prop_alpha, prop_modulus, prop_plasticity, prop_rise, prop_saturation, prop_hardness, prop_softening)
      worst = minval(curve%v)
      if (worst < 0) call fail('must be at least 0')
    case (prop_rate)
      worst = minval(curve%v)
      if (worst < 0.001_wp) call fail('must be at least 0.001')
      worst = maxval(curve%v)
      if (worst > 1) call fail('must be at most 1')
    case (prop_memory, prop_hardening)
      worst = minval(curve%v)
      if (worst < 0) call fail('must be at least 0')
      worst = maxval(curve%v)
      if (worst > 1) call fail('must be at most 1')
    case (prop_strain)
      worst = maxval(abs(curve%v))
      if (.not. worst < 0.1_wp) call fail('must be below 0.1 in size')
    case (prop_lambda, prop_rhoc)
      worst = minval(curve%v)
      if (.not. worst > 0) call fail('must be above 0')
    end select
    if (cursor%failed()) return
    worst = maxval(abs(curve%v))
    if (worst > most_of(property)) call fail('is in '//trim(property_units(property))//', at most '//to_text(most_of(property)))

  contains

    subroutine fail(what)
      character(len=*), intent(in) :: what

      call cursor%fail(trim(property_names(property))//' '//what//', found '//to_text(worst))
    end subroutine fail

  end subroutine check_range

end module steel_mechanics_cards
