!> Card of the effect of stress on a steel's kinetics: ISIG.
module steel_stress_cards
  use deck_cursor, only: cursor_t
  use steels, only: first_diffusive, martensite, last_diffusive, phase_names, steel_t
  use text, only: string_t
  implicit none
  private
  public :: read_isig

contains

  !> `ISIG`, rows `phase [SHIFT a b] [TIME c d]`.
  subroutine read_isig(cursor, steel)
    type(cursor_t), intent(inout) :: cursor
    type(steel_t), intent(inout) :: steel
    type(string_t) :: phases(martensite - first_diffusive + 1), options(2)
    logical :: given(2, first_diffusive:martensite)
    integer :: i, k

    do i = 1, size(phases)
      phases(i)%s = trim(phase_names(first_diffusive + i - 1))
    end do
    options(1)%s = 'SHIFT'
    options(2)%s = 'TIME'
    given = .false.
    call cursor%next_row('a phase, SHIFT or TIME')
    do
      call cursor%name('a phase that forms from austenite', phases, i)
      if (i == 0) return
      i = first_diffusive + i - 1
      do
        call cursor%name('SHIFT or TIME', options, k)
        if (k == 0) return
        if (given(k, i)) call cursor%fail(options(k)%s//' of '//trim(phase_names(i))//' is given twice')
        given(k, i) = .true.
        if (k == 1) then
          call cursor%real('the shift by the mean stress', steel%isig%shift(1, i), unit='K/MPa')
          call cursor%real('the shift by von Mises'' stress', steel%isig%shift(2, i), unit='K/MPa')
        else if (i > last_diffusive) then
          call cursor%fail('TIME is of phases that form by diffusion: martensite takes no time')
          return
        else
          call cursor%real('the logarithm of times by the mean stress', steel%isig%haste(1, i), unit='1/MPa')
          call cursor%real('the logarithm of times by von Mises'' stress', steel%isig%haste(2, i), unit='1/MPa')
        end if
        if (.not. cursor%more()) exit
      end do
      if (.not. cursor%more_rows()) exit
      call cursor%next_row('a phase, SHIFT or TIME')
    end do
    steel%isig%given = .true.
  end subroutine read_isig

end module steel_stress_cards
