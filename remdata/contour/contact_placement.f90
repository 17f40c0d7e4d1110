!> Runs of contact of a loop with the places of their dies that they go through.
module contact_placement
  use boundary_sides, only: loop_t
  use contact_ends, only: contact_end_t
  use contact_gaps, only: close_gaps, mark_pockets
  use contact_knots, only: begin_at_point, section_t, sections_of_run
  use contact_runs, only: find_runs, is_shared, run_t
  use contour_assembly, only: contact_t
  use dies, only: present_die
  use kinds, only: pi, wp
  use scene, only: scene_t
  use side_tags, only: lasting_ends, side_tags_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: contour_options_t, place_contacts

  type :: contour_options_t
    !> Tangents that turn by more make a corner [radian].
    real(wp) :: corner_turn = 20*pi/180
    !> Contact over less of a side, in sides, is left as it is.
    real(wp) :: least_contact = 0.05_wp
    !> Gaps between two runs that are no wider than this share of a side are contact too: no mesh resolves them.
    real(wp) :: narrow_gap = 0.01_wp
    !> Gaps that are no wider than this share of a side, and no longer than some sides, are pockets: their ends are no limits.
    real(wp) :: pocket_width = 0.1_wp, pocket_length = 2.0_wp
  end type contour_options_t

  !> Old sides that turn by less than a corner may leave one on the die: nodes are lasting, and sides steep, from this share of the
  !> turn on.
  real(wp), parameter :: lasting_share = 0.5_wp

contains

  !> Runs of contact of a loop with the die's places they go through.
  pure subroutine place_contacts(scene, solution, x, ends, options, loop, tags, contacts, backward)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)              !! nodes now (2, nnode) [length]
    type(contact_end_t), intent(in) :: ends(:)   !! of the checkpoint
    type(contour_options_t), intent(in) :: options
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    type(contact_t), allocatable, intent(out) :: contacts(:)
    integer, intent(inout) :: backward   !! one more for each run left out because it goes backwards along its die
    type(run_t), allocatable :: runs(:)
    type(contact_t) :: one
    type(section_t), allocatable :: sections(:)
    type(contact_t), allocatable :: list(:)
    real(wp) :: turn
    integer :: k, n

    turn = lasting_share*options%corner_turn
    call find_runs(scene, loop, tags, lasting_ends(loop, tags, x, turn), ends, closed_groups(scene, solution), &
                   options%least_contact, runs)
    call close_gaps(scene, solution, loop, tags, x, options%narrow_gap, runs)
    call mark_pockets(scene, solution, loop, x, options%pocket_width, options%pocket_length, runs)
    allocate (list(size(runs)))
    n = 0
    do k = 1, size(runs)
      one%run = runs(k)
      one%number = scene%groups(runs(k)%group)%die
      one%die = present_die(scene%dies(one%number), x)
      one%pilot = solution%pilots(:, one%number)
      associate (npoint => scene%groups(runs(k)%group)%npoint)
        call begin_at_point(npoint, loop, x, one%die, one%pilot, options%least_contact, turn, &
                            [is_shared(runs, k, 1, size(loop%sides, 2)), is_shared(runs, k, 2, size(loop%sides, 2))], one%run)
        call sections_of_run(one%run, npoint, loop, tags, x, one%die, one%pilot, sections)
      end associate
      if (size(sections) == 0) then
        backward = backward + 1
        cycle
      end if
      n = n + 1
      list(n) = one
      call move_alloc(sections, list(n)%sections)
    end do
    ! behind a run that is left out there is no pocket
    if (n < size(runs)) list%run%pocket = .false.
    allocate (contacts, source=list(:n))
  end subroutine place_contacts

  !> Groups with points in contact: their status is zero when open.
  pure function closed_groups(scene, solution) result(closed)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: closed(size(scene%groups))
    integer :: g, place

    closed = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0) cycle
        place = find_variable(group%variables, 'contact_status')
        if (place > 0) closed(g) = any(nint(solution%groups(g)%committed(group%variables(place)%first, :, :)) /= 0)
      end associate
    end do
  end function closed_groups

end module contact_placement
