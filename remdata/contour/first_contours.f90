!> Contours of bodies that have no mesh yet, from their BODY cards.
module first_contours
  use boundary_curves, only: close_boundary, kind_end, kind_joint
  use contour_laps, only: find_laps
  use corrected_contours, only: contour_options_t, contour_report_t, contour_t
  use errors, only: error_t, exit_input, fail
  use scene, only: scene_t
  use text, only: to_text
  use zone_marks, only: contour_card_t
  implicit none
  private
  public :: contours_of_cards

contains

  !> The contours of each body, the outer one and those of holes; rows are the sets of sides NAME.1, NAME.2 ...
  pure subroutine contours_of_cards(scene, contours, report, error)
    type(scene_t), intent(in) :: scene
    type(contour_t), allocatable, intent(out) :: contours(:)   !! (ncontour)
    type(contour_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: no_dies(:, :)
    logical, allocatable :: no_faces(:, :, :)
    integer :: b, c, k, n

    associate (cards => scene%remesher%contours)
      allocate (contours(sum([(maxval(cards(b)%loop), b=1, size(cards))])), report%limits(0))
      n = maxval([(size(cards(b)%row), b=1, size(cards))])
      c = 0
      do b = 1, size(cards)
        do k = 1, maxval(cards(b)%loop)
          c = c + 1
          contours(c)%loop%body = b
          call contour_of_card(scene, cards(b), k, contours(c))
        end do
      end do
    end associate
    allocate (no_dies(n, size(contours)), source=0)
    allocate (no_faces(size(scene%dies), n, size(contours)), source=.false.)
    call find_laps([(contours(c)%boundary, c=1, size(contours))], no_dies, no_faces, report%laps)
    if (size(report%laps) == 0) return
    call fail(error, exit_input, 'contours of bodies cross at x = '//to_text(report%laps(1)%point(1))//', y = ' &
              //to_text(report%laps(1)%point(2)), 'correct the rows of the BODY cards there')
  end subroutine contours_of_cards

  !> One of the contours of a card.
  pure subroutine contour_of_card(scene, card, loop, contour)
    type(scene_t), intent(in) :: scene
    type(contour_card_t), intent(in) :: card
    integer, intent(in) :: loop
    type(contour_t), intent(inout) :: contour
    type(contour_options_t) :: options
    integer, allocatable :: piece(:)
    integer :: k, n, s

    piece = pack([(k, k=1, size(card%loop))], card%loop == loop)
    n = size(piece)
    associate (boundary => contour%boundary, tags => contour%tags)
      allocate (contour%loop%sides(3, 0), contour%loop%element(0), contour%contacts(0))
      allocate (boundary%arcs(n), boundary%kinds(n))
      do k = 1, n
        boundary%arcs(k)%points = card%pieces(:, :, piece(k))
        boundary%arcs(k)%middle = k
        boundary%arcs(k)%side = k
        ! a node stands where one side of the body ends and the next begins
        boundary%kinds(k) = merge(kind_end, kind_joint, card%row(piece(k)) == card%row(piece(modulo(k - 2, n) + 1)))
      end do
      call close_boundary(options%corner_turn, boundary)
      allocate (tags%on_set(size(scene%mesh%sides), n), tags%on_group(size(scene%groups), n), &
                tags%on_fixation(size(scene%fixations), n), tags%on_die(size(scene%dies), n), source=.false.)
      allocate (tags%on_axis(n), tags%on_wall(n), source=.false.)
      do s = 1, size(scene%mesh%sides)
        do k = 1, n
          tags%on_set(s, k) = scene%mesh%sides(s)%name == scene%groups(card%group)%name//'.'//to_text(card%row(piece(k)))
        end do
      end do
    end associate
  end subroutine contour_of_card

end module first_contours
