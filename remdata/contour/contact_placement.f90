!> Contact intervals of a loop with their closest points on the dies, and points of contact.
module contact_placement
  use boundary_sides, only: loop_t
  use contact_ends, only: contact_end_t
  use contact_gaps, only: close_gaps, mark_small_gaps
  use contact_intervals, only: find_intervals
  use contour_contacts, only: contact_t
  use corrected_contours, only: contour_options_t
  use die_corner_contact, only: extend_to_corners
  use corner_ends, only: end_in_corners
  use dies, only: present_die
  use fields, only: pilot_field
  use interval_sections, only: section_t, sections_of_interval, start_at_contact_point
  use kinds, only: pi, wp
  use loop_intervals, only: along, contact_interval_t, is_shared, sort_intervals
  use own_contact, only: faces_itself
  use point_contacts, only: find_points, lies_beside, point_contact_t
  use quadrature, only: rule_control
  use scene, only: scene_t
  use side_tags, only: kept_corners, side_tags_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: place_contacts

  !> Old sides that turn by less than a corner may form one on the die: corners are kept, and sides are steep, from this share of
  !> the turn on.
  real(wp), parameter :: kept_corner_share = 0.5_wp
  !> Length beside an end of a side that its control point stands for [sides].
  real(wp), parameter :: of_control_point = 0.5_wp

contains

  !> Find the contact intervals of a loop and their closest points on the dies, and where contact is at a point.
  pure subroutine place_contacts(scene, solution, x, ends, options, loop, tags, contacts, points, backward)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)              !! nodes now (2, nnode) [length]
    type(contact_end_t), intent(in) :: ends(:)   !! (nend) of the checkpoint
    type(contour_options_t), intent(in) :: options
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    type(contact_t), allocatable, intent(out) :: contacts(:)   !! (ncontact)
    type(point_contact_t), allocatable, intent(out) :: points(:)   !! (n)
    integer, intent(inout) :: backward  !! incremented for each interval dropped because it runs backwards along its die
    type(contact_interval_t), allocatable :: intervals(:), short(:)
    type(contact_t) :: one
    type(section_t), allocatable :: sections(:)
    type(contact_t), allocatable :: list(:)
    real(wp) :: turn
    integer :: k, n

    turn = kept_corner_share*options%corner_turn
    call find_intervals(scene, loop, tags, kept_corners(loop, tags, x, turn), ends, closed_groups(scene, solution), &
                   options%least_contact, intervals, short)
    call extend_intervals(scene, solution, loop, options, intervals, short)
    if (options%least_free > 0) call end_in_corners(loop, tags, x, options%corner_turn, options%least_free, intervals)
    call join_over_gaps(scene, solution, loop, tags, x, options, intervals, short)
    call mark_small_gaps(scene, solution, loop, x, options%small_gap_width, options%small_gap_length, intervals)
    allocate (list(size(intervals)))
    n = 0
    do k = 1, size(intervals)
      one%interval = intervals(k)
      one%number = scene%groups(intervals(k)%group)%die
      one%die = present_die(scene%dies(one%number), x)
      one%pilot = solution%fields(pilot_field)%value(:, one%number)
      associate (rule => scene%groups(intervals(k)%group)%rule)
        call start_at_contact_point(rule, loop, x, one%die, one%pilot, options%least_contact, turn, &
                            [is_shared(intervals, k, 1, size(loop%sides, 2)), is_shared(intervals, k, 2, size(loop%sides, 2))], &
                              one%interval)
        call sections_of_interval(one%interval, rule, loop, tags, x, one%die, one%pilot, sections)
      end associate
      if (size(sections) == 0) then
        backward = backward + 1
        cycle
      end if
      n = n + 1
      list(n) = one
      call move_alloc(sections, list(n)%sections)
    end do
    ! no small gap follows an interval that is dropped
    if (n < size(intervals)) list%interval%small_gap = .false.
    allocate (contacts, source=list(:n))
    call find_points(scene, solution, loop, x, short, contacts%interval, points)
  end subroutine place_contacts

  !> Extend intervals to corners of the die in contact. Short ones that go on to one are intervals like the others, but beside
  !> others they are no more than their ends.
  pure subroutine extend_intervals(scene, solution, loop, options, intervals, short)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    type(contour_options_t), intent(in) :: options
    type(contact_interval_t), allocatable, intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    type(contact_interval_t), allocatable, intent(inout) :: short(:)       !! (nshort)
    type(contact_interval_t), allocatable :: list(:)
    logical :: apart(size(short))
    integer :: k, i

    do k = 1, size(short)
      apart(k) = .not. any([(lies_beside(short(k), intervals(i), size(loop%sides, 2)), i=1, size(intervals))])
    end do
    list = [intervals, pack(short, apart)]
    call sort_intervals(list)
    call extend_to_corners(scene, solution, loop, options%small_gap_length, list)
    call part_by_length(scene, options, size(loop%sides, 2), list, intervals, short)
  end subroutine extend_intervals

  !> Join what narrow gaps part, points of contact too.
  pure subroutine join_over_gaps(scene, solution, loop, tags, x, options, intervals, short)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(loop_t), intent(in) :: loop
    type(side_tags_t), intent(in) :: tags
    real(wp), intent(in) :: x(:, :)   !! nodes now (2, nnode) [length]
    type(contour_options_t), intent(in) :: options
    type(contact_interval_t), allocatable, intent(inout) :: intervals(:)   !! (ninterval) in their order along the loop
    type(contact_interval_t), allocatable, intent(inout) :: short(:)       !! (nshort)
    type(contact_interval_t), allocatable :: list(:)

    allocate (list, source=[intervals, short])
    call sort_intervals(list)
    call close_gaps(scene, solution, loop, tags, x, options%narrow_gap, list, &
                    options%small_gap_width, options%small_gap_length)
    call part_by_length(scene, options, size(loop%sides, 2), list, intervals, short)
  end subroutine join_over_gaps

  !> Intervals, and those so short that they are contact at a point. A control point is in contact over what its side has there, at
  !> its end (contact_contour), and stands for the half beside it: an interval shorter than that, with no other beside it, is no
  !> width of the contact.
  pure subroutine part_by_length(scene, options, nside, list, intervals, short)
    type(scene_t), intent(in) :: scene
    type(contour_options_t), intent(in) :: options
    integer, intent(in) :: nside   !! of the loop
    type(contact_interval_t), intent(in) :: list(:)
    type(contact_interval_t), allocatable, intent(inout) :: intervals(:), short(:)
    logical :: long(size(list))
    integer :: k, i

    do k = 1, size(list)
      associate (length => along(list(k)%to) - along(list(k)%from))
        long(k) = length >= options%least_contact
        if (.not. long(k) .or. length >= of_control_point) cycle
        if (scene%groups(list(k)%group)%rule%family /= rule_control) cycle
        long(k) = any([(i /= k .and. lies_beside(list(k), list(i), nside), i=1, size(list))])
      end associate
    end do
    intervals = pack(list, long)
    short = pack(list,.not. long)
  end subroutine part_by_length

  !> Groups with points in contact: their status is zero when open. Sides that face their own body keep their contour
  !> (folded_sides).
  pure function closed_groups(scene, solution) result(closed)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: closed(size(scene%groups))
    integer :: g, row

    closed = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. faces_itself(scene, group)) cycle
        row = find_variable(group%variables, 'contact_status')
        if (row > 0) closed(g) = any(nint(solution%groups(g)%committed(group%variables(row)%first, :, :)) /= 0)
        ! a node on the axis is in contact by itself
        row = find_variable(group%variables, 'corner_contact_status')
        if (row > 0) closed(g) = closed(g) .or. any(nint(solution%groups(g)%committed(group%variables(row)%first, :, :)) /= 0)
      end associate
    end do
  end function closed_groups

end module contact_placement
