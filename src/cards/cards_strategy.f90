!> STRAT, NORMS, SOLVR, STOP, SAVE and CKPT: how a run marches, which linear solver it takes, and what it keeps.
module cards_strategy
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t, location_t
  use kinds, only: wp
  use linear_api, only: solver_row_t
  use linear_registry, only: list_solvers
  use scene_draft, only: close_card, draft_t, head_location, only_card, words_of
  use strategy, only: strategy_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_strategy

contains

  subroutine read_strategy(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    integer :: k

    associate (strategy => draft%scene%strategy)
      allocate (strategy%save_times(0))
      call only_card(deck, 'STRAT', diagnostics, k, &
                     'the first, the least and the largest step [time], NOPTI and NALPHA')
      if (k > 0) then
        call cursor%open(deck%cards(k), diagnostics)
        call read_steps(cursor, strategy)
        call close_card(draft, cursor, deck%cards(k))
      end if
      call only_card(deck, 'NORMS', diagnostics, k)
      if (k > 0) then
        call cursor%open(deck%cards(k), diagnostics)
        call read_norms(cursor, strategy)
        call close_card(draft, cursor, deck%cards(k))
      end if
      call only_card(deck, 'SOLVR', diagnostics, k)
      if (k > 0) then
        call cursor%open(deck%cards(k), diagnostics)
        call read_linear_solver(cursor, strategy)
        call close_card(draft, cursor, deck%cards(k))
      end if
      call read_end(deck, draft, diagnostics)
      call read_savings(deck, draft, diagnostics)
      call only_card(deck, 'CKPT', diagnostics, k)
      if (k > 0) then
        call cursor%open(deck%cards(k), diagnostics)
        call cursor%integer('the number of steps between checkpoints', strategy%checkpoint_every, lower=1)
        call close_card(draft, cursor, deck%cards(k))
      end if
    end associate
  end subroutine read_strategy

  !> `first least largest nopti nalpha [dminmu dmaxmu]`.
  subroutine read_steps(cursor, strategy)
    type(cursor_t), intent(inout) :: cursor
    type(strategy_t), intent(inout) :: strategy

    call cursor%real('the first step', strategy%first_step, lower=0.0_wp, strict_lower=.true., unit='time')
    call cursor%real('the least step', strategy%least_step, lower=0.0_wp, strict_lower=.true., &
                     upper=strategy%first_step, unit='time')
    call cursor%real('the largest step', strategy%largest_step, lower=strategy%first_step, unit='time')
    call cursor%integer('NOPTI, the iterations wanted', strategy%nopti, lower=1, upper=100)
    call cursor%real('NALPHA, the root taken', strategy%nalpha, lower=1.0_wp)
    if (.not. cursor%more()) return
    call cursor%real('DMINMU, the least factor of a step', strategy%dminmu, lower=0.0_wp, upper=1.0_wp, &
                     strict_lower=.true., strict_upper=.true.)
    call cursor%real('DMAXMU, the largest factor of a step', strategy%dmaxmu, lower=1.0_wp)
  end subroutine read_steps

  !> Pairs of a name and a number, in any order.
  subroutine read_norms(cursor, strategy)
    type(cursor_t), intent(inout) :: cursor
    type(strategy_t), intent(inout) :: strategy
    type(string_t), allocatable :: names(:)
    logical :: given(8)
    integer :: k

    call words_of('FORCE DISPL ITMAX STRAIN PATH RATE TRAVEL PATCH', names)
    given = .false.
    do
      call cursor%name('the name of a norm', names, k)
      if (k == 0) return
      if (given(k)) call cursor%fail(names(k)%s//' is given twice')
      given(k) = .true.
      select case (k)
      case (1)
        call cursor%real('the residual force over the reference', strategy%force_norm, lower=0.0_wp, upper=1.0_wp, &
                         strict_lower=.true., strict_upper=.true.)
      case (2)
        call cursor%real('the correction over the displacement of the step', strategy%displacement_norm, lower=0.0_wp, &
                         upper=1.0_wp, strict_lower=.true., strict_upper=.true.)
      case (3)
        call cursor%integer('the iterations after which a step is cut back', strategy%max_iterations, lower=2, upper=1000)
      case (4)
        call cursor%real('the largest strain increment of a step', strategy%strain_bound, lower=0.0_wp, strict_lower=.true.)
      case (5)
        call cursor%real('the largest error of the motion of a step over the motion, or 0', strategy%path_bound, &
                         lower=0.0_wp, upper=1.0_wp, strict_upper=.true.)
      case (6)
        call cursor%real('the largest error of the stress over the stress, or 0', strategy%rate_bound, &
                         lower=0.0_wp, upper=1.0_wp, strict_upper=.true.)
      case (7)
        call cursor%real('the longest way of a die in a step', strategy%travel_bound, lower=0.0_wp, strict_lower=.true., &
                         unit='length')
      case (8)
        call cursor%integer('the elements of a patch at most, or 0', strategy%patch, lower=0, upper=100)
      end select
      if (.not. cursor%more()) exit
    end do
  end subroutine read_norms

  !> `SOLVR name`.
  subroutine read_linear_solver(cursor, strategy)
    type(cursor_t), intent(inout) :: cursor
    type(strategy_t), intent(inout) :: strategy
    type(solver_row_t), allocatable :: rows(:)
    type(string_t), allocatable :: names(:)
    integer :: k

    call list_solvers(rows)
    allocate (names(size(rows)))
    do k = 1, size(rows)
      names(k)%s = rows(k)%name
    end do
    call cursor%name('the name of a linear solver', names, k)
    if (k > 0) strategy%linear_solver = k
  end subroutine read_linear_solver

  !> `STOP time`, or the last time of all multipliers.
  subroutine read_end(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(location_t) :: where
    logical :: known
    integer :: k

    associate (strategy => draft%scene%strategy)
      call only_card(deck, 'STOP', diagnostics, k)
      if (k > 0) then
        call cursor%open(deck%cards(k), diagnostics)
        call cursor%real('the time at the end', strategy%end_time, lower=0.0_wp, strict_lower=.true., unit='time')
        call close_card(draft, cursor, deck%cards(k))
        return
      end if
      known = .true.
      strategy%end_time = 0
      do k = 1, size(draft%scene%multipliers)
        associate (time => draft%scene%multipliers(k)%time)
          known = known .and. size(time) > 0
          if (size(time) > 0) strategy%end_time = max(strategy%end_time, time(size(time)))
        end associate
      end do
      if (strategy%end_time > 0 .or. .not. known) return
      call diagnostics%register(deck%path, where%file)
      call diagnostics%add(where, 'STOP', 'no LIC goes beyond time 0: a STOP card must give the end')
    end associate
  end subroutine read_end

  !> `SAVE n` and `SAVE TIMES t1 t2 ...`, each once.
  subroutine read_savings(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(location_t) :: first(2)
    type(string_t), allocatable :: words(:)
    integer :: i, k, form

    call words_of('TIMES', words)
    associate (strategy => draft%scene%strategy)
      do i = 1, size(deck%cards)
        if (deck%cards(i)%keyword /= 'SAVE') cycle
        call cursor%open(deck%cards(i), diagnostics)
        form = merge(1, 2, cursor%next_is_number())
        if (first(form)%line > 0) call cursor%fail('given twice, the first is at '//diagnostics%place(first(form)))
        first(form) = head_location(deck%cards(i))
        if (form == 1) then
          call cursor%integer('the number of steps between savings', strategy%save_every, lower=1)
        else
          call cursor%name('a number of steps, or TIMES', words, k)
          call read_times(cursor, strategy)
        end if
        call close_card(draft, cursor, deck%cards(i))
      end do
    end associate
  end subroutine read_savings

  subroutine read_times(cursor, strategy)
    type(cursor_t), intent(inout) :: cursor
    type(strategy_t), intent(inout) :: strategy
    real(wp) :: time, last

    last = 0
    do while (.not. cursor%failed())
      call cursor%real('a time later than the one before', time, lower=last, strict_lower=.true., unit='time')
      if (cursor%failed()) return
      if (strategy%end_time > 0 .and. time > strategy%end_time) &
        call cursor%fail('this time is after the end at '//to_text(strategy%end_time)//': nothing would be saved')
      strategy%save_times = [strategy%save_times, time]
      last = time
      if (.not. cursor%more()) exit
    end do
  end subroutine read_times

end module cards_strategy
