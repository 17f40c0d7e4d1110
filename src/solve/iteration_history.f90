!> What the iterations of a step tell: whether it has converged, whether it goes round in circles, and why to stop.
module iteration_history
  use kinds, only: wp
  use line_search, only: short_share
  use scene, only: scene_t
  use text, only: to_text
  implicit none
  private
  public :: iteration_t
  public :: caught, ceiling_of_residual, difficulty_of_patches, goes_to_and_fro, has_converged, in_circles, in_turmoil, is_near
  public :: judge
  public :: was_given_time, went_round

  !> One line of the listing.
  type :: iteration_t
    real(wp) :: force_norm = 0.0_wp, displacement_norm = 0.0_wp, line_search = 1.0_wp
    !> Points opened, closed, stuck or slipped the other way.
    logical :: contact_changed = .false.
    !> Points began or ceased to flow.
    logical :: flow_changed = .false.
    !> Iterations on the unknowns of a patch that was eliminated (nonlinear_elimination); 0 where none was.
    integer :: inner = 0
    !> The share was searched closely, since contact was in turmoil.
    logical :: closely = .false.
    !> The whole correction was taken, whatever the residual, after searches that were all short.
    logical :: watched = .false.
    !> The matrix led uphill: the state is past a limit point (pseudo_transient).
    logical :: past_limit = .false.
  end type iteration_t

  !> Corrections that keep to the way downhill may take so many times the most iterations of a step (ITMAX).
  integer, parameter :: times_downhill = 3
  !> A residual this many times larger than the first one, after `patience` iterations, counts as divergence.
  real(wp), parameter :: hopeless = 1.0e3_wp
  integer, parameter :: patience = 6
  !> The residual stagnates when the best of the last `patience` - 1 iterations is above this share of the best before, and
  !> none of them was under way.
  real(wp), parameter :: stagnant = 0.3_wp
  !> Corrections that follow the heat content go round in circles when the residual is above this share of the best so far.
  real(wp), parameter :: circling = 0.9_wp
  !> Beyond the largest number of iterations the residual falls on when the best of the last `patience` is below this share of the
  !> best before.
  real(wp), parameter :: falling = 0.7_wp
  !> Nor is a step cut whose last two iterations each brought the residual to this share.
  real(wp), parameter :: about_to_end = 0.1_wp
  !> As long as a sheet peels off a die, point by point, contact changes in each iteration, and the best of the last
  !> `peeling_window` is below this share of the best before: the number of points ends it. Single searches may be short on the way.
  real(wp), parameter :: peeling = 0.97_wp
  integer, parameter :: peeling_window = 3*patience
  !> Residuals of one state that comes again differ by this share at most.
  real(wp), parameter :: same_state = 2.0e-3_wp
  !> Circles of more iterations are not looked for.
  integer, parameter :: longest_circle = 6
  !> So many more iterations are made for the balance of heat.
  integer, parameter :: for_balance = 2
  !> Heat through contact is linearised along the motion where the residual is below this (contact_heat_tangent).
  real(wp), parameter :: near_force = 1.0e-2_wp
  !> What an iteration on the unknowns of a patch, after the first, counts in the difficulty of a step: with 0 steps get so long
  !> that many fail, with 1 there are as many as without patches.
  real(wp), parameter :: inner_share = 0.4_wp
  !> A search that ends below this share of the correction is short too where the residual is below this, and contact is settled.
  real(wp), parameter :: before_turn = 0.35_wp, turn_force = 1.0e-3_wp
  !> A residual that need not fall in each iteration may rise to the largest of so many.
  integer, parameter :: remembered = 3
  !> The first correction of a motion that was predicted may raise it by this factor.
  real(wp), parameter :: first_rise = 1.5_wp
  !> After so many short searches one after the other the whole correction is taken.
  integer, parameter :: short_searches = 2

contains

  !> Both norms are met. A motion that starts in equilibrium needs no correction; one that an earlier turn has found gets one, if
  !> its residual is more than round-off: the last of all turns would else always leave just less than the norm, and with the same
  !> sign (2.4e-8 of the heat that passed in decks/hot_upsetting). So does one whose contact was kept: its forces are not those of
  !> the motion.
  pure function has_converged(scene, history, again) result(converged)
    type(scene_t), intent(in) :: scene
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical, intent(in) :: again   !! begun where an earlier turn ended, or with contact kept
    logical :: converged
    real(wp) :: to_come
    integer :: n

    n = size(history)
    converged = history(n)%force_norm <= scene%strategy%force_norm
    if (converged .and. again .and. n == 1) converged = .not. history(n)%force_norm > 0
    if (.not. converged .or. n == 1) return
    to_come = history(n)%displacement_norm
    if (history(n - 1)%force_norm > 0) to_come = to_come*min(1.0_wp, history(n)%force_norm/history(n - 1)%force_norm)
    converged = to_come <= scene%strategy%displacement_norm
  end function has_converged

  !> Residuals have been within their norm for some iterations, or are round-off: heat does not get nearer to its balance.
  pure function was_given_time(scene, history) result(was)
    type(scene_t), intent(in) :: scene
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: was
    integer :: n

    n = size(history)
    was = .not. history(n)%force_norm > 0
    if (n > for_balance) was = was .or. all(history(n - for_balance:)%force_norm <= scene%strategy%force_norm)
  end function was_given_time

  !> What iterations on the unknowns of patches add to the difficulty of a step.
  pure function difficulty_of_patches(history) result(added)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    real(wp) :: added

    added = inner_share*sum(max(history%inner - 1, 0))
  end function difficulty_of_patches

  !> Near the solution: the residual has fallen below a small share of the forces.
  pure function is_near(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: is_near

    is_near = history(size(history))%force_norm < near_force
  end function is_near

  !> How far a residual that need not fall in each iteration may rise, over what it is: to the largest of the last ones, and by the
  !> first correction a little; a correction from rest makes the motion of the step, by which the residual changes as it will.
  pure function ceiling_of_residual(history, moves) result(ceiling)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical, intent(in) :: moves                  !! there is a motion, predicted or corrected
    real(wp) :: ceiling
    integer :: n

    n = size(history)
    ceiling = huge(ceiling)
    if (.not. (moves .and. history(n)%force_norm > 0)) return
    ceiling = first_rise
    if (n > 1) ceiling = maxval(history(max(1, n - remembered + 1):)%force_norm)/history(n)%force_norm
  end function ceiling_of_residual

  !> The last searches were all short: they do not get past a turn of loading to unloading.
  pure function caught(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: caught

    caught = size(history) > short_searches
    if (caught) caught = all(is_short(history(size(history) - short_searches + 1:)))
    if (caught) caught = .not. went_round(history)
  end function caught

  !> The whole correction was taken after short searches before, and the short searches since came back to no less: to take it again
  !> would go round in circles.
  pure function went_round(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: went_round
    integer :: n, whole

    n = size(history)
    whole = n - short_searches
    went_round = whole > short_searches + 1
    if (.not. went_round) return
    went_round = history(whole)%line_search >= 1 &
                 .and. all(is_short(history(whole - short_searches:whole - 1))) &
                 .and. history(n)%force_norm > circling*history(whole - 1)%force_norm
  end function went_round

  !> Contact keeps changing and the residual does not fall: it stagnates over the last two iterations.
  pure function in_turmoil(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: in_turmoil
    integer :: n

    n = size(history)
    in_turmoil = n > 3
    if (.not. in_turmoil) return
    in_turmoil = all(history(n - 1:)%contact_changed) &
                 .and. minval(history(n - 1:)%force_norm) > stagnant*minval(history(2:n - 2)%force_norm)
  end function in_turmoil

  !> A search ended short of the correction: before a turn, where its first trials are tenths of the way to a stiffer far side.
  elemental function is_short(line)
    type(iteration_t), intent(in) :: line
    logical :: is_short

    is_short = line%line_search < short_share .or. line%line_search < before_turn .and. line%force_norm < turn_force &
               .and. .not. line%contact_changed
  end function is_short

  !> Corrections that follow the heat content go round in circles: the residual is hardly below the best so far.
  pure function in_circles(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: in_circles
    integer :: n

    n = size(history)
    in_circles = n > 3
    if (in_circles) in_circles = history(n)%force_norm > circling*minval(history(2:n - 1)%force_norm)
  end function in_circles

  !> Contact or the points that flow changed, or the state is past a limit point: the residual need not fall.
  elemental function is_under_way(line)
    type(iteration_t), intent(in) :: line
    logical :: is_under_way

    is_under_way = line%contact_changed .or. line%flow_changed .or. line%watched .or. line%past_limit
  end function is_under_way

  !> The residual falls fast: an iteration or two are missing.
  pure function is_about_to_end(history) result(yes)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: yes
    integer :: n

    n = size(history)
    yes = n > 2
    if (yes) yes = all(history(n - 1:n)%force_norm < about_to_end*history(n - 2:n - 1)%force_norm)
  end function is_about_to_end

  !> Contact still changes and the residual falls with it: a thin sheet between dies opens and closes point by point, whatever the
  !> length of the step.
  pure function falls_on(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: falls_on
    integer :: n

    n = size(history)
    falls_on = n > 2*patience
    if (.not. falls_on) return
    associate (now => history(n - patience + 1:), norms => history%force_norm)
      falls_on = any(now%contact_changed) .and. minval(now%force_norm) < falling*minval(norms(2:n - patience))
      if (n > peeling_window + 2) falls_on = falls_on .or. all(now%contact_changed) .and. &
                                             minval(norms(n - peeling_window + 1:)) < peeling*minval(norms(2:n - peeling_window))
    end associate
  end function falls_on

  !> Contact changes in a circle of two states or a few more: the residuals of the last iterations are those of some before.
  pure function goes_to_and_fro(history)
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical :: goes_to_and_fro
    integer :: n, period

    n = size(history)
    goes_to_and_fro = .false.
    associate (norms => history%force_norm)
      do period = 2, min(longest_circle, n - 4)
        if (.not. any(history(n - period + 1:)%contact_changed)) cycle
        goes_to_and_fro = all(abs(norms(n - 2:) - norms(n - period - 2:n - period)) <= same_state*norms(n - 2:))
        if (goes_to_and_fro) return
      end do
    end associate
  end function goes_to_and_fro

  !> Reason to stop the iterations, if there is one.
  pure subroutine judge(scene, history, downhill, reason)
    type(scene_t), intent(in) :: scene
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    logical, intent(in) :: downhill               !! corrections keep to the way downhill, on which the residual may grow
    character(len=:), allocatable, intent(out) :: reason
    integer :: n, most

    n = size(history) - 1
    most = merge(times_downhill, 1, downhill)*scene%strategy%max_iterations
    associate (norms => history%force_norm)
      if (.not. norms(n + 1) <= huge(1.0_wp)) then
        reason = 'not a number in the forces'
      else if (n >= most .and. .not. (falls_on(history) .or. is_about_to_end(history))) then
        reason = to_text(n)//' iterations without convergence (residual '//to_text(norms(n + 1), 3)//')'
      else if (n > patience .and. .not. downhill .and. norms(n + 1) > hopeless*norms(min(2, n + 1))) then
        reason = 'diverged: residual '//to_text(norms(n + 1), 3)
      else if (n >= patience) then
        if (minval(norms(n - patience + 3:)) > stagnant*minval(norms(2:n - patience + 2)) &
            .and. .not. any(is_under_way(history(n - patience + 3:)))) then
          reason = 'residual stagnates at '//to_text(norms(n + 1), 3)
        end if
      end if
    end associate
  end subroutine judge

end module iteration_history
