!> What can be said of the heat of a deck before it runs: torches beside their bodies, dies beside sides, sides cooled twice, sides
!> that radiate below absolute zero, steels without hardness, steels that begin below absolute zero, austenite that is too cold,
!> bodies whose temperature never changes.
module heat_check
  use absolute_zeros, only: judge_zeros
  use contact_outlook, only: gaps_at_rest
  use cycle_heat_check, only: judge_cycle_heat
  use dies, only: is_deformable
  use elem_weld_source, only: source_share
  use fields, only: displacement_field, field_t, find_field
  use hardness_check, only: judge_hardness
  use heat_units, only: judge_heat_units
  use heat_contact_point, only: touching_still
  use isolated_bodies, only: judge_isolated
  use kinds, only: wp
  use kinetics_check, only: judge_kinetics
  use law_api, only: find_parameter, heat_law, law_t
  use loads, only: by_convection, by_radiation, multiplier_at
  use scene, only: group_t, host_of, lacks_mesh, role_heat_contact, scene_t
  use solution, only: start_fields
  use state_variables, only: find_variable
  use sheet_sources, only: judge_sheet_sources
  use steel_numbers, only: judge_steels
  use steel_units, only: judge_units
  use steels, only: unknown_temperature
  use text, only: add => add_text, string_t, to_text
  use torch_units, only: judge_torch_powers
  use vectors, only: length_of
  use weld_sources, only: felt_ahead, name_of_torch, power_in_plane, share_within
  implicit none
  private
  public :: check_exchanges, check_heat

  !> A torch with less of half its ellipse in its bodies is not where it was meant to be, or the mesh too coarse for it.
  real(wp), parameter :: expected_share = 0.9_wp
  !> One that crosses with less of its heat between start and end of the run is cut off.
  real(wp), parameter :: whole_share = 0.99_wp
  !> A side beside a die by less than this share of its length was meant to lie on it.
  real(wp), parameter :: nearly = 0.05_wp
  !> What boils colder cools no parts [K].
  real(wp), parameter :: liquid_nitrogen = 77.0_wp
  !> Absolute zero [degC].
  real(wp), parameter :: absolute_zero = -273.15_wp
  !> Less austenite than that is a mixture that is cold.
  real(wp), parameter :: half = 0.5_wp
  !> Half of a largest value is meant to be half.
  real(wp), parameter :: round_off = 1.0e-9_wp

contains

  !> Lines of the table of places and dies, and warnings, one line each. Torches are not looked at where bodies have contours alone.
  subroutine check_heat(scene, laws, table, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: table(:)      !! (nline)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: g

    call check_exchanges(scene, warnings)
    do g = 1, size(scene%groups)
      call judge_start(scene, laws, g, warnings)
      call judge_radiation(scene, g, warnings)
    end do
    call judge_zeros(scene, laws, warnings)
    call judge_units(scene, laws, warnings)
    call judge_heat_units(scene, laws, warnings)
    if (.not. lacks_mesh(scene)) call judge_isolated(scene, laws, warnings)
    call judge_torch_powers(scene, laws, warnings)
    call judge_kinetics(scene, warnings)
    call judge_steels(scene, warnings)
    call judge_sheet_sources(scene, laws, warnings)
    call judge_hardness(scene, warnings)
    call judge_cycle_heat(scene, laws, warnings)
    if (scene%fields(displacement_field)%declared) return
    do g = 1, size(scene%groups)
      if (scene%groups(g)%role == role_heat_contact) call judge_heat_contact(scene, scene%groups(g), table, warnings)
    end do
  end subroutine check_heat

  !> Of torches and sides: what can be said also of a later operation, whatever it begins with.
  subroutine check_exchanges(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: g

    if (allocated(scene%sources) .and. .not. lacks_mesh(scene)) then
      do g = 1, size(scene%sources)
        call judge_torch(scene, g, warnings)
      end do
    end if
    do g = 1, size(scene%groups)
      call judge_exchange(scene, g, warnings)
    end do
  end subroutine check_exchanges

  !> A body of a steel that begins below absolute zero, or as austenite below Ms: no temperature, or no phases, were given.
  subroutine judge_start(scene, laws, g, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g   !! number of the group
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: coldest, zero
    integer :: f, k, v

    associate (group => scene%groups(g))
      if (group%material == 0) return
      if (.not. allocated(scene%materials(group%material)%steel)) return
      f = find_field(scene%fields, 'temperature')
      v = find_variable(group%variables, 'austenite')
      if (f == 0 .or. v == 0) return
      if (.not. scene%fields(f)%declared .or. scene%fields(f)%given) return
      coldest = scene%fields(f)%initial
      if (allocated(scene%starts)) then
        do k = 1, size(scene%starts)
          if (scene%starts(k)%field /= f) cycle
          if (len(scene%starts(k)%body) > 0 .and. scene%starts(k)%body /= scene%groups(host_of(scene, g))%name) cycle
          coldest = minval(scene%starts(k)%values(pack(group%connectivity, .true.)))
        end do
      end if
      associate (material => scene%materials(group%material), law => laws(scene%materials(group%material)%law_id))
        if (law%kind /= heat_law) return
        zero = material%values(find_parameter(law, 'ZERO'))
        if (coldest + zero < absolute_zero) then
          call add(warnings, group%name//': it begins at '//to_text(coldest, 4)//', which is '//to_text(coldest + zero, 4) &
                   //' degC by ZERO of its law, below absolute zero')
        end if
        if (group%variables(v)%initial < half .and. material%steel%ac3 > unknown_temperature .and. &
            coldest + zero > material%steel%ac3) &
          call add(warnings, group%name//': it begins at '//to_text(coldest, 4)//', above Ac3 of the steel '//material%steel%name &
                   //' ('//to_text(material%steel%ac3, 4)//' degC), and is no austenite: START T, or START PHASES')
        if (group%variables(v)%initial < 1 .or. .not. coldest + zero < material%steel%ms) return
        call add(warnings, group%name//': it begins as austenite at '//to_text(coldest, 4)//', below Ms of the steel ' &
                 //material%steel%name//' ('//to_text(material%steel%ms, 4)//' degC): START T, or START PHASES')
      end associate
    end associate
  end subroutine judge_start

  !> A side, or a face of a sheet, that two cards of convection name, at one time: their exchanges add up.
  subroutine judge_exchange(scene, g, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    type(string_t), allocatable, intent(inout) :: warnings(:)
    integer :: k, s, n

    if (.not. cools(scene%groups(g))) return
    do k = 1, g - 1
      if (.not. cools(scene%groups(k))) cycle
      if (.not. act_together(scene, scene%groups(g)%exchange%multiplier, scene%groups(k)%exchange%multiplier)) cycle
      associate (these => scene%groups(g)%exchange%faces, those => scene%groups(k)%exchange%faces)
        if (any(these .and. those) .and. scene%groups(g)%host == scene%groups(k)%host) &
          call add(warnings, scene%groups(g)%name//' and '//scene%groups(k)%name &
                   //': a face is on both, and has the sum of both exchanges')
        if (any(these .or. those)) cycle
      end associate
      associate (here => scene%groups(g)%connectivity, there => scene%groups(k)%connectivity)
        n = 0
        do s = 1, size(here, 2)
          if (any(there(1, :) == here(1, s) .and. there(3, :) == here(3, s))) n = n + 1
        end do
      end associate
      if (n > 0) call add(warnings, scene%groups(g)%name//' and '//scene%groups(k)%name//': '//to_text(n) &
                          //' sides of elements are on both, and have the sum of both exchanges')
    end do
  end subroutine judge_exchange

  !> A side that radiates and begins below absolute zero: ZERO is not that of its temperatures.
  subroutine judge_radiation(scene, g, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    type(string_t), allocatable, intent(inout) :: warnings(:)
    type(field_t), allocatable :: fields(:)
    real(wp) :: coldest
    integer :: f

    f = find_field(scene%fields, 'temperature')
    associate (group => scene%groups(g))
      if (f == 0 .or. group%exchange%kind /= by_radiation .or. size(group%connectivity) == 0) return
      call start_fields(scene, 0.0_wp, fields)
      coldest = minval(fields(f)%value(1, pack(group%connectivity, .true.)))
      call judge_surroundings(scene, group, warnings)
      if (.not. coldest < -group%exchange%zero) return
      call add(warnings, group%name//': it begins at '//to_text(coldest, 4)//', below absolute zero, '// &
               to_text(-group%exchange%zero, 6)//': ZERO is what makes temperatures absolute')
    end associate
  end subroutine judge_radiation

  !> Surroundings colder than any bath: their temperature is not in kelvin. At absolute zero itself they take up all and send
  !> nothing.
  subroutine judge_surroundings(scene, group, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group   !! sides that radiate
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: coldest

    associate (exchange => group%exchange)
      coldest = exchange%surroundings
      if (exchange%surroundings_multiplier > 0) &
        coldest = coldest*minval(scene%multipliers(exchange%surroundings_multiplier)%value)
      if (.not. (coldest + exchange%zero > 0 .and. coldest + exchange%zero < liquid_nitrogen)) return
      call add(warnings, group%name//': surroundings at '//to_text(coldest, 4)//' are '//to_text(coldest + exchange%zero, 4) &
               //' K by ZERO '//to_text(exchange%zero, 5)//', colder than liquid nitrogen: ZERO is 273.15 for temperatures in degC')
    end associate
  end subroutine judge_surroundings

  !> Two multipliers are above half of their largest values at one time; one alone may be on while the other fades.
  pure function act_together(scene, one, other) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: one, other   !! 0 for one that is always on
    logical :: yes
    real(wp), allocatable :: times(:)
    integer :: i, j

    yes = one == 0 .or. other == 0 .or. one == other
    if (yes) return
    allocate (times, source=[scene%multipliers(one)%time, scene%multipliers(other)%time])
    do i = 1, size(times)
      do j = 1, i
        yes = yes .or. (is_on(one, 0.5_wp*(times(i) + times(j))) .and. is_on(other, 0.5_wp*(times(i) + times(j))))
      end do
    end do

  contains

    pure function is_on(k, time)
      integer, intent(in) :: k
      real(wp), intent(in) :: time
      logical :: is_on

      is_on = 2*abs(multiplier_at(scene%multipliers(k), time)) > maxval(abs(scene%multipliers(k)%value))*(1 + round_off)
    end function is_on
  end function act_together

  pure function cools(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = group%exchange%kind == by_convection .and. group%die == 0
  end function cools

  !> Heat to a die in a scene of heat alone: nothing moves, so what does not pass at the start never does.
  subroutine judge_heat_contact(scene, group, table, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(string_t), allocatable, intent(inout) :: table(:), warnings(:)
    real(wp), allocatable :: gap(:, :), over_side(:, :)
    integer :: closed, beside

    if (lacks_mesh(scene) .and. is_deformable(scene%dies(group%die))) return
    call gaps_at_rest(scene, group, gap, over_side)
    associate (limit => touching_still(group), die => scene%dies(group%die)%name)
      closed = count(over_side <= limit)
      beside = count(over_side > limit .and. over_side < nearly .and. gap > group%heat_contact%reach)
      if (.not. any(gap < huge(1.0_wp))) then
        call add(table, 'heat       '//group%name//': no side faces the die')
        call add(warnings, group%name//': no side faces die '//die//', and no heat passes: a die is walked ' &
                 //'with the part on the left (DIE)')
        return
      end if
      call add(table, 'heat       '//group%name//': '//to_text(closed)//' of '//to_text(size(gap))//' points of sides lie on the ' &
               //'die, least gap '//to_text(max(minval(gap), 0.0_wp), 3))
      if (closed + beside == 0 .and. minval(gap) > group%heat_contact%reach) then
        call add(warnings, group%name//': the least gap to die '//die//' is '//to_text(minval(gap), 3) &
                 //', wider than REACH, and no heat passes')
      else if (beside > 0) then
        call add(warnings, group%name//': '//to_text(beside)//' of '//to_text(size(gap))//' points of sides are beside die '//die &
                 //' by more than '//to_text(100*limit, 2)//' % of a side and beyond REACH: no heat passes there ' &
                 //'(a finer ARC of the die, a finer mesh?)')
      end if
    end associate
  end subroutine judge_heat_contact

  !> A torch whose ellipsoid is not all in its bodies, or that goes far in a step.
  subroutine judge_torch(scene, k, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: k   !! place in the scene's list
    type(string_t), allocatable, intent(inout) :: warnings(:)
    character(len=:), allocatable :: when
    real(wp) :: share, least, time, at, way, axis, begins
    integer :: i, j
    integer, parameter :: parts = 8

    associate (source => scene%sources(k), path => scene%sources(k)%path)
      axis = min(source%front, source%rear)
      ! cards have the clock of the operation
      begins = scene%strategy%begins
      way = 0
      ! steps end where the torch begins to be felt, crosses, and is gone
      if (source%crosses) way = min(source%speed*scene%strategy%largest_step, felt_ahead*axis)
      least = huge(least)
      at = 0
      do i = 1, size(path, 2)
        do j = 1, parts
          time = path(1, i)
          if (i > 1) time = time - (path(1, i) - path(1, i - 1))*real(j - 1, wp)/parts
          time = min(max(time, begins), scene%strategy%end_time)
          if (.not. power_in_plane(source, scene%multipliers, merge(source%crossing_time, time, source%crosses), 1.0_wp) > 0) cycle
          share = source_share(scene, k, time)
          if (share < least) at = time
          least = min(share, least)
        end do
        if (i == 1 .or. source%crosses) cycle
        ! and at the rows of the path
        way = max(way, length_of(path(2:3, i) - path(2:3, i - 1)) &
                  *min(scene%strategy%largest_step/(path(1, i) - path(1, i - 1)), 1.0_wp))
      end do
    end associate
    when = 'at time '//to_text(at - begins, 3)
    if (scene%sources(k)%crosses) when = 'where it crosses'
    if (least < expected_share) call add(warnings, name_of_torch(scene%sources(k), k)//': '//when//' only ' &
      //to_text(100*least, 3)//' % of half its ellipse is found in its bodies, which take all of the power: it ends outside them ' &
      //'(half a weld, of half the power, does), or elements are longer than its semi-axes')
    if (scene%sources(k)%crosses) then
      share = share_within(scene%sources(k), begins, scene%strategy%end_time)
      if (share < whole_share) call add(warnings, name_of_torch(scene%sources(k), k)//': from the start to the end of the ' &
        //trim(merge('operation', 'run      ', scene%operation > 0))//' it leaves '//to_text(100*share, 3) &
        //' % of its heat in the plane: it crosses at time '//to_text(scene%sources(k)%crossing_time - begins, 3) &
        //', too early or too late (CROSS, STOP)')
    end if
    ! with a tolerance steps are as short as the torch asks
    if (way > axis .and. .not. scene%strategy%time_tolerance > 0) call add(warnings, name_of_torch(scene%sources(k), k) &
      //': it goes '//to_text(way/axis, 3)//' times its shorter semi-axis in a step (STRAT): the heat of single steps shows')
  end subroutine judge_torch

end module heat_check
