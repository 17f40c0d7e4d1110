!> What a new mesh changes at the restart on it, forces of dies and elastic energy, and the limits of that.
module remesh_limits
  use acceptance, only: acceptance_t
  use kinds, only: wp
  use restore_balance, only: balance_t
  use vectors, only: length_of
  implicit none
  private
  public :: carried_change, energy_change, energy_limit, error_limit, force_along, force_change, force_limit, has_lost_force
  public :: lost_limit, residual_limit

  !> Pressures that miss the force of a die by more than this share of the largest were lost in the transfer. (Found: 0.27 where
  !> a point in a corner carried much of the force; Newton's method finds the rest.)
  real(wp), parameter :: lost_pressure = 0.5_wp
  !> Largest limit of the change of a force where the deck gives none, over the default.
  real(wp), parameter :: most_wrong = 2.0_wp
  !> Changes are over the force of now, or over this share of the largest so far where the load is light: the tenth part of nothing
  !> says nothing about a mesh.
  real(wp), parameter :: light_load = 0.2_wp

contains

  !> Change of the force of a die over the largest force on any, or what presses on one made of sides: the worst.
  pure function force_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change

    change = worst_change(balance, balance%pilot_after)
  end function force_change

  !> The same of the forces of the carried pressures, before the first iteration.
  pure function carried_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change

    change = worst_change(balance, balance%pilot_carried)
  end function carried_change

  pure function worst_change(balance, after) result(change)
    type(balance_t), intent(in) :: balance
    real(wp), intent(in) :: after(:, :)   !! (3, ndie) [force]
    real(wp) :: change
    real(wp) :: largest
    integer :: k

    change = 0
    largest = maxval([light_load*balance%largest_force, balance%pressed])
    do k = 1, size(after, 2)
      largest = max(largest, length_of(balance%pilot_before(1:2, k)))
      change = max(change, length_of(after(1:2, k) - balance%pilot_before(1:2, k)))
    end do
    if (largest > 0) change = change/largest
  end function worst_change

  !> Of the force that changes most: its change along what it was, over the largest force; negative where it becomes smaller.
  pure function force_along(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change
    integer :: worst, k
    real(wp) :: size_of(size(balance%pilot_before, 2))

    change = 0
    if (size(size_of) == 0) return
    size_of = [(length_of(balance%pilot_after(1:2, k) - balance%pilot_before(1:2, k)), k=1, size(size_of))]
    worst = maxloc(size_of, 1)
    if (.not. size_of(worst) > 0) return
    change = force_change(balance)
    if (dot_product(balance%pilot_after(1:2, worst) - balance%pilot_before(1:2, worst), balance%pilot_before(1:2, worst)) < 0) &
      change = -change
  end function force_along

  !> Change of the elastic energy over what was carried; where that is round-off, over what round-off may be.
  pure function energy_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change
    real(wp) :: carried

    carried = max(balance%before%elastic_energy, balance%round_off)
    change = 0
    if (carried > 0) change = abs(balance%after%elastic_energy - balance%before%elastic_energy)/carried
  end function energy_change

  !> Limit of the change of a force. Where few nodes bear the load it is up to what their number leaves open (bearing_nodes) and the
  !> old mesh's error says; where that is more than the force itself, as of a node on the axis, whose force goes with the square of
  !> the sides, the estimated error says nothing of it.
  pure function force_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = error_limit(accept, balance)
    if (accept%force_is_given) return
    if (balance%open_share > 1) then
      limit = max(limit, balance%open_share)
    else
      limit = max(limit, min(balance%old_error, balance%open_share))
    end if
  end function force_limit

  !> The same by the errors alone. Where the deck gives no limit an old mesh whose stress was wrong by more than the default may
  !> have had a force as wrong, and it is the new one that is right then; up to `most_wrong` times the default: a larger change may
  !> as well come of a bad new mesh.
  pure function error_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%force_change
    if (.not. accept%force_is_given) limit = max(limit, min(balance%old_error, most_wrong*limit))
  end function error_limit

  !> Limit of the first residual: about as large as the error of the stress on the old mesh in any case, where few nodes bear the
  !> load, and where the stress of the body is that around them; all of it where they leave open as much as the force.
  pure function residual_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%first_residual
    if (accept%residual_is_given) return
    if (balance%open_share >= 1) then
      limit = max(limit, 1.0_wp)
    else
      limit = max(limit, min(balance%old_error, balance%open_share))
    end if
  end function residual_limit

  !> The same of the elastic energy, which goes with the square of the force where few nodes bear that.
  pure function energy_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%energy_change
    if (force_limit(accept, balance) > error_limit(accept, balance)) &
      limit = max(limit, (1 + force_limit(accept, balance))**2 - 1)
  end function energy_limit

  !> The pressures carried over miss the force of a die, and by more than few nodes explain: what these bear has a direction of its
  !> own, which it loses on the faces of the new sides; there it is enough that equilibrium brings the force back.
  pure function has_lost_force(accept, balance) result(lost)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    logical :: lost

    lost = carried_change(balance) > lost_limit(accept, balance)
    if (balance%restored .and. balance%open_share > most_wrong*accept%force_change) &
      lost = lost .and. force_change(balance) > force_limit(accept, balance)
  end function has_lost_force

  !> Limit of the change of the force of a die by the pressures that were carried.
  pure function lost_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = max(lost_pressure, force_limit(accept, balance))
  end function lost_limit

end module remesh_limits
