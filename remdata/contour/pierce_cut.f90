!> The piece that a cut through the web under a die leaves of a body (card PIERC).
module pierce_cut
  use contour_volume, only: volume_inside, volume_of_section
  use corrected_contours, only: contour_t
  use cut_crossings, only: close_to_joint, crossings_of_way, cut_crossing_t
  use cut_pieces, only: follow_pieces, piece_t
  use cuts, only: cut_record_t, cut_t
  use errors, only: error_t, exit_input, fail
  use fields, only: pilot_field, section_field
  use kinds, only: wp
  use point_in_curve, only: is_around
  use scene, only: axisymmetric, scene_t
  use solution, only: solution_t
  use vectors, only: length_of
  use web_thickness, only: measure_web, web_t
  implicit none
  private
  public :: pierce_body

contains

  !> Through the web under a die. What is as thin goes with the slug, and the rim of it that no element could resolve, a lip which
  !> the die would fold under its edge: of all these ways the one is taken that leaves least of the piece that is kept.
  subroutine pierce_body(scene, solution, cut, contours, of_body, whole, pieces, record, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(cut_t), intent(in) :: cut
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: of_body(:)   !! (ncontour) contours of the body that is cut
    real(wp), intent(in) :: whole   !! volume of the body [length^3], per radian when axisymmetric
    type(piece_t), allocatable, intent(out) :: pieces(:)   !! (npiece) that are left
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
      real(wp) :: apart
      integer :: i

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
        first = part > 0.5_wp*whole
      end if
    end subroutine choose_kept

  end subroutine pierce_body

end module pierce_cut
