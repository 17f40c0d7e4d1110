!> What forms from austenite within a sub-step.
!>
!> Each phase answers the logarithm w_i by which it alone would divide the austenite; together they divide it by exp(sum w_i) and
!> share what forms in proportion: exact for one phase, order 2 for several. What forms as a fraction of the whole volume is taken
!> from the austenite half before, half after that.
module austenite_decomposition
  use cct_histories, only: cct_increments
  use dual_numbers, only: dual_t, exp, operator(*), operator(+), operator(-), operator(/)
  use kinds, only: wp
  use latent_heat, only: release_latent
  use martensite_kinetics, only: grow_martensite, martensite_start, total_martensite
  use phase_growth, only: forget_growth, forms, grow, limit_growth, match_growth
  use phase_state, only: at_coldest, at_grain, first_growth, first_incubation
  use steels, only: austenite, bainite, ferrite, martensite, pearlite, steel_t
  use stress_kinetics, only: shift_of_phase, stressed_span
  implicit none
  private
  public :: cool_by_histories, transform

  !> Others that divide the austenite by less are as good as none.
  real(wp), parameter :: least_others = 1.0e-8_wp

contains

  !> What the histories of a CCT diagram give down to Ms, as far as there is austenite.
  pure subroutine cool_by_histories(steel, time, from, to, stress, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, from, to, stress(2)
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]
    type(dual_t), intent(inout) :: heat   !! [MJ/m3]
    type(dual_t) :: dz(3), total, ms, finish, share
    integer :: i

    ms = martensite_start(steel, s(ferrite) + s(pearlite) + s(bainite)) + shift_of_phase(steel%isig, martensite, stress)
    if (from%value <= ms%value) return
    finish = to
    share = dual_t(1.0_wp)
    if (to%value < ms%value) then
      finish = ms
      share = (from - ms)/(from - to)
    end if
    call cct_increments(steel%cct, share*time, from, finish, s(at_grain), s(ferrite:bainite), dz)
    total = dual_t()
    do i = 1, 3
      if (dz(i)%value < 0) dz(i) = dual_t()
      total = total + dz(i)
    end do
    if (.not. total%value > 0) return
    do i = 1, 3
      if (total%value > s(austenite)%value) dz(i) = dz(i)*s(austenite)/total
      call release_latent(steel, ferrite + i - 1, 0.5_wp*(from + to), dz(i), heat)
      s(ferrite + i - 1) = s(ferrite + i - 1) + dz(i)
    end do
    if (total%value > s(austenite)%value) total = s(austenite)
    s(austenite) = s(austenite) - total
  end subroutine cool_by_histories

  !> Ferrite, pearlite, bainite and martensite from austenite.
  pure subroutine transform(steel, time, from, to, stress, s, heat)
    type(steel_t), intent(in) :: steel
    type(dual_t), intent(in) :: time, from, to, stress(2, 2)
    type(dual_t), intent(inout) :: s(:)   !! (state_size) [state_units]
    type(dual_t), intent(inout) :: heat   !! [MJ/m3]
    type(dual_t), dimension(ferrite:martensite) :: w, free, volume, dz
    type(dual_t) :: total, total_volume, room, formed, middle, own, span, ms(2), coldest(2), by_diffusion, cold(2)
    integer :: i

    middle = 0.5_wp*(from + to)
    w = dual_t()
    free = dual_t()
    volume = dual_t()
    do i = ferrite, bainite
      own = middle
      span = time
      call stressed_span(steel, i, from, to, stress, own, span)
      if (forms(steel, i, own%value)) then
        call match_growth(steel, i, own, s(i), s(first_growth + i - ferrite))
        call grow(steel, i, span, own, s(first_incubation + i - ferrite), s(first_growth + i - ferrite), w(i), volume(i))
        free(i) = w(i)
        call limit_growth(steel, i, own, 0.5_wp*(to - from), s, w(i), volume(i))
      else if (.not. s(i)%value > 0) then
        ! those beside what has formed stay: it can go on
        call forget_growth(steel, i, own%value, s)
      end if
    end do
    by_diffusion = s(ferrite) + s(pearlite) + s(bainite)
    ms(1) = martensite_start(steel, by_diffusion)
    coldest(1) = s(at_coldest)
    ! a point that begins cold is at its coldest before it is heated
    cold = [from - shift_of_phase(steel%isig, martensite, stress(:, 1)), to - shift_of_phase(steel%isig, martensite, stress(:, 2))]
    if (cold(1)%value < cold(2)%value) cold(2) = cold(1)
    call grow_martensite(steel, by_diffusion, cold(2), s(at_coldest), w(martensite))
    coldest(2) = s(at_coldest)
    call share_with_others(free, w)
    total = sum_of(w)
    total_volume = sum_of(volume)
    if (.not. (total%value + total_volume%value > 0 .and. s(austenite)%value > 0)) return
    if (total_volume%value > 0) then
      ! (z - v/2) exp(-w) - v/2 is not below 0
      room = 2.0_wp*s(austenite)*exp(-total)/(1.0_wp + exp(-total))
      if (total_volume%value > room%value) then
        do i = ferrite, bainite
          volume(i) = volume(i)*(room/total_volume)
        end do
        total_volume = room
      end if
    end if
    formed = (s(austenite) - 0.5_wp*total_volume)*(1.0_wp - exp(-total))
    dz = volume
    do i = ferrite, martensite
      if (w(i)%value > 0) dz(i) = dz(i) + formed*w(i)/total
    end do
    if (steel%martensite_total) then
      ms(2) = martensite_start(steel, by_diffusion + sum_of(dz(:bainite)))
      dz(martensite) = total_martensite(steel, ms, coldest, s(austenite), sum_of(dz(:bainite)))
    end if
    do i = ferrite, martensite
      if (.not. dz(i)%value > 0) cycle
      call release_latent(steel, i, middle, dz(i), heat)
      s(i) = s(i) + dz(i)
    end do
    s(austenite) = s(austenite) - sum_of(dz)
  end subroutine transform

  !> A phase that a largest fraction holds back forms as much beside others as alone, as long as there is austenite for it: w is
  !> over the austenite that is left on the average, the others at work; no more than it would be without the largest fraction.
  pure subroutine share_with_others(free, w)
    type(dual_t), intent(in) :: free(ferrite:)       !! (ferrite:martensite) w without a largest fraction
    type(dual_t), intent(inout) :: w(ferrite:)       !! (ferrite:martensite)
    type(dual_t) :: alone(ferrite:martensite), others
    integer :: i

    alone = w
    do i = ferrite, bainite
      if (.not. (alone(i)%value > 0 .and. alone(i)%value < free(i)%value)) cycle
      others = sum_of(alone) - alone(i)
      if (.not. others%value > least_others) cycle
      w(i) = alone(i)*others/(1.0_wp - exp(-others))
      if (w(i)%value > free(i)%value) w(i) = free(i)
    end do
  end subroutine share_with_others

  pure function sum_of(parts) result(total)
    type(dual_t), intent(in) :: parts(:)   !! (any number)
    type(dual_t) :: total

    total = dual_t(sum(parts%value), sum(parts%slope))
  end function sum_of

end module austenite_decomposition
