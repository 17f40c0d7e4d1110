!> What is kept of the corners of a die in the intervals between the points of a side (corner_contact).
!>
!> The state of an interval is that of one corner, the one that bore there as the step began while it bears, otherwise the
!> deepest. Others in the same interval have none.
module corner_states
  use contact_penalties, only: allowed_penetration
  use contact_state, only: at_augmentation, at_between, at_energy, at_penetration, at_piece, at_pressure, at_status, at_tau, &
                           at_xi, contact_block
  use dies, only: die_t
  use kinds, only: wp
  use law_api, only: contact_open, contact_slip
  use materials, only: material_t
  use passing_corners, only: corner_at_side, share_of
  use rigid_contact, only: is_kept, nodes_in_axes, side_at_start, side_t
  use side_corners, only: corner_t
  implicit none
  private
  public :: bears, corner_at_start, corner_before, corner_share, free_depth, keep_corner

  !> A corner acts on what is deeper than this share of the allowed penetration.
  real(wp), parameter :: corner_share = 0.5_wp

contains

  !> The corner that was in contact in this interval as the step began, in place of the deepest one, while it bears.
  pure subroutine keep_corner(die, material, side, nodes, from, to, committed, corner)
    type(die_t), intent(in) :: die
    type(material_t), intent(in) :: material
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: nodes(2, 3)    !! of the side, in the pilot's axes [length]
    real(wp), intent(in) :: from, to       !! [-]
    real(wp), intent(in) :: committed(:)   !! (nstate) of the interval's corner [unit of each component]
    type(corner_t), intent(inout) :: corner
    type(corner_t) :: same
    integer :: k

    if (nint(committed(at_status)) == contact_open .or. is_of(committed, corner)) return
    do k = 1, size(die%corners, 2)
      if (die%corner_piece(k) /= nint(committed(at_piece)) .or. die%corner_xi(k)*committed(at_xi) < 0) cycle
      call corner_at_side(die, k, side, nodes, from, to, same)
      if (.not. same%found) cycle
      if (bears(material, side, same, committed)) corner = same
    end do
  end subroutine keep_corner

  !> A state is that of this corner.
  pure function is_of(state, corner) result(yes)
    real(wp), intent(in) :: state(:)   !! (nstate) [unit of each component]
    type(corner_t), intent(in) :: corner
    logical :: yes

    yes = nint(state(at_piece)) == corner%piece .and. .not. state(at_xi)*corner%xi < 0
  end function is_of

  !> State of a corner in the interval before a point as the step began: what it was there where it was in contact, in this
  !> interval or in one beside, but its work, which stays where it was done. What the interval keeps of another corner is not of
  !> this one, but for the multiplier, which an augmentation within the step may have given to the one that has the state.
  pure function corner_at_start(die, material, side, committed, p, corner, first) result(state)
    type(die_t), intent(in) :: die
    type(material_t), intent(in) :: material
    type(side_t), intent(in) :: side
    real(wp), intent(in) :: committed(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    type(corner_t), intent(in) :: corner
    logical, intent(in) :: first              !! it is the one that has the state of the interval
    real(wp) :: state(contact_block(.true., size(committed, 1)))
    type(corner_t) :: start
    logical :: known
    integer :: q, n

    n = size(state)
    state = committed(n + 1:2*n, p)
    if (nint(state(at_status)) /= contact_open .and. is_of(state, corner)) return
    do q = max(1, p - 1), min(size(committed, 2), p + 1)
      associate (beside => committed(n + 1:2*n, q))
        if (nint(beside(at_status)) == contact_open .or. .not. is_of(beside, corner)) cycle
        state(:at_augmentation) = beside(:at_augmentation)
        state([at_piece, at_xi]) = beside([at_piece, at_xi])
        return
      end associate
    end do
    if (is_of(state, corner)) return
    known = nint(state(at_piece)) /= 0
    state([at_pressure, at_tau, at_penetration, at_status, at_piece, at_xi, at_between, at_energy]) = 0
    if (.not. first) state(at_augmentation) = 0
    call corner_at_side(die, corner%number, side, nodes_in_axes(side_at_start(side)), -1.0_wp, 1.0_wp, start)
    if (.not. start%found) return
    state(at_penetration) = start%d
    if (.not. known) return
    state([at_piece, at_xi]) = [real(corner%piece, wp), corner%xi]
    if (.not. start%d > free_depth(material, side)) return
    state([at_pressure, at_status]) = [side%penalty(1)*(start%d - free_depth(material, side)), real(contact_slip, wp)]
  end function corner_at_start

  !> State that the corner of the interval before a point had one step before, in this interval or in one beside; without contact
  !> where it had none.
  pure function corner_before(before, now, p) result(state)
    real(wp), intent(in) :: before(:, :), now(:, :)   !! (nstate, npoint) [unit of each component]
    integer, intent(in) :: p
    real(wp) :: state(contact_block(.true., size(before, 1)))
    integer :: q, n

    n = size(state)
    state = before(n + 1:2*n, p)
    if (nint(state(at_status)) /= contact_open .and. is_same(state)) return
    do q = max(1, p - 1), min(size(before, 2), p + 1)
      if (nint(before(n + at_status, q)) == contact_open .or. .not. is_same(before(n + 1:2*n, q))) cycle
      state = before(n + 1:2*n, q)
      return
    end do
    if (.not. is_same(state)) state([at_pressure, at_tau, at_status, at_between, at_energy]) = 0

  contains

    !> A state is that of the corner now.
    pure function is_same(one) result(yes)
      real(wp), intent(in) :: one(:)   !! (nstate) [unit of each component]
      logical :: yes

      yes = nint(one(at_piece)) == nint(now(n + at_piece, p)) .and. .not. one(at_xi)*now(n + at_xi, p) < 0
    end function is_same
  end function corner_before

  !> A corner bears: it is deeper than it needs for no pressure. What is kept in contact answers to the depth at the start of the
  !> step (contact_point).
  pure function bears(material, side, corner, committed) result(yes)
    type(material_t), intent(in) :: material
    type(side_t), intent(in) :: side
    type(corner_t), intent(in) :: corner
    real(wp), intent(in) :: committed(:)   !! (nstate) of the corner [unit of each component]
    logical :: yes
    real(wp) :: depth

    depth = corner%d
    if (is_kept(side, committed)) depth = committed(at_penetration)
    yes = committed(at_augmentation) + side%penalty(1)*(depth - free_depth(material, side)) > 0 &
          .and. share_of(corner) > 0
  end function bears

  !> Depth of a corner without pressure.
  pure function free_depth(material, side) result(depth)
    type(material_t), intent(in) :: material
    type(side_t), intent(in) :: side
    real(wp) :: depth   !! [length]

    depth = corner_share*allowed_penetration(material)*side%length
  end function free_depth

end module corner_states
