!> What heating above Ac1 makes within a sub-step.
module reheating
  use austenite_kinetics, only: form_austenite, grow_grains
  use dual_numbers, only: dual_t, operator(*), operator(+), operator(-), operator(/)
  use latent_heat, only: release_latent
  use phase_growth, only: forget_growth
  use phase_state, only: at_coldest, at_grain, at_rate, never_cold
  use phase_tempering, only: forget_tempering
  use kinds, only: wp
  use steels, only: austenite, first_diffusive, last_diffusive, phase_count, steel_t
  implicit none
  private
  public :: heat_up

  !> All is austenite from this fraction on.
  real(wp), parameter :: all_austenite = 0.99_wp

contains

  !> Austenite from all other phases, in proportion, and its grains. Of what is left, tempering goes on.
  pure subroutine heat_up(steel, time, temperature, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, temperature
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]
    type(dual_t), intent(inout) :: heat   !! [MJ/m3]
    type(dual_t) :: formed, left, lost
    integer :: i

    call form_austenite(steel, time, temperature, s(austenite), formed)
    call grow_grains(steel, time, temperature, s(austenite), formed, s(at_grain))
    if (formed%value > 0) then
      left = dual_t()
      do i = 2, phase_count
        left = left + s(i)
      end do
      do i = 2, phase_count
        if (.not. s(i)%value > 0) cycle
        lost = formed*s(i)/left
        s(i) = s(i) - lost
        call release_latent(steel, i, temperature, -lost, heat)
      end do
      s(austenite) = s(austenite) + formed
    end if
    do i = first_diffusive, last_diffusive
      call forget_growth(steel, i, temperature%value, s)
    end do
    s(at_coldest) = dual_t(never_cold)
    ! what forms next has a rate of its own
    if (s(austenite)%value > all_austenite) s(at_rate) = dual_t()
    call forget_tempering(s)
  end subroutine heat_up

end module reheating
