!> The pieces that a cut along a line leaves of a body (card TRIM).
module trim_cut
  use contour_volume, only: volume_inside
  use corrected_contours, only: contour_t
  use cut_crossings, only: close_to_joint, crossings_of_line, cut_crossing_t
  use cut_pieces, only: follow_pieces, piece_t
  use cuts, only: cut_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use scene, only: scene_t
  use text, only: to_text
  implicit none
  private
  public :: trim_body, point_text

contains

  !> The piece of a body on the side of a line that is kept; an error where it is not one.
  subroutine trim_body(scene, cut, contours, of_body, pieces, error)
    type(scene_t), intent(in) :: scene
    type(cut_t), intent(in) :: cut
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: of_body(:)   !! (ncontour) contours of the body that is cut
    type(piece_t), allocatable, intent(out) :: pieces(:)   !! (npiece) that are left
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

  !> A point for a message.
  pure function point_text(point) result(s)
    real(wp), intent(in) :: point(2)   !! [length]
    character(len=:), allocatable :: s

    s = '('//to_text(point(1))//', '//to_text(point(2))//')'
  end function point_text

end module trim_cut
