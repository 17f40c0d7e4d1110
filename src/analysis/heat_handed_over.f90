!> Heat that an operation has left to the next one. A contact that goes on keeps its own, and so does plastic work where both laws
!> have QUINNEY; the rest is put into the points of the bodies (`heat_due`), who release it in the first step: that of friction into
!> those beside the side, and beside the facing side of another body. What a rigid die has of it goes with the die.
!>
!> Plastic work done before a law with QUINNEY came has made no heat, and makes none later.
module heat_handed_over
  use bodies_behind, only: find_bodies_behind
  use driver_sources, only: find_drivers
  use driver_values, only: start_drivers
  use drivers, only: at_body_effusivity, at_die_effusivity, at_die_piece, drivers_t
  use elem_heat_contact, only: name_of_due
  use heat_contacts, only: share_by_effusivity
  use heat_sources, only: work_heated, work_name
  use kinds, only: wp
  use law_api, only: law_t
  use next_operation, only: same_group
  use pending_heat, only: first_of, heat_of_friction, heat_of_work, volumes_at_start
  use quadrature, only: square_rule
  use scene, only: role_heat_contact, role_second, scene_t
  use solution, only: solution_t
  use state_variables, only: name_of_heat_due
  implicit none
  private
  public :: hand_heat_over

  !> A body's element beside a side.
  type :: beside_t
    integer, allocatable :: body(:), element(:), side(:)   ! (nside)
  end type beside_t

contains

  !> Into the state with which an operation begins.
  subroutine hand_heat_over(old, before, new, laws, after)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before
    type(law_t), intent(in) :: laws(:)         !! (nlaw)
    type(solution_t), intent(inout) :: after
    type(drivers_t), allocatable :: drivers(:)
    integer :: g, k

    call find_drivers(old, laws, drivers)
    call start_drivers(old, laws, before, drivers)
    do g = 1, size(old%groups)
      if (old%groups(g)%role == role_heat_contact) then
        if (.not. goes_on(old, before, new, after, g)) call leave_friction(old, before, new, drivers, g, after)
      else if (first_of(old, g, work_heated) > 0) then
        k = named(new, old%groups(g)%name)
        if (k == 0) cycle
        if (first_of(new, k, work_heated) == 0) call leave_work(new, heat_of_work(old, laws, drivers, before, g), k, after)
      end if
    end do
    do g = 1, size(new%groups)
      if (first_of(new, g, work_heated) == 0 .or. new%groups(g)%host == 0) cycle
      k = named(old, new%groups(g)%name)
      if (k > 0) then
        if (first_of(old, k, work_heated) > 0) cycle
      end if
      associate (done => first_of(new, new%groups(g)%host, work_name))
        if (done == 0) cycle
        after%groups(g)%committed(first_of(new, g, work_heated), :, :) = after%groups(new%groups(g)%host)%committed(done, :, :)
      end associate
      after%groups(g)%trial = after%groups(g)%committed
    end do
  end subroutine hand_heat_over

  !> The heat of friction of a contact is that of the same one in the next operation.
  pure function goes_on(old, before, new, after, k) result(yes)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before, after
    integer, intent(in) :: k   !! place in the old list
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(new%groups)
      if (first_of(new, g, name_of_due) == 0) cycle
      yes = yes .or. same_group(old, before, new, after, g) == k
    end do
  end function goes_on

  !> Heat of plastic work at the points of a group, to the same points.
  subroutine leave_work(new, heat, g, after)
    type(scene_t), intent(in) :: new
    real(wp), intent(in) :: heat(:, :)   !! (npoint, nelem) [energy]
    integer, intent(in) :: g             !! place in the new list
    type(solution_t), intent(inout) :: after
    integer :: e, row

    row = first_of(new, g, name_of_heat_due)
    if (row == 0) return
    do e = 1, size(heat, 2)
      after%groups(g)%committed(row, :, e) = after%groups(g)%committed(row, :, e) + heat(:, e)/volumes_at_start(new, after, g, e)
    end do
    after%groups(g)%trial = after%groups(g)%committed
  end subroutine leave_work

  !> Shared between both sides as the contact does it (elem_heat_contact).
  subroutine leave_friction(old, before, new, drivers, g, after)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before
    type(drivers_t), intent(in) :: drivers(:)   !! (ngroup) of the old scene
    integer, intent(in) :: g                    !! place of the contact
    type(solution_t), intent(inout) :: after
    real(wp), allocatable :: heat(:, :)
    type(beside_t) :: part, die
    real(wp) :: share, to_die
    integer :: e, p, piece

    allocate (heat, source=heat_of_friction(old, before, g))
    if (.not. any(abs(heat) > 0)) return
    associate (contact => old%groups(g)%heat_contact, at_points => drivers(g)%value, nodes => old%groups(g)%connectivity)
      call find_bodies_behind(old, nodes(2, :), part%body, part%element, part%side)
      if (allocated(old%dies(old%groups(g)%die)%nodes)) &
        call find_bodies_behind(old, old%dies(old%groups(g)%die)%nodes(2, :), die%body, die%element, die%side)
      do e = 1, size(heat, 2)
        do p = 1, size(heat, 1)
          piece = nint(at_points(at_die_piece, 1, p, e))
          share = contact%share
          if (share < 0) share = share_by_effusivity(at_points(at_body_effusivity, 1, p, e), at_points(at_die_effusivity, 1, p, e))
          if (allocated(die%body) .and. piece == 0) share = 1
          call put_beside(old, new, part, e, share*heat(p, e), after)
          to_die = (1 - share)*heat(p, e)
          if (allocated(die%body)) then
            if (piece > 0) call put_beside(old, new, die, piece, to_die, after)
          else
            after%heat_released = after%heat_released + to_die
            after%heat_in = after%heat_in - to_die
            after%heat_passed = after%heat_passed + 2*abs(to_die)
          end if
        end do
      end do
    end associate
  end subroutine leave_friction

  !> Into the points of the element behind a side, the more the nearer they are to it.
  subroutine put_beside(old, new, beside, s, heat, after)
    type(scene_t), intent(in) :: old, new
    type(beside_t), intent(in) :: beside
    integer, intent(in) :: s             !! side
    real(wp), intent(in) :: heat         !! [energy]
    type(solution_t), intent(inout) :: after
    real(wp), allocatable :: xi(:, :), weight(:), share(:), volume(:)
    integer :: g, row

    if (beside%body(s) == 0) return
    do g = 1, size(new%groups)
      row = first_of(new, g, name_of_heat_due)
      if (row == 0) cycle
      if (new%groups(merge(new%groups(g)%host, g, new%groups(g)%role == role_second))%name /= old%groups(beside%body(s))%name) cycle
      call square_rule(new%groups(g)%rule%n, xi, weight)
      select case (beside%side(s))
      case (1)
        share = 0.5_wp*(1 - xi(2, :))
      case (2)
        share = 0.5_wp*(1 + xi(1, :))
      case (3)
        share = 0.5_wp*(1 + xi(2, :))
      case default
        share = 0.5_wp*(1 - xi(1, :))
      end select
      volume = volumes_at_start(new, after, g, beside%element(s))
      associate (state => after%groups(g)%committed(row, :, beside%element(s)))
        state = state + heat*share/dot_product(share, volume)
      end associate
      after%groups(g)%trial = after%groups(g)%committed
      return
    end do
  end subroutine put_beside

  !> Place of a group by its name, 0 where there is none.
  pure function named(scene, name) result(g)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    integer :: g

    do g = 1, size(scene%groups)
      if (scene%groups(g)%name == name) return
    end do
    g = 0
  end function named

end module heat_handed_over
