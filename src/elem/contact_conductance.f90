!> Conductances of the points of heat through contact, as the mechanics has left them, to be handed over from one turn of the solves
!> to the next (exchange_in_turns).
module contact_conductance
  use drivers, only: at_die_piece, at_status, drivers_t, hand_over_conductance, heat_contact_drivers
  use heat_contact_point, only: conductance_by_contact
  use heat_contacts, only: largest_conductance
  use kinds, only: wp
  use scene, only: scene_t
  use side_points, only: side_length
  use solution, only: solution_t
  implicit none
  private
  public :: conductance_count, conductance_of_solution, hand_over, largest_conductances

contains

  !> Number of values of all points of all groups together: two a point (conductance_of in heat_contacts).
  pure function conductance_count(drivers) result(n)
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
    integer :: n
    integer :: g

    n = 0
    do g = 1, size(drivers)
      if (drivers(g)%is_of_heat_contact) n = n + 2*size(drivers(g)%value, 3)*size(drivers(g)%value, 4)
    end do
  end function conductance_count

  !> Conductances as the trial state has them, group by group; not_handed where contact knows nothing of a point.
  subroutine conductance_of_solution(scene, solution, drivers, values)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
    real(wp), intent(out) :: values(:)          !! (conductance_count) [power/area/temperature], [-]
    real(wp) :: now(heat_contact_drivers), side
    integer :: g, p, e, k, i

    i = 0
    now = 0
    do g = 1, size(drivers)
      if (.not. drivers(g)%is_of_heat_contact) cycle
      associate (group => scene%groups(g), own => drivers(g))
        do e = 1, size(own%value, 4)
          side = side_length(scene, group%connectivity(:, e))
          do p = 1, size(own%value, 3)
            do k = at_status, at_die_piece
              now(k) = solution%groups(group%host)%trial(own%source(k)%row(group%host), p, e)
            end do
            values(i + 1:i + 2) = conductance_by_contact(group, now, side)
            i = i + 2
          end do
        end do
      end associate
    end do
  end subroutine conductance_of_solution

  !> Bounds of these values.
  pure subroutine largest_conductances(scene, drivers, values)
    type(scene_t), intent(in) :: scene
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup)
    real(wp), intent(out) :: values(:)          !! (conductance_count) [power/area/temperature], [-]
    integer :: g, i, n

    i = 0
    do g = 1, size(drivers)
      if (.not. drivers(g)%is_of_heat_contact) cycle
      n = conductance_count(drivers(g:g))
      values(i + 1:i + n) = pack(spread(largest_conductance(scene%groups(g)%heat_contact), 2, n/2), .true.)
      i = i + n
    end do
  end subroutine largest_conductances

  !> Heat has these conductances at the end of the step from now on; with none, those that contact has reached.
  pure subroutine hand_over(values, drivers)
    real(wp), intent(in) :: values(:)               !! (conductance_count), or none [power/area/temperature], [-]
    type(drivers_t), intent(inout) :: drivers(:)    !! (ngroup)
    real(wp), parameter :: none(0, 0, 0) = 0.0_wp
    integer :: g, i, n

    i = 0
    do g = 1, size(drivers)
      if (.not. drivers(g)%is_of_heat_contact) cycle
      if (size(values) == 0) then
        call hand_over_conductance(none, drivers(g))
        cycle
      end if
      n = conductance_count(drivers(g:g))
      call hand_over_conductance(reshape(values(i + 1:i + n), [2, size(drivers(g)%value, 3), size(drivers(g)%value, 4)]), &
                                 drivers(g))
      i = i + n
    end do
  end subroutine hand_over

end module contact_conductance
