!> Offsets of temperatures of a deck: what makes one absolute is the same on all cards. Radiation has it as ZERO, G'Sell-Jonas as
!> TABS, and a steel has in ZERO what makes it degC, 273.15 less. Where all cards take temperatures for degC, surroundings that
!> would be a room in kelvin, with nothing colder in the deck, say that they are kelvin.
module absolute_zeros
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: find_parameter, law_t
  use loads, only: by_convection, by_radiation
  use scene, only: role_heat_contact, scene_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: judge_zeros

  !> Of freezing water [K].
  real(wp), parameter :: freezing = 273.15_wp
  !> 273 for 273.15 is no mistake [temperature].
  real(wp), parameter :: slack = 1.0_wp
  !> A room, or water from the tap [K]. Salt and air are as hot in degC now and then; something in such a deck is colder than
  !> anything is in kelvin.
  real(wp), parameter :: room(2) = [280.0_wp, 304.0_wp], coldest_of_kelvin = 250.0_wp

contains

  !> A warning where two cards have other temperatures in mind.
  subroutine judge_zeros(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    character(len=:), allocatable :: first
    real(wp) :: zero
    logical :: told
    integer :: k, p, a

    call judge_rooms(scene, laws, warnings)
    told = .false.
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%role == role_heat_contact) then
          if (group%heat_contact%radiation > 0) call compare(group%name, group%heat_contact%zero)
        else if (group%exchange%kind == by_radiation) then
          call compare(group%name, group%exchange%zero)
        end if
      end associate
    end do
    do k = 1, size(scene%materials)
      associate (material => scene%materials(k), law => laws(scene%materials(k)%law_id))
        p = find_parameter(law, 'ZERO')
        if (law%of_steel .and. p > 0) then
          if (abs(material%values(p) - freezing) < slack) &
            call add_text(warnings, 'LAW '//material%name//': with ZERO '//to_text(material%values(p), 5)//' what is 0 in this ' &
                          //'deck is '//to_text(material%values(p), 5)//' degC for the steel: ZERO is what is added to make ' &
                          //'temperatures degC, -273.15 for a deck in kelvin')
          call compare('LAW '//material%name, freezing + material%values(p))
        end if
        p = find_parameter(law, 'TABS')
        a = find_parameter(law, 'A')
        if (p == 0 .or. a == 0) cycle
        ! without A nothing depends on it
        if (material%values(a) > 0) call compare('LAW '//material%name, material%values(p))
      end associate
    end do

  contains

    subroutine compare(name, this)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: this   !! to be added to make a temperature absolute [temperature]

      if (told) return
      if (.not. allocated(first)) then
        first = name
        zero = this
      else if (abs(this - zero) > slack) then
        told = .true.
        call add_text(warnings, 'absolute zero is '//to_text(-zero, 5)//' by '//first//', and '//to_text(-this, 5)//' by '//name &
                      //': ZERO of RADIA and COU2DC, and TABS, make temperatures of the deck absolute, ZERO of a steel makes ' &
                      //'them degC: in kelvin they are 0 and -273.15, in degC 273.15 and 0')
      end if
    end subroutine compare

  end subroutine judge_zeros

  !> A warning where the surroundings are hot by what a card adds to make temperatures degC, and a room in kelvin.
  subroutine judge_rooms(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(string_t), allocatable, intent(inout) :: warnings(:)
    character(len=:), allocatable :: card, should
    real(wp) :: coldest, other
    integer :: g, k, p, f, at

    card = ''
    do g = 1, size(scene%groups)
      associate (exchange => scene%groups(g)%exchange)
        if (exchange%kind == by_radiation .and. abs(exchange%zero - freezing) < slack) then
          card = 'ZERO '//to_text(exchange%zero, 5)//' of '//scene%groups(g)%name
          should = 'ZERO is 0 then, and -273.15 of a steel'
        end if
      end associate
    end do
    do k = 1, size(scene%materials)
      p = find_parameter(laws(scene%materials(k)%law_id), 'ZERO')
      if (.not. laws(scene%materials(k)%law_id)%of_steel .or. p == 0) cycle
      if (abs(scene%materials(k)%values(p)) > slack) cycle
      card = 'ZERO '//to_text(scene%materials(k)%values(p), 5)//' of LAW '//scene%materials(k)%name
      should = 'ZERO of a steel is -273.15 then'
    end do
    f = find_field(scene%fields, 'temperature')
    if (len(card) == 0 .or. f == 0) return
    if (.not. scene%fields(f)%declared) return
    coldest = huge(coldest)
    at = 0
    do g = 1, size(scene%groups)
      associate (exchange => scene%groups(g)%exchange)
        if (all(exchange%kind /= [by_convection, by_radiation])) cycle
        other = exchange%surroundings
        if (exchange%surroundings_multiplier > 0) &
          other = other*minval(scene%multipliers(exchange%surroundings_multiplier)%value)
        if (other < coldest) at = g
        coldest = min(coldest, other)
      end associate
    end do
    if (at == 0 .or. coldest < room(1) .or. coldest > room(2)) return
    other = coldest
    if (allocated(scene%starts)) then
      do k = 1, size(scene%starts)
        if (scene%starts(k)%field == f) other = min(other, minval(scene%starts(k)%values))
      end do
    else
      other = min(other, scene%fields(f)%initial)
    end if
    if (other < coldest_of_kelvin) return
    call add_text(warnings, scene%groups(at)%name//': surroundings at '//to_text(coldest, 4)//' are '//to_text(coldest, 4) &
                  //' degC by '//card//'; where the deck is in kelvin, so that they are '//to_text(coldest - freezing, 3) &
                  //' degC, '//should)
  end subroutine judge_rooms

end module absolute_zeros
