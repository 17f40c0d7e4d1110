!> States of the edges of a deformable die on a side (edge_contact): each is in the interval between two points of the side where
!> the edge is, and goes on from there to the next as the side slides.
module edge_states
  use contact_point, only: at_augmentation, at_piece, at_status, at_xi, contact_block
  use corner_weights, only: handing_over, share_of_corner
  use kinds, only: wp
  use law_api, only: contact_open
  implicit none
  private
  public :: beside_edges, edge_at_start, interval_at_start

contains

  !> State of an edge in the interval before a point as the step began: where it was in contact in another interval of the side,
  !> what it was there, but its work, which stays where it was done.
  pure function edge_at_start(committed, p, piece) result(state)
    real(wp), intent(in) :: committed(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    integer, intent(in) :: piece             !! of the edge
    real(wp) :: state(contact_block(.true., size(committed, 1)))
    integer :: q, n

    n = size(state)
    state = committed(n + 1:2*n, p)
    q = interval_with(committed, p, piece)
    if (q == 0 .or. q == p) return
    associate (other => committed(n + 1:2*n, q))
      state(:at_augmentation) = other(:at_augmentation)
      state([at_piece, at_xi]) = other([at_piece, at_xi])
    end associate
  end function edge_at_start

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

  !> The interval in which the edge that is in contact in the interval before a point was when the step began; that interval
  !> itself where it was in none, and 0 where it has left this one for another.
  pure function interval_at_start(before, now, p) result(q)
    real(wp), intent(in) :: before(:, :), now(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    integer :: q
    integer :: n

    n = contact_block(.true., size(now, 1))
    q = p
    if (nint(now(n + at_status, p)) /= contact_open) then
      q = interval_with(before, p, nint(now(n + at_piece, p)))
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
        if (share_of_corner(place, of_body=.true.) < 1) cycle
        yes = yes .or. abs(xi - place) < max(handing_over, xi(p) - xi(p - 1))
      end associate
    end do
  end function beside_edges

end module edge_states
