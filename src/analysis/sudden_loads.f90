!> Loads that act at once where a run or an operation begins: no shorter step has less of them.
module sudden_loads
  use history, only: circumference
  use kinds, only: wp
  use loads, only: multiplier_at
  use scene, only: role_side_load, scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: sudden_load_words

contains

  !> The first of them, and what to do, for the advice of a run that ends there; empty where no load is sudden.
  function sudden_load_words(scene, solution, at_release) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: at_release   !! the part is released from an operation; else a first step has failed
    character(len=:), allocatable :: words
    integer :: k

    words = ''
    if (solution%last_step > 0) return
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        call try_load(load%amplitude, load%multiplier, 'the FORCE on die '//scene%dies(load%die)%name, circumference(scene))
      end associate
    end do
    do k = 1, size(scene%forces)
      associate (load => scene%forces(k))
        if (load%multiplier == scene%load_factor%multiplier) cycle
        call try_load(load%amplitude, load%multiplier, 'the FORCE on node '//to_text(scene%mesh%labels(load%node)), 1.0_wp)
      end associate
    end do
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%role /= role_side_load .or. group%brings_heat .or. group%multiplier == scene%load_factor%multiplier) cycle
        call try_load(group%amplitude, group%multiplier, 'the load on '//group%name, 1.0_wp)
      end associate
    end do

  contains

    subroutine try_load(amplitude, multiplier, what, factor)
      real(wp), intent(in) :: amplitude       !! [of the load]
      integer, intent(in) :: multiplier       !! 0 for none
      character(len=*), intent(in) :: what
      real(wp), intent(in) :: factor          !! from the amplitude to what is shown
      real(wp) :: value

      if (words /= '' .or. multiplier == 0) return
      value = amplitude*multiplier_at(scene%multipliers(multiplier), solution%time)
      if (.not. abs(value) > 0) return
      words = what//' acts at once, with '//to_text(factor*abs(value), 5) &
              //trim(merge(' as the part is released         ', ' in the first step however short ', at_release)) &
              //': let its LIC begin at 0; '
    end subroutine try_load
  end function sudden_load_words

end module sudden_loads
