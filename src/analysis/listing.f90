!> The listing (`NAME.log`) and the line that shows progress on a terminal.
module listing
  use dies, only: is_deformable
  use elem_api, only: totals_t
  use errors, only: error_t, exit_machine, fail
  use file_kinds, only: refuse_to_replace
  use kinds, only: wp
  use restore_balance, only: balance_t
  use scene, only: scene_t
  use solution, only: solution_t
  use standard_streams, only: print_error, print_line, print_part
  use step_outcome, only: outcome_t
  use system, only: is_terminal, wall_seconds
  use text, only: string_t, to_text
  implicit none
  private
  public :: listing_t, open_listing, close_listing, share_done, show_progress, end_progress, steps_left
  public :: list_lines, list_resumed, list_balance, list_step, list_cutback, list_event, list_note, list_softer_contact

  type :: listing_t
    integer :: unit = -1
    !> Progress is shown: over and over in one line of a terminal, or in a new line each time.
    logical :: live = .false., terminal = .false.
    real(wp) :: started = 0.0_wp, shown = 0.0_wp
    !> Share of the scene already done when the program started (a resumed run), and steps shown since.
    real(wp) :: start_share = 0.0_wp
    integer :: steps = 0
  end type listing_t

  integer, parameter :: standard_output = 1
  !> Seconds between two progress lines, on a terminal and elsewhere.
  real(wp), parameter :: refresh = 0.2_wp, refresh_file = 60.0_wp
  !> Lengths of steps that differ by less than this share are the same.
  real(wp), parameter :: same = 1.0e-2_wp

contains

  subroutine open_listing(path, resume, quiet, progress, share, listing, error)
    character(len=*), intent(in) :: path
    logical, intent(in) :: resume, quiet
    logical, intent(in) :: progress   !! show it also where there is no terminal
    real(wp), intent(in) :: share
    type(listing_t), intent(out) :: listing
    type(error_t), allocatable, intent(out) :: error
    integer :: status

    call refuse_to_replace(path, error)
    if (allocated(error)) return
    if (resume) then
      open (newunit=listing%unit, file=path, action='write', position='append', iostat=status)
    else
      open (newunit=listing%unit, file=path, action='write', status='replace', iostat=status)
    end if
    if (status /= 0) call fail(error, exit_machine, path//': cannot be written')
    listing%terminal = is_terminal(standard_output)
    listing%live = (listing%terminal .or. progress) .and. .not. quiet
    listing%started = wall_seconds()
    listing%start_share = share
  end subroutine open_listing

  subroutine close_listing(listing)
    type(listing_t), intent(inout) :: listing

    if (listing%unit /= -1) close (listing%unit)
    listing%unit = -1
  end subroutine close_listing

  subroutine list_lines(listing, lines)
    type(listing_t), intent(in) :: listing
    type(string_t), intent(in) :: lines(:)   !! (nline)
    integer :: k

    do k = 1, size(lines)
      write (listing%unit, '(a)') lines(k)%s
    end do
    flush (listing%unit)
  end subroutine list_lines

  !> The listing is only appended to: earlier text stays, also of steps that are now repeated. The empty line ends one that
  !> was cut in the middle.
  subroutine list_resumed(listing, path, solution)
    type(listing_t), intent(in) :: listing
    character(len=*), intent(in) :: path
    type(solution_t), intent(in) :: solution

    write (listing%unit, '(/,a)') 'resumed from '//path//' after step '//to_text(solution%step)//', time ' &
      //to_text(solution%time)
  end subroutine list_resumed

  !> An accepted step with its iterations.
  subroutine list_step(listing, solution, outcome, totals)
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    type(totals_t), intent(in) :: totals

    write (listing%unit, '(a)') 'step '//to_text(solution%step)//'  time '//to_text(solution%time)//'  length ' &
      //to_text(solution%last_step)//'  iterations '//to_text(outcome%iterations)//parts_of(outcome)//patches_of(outcome)
    call list_iterations(listing, outcome)
    if (outcome%gave_way) write (listing%unit, '(a)') '  augmentation '//to_text(outcome%augmentations + 1) &
      //' of contact had no equilibrium: the one before it was kept'
    if (outcome%contact_lag > 0) write (listing%unit, '(a)') '  heat and contact do not agree: '// &
      to_text(100*outcome%contact_lag, 3)//' % of what passes at contact is another by the pressures and gaps that it leads to'
    if (outcome%left_unstable) write (listing%unit, '(a)') '  the equilibrium found first is not stable: looked for again, downhill'
    if (outcome%unstable > 0) write (listing%unit, '(a)') '  the equilibrium is not stable: eigenvalues of its matrix below 0: ' &
      //to_text(outcome%unstable)
    write (listing%unit, '(a)') '  strain increment '//to_text(outcome%strain, 3)//'  contact '//to_text(totals%stick) &
      //' stick '//to_text(totals%slip)//' slip '//to_text(totals%open)//' open  penetration ' &
      //to_text(totals%max_penetration, 3)//'  linear residual '//to_text(outcome%linear_residual, 2)
    flush (listing%unit)
  end subroutine list_step

  !> A first step on a new mesh that was found in parts.
  pure function parts_of(outcome) result(words)
    type(outcome_t), intent(in) :: outcome
    character(len=:), allocatable :: words

    words = ''
    if (outcome%parts > 1) words = ' in '//to_text(outcome%parts)//' parts'
  end function parts_of

  !> Iterations with a patch eliminated, and those on its unknowns.
  pure function patches_of(outcome) result(words)
    type(outcome_t), intent(in) :: outcome
    character(len=:), allocatable :: words

    words = ''
    if (any(outcome%history%inner > 0)) words = ', '//to_text(count(outcome%history%inner > 0))//' with a patch ('// &
                                                to_text(sum(outcome%history%inner))//' inner)'
  end function patches_of

  subroutine list_iterations(listing, outcome)
    type(listing_t), intent(in) :: listing
    type(outcome_t), intent(in) :: outcome
    integer :: k
    logical :: patches

    patches = any(outcome%history%inner > 0)
    write (listing%unit, '(a)') '  iteration   residual/force  correction/motion  line search' &
      //trim(merge('  inner', '       ', patches))
    do k = 1, size(outcome%history)
      associate (line => outcome%history(k))
        if (k == 1) then
          write (listing%unit, '(i10,es17.3)') k - 1, line%force_norm
        else if (patches) then
          write (listing%unit, '(i10,es17.3,es19.3,f13.3,i7,a)') k - 1, line%force_norm, line%displacement_norm, line%line_search, &
            line%inner, trim(merge(' *', '  ', line%past_limit))
        else
          write (listing%unit, '(i10,es17.3,es19.3,f13.3,a)') k - 1, line%force_norm, line%displacement_norm, line%line_search, &
            trim(merge(' *', '  ', line%past_limit))
        end if
      end associate
    end do
  end subroutine list_iterations

  !> Equilibrium restored on a new mesh: its iterations, and what it changed.
  subroutine list_balance(listing, scene, solution, balance, outcome)
    type(listing_t), intent(in) :: listing
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(balance_t), intent(in) :: balance
    type(outcome_t), intent(in) :: outcome
    integer :: k

    write (listing%unit, '(a)') 'mesh '//to_text(scene%generation)//'  after step '//to_text(solution%step)//'  time ' &
      //to_text(solution%time)//'  first residual '//to_text(balance%first_residual, 3)//'  iterations ' &
      //to_text(balance%iterations)//' in '//to_text(balance%parts)//' part'//trim(merge('s', ' ', balance%parts > 1)) &
      //'  motion/size '//to_text(balance%motion, 3)
    call list_iterations(listing, outcome)
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) cycle
      write (listing%unit, '(a)') '  force on '//scene%dies(k)%name//' '//to_text(balance%pilot_before(1, k), 6)//' ' &
        //to_text(balance%pilot_before(2, k), 6)//' before, '//to_text(balance%pilot_after(1, k), 6)//' ' &
        //to_text(balance%pilot_after(2, k), 6)//' after'
    end do
    flush (listing%unit)
  end subroutine list_balance

  !> A step that was cut back: why, where, and the next length.
  subroutine list_cutback(listing, scene, solution, dt, next, outcome)
    type(listing_t), intent(in) :: listing
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt, next
    type(outcome_t), intent(in) :: outcome
    character(len=:), allocatable :: where_at

    where_at = ''
    if (outcome%group > 0) where_at = ' (element '//to_text(outcome%element)//' of '//scene%groups(outcome%group)%name//')'
    write (listing%unit, '(a)') 'cutback: step '//to_text(solution%step + 1)//'  time '//to_text(solution%time)//'  length ' &
      //to_text(dt)//' -> '//to_text(next)//': '//outcome%reason//where_at
    call list_iterations(listing, outcome)
    flush (listing%unit)
  end subroutine list_cutback

  !> Penalties that were lowered after a step that failed (soft_penalties).
  subroutine list_softer_contact(listing, solution)
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(in) :: solution

    write (listing%unit, '(a)') '  contact bears little, and presses with '//to_text(solution%penalty_share) &
      //' of the penalties of PENETR until it is deeper'
  end subroutine list_softer_contact

  !> A step shortened to the moment when contact begins, or by its error in time.
  subroutine list_event(listing, solution, dt, reason)
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt
    character(len=*), intent(in) :: reason

    write (listing%unit, '(a)') 'event: '//reason//', step '//to_text(solution%step + 1)//' shortened to '//to_text(dt)
  end subroutine list_event

  !> A note for the user: in the listing, and on the terminal.
  subroutine list_note(listing, note)
    type(listing_t), intent(in) :: listing
    character(len=*), intent(in) :: note

    write (listing%unit, '(a)') note
    call print_error(note)
  end subroutine list_note

  !> One line: step, time, iterations, share done, time left; of several operations, of the present one.
  subroutine show_progress(listing, scene, solution, iterations)
    type(listing_t), intent(inout) :: listing
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: iterations
    real(wp) :: now, share, left
    character(len=120) :: line
    type(error_t), allocatable :: unseen

    if (.not. listing%live) return
    now = wall_seconds()
    share = share_done(scene, solution%time)
    listing%steps = listing%steps + 1
    if (listing%shown > 0 .and. now - listing%shown < merge(refresh, refresh_file, listing%terminal) .and. share < 1) return
    listing%shown = now
    left = (now - listing%started)/listing%steps*steps_left(scene, solution, (share - listing%start_share)/listing%steps)
    line = 'step '//to_text(solution%step)//'  time '//to_text(solution%time, 4)//'  iterations '//to_text(iterations) &
           //'  '//to_text(100*share, 3)//' %  '//to_text(now - listing%started, 3)//' s, left ' &
           //to_text(min(left, 1.0e9_wp), 3)//' s'
    if (scene%operations > 1) line = trim(line)//' of operation '//to_text(scene%operation)//'/'//to_text(scene%operations)
    if (listing%terminal) then
      call print_part(achar(13)//line(:79), unseen)
    else
      call print_line(trim(line), unseen)
    end if
    ! the output cannot be written
    if (allocated(unseen)) listing%live = .false.
  end subroutine show_progress

  !> Steps up to the end. Steps that have been shorter than the last one grow on as the next one does, up to the largest; others go
  !> on as they were in the mean.
  pure function steps_left(scene, solution, mean) result(steps)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: mean   !! length of the steps so far, as a share of the scene
    real(wp) :: steps
    real(wp) :: length, way, growth

    associate (strategy => scene%strategy)
      way = max(strategy%end_time - solution%time, 0.0_wp)
      length = mean*(strategy%end_time - strategy%begins)
      steps = way/max(length, tiny(1.0_wp))
      if (solution%last_step < (1 - same)*length) return
      length = max(length, solution%last_step)
      growth = min(solution%next_step, strategy%largest_step)/length
      steps = 0
      if (growth > 1 + same) then
        do while (way > 0 .and. length*growth < strategy%largest_step)
          length = length*growth
          way = way - length
          steps = steps + 1
        end do
        length = strategy%largest_step
      end if
      steps = steps + max(way, 0.0_wp)/length
    end associate
  end function steps_left

  !> Share of the scene, or of the present operation, that is done.
  pure function share_done(scene, time) result(share)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: time   !! [time]
    real(wp) :: share

    share = (time - scene%strategy%begins)/(scene%strategy%end_time - scene%strategy%begins)
  end function share_done

  !> Leave the progress line.
  subroutine end_progress(listing)
    type(listing_t), intent(in) :: listing
    type(error_t), allocatable :: ignored

    if (listing%live .and. listing%terminal .and. listing%shown > 0) call print_line('', ignored)
  end subroutine end_progress

end module listing
