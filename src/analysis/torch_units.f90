!> Power of torches (GOLDAK) that no weld has: the deck's unit of power is another, as the mW of mm N s where W are given.
!>
!> A torch that crosses the plane with the speed v leaves P/v of heat per length, most of it within the half ellipse of its width a
!> and depth b. If all of it stayed there, that would be P/(v rho c pi a b/2) warmer: thousands of K in welds, which melt
!> most of their ellipse, and hundreds in what only anneals.
module torch_units
  use fields, only: find_field
  use kinds, only: pi, wp
  use law_api, only: driver_count, driver_temperature, find_parameter, heat_law, law_t
  use scene, only: host_of, scene_t
  use text, only: add => add_text, string_t, to_text
  use weld_sources, only: name_of_torch
  implicit none
  private
  public :: judge_torch_powers

  !> What torches warm by, were none of it conducted away: more than the first, less than the second [K].
  real(wp), parameter :: least_warmth = 30.0_wp, most_warmth = 1.0e5_wp
  !> Heat capacity of steels [MJ/m3/K].
  real(wp), parameter :: capacity_of_steel = 4.5_wp

contains

  !> Warnings, one line each.
  subroutine judge_torch_powers(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: capacity, power, warmth
    integer :: k

    if (.not. allocated(scene%sources)) return
    do k = 1, size(scene%sources)
      associate (source => scene%sources(k))
        capacity = capacity_of(scene, laws, k)
        if (.not. (source%crosses .and. capacity > 0)) cycle
        power = source%power
        if (source%multiplier > 0) power = power*maxval(scene%multipliers(source%multiplier)%value)
        if (.not. power > 0) cycle
        warmth = source%efficiency*power/source%speed/(capacity*0.5_wp*pi*source%width*source%depth)
        if (warmth > least_warmth .and. warmth < most_warmth) cycle
        call add(warnings, name_of_torch(scene%sources(k), k)//': P reaches '//to_text(power, 4)//', which at the speed ' &
                 //to_text(source%speed, 4)//' warms what its half ellipse crosses by '//to_text(warmth, 3) &
                 //' K if none of it is conducted away, welds by thousands: is P in the unit of power of the deck (mW in mm N s, ' &
                 //'W in m N s)?')
      end associate
    end do
  end subroutine judge_torch_powers

  !> Heat capacity of the bodies that a torch heats; 0 where there is none [energy/volume/temperature].
  function capacity_of(scene, laws, k) result(capacity)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: k             !! place of the torch in the scene's list
    real(wp) :: capacity
    integer :: g, b, f

    capacity = 0
    f = find_field(scene%fields, 'temperature')
    do g = 1, size(scene%groups)
      if (scene%groups(g)%source /= k) cycle
      do b = 1, size(scene%groups)
        if (scene%groups(b)%material == 0 .or. host_of(scene, b) /= host_of(scene, g)) cycle
        associate (material => scene%materials(scene%groups(b)%material), &
                   law => laws(scene%materials(scene%groups(b)%material)%law_id))
          if (law%kind /= heat_law) cycle
          if (law%of_steel) then
            capacity = max(capacity, capacity_of_steel*material%values(find_parameter(law, 'ENERGY')))
          else
            block
              real(wp) :: given(driver_count(law), 1), taken(1), slope(1)

              given = 0
              given(driver_temperature, 1) = scene%fields(f)%initial
              call law%store(material, given, given, taken, slope)
              capacity = max(capacity, slope(1))
            end block
          end if
        end associate
      end do
    end do
  end function capacity_of

end module torch_units
