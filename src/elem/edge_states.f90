!> States of the edges of a deformable die on a side (edge_contact): each is in the interval between two points of the side where
!> the edge is, and goes on from there to the next as the side slides.
module edge_states
  use contact_state, only: at_augmentation, at_between, at_piece, at_pressure, at_status, at_xi, contact_block
  use corner_weights, only: handing_over
  use kinds, only: wp
  use law_api, only: contact_open
  implicit none
  private
  public :: augment_edges, beside_edges, edge_at_start, interval_at_start

contains

  !> State of an edge in the interval before a point as the step began: where it was in another interval of the side, what it was
  !> there, but its work, which stays where it was done.
  pure function edge_at_start(committed, p, piece) result(state)
    real(wp), intent(in) :: committed(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    integer, intent(in) :: piece             !! of the edge
    real(wp) :: state(contact_block(.true., size(committed, 1)))
    integer :: q, n

    n = size(state)
    state = committed(n + 1:2*n, p)
    q = interval_of_start(committed, p, piece)
    if (q == 0 .or. q == p) return
    associate (other => committed(n + 1:2*n, q))
      state(:at_augmentation) = other(:at_augmentation)
      state([at_piece, at_xi]) = other([at_piece, at_xi])
    end associate
  end function edge_at_start

  !> The pressure of each edge becomes its multiplier, in the interval where it was as the step began: that is where the state it
  !> goes on from is looked up, wherever it slides. One that was in none is in the interval where it is now.
  pure subroutine augment_edges(held, committed, trial)
    logical, intent(in) :: held(:)                !! (npoint) the edge in the interval before a point is augmented
    real(wp), intent(inout) :: committed(:, :)    !! (nstate, npoint) [unit of each component]
    real(wp), intent(in) :: trial(:, :)           !! (nstate, npoint) [unit of each component]
    real(wp) :: multiplier(size(trial, 2))
    logical :: there(size(trial, 2))
    integer :: p, q, n

    n = contact_block(.true., size(trial, 1))
    multiplier = merge(0.0_wp, committed(n + at_augmentation, :), held)
    there = nint(trial(n + at_status, :)) /= contact_open
    do p = 1, size(trial, 2)
      if (.not. there(p)) cycle
      q = interval_of_start(committed, p, nint(trial(n + at_piece, p)))
      if (q == 0) q = p
      multiplier(q) = committed(n + at_augmentation, q)
      if (held(p)) multiplier(q) = trial(n + at_pressure, p) - trial(n + at_between, p)
      committed(n + at_piece, q) = trial(n + at_piece, p)
    end do
    committed(n + at_augmentation, :) = multiplier
  end subroutine augment_edges

  !> The interval of a side in which an edge was as the step began: in contact, or else known to be, an interval itself where it was
  !> there; 0 for none.
  pure function interval_of_start(committed, p, piece) result(q)
    real(wp), intent(in) :: committed(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p, piece
    integer :: q
    logical :: known(size(committed, 2))

    q = interval_with(committed, p, piece)
    if (q > 0) return
    known = nint(committed(contact_block(.true., size(committed, 1)) + at_piece, :)) == piece
    q = p
    if (.not. known(p)) q = findloc(known, .true., 1)
  end function interval_of_start

  !> The interval of a side in which an edge is in contact, an interval itself where it is there; 0 for none.
  pure function interval_with(states, p, piece) result(q)
    real(wp), intent(in) :: states(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p, piece
    integer :: q
    integer :: n
    logical :: there(size(states, 2))

    n = contact_block(.true., size(states, 1))
    there = nint(states(n + at_status, :)) /= contact_open .and. nint(states(n + at_piece, :)) == piece
    q = p
    if (.not. there(p)) q = findloc(there, .true., 1)
  end function interval_with

  !> The interval from which the edge that is in contact in the interval before a point goes on, as edge_at_start has it; that
  !> interval itself where it was in none, and 0 where it has left this one for another.
  pure function interval_at_start(before, now, p) result(q)
    real(wp), intent(in) :: before(:, :), now(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    integer :: q
    integer :: n

    n = contact_block(.true., size(now, 1))
    q = p
    if (nint(now(n + at_status, p)) /= contact_open) then
      q = interval_of_start(before, p, nint(now(n + at_piece, p)))
      if (q == 0) q = p
    else if (nint(before(n + at_status, p)) /= contact_open) then
      if (interval_with(now, p, nint(before(n + at_piece, p))) > 0) q = 0
    end if
  end function interval_at_start

  !> Points of a side next to an edge that acts with all of its area.
  pure function beside_edges(state, xi) result(yes)
    real(wp), intent(in) :: state(:, :)   !! (nstate, npoint) [unit of each component]
    real(wp), intent(in) :: xi(:)         !! (npoint) [-]
    logical :: yes(size(xi))
    integer :: p, n

    n = contact_block(.true., size(state, 1))
    yes = .false.
    do p = 2, size(xi)
      if (nint(state(n + at_piece, p)) == 0) cycle
      associate (place => state(2*n + 1, p))
        if (state(2*n + 2, p) < 1) cycle
        yes = yes .or. abs(xi - place) < max(handing_over, xi(p) - xi(p - 1))
      end associate
    end do
  end function beside_edges

end module edge_states
