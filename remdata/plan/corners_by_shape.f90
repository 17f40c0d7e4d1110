!> Corners of zones at the corners of the contour, or the beginnings and ends of contact, that are nearest to them.
!>
!> When a side folds onto a die the old corner lies flat there, and the new one is where contact ends.
module corners_by_shape
  use boundary_curves, only: arc_length_at, boundary_curve_t, boundary_length, kind_corner, kind_entry, kind_exit, position_t, &
                             turn_at
  use corrected_contours, only: contour_t
  use kinds, only: wp
  use zones, only: zone_point_t
  implicit none
  private
  public :: assign_by_shape

  !> A point coincides with a corner that is nearer than this share of the contour.
  real(wp), parameter :: coincidence_tolerance = 1.0e-6_wp
  !> Share of the contour that must be free beside an end of contact for a corner of a zone to be located there.
  real(wp), parameter :: free_share = 0.1_wp

contains

  !> Points in a corner of the contour stay there; the others are moved to the nearest corner, beginning or end of contact that is
  !> not taken.
  pure subroutine assign_by_shape(contours, points)
    type(contour_t), intent(in) :: contours(:)         !! (ncontour)
    type(zone_point_t), intent(inout) :: points(:)   !! (npoint)
    logical :: assigned(size(points))
    integer :: p, pass, joint(size(points))
    real(wp) :: distance

    assigned = .not. points%by_shape
    joint = 0
    do pass = 1, 2
      do p = 1, size(points)
        if (assigned(p)) cycle
        call free_joint(contours(points(p)%boundary)%boundary, points(p)%position, &
                           pack(joint, points%boundary == points(p)%boundary .and. joint > 0), joint(p), distance)
        if (joint(p) == 0 .or. (pass == 1 &
                                .and. distance > coincidence_tolerance*boundary_length(contours(points(p)%boundary)%boundary))) then
          joint(p) = 0
          cycle
        end if
        points(p)%position = position_t(joint(p), contours(points(p)%boundary)%boundary%arcs(joint(p))%range(1))
        assigned(p) = .true.
      end do
    end do
  end subroutine assign_by_shape

  !> The nearest corner, beginning or end of contact along the boundary curve that is not taken; 0 when there is none.
  pure subroutine free_joint(boundary, from, taken, joint, least)
    type(boundary_curve_t), intent(in) :: boundary
    type(position_t), intent(in) :: from
    integer, intent(in) :: taken(:)
    integer, intent(out) :: joint
    real(wp), intent(out) :: least
    real(wp) :: here, distance
    integer :: k

    joint = 0
    here = arc_length_at(boundary, from)
    least = huge(least)
    do k = 1, size(boundary%arcs)
      distance = abs(boundary%arc_length(k - 1) - here)
      distance = min(distance, boundary_length(boundary) - distance)
      if (any(taken == k) .or. .not. distance < least) cycle
      ! where contact ends in a corner the corner is used
      if (.not. (boundary%kinds(k) == kind_corner .or. is_outer_end(boundary, k) .or. &
                 (distance <= coincidence_tolerance*boundary_length(boundary) &
                  .and. abs(turn_at(boundary, k)) > boundary%corner_turn))) cycle
      least = distance
      joint = k
    end do
  end subroutine free_joint

  !> Does contact begin or end there for a large part of the contour? Gaps within contact are not considered.
  pure function is_outer_end(boundary, joint) result(outer)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: joint
    logical :: outer
    real(wp) :: distance
    integer :: k, i, n

    outer = .false.
    if (all(boundary%kinds(joint) /= [kind_entry, kind_exit])) return
    n = size(boundary%arcs)
    distance = 0
    do i = 1, n
      k = merge(modulo(joint + i - 2, n) + 1, modulo(joint - i - 1, n) + 1, boundary%kinds(joint) == kind_exit)
      if (boundary%arcs(k)%interval > 0) exit
      distance = distance + boundary%arc_length(k) - boundary%arc_length(k - 1)
    end do
    outer = distance > free_share*boundary_length(boundary)
  end function is_outer_end

end module corners_by_shape
