!> Bodies are cut, after their contours were corrected and before they are meshed (cards TRIM and PIERC).
module contour_cuts
  use contour_volume, only: volume_inside, volume_of_section
  use corrected_contours, only: contour_t
  use cut_contour, only: contour_of_piece
  use cut_pieces, only: piece_t
  use cuts, only: cut_record_t, cut_t, is_trim, web_trigger
  use errors, only: error_t, exit_input, fail
  use fields, only: section_field
  use kinds, only: wp
  use loop_group, only: group_of
  use offset_parabolas, only: point_at
  use pierce_cut, only: pierce_body
  use plane_vectors, only: cross
  use point_in_curve, only: is_around
  use scene, only: axisymmetric, scene_t
  use solution, only: present_coordinates, solution_t
  use trim_cut, only: point_text, trim_body
  use web_thickness, only: measure_web, web_t
  implicit none
  private
  public :: cut_is_due, make_cuts

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
      of_body(c) = group_of(scene, contours(c)%loop) == cut%group
    end do
    before = total_volume(contours, of_body, solution%fields(section_field)%value(:, 1))
    if (is_trim(cut)) then
      call trim_body(scene, cut, contours, of_body, pieces, error)
    else
      call pierce_body(scene, solution, cut, contours, of_body, before, pieces, record, error)
    end if
    if (allocated(error)) return
    call replace_contours(scene, solution, cut, of_body, pieces, contours)
    record%volume = before - total_volume(contours, [(group_of(scene, contours(c)%loop) == cut%group, c=1, size(contours))], &
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

end module contour_cuts
