!> What the rows of a cycle's table say of the tries so far: what was refused at a stop is not tried again there.
module cycle_tries
  use cycle_table, only: try_row_t, way_agreed, way_earlier, way_old_mesh
  use kinds, only: wp
  implicit none
  private
  public :: agreed_way, any_agreed, first_reason, first_step_of, number_refused, was_refused, has_new_mesh, keeps_old_mesh, &
            transfer_is_responsible, mesh_is_responsible, took_earlier

  !> So many tries that were refused by the force of a die alone are several. They agree when their changes of the force differ by
  !> no more than its limit.
  integer, parameter :: several = 3
  real(wp), parameter :: agree_within = 1.0_wp

  !> Times are the same up to this share: the table has all their digits.
  real(wp), parameter :: same_time = 1.0e-12_wp

contains

  !> Tries at mesh `generation` that were refused at the stop after `stop_step`.
  pure function number_refused(rows, generation, stop_step) result(number)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    integer :: number

    number = count(is_refused(rows, generation, stop_step))
  end function number_refused

  !> A try at this mesh, at this stop, that was refused.
  elemental function is_refused(row, generation, stop_step) result(refused)
    type(try_row_t), intent(in) :: row
    integer, intent(in) :: generation, stop_step
    logical :: refused

    refused = row%generation == generation .and. row%stop_step == stop_step .and. .not. row%accepted
  end function is_refused

  !> Was this way refused at this stop?
  pure function was_refused(rows, generation, stop_step, way) result(refused)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=*), intent(in) :: way
    logical :: refused
    integer :: k

    refused = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) refused = refused .or. rows(k)%action == way
    end do
  end function was_refused

  !> Why the first try was refused at this stop, '' where it is not known.
  pure function first_reason(rows, generation, stop_step) result(reason)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=:), allocatable :: reason
    integer :: k

    reason = ''
    do k = 1, size(rows)
      if (.not. is_refused(rows(k), generation, stop_step)) cycle
      if (allocated(rows(k)%reason)) reason = rows(k)%reason
      return
    end do
  end function first_reason

  !> Step at which mesh `generation` began; 0 for the first.
  pure function first_step_of(rows, generation) result(step)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    integer :: step
    integer :: k

    step = 0
    do k = 1, size(rows)
      if (rows(k)%generation == generation .and. rows(k)%accepted .and. rows(k)%action /= way_old_mesh) step = rows(k)%step
    end do
  end function first_step_of

  !> Is there a row of mesh `generation` as an accepted one?
  pure function has_new_mesh(rows, generation) result(has)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    logical :: has
    integer :: k

    has = .false.
    do k = 1, size(rows)
      if (rows(k)%generation == generation .and. rows(k)%accepted) has = has .or. rows(k)%action /= way_old_mesh
    end do
  end function has_new_mesh

  !> Was it decided that the old mesh goes on, before mesh `generation` could be made: at this stop, or at any?
  pure function keeps_old_mesh(rows, generation, stop_step) result(keeps)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation
    integer, intent(in), optional :: stop_step
    logical :: keeps
    integer :: k

    keeps = .false.
    do k = 1, size(rows)
      if (rows(k)%generation /= generation .or. rows(k)%action /= way_old_mesh) cycle
      if (present(stop_step)) then
        keeps = keeps .or. rows(k)%stop_step == stop_step
      else
        keeps = .true.
      end if
    end do
  end function keeps_old_mesh

  !> Was a try at this stop refused by the transfer or a later stage? Another method of transfer cannot repair an earlier stage.
  pure function transfer_is_responsible(rows, generation, stop_step) result(can)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    logical :: can
    integer :: k

    can = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) &
        can = can .or. all(rows(k)%stage /= [character(len=10) :: 'contour', 'mesh', 'checkpoint'])
    end do
  end function transfer_is_responsible

  !> Was a try refused at this stop because no good mesh came of it?
  pure function mesh_is_responsible(rows, generation, stop_step) result(is)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    logical :: is
    integer :: k

    is = .false.
    do k = 1, size(rows)
      if (is_refused(rows(k), generation, stop_step)) is = is .or. rows(k)%stage == 'mesh'
    end do
  end function mesh_is_responsible

  !> The way of the best of several tries at this stop that were refused by the force of a die alone and agree on it: then the old
  !> mesh was wrong. The best is that with the least error of the stress; '' where there are not several, or they do not agree.
  pure function agreed_way(rows, generation, stop_step) result(way)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    integer, intent(in) :: generation, stop_step
    character(len=:), allocatable :: way
    real(wp) :: least, largest, best
    integer :: k, n

    way = ''
    least = huge(least)
    largest = -huge(largest)
    best = huge(best)
    n = 0
    do k = 1, size(rows)
      associate (row => rows(k))
        if (.not. is_refused(row, generation, stop_step)) cycle
        ! all from one state of the old mesh
        if (.not. abs(row%force) > 0 .or. row%step /= stop_step .or. row%action == way_agreed) cycle
        n = n + 1
        least = min(least, row%force)
        largest = max(largest, row%force)
        if (.not. row%error_after < best) cycle
        best = row%error_after
        way = row%action
      end associate
    end do
    if (n < several) then
      way = ''
    else if (least*largest < 0 .or. largest - least > agree_within) then
      way = ''
    end if
  end function agreed_way

  !> Was a mesh taken up on which several tries agreed?
  pure function any_agreed(rows) result(any)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    logical :: any
    integer :: k

    any = .false.
    do k = 1, size(rows)
      if (rows(k)%accepted) any = any .or. rows(k)%action == way_agreed
    end do
  end function any_agreed

  !> Was a mesh made from the save before a stop at this time, or at a later one?
  pure function took_earlier(rows, time) result(took)
    type(try_row_t), intent(in) :: rows(:)   !! (ntry)
    real(wp), intent(in) :: time
    logical :: took
    integer :: k

    took = .false.
    do k = 1, size(rows)
      if (rows(k)%accepted .and. rows(k)%stop_time >= time*(1 - same_time)) took = took .or. rows(k)%action == way_earlier
    end do
  end function took_earlier

end module cycle_tries
