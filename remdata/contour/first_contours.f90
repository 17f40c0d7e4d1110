!> Contours of bodies that have no mesh yet, from their BODY cards.
module first_contours
  use boundary_curves, only: close_boundary, kind_end, kind_joint
  use contour_laps, only: find_laps
  use corrected_contours, only: contour_options_t, contour_report_t, contour_t
  use errors, only: error_t, exit_input, fail
  use scene, only: scene_t
  use text, only: to_text
  implicit none
  private
  public :: contours_of_cards

contains

  !> One contour for each body; its rows are the sets of sides NAME.1, NAME.2 ...
  pure subroutine contours_of_cards(scene, contours, report, error)
    type(scene_t), intent(in) :: scene
    type(contour_t), allocatable, intent(out) :: contours(:)   !! (ncontour)
    type(contour_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(contour_options_t) :: options
    integer, allocatable :: no_dies(:, :)
    logical, allocatable :: no_faces(:, :, :)
    integer :: c, k, n, s

    associate (cards => scene%remesher%contours)
      allocate (contours(size(cards)), report%limits(0))
      do c = 1, size(cards)
        n = size(cards(c)%row)
        associate (boundary => contours(c)%boundary, tags => contours(c)%tags)
          allocate (contours(c)%loop%sides(3, 0), contours(c)%loop%element(0), contours(c)%contacts(0))
          allocate (boundary%arcs(n), boundary%kinds(n))
          do k = 1, n
            boundary%arcs(k)%points = cards(c)%pieces(:, :, k)
            boundary%arcs(k)%middle = k
            boundary%arcs(k)%side = k
            ! a node stands where one side of the body ends and the next begins
            boundary%kinds(k) = merge(kind_end, kind_joint, cards(c)%row(k) == cards(c)%row(modulo(k - 2, n) + 1))
          end do
          call close_boundary(options%corner_turn, boundary)
          allocate (tags%on_set(size(scene%mesh%sides), n), tags%on_group(size(scene%groups), n), &
                    tags%on_fixation(size(scene%fixations), n), tags%on_die(size(scene%dies), n), source=.false.)
          allocate (tags%on_axis(n), tags%on_wall(n), source=.false.)
          do s = 1, size(scene%mesh%sides)
            do k = 1, n
              tags%on_set(s, k) = scene%mesh%sides(s)%name == scene%groups(cards(c)%group)%name//'.'//to_text(cards(c)%row(k))
            end do
          end do
        end associate
      end do
      allocate (no_dies(maxval([(size(cards(c)%row), c=1, size(cards))]), size(cards)), source=0)
      allocate (no_faces(size(scene%dies), size(no_dies, 1), size(cards)), source=.false.)
    end associate
    call find_laps([(contours(c)%boundary, c=1, size(contours))], no_dies, no_faces, report%laps)
    if (size(report%laps) == 0) return
    call fail(error, exit_input, 'contours of bodies cross at x = '//to_text(report%laps(1)%point(1))//', y = ' &
              //to_text(report%laps(1)%point(2)), 'correct the rows of the BODY cards there')
  end subroutine contours_of_cards

end module first_contours
