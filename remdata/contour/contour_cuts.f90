!> Bodies are cut, after their contours were corrected and before they are meshed (cards TRIM and PIERC).
module contour_cuts
  use contour_volume, only: volume_inside, volume_of_section
  use cut_contour, only: contour_of_piece
  use cut_crossings, only: cut_crossing_t, crossings_of_line, crossings_of_way
  use cut_pieces, only: follow_pieces, piece_t
  use cuts, only: cut_record_t, cut_t, is_trim, web_trigger
  use boundary_curves, only: boundary_curve_t
  use errors, only: error_t, exit_input, fail
  use fields, only: pilot_field, section_field
  use kinds, only: wp
  use loop_group, only: group_of
  use offset_parabolas, only: point_at
  use part_contour, only: contour_t
  use plane_vectors, only: cross
  use scene, only: axisymmetric, scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: to_text
  use vectors, only: length_of
  use web_thickness, only: measure_web, web_t
  implicit none
  private
  public :: cut_is_due, make_cuts

  !> Points along an arc, for the question whether a curve is around a point.
  integer, parameter :: chords = 4
  !> Where they meet, cuts and joints closer than this share of the smallest element are one point.
  real(wp), parameter :: close_to_joint = 0.25_wp
  !> A cut that removes no more than this share of the volume removes nothing: round-off of the volumes.
  real(wp), parameter :: nothing = 1.0e-9_wp

contains

  !> Cut k of the scene is to be made on this mesh.
  pure function cut_is_due(scene, solution, k) result(due)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: k
    logical :: due
    type(web_t), allocatable :: ways(:)
    integer :: i

    due = solution%cuts(k)%generation == 0
    if (.not. due .or. is_trim(scene%remesher%cuts(k))) return
    due = .false.
    do i = 1, size(solution%estimate%triggers)
      due = due .or. solution%estimate%triggers(i)%name == web_trigger
    end do
    if (.not. due) return
    call measure_web(scene, solution, scene%remesher%cuts(k), ways)
    due = any(ways%thickness <= scene%remesher%cuts(k)%thickness)
  end function cut_is_due

  !> Make all cuts that are due; `records` holds what came of them.
  subroutine make_cuts(scene, solution, contours, records, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), allocatable, intent(inout) :: contours(:)         !! (ncontour)
    type(cut_record_t), allocatable, intent(out) :: records(:)         !! (ncut)
    type(error_t), allocatable, intent(out) :: error
    integer :: k

    allocate (records, source=solution%cuts)
    do k = 1, size(records)
      if (.not. cut_is_due(scene, solution, k)) cycle
      call make_cut(scene, solution, scene%remesher%cuts(k), contours, records(k), error)
      if (allocated(error)) return
      records(k)%generation = scene%generation + 1
      records(k)%time = solution%time
    end do
  end subroutine make_cuts

  subroutine make_cut(scene, solution, cut, contours, record, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(cut_t), intent(in) :: cut
    type(contour_t), allocatable, intent(inout) :: contours(:)
    type(cut_record_t), intent(inout) :: record
    type(error_t), allocatable, intent(out) :: error
    type(piece_t), allocatable :: pieces(:)
    logical :: of_body(size(contours))
    real(wp) :: before
    integer :: c

    do c = 1, size(contours)
      of_body(c) = group_of(scene, contours(c)%loop, c) == cut%group
    end do
    before = total_volume(contours, of_body, solution%fields(section_field)%value(:, 1))
    if (is_trim(cut)) then
      call trim_body(scene, cut, contours, of_body, pieces, error)
    else
      call pierce_body(scene, solution, cut, contours, of_body, pieces, record, error)
    end if
    if (allocated(error)) return
    call replace_contours(scene, solution, cut, of_body, pieces, contours)
    record%volume = before - total_volume(contours, [(group_of(scene, contours(c)%loop, c) == cut%group, c=1, size(contours))], &
                                          solution%fields(section_field)%value(:, 1))
    if (is_trim(cut) .and. .not. record%volume > nothing*before) &
      call fail(error, exit_input, 'TRIM '//scene%groups(cut%group)%name//': the line from '//point_text(cut%line(1:2))//' to ' &
                //point_text(cut%line(3:4))//' is along the side of the body, so that nothing is cut', &
                'corners closer to it than a quarter of the smallest element are on it: give a line farther inside')
  end subroutine make_cut

  !> Volume of those of the contours that `among` names.
  pure function total_volume(contours, among, section) result(volume)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: among(:)              !! (ncontour)
    real(wp), intent(in) :: section(:)           !! (3) thickness at the origin [length], and its slopes [-]
    real(wp) :: volume                           !! [length^3], per radian when axisymmetric
    integer :: c

    volume = 0
    do c = 1, size(contours)
      if (among(c)) volume = volume + volume_of_section(contours(c)%boundary, section)
    end do
  end function total_volume

  !> Along a line.
  subroutine trim_body(scene, cut, contours, of_body, pieces, error)
    type(scene_t), intent(in) :: scene
    type(cut_t), intent(in) :: cut
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: of_body(:)
    type(piece_t), allocatable, intent(out) :: pieces(:)
    type(error_t), allocatable, intent(out) :: error
    type(cut_crossing_t), allocatable :: crossings(:)
    character(len=:), allocatable :: what
    logical :: odd, clean
    integer :: n, k

    what = 'TRIM '//scene%groups(cut%group)%name//': the line from '//point_text(cut%line(1:2))//' to '//point_text(cut%line(3:4))
    call crossings_of_line(contours, of_body, cut%line, cut%kept, close_to_joint*scene%remesher%smallest, crossings, odd)
    if (size(crossings) == 0) then
      call fail(error, exit_input, what//' does not cross the body, so that nothing is cut', &
                'give a line through the body as it is now')
    else if (odd) then
      call fail(error, exit_input, what//' begins or ends within the body', 'let it begin and end outside')
    else
      call follow_pieces(contours, crossings, pieces, clean)
      n = count([(volume_inside(pieces(k)%boundary, .false.) > 0, k=1, size(pieces))])
      if (.not. clean) then
        call fail(error, exit_input, what//' does not part the body: it begins or ends in a hole', &
                  'let it begin and end outside, and go on through the body on both sides of the hole')
      else if (n == 0) then
        call fail(error, exit_input, what//' leaves nothing of the body', 'give another line, or another point to keep')
      else if (n > 1) then
        call fail(error, exit_input, what//' leaves '//to_text(n)//' pieces of the body', 'give a line that leaves one')
      end if
    end if
  end subroutine trim_body

  !> Through the web under a die. What is as thin goes with the slug, and the rim of it that no element could resolve, a lip which
  !> the die would fold under its edge: of all these ways the one is taken that leaves least of the piece that is kept.
  subroutine pierce_body(scene, solution, cut, contours, of_body, pieces, record, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(cut_t), intent(in) :: cut
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: of_body(:)
    type(piece_t), allocatable, intent(out) :: pieces(:)
    type(cut_record_t), intent(inout) :: record
    type(error_t), allocatable, intent(out) :: error
    type(piece_t), allocatable :: some(:)
    type(web_t), allocatable :: ways(:)
    real(wp) :: least, volume
    integer :: k
    logical :: kept_first, clean

    record%force = length_of(solution%fields(pilot_field)%applied(1:2, cut%die))
    call measure_web(scene, solution, cut, ways)
    record%thickness = huge(record%thickness)
    if (size(ways) > 0) record%thickness = minval(ways%thickness)
    allocate (pieces(0))
    if (record%thickness <= cut%thickness) call part_at(minloc(ways%thickness, 1), .true., some, clean)
    if (.not. allocated(some)) clean = .false.
    if (clean) call choose_kept(some(1), kept_first)
    least = huge(least)
    if (clean) then
      do k = 1, size(ways)
        if (.not. is_beside_thin(k)) cycle
        call part_at(k, kept_first, some, clean)
        if (.not. clean) cycle
        volume = volume_inside(some(1)%boundary, scene%plane_state == axisymmetric)
        if (.not. (volume > 0 .and. volume < least)) cycle
        if (cut%names_kept) then
          if (.not. is_around(some(1)%boundary, cut%kept)) cycle
        end if
        least = volume
        pieces = some
      end do
    end if
    if (size(pieces) == 0) call fail(error, exit_input, 'PIERC '//scene%groups(cut%group)%name//' '//scene%dies(cut%die)%name &
      //': no cut through the web leaves one piece of the body', &
      'the web must part the body in two; of a hole, or of half a body, the piece that is kept has a point KEEP x y')

  contains

    !> Where a way begins the web is thin enough, or it is within the smallest element from there: a point has a way across no
    !> longer than that of another by more than its distance from it, but where it leads elsewhere, as along the part.
    pure function is_beside_thin(way) result(beside)
      integer, intent(in) :: way
      logical :: beside
      integer :: i

      real(wp) :: apart

      beside = .false.
      do i = 1, size(ways)
        if (ways(i)%thickness > cut%thickness) cycle
        apart = length_of(ways(i)%from - ways(way)%from)
        beside = beside .or. apart <= scene%remesher%smallest .and. ways(way)%thickness <= ways(i)%thickness + apart
      end do
    end function is_beside_thin

    !> The piece on one side of way k.
    subroutine part_at(way, first, found, is_clean)
      integer, intent(in) :: way
      logical, intent(in) :: first   !! the piece that begins where the way begins; else the other one
      type(piece_t), allocatable, intent(out) :: found(:)
      logical, intent(out) :: is_clean
      type(cut_crossing_t), allocatable :: crossings(:)

      call crossings_of_way(contours, of_body, ways(way)%from, ways(way)%to, close_to_joint*scene%remesher%smallest, crossings)
      if (.not. first) crossings%enters = .not. crossings%enters
      call follow_pieces(contours, crossings, found, is_clean)
      is_clean = is_clean .and. size(found) == 1
    end subroutine part_at

    !> The piece with the point of the card, or else the larger one.
    subroutine choose_kept(one, first)
      type(piece_t), intent(in) :: one
      logical, intent(out) :: first
      real(wp) :: part

      part = volume_of_section(one%boundary, solution%fields(section_field)%value(:, 1))
      if (cut%names_kept) then
        first = is_around(one%boundary, cut%kept)
      else
        first = part > 0.5_wp*total_volume(contours, of_body, solution%fields(section_field)%value(:, 1))
      end if
    end subroutine choose_kept

  end subroutine pierce_body

  !> The pieces take the place of the contours of the body; of contours that the cut does not cross holes within the pieces stay,
  !> and parts that stand for themselves: those beside a line on the side that is kept.
  subroutine replace_contours(scene, solution, cut, of_body, pieces, contours)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(cut_t), intent(in) :: cut
    logical, intent(in) :: of_body(:)
    type(piece_t), intent(in) :: pieces(:)
    type(contour_t), allocatable, intent(inout) :: contours(:)
    type(contour_t), allocatable :: after(:)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))
    logical :: crossed, stays
    integer :: c, k

    x = present_coordinates(scene, solution)
    allocate (after(0))
    do c = 1, size(contours)
      crossed = any([(any(pieces(k)%contour == c), k=1, size(pieces))])
      stays = .not. of_body(c)
      if (.not. (stays .or. crossed)) then
        associate (arc => contours(c)%boundary%arcs(1))
          if (volume_inside(contours(c)%boundary, .false.) > 0) then
            stays = .not. is_trim(cut)
            if (is_trim(cut)) stays = side_of_line(cut, point_at(arc, arc%range(1)))*side_of_line(cut, cut%kept) > 0
          else
            stays = any([(is_around(pieces(k)%boundary, point_at(arc, arc%range(1))), k=1, size(pieces))])
          end if
        end associate
      end if
      if (stays) after = [after, contours(c)]
    end do
    do k = 1, size(pieces)
      after = [after, contour_of_piece(contours, pieces(k), x, scene%plane_state == axisymmetric)]
    end do
    call move_alloc(after, contours)
  end subroutine replace_contours

  !> Above 0 on the left of the line of a cut, below on its right [area].
  pure function side_of_line(cut, point) result(side)
    type(cut_t), intent(in) :: cut
    real(wp), intent(in) :: point(2)   !! [length]
    real(wp) :: side

    side = cross(cut%line(3:4) - cut%line(1:2), point - cut%line(1:2))
  end function side_of_line

  !> Is a point within a closed curve? By the crossings of a ray along x with its chords.
  pure function is_around(boundary, point) result(around)
    type(boundary_curve_t), intent(in) :: boundary
    real(wp), intent(in) :: point(2)   !! [length]
    logical :: around
    real(wp) :: a(2), b(2)
    integer :: k, i

    around = .false.
    do k = 1, size(boundary%arcs)
      associate (arc => boundary%arcs(k))
        a = point_at(arc, arc%range(1))
        do i = 1, chords
          b = point_at(arc, arc%range(1) + (arc%range(2) - arc%range(1))*i/chords)
          if ((a(2) > point(2)) .neqv. (b(2) > point(2))) then
            if (point(1) < a(1) + (point(2) - a(2))*(b(1) - a(1))/(b(2) - a(2))) around = .not. around
          end if
          a = b
        end do
      end associate
    end do
  end function is_around

  function point_text(point) result(s)
    real(wp), intent(in) :: point(2)
    character(len=:), allocatable :: s

    s = '('//to_text(point(1))//', '//to_text(point(2))//')'
  end function point_text

end module contour_cuts
