!> Tempering of martensite and bainite within a sub-step.
module phase_tempering
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-)
  use kinds, only: wp
  use latent_heat, only: heat_of_tempering
  use phase_state, only: at_hollomon_jaffe, at_tempering
  use steels, only: bainite, martensite, steel_t, tempered
  use tempering, only: add_hollomon_jaffe, join_hollomon_jaffe, make_younger, temper
  implicit none
  private
  public :: temper_phases, forget_tempering

  !> A phase of which austenite has left no more than this has nothing to remember of its tempering.
  real(wp), parameter :: nothing_left = 1.0e-6_wp

contains

  !> Martensite and bainite become tempered; the time counts for P where there is something to temper. What has formed in the
  !> sub-step, and what austenite has taken, is tempered for half of it in the mean: half of what is new joins before, half after.
  pure subroutine temper_phases(steel, time, temperature, before, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, temperature
    type(dual_t), intent(in) :: before(2)   !! martensite and bainite at the start of the sub-step
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]
    type(dual_t), intent(inout) :: heat   !! [MJ/m3]
    integer, parameter :: phases(2) = [martensite, bainite]
    type(dual_t) :: w, gone, half, mean
    integer :: k

    if (to_temper(s) > nothing_left) call add_hollomon_jaffe(steel, time, temperature, s(at_hollomon_jaffe))
    do k = 1, 2
      if (.not. s(phases(k))%value > 0) cycle
      mean = 0.5_wp*(before(k) + s(phases(k)))
      half = mean - before(k)
      call make_younger(steel, k, before(k), half, s(at_tempering + k - 1))
      call temper(steel, k, time, temperature, s(at_tempering + k - 1), w)
      gone = mean*(1.0_wp - exp(-w))
      if (gone%value > s(phases(k))%value) gone = s(phases(k))
      call join_hollomon_jaffe(steel, k, temperature, s(at_tempering + k - 1), s(tempered), gone, s(at_hollomon_jaffe))
      call make_younger(steel, k, mean - gone, half, s(at_tempering + k - 1))
      s(phases(k)) = s(phases(k)) - gone
      s(tempered) = s(tempered) + gone
      heat = heat + heat_of_tempering(steel, phases(k), temperature)*gone
    end do
  end subroutine temper_phases

  !> What austenite has left nothing of remembers no tempering.
  pure subroutine forget_tempering(s)
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]

    if (.not. s(martensite)%value > nothing_left) s(at_tempering) = dual_t()
    if (.not. s(bainite)%value > nothing_left) s(at_tempering + 1) = dual_t()
    if (.not. to_temper(s) > nothing_left) s(at_hollomon_jaffe) = dual_t()
  end subroutine forget_tempering

  !> Fraction that is tempered, or can be.
  pure function to_temper(s) result(fraction)
    type(dual_t), intent(in) :: s(:)
    real(wp) :: fraction

    fraction = s(martensite)%value + s(bainite)%value + s(tempered)%value
  end function to_temper

end module phase_tempering
