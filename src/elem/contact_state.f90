!> State of a point of a side in contact: its rows, what they say, and what is shown of them.
module contact_state
  use closest_point, only: end_slack
  use kinds, only: wp
  use law_api, only: contact_open, law_t
  use shape_functions, only: line3
  use side_points, only: no_surface
  use state_variables, only: state_variable, state_variable_t, transfer_contact, transfer_recompute
  implicit none
  private
  public :: contact_block, is_in_contact, is_released, point_variables, rest, show_on_axis
  public :: at_pressure, at_tau, at_penetration, at_status, at_slip, at_augmentation, at_work, at_piece, at_xi, at_between, &
            at_energy, npoint_state

  !> Rows in the state of a point; the history of its law follows. The pressure has in it that of the side beside the point, where
  !> it is deeper between points than allowed (contact_between).
  integer, parameter :: at_pressure = 1, at_tau = 2, at_penetration = 3, at_status = 4, at_slip = 5, &
                        at_augmentation = 6, at_work = 7, at_piece = 8, at_xi = 9, at_between = 10, at_energy = 11, &
                        npoint_state = 11

contains

  !> State of a point, with the history of its law.
  pure function point_variables(law) result(list)
    type(law_t), intent(in) :: law
    type(state_variable_t), allocatable :: list(:)

    allocate (list, source=[state_variable('pressure', 'stress', transfer_contact), &
                            state_variable('friction', 'stress', transfer_contact), &
                            state_variable('penetration', 'length', transfer_recompute), &
                            state_variable('contact_status', '-', transfer_recompute), &
                            state_variable('slip', 'length', transfer_contact), &
                            state_variable('augmentation', 'stress', transfer_contact), &
                            state_variable('friction_work', 'stress*length', transfer_contact), &
                            state_variable('die_piece', '-', transfer_recompute), &
                            state_variable('die_xi', '-', transfer_recompute), &
                            state_variable('pressure_between', 'stress', transfer_recompute), &
                            state_variable('energy_between', 'stress*length', transfer_recompute), law%history])
  end function point_variables

  !> Points without contact: slip and work of friction so far stay.
  pure subroutine rest(state)
    real(wp), intent(inout) :: state(:, :)   !! (nstate, npoint) [unit of each component]

    state([at_pressure, at_tau, at_status, at_penetration, at_piece, at_xi, at_augmentation, at_between, &
           at_energy], :) = 0
  end subroutine rest

  !> Rows of the state that are of the point itself: with corners the same of a corner follow, its position on the side, and its
  !> share there.
  pure function contact_block(corners, nstate) result(n)
    logical, intent(in) :: corners   !! corners of the die are points of contact of their own
    integer, intent(in) :: nstate    !! rows of the state
    integer :: n

    n = merge((nstate - 2)/2, nstate, corners)
  end function contact_block

  !> A point is in contact, or the corner of the die beside it, or its side next to it (contact_between).
  pure function is_in_contact(state, corners) result(yes)
    real(wp), intent(in) :: state(:)   !! (nstate) with that of the corner, where there is one [unit of each component]
    logical, intent(in) :: corners     !! corners of the die are points of contact of their own
    logical :: yes

    integer :: n

    yes = nint(state(at_status)) /= contact_open .or. state(at_between) > 0
    if (yes .or. .not. corners) return
    n = contact_block(corners, size(state))
    yes = nint(state(n + at_status)) /= contact_open .or. state(n + at_between) > 0
  end function is_in_contact

  !> A point that has lost more than half of its pressure beyond the corner at the end of its face (corner_release).
  elemental function is_released(xi) result(yes)
    real(wp), intent(in) :: xi   !! parent coordinate in its state [-]
    logical :: yes

    yes = abs(xi) > 1 + 1.5_wp*end_slack
  end function is_released

  !> Stresses shown at a point on the axis, where none act: on the line through its two neighbours.
  pure subroutine show_on_axis(xi, x, side, trial)
    real(wp), intent(in) :: xi(:)            !! (npoint) [-]
    real(wp), intent(in) :: x(3)             !! radii of the nodes [length]
    real(wp), intent(in) :: side             !! length of the side [length]
    real(wp), intent(inout) :: trial(:, :)   !! (nstate, npoint) [unit of each component]
    real(wp) :: phi(3), dphi(3), share
    integer :: p, step, n

    n = size(xi)
    if (n < 3) return
    do p = 1, n, n - 1
      call line3(xi(p), phi, dphi)
      if (dot_product(phi, x) > no_surface*side) cycle
      step = merge(1, -1, p == 1)
      share = (xi(p) - xi(p + step))/(xi(p + 2*step) - xi(p + step))
      trial([at_pressure, at_tau], p) = (1 - share)*trial([at_pressure, at_tau], p + step) &
                                        + share*trial([at_pressure, at_tau], p + 2*step)
    end do
  end subroutine show_on_axis

end module contact_state
