!> Element sizes that one body requires of the others where it lies near them.
!>
!> Bodies of unlike shape have sizes of their own. Where a coarse one lies on a fine one it has elements no larger than a number of
!> times those of the fine one (`facing_ratio`); from there they grow with the distance, as within a body: over a gap too, so that
!> what will touch only later is the less refined the farther off it is.
module facing_sizes
  use body_sizes, only: body_sizes_t
  use corrected_contours, only: contour_t
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use offset_parabolas, only: length_between, point_at
  use remesh_defaults, only: facing_ratio
  use square_sizes, only: need_t, size_at
  use vectors, only: length_of
  implicit none
  private
  public :: needs_of_others

  !> Parts of a part's arc at most.
  integer, parameter :: most_parts = 400

contains

  !> Requirements of all other bodies on one of them, along their contours; those that do not reach it are left out.
  pure subroutine needs_of_others(contours, body_of, bodies, body, needs)
    type(contour_t), intent(in) :: contours(:)           !! (ncontour)
    integer, intent(in) :: body_of(:)                    !! (ncontour) number of its body
    type(body_sizes_t), intent(in) :: bodies(:)          !! (nbody) sizes that each asks for by itself
    integer, intent(in) :: body                          !! the one that requirements are for
    type(need_t), allocatable, intent(out) :: needs(:)   !! (nneed)
    type(need_t), allocatable :: more(:)
    real(wp) :: box(4)
    integer :: c, k

    allocate (needs(0))
    box = box_around(contours, body_of, body)
    do c = 1, size(contours)
      if (body_of(c) == body) cycle
      do k = 1, size(contours(c)%boundary%arcs)
        call needs_along(contours(c), k, bodies(body_of(c)), body_of(c), more)
        needs = [needs, pack(more, reaches(more, box, bodies(body)))]
      end do
    end do
  end subroutine needs_of_others

  !> Box around a body: least x and y, largest x and y [length].
  pure function box_around(contours, body_of, body) result(box)
    type(contour_t), intent(in) :: contours(:)
    integer, intent(in) :: body_of(:), body
    real(wp) :: box(4)
    integer :: c, k, i

    box(1:2) = huge(1.0_wp)
    box(3:4) = -huge(1.0_wp)
    do c = 1, size(contours)
      if (body_of(c) /= body) cycle
      do k = 1, size(contours(c)%boundary%arcs)
        do i = 1, 3
          associate (x => contours(c)%boundary%arcs(k)%points(:, i))
            box(1:2) = min(box(1:2), x)
            box(3:4) = max(box(3:4), x)
          end associate
        end do
      end do
    end do
  end function box_around

  !> Whether each requirement, grown with the distance, is below the largest size of a body somewhere in its box.
  pure function reaches(needs, box, sizes) result(yes)
    type(need_t), intent(in) :: needs(:)
    real(wp), intent(in) :: box(4)            !! [length]
    type(body_sizes_t), intent(in) :: sizes   !! of the body in the box
    logical :: yes(size(needs))
    real(wp) :: away
    integer :: i

    do i = 1, size(needs)
      away = length_of(max(box(1:2) - needs(i)%x, needs(i)%x - box(3:4), 0.0_wp))
      yes(i) = needs(i)%size + slope_of(sizes%limits%gradation)*max(away - needs(i)%radius, 0.0_wp) < sizes%limits%largest
    end do
  end function reaches

  !> Requirements along an arc of a finer body, in parts about as long as its elements.
  pure subroutine needs_along(contour, k, sizes, material, needs)
    type(contour_t), intent(in) :: contour
    integer, intent(in) :: k                    !! of the arc
    type(body_sizes_t), intent(in) :: sizes     !! of the contour's body
    integer, intent(in) :: material             !! number of that body
    type(need_t), allocatable, intent(out) :: needs(:)
    real(wp) :: length, h, step
    integer :: i, n

    associate (arc => contour%boundary%arcs(k))
      length = contour%boundary%arc_length(k) - contour%boundary%arc_length(k - 1)
      step = arc%range(2) - arc%range(1)
      h = huge(h)
      do i = 0, 4
        h = min(h, size_at(sizes, material, point_at(arc, arc%range(1) + 0.25_wp*i*step)))
      end do
      n = max(1, min(ceiling(length/h), most_parts))
      step = step/n
      allocate (needs(n))
      do i = 1, n
        associate (from => arc%range(1) + (i - 1)*step)
          needs(i)%x = point_at(arc, from + 0.5_wp*step)
          needs(i)%radius = 0.5_wp*length_between(arc, from, from + step)
          needs(i)%size = facing_ratio*size_at(sizes, material, needs(i)%x)
        end associate
      end do
    end associate
  end subroutine needs_along

end module facing_sizes
