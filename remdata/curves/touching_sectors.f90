!> Two bodies that meet in a point: do they touch, or lie in each other?
!>
!> Near the point each body is a sector, between the direction in which its contour leaves and the one from which it came, with the
!> body on the left: half of the plane within an arc, the angle of the corner at a joint. The bodies touch when the sectors have
!> nothing in common but their edges, as the corner of one on a side of the other.
module touching_sectors
  use arc_crossings, only: touching
  use boundary_curves, only: boundary_curve_t, joint_after
  use kinds, only: pi, wp
  use offset_parabolas, only: tangent_at
  use plane_vectors, only: angle_between
  implicit none
  private
  public :: sectors_overlap

  !> A sector: direction of its first edge, and its angle to the left of that.
  type :: sector_t
    real(wp) :: edge(2) = 0.0_wp, angle = 0.0_wp   !! [of any length], [radian]
  end type sector_t

  !> Edges that differ by less than this are the same [radian].
  real(wp), parameter :: same_edge = 1.0e-6_wp

contains

  !> The bodies to the left of two contours overlap next to the point that they have in common.
  pure function sectors_overlap(one, k, at, other, j, there) result(yes)
    type(boundary_curve_t), intent(in) :: one, other
    integer, intent(in) :: k, j          !! arcs of the one and of the other
    real(wp), intent(in) :: at, there    !! where on these arcs [-]
    logical :: yes
    type(sector_t) :: a, b

    a = sector_at(one, k, at)
    b = sector_at(other, j, there)
    yes = reaches_into(a, b) .or. reaches_into(b, a)
  end function sectors_overlap

  !> The sector of the body at xi of arc k.
  pure function sector_at(boundary, k, xi) result(sector)
    type(boundary_curve_t), intent(in) :: boundary
    integer, intent(in) :: k
    real(wp), intent(in) :: xi   !! [-]
    type(sector_t) :: sector
    integer :: joint, before

    joint = 0
    associate (arc => boundary%arcs(k))
      if (abs(xi - arc%range(1)) <= touching*(arc%range(2) - arc%range(1))) joint = k
      if (abs(xi - arc%range(2)) <= touching*(arc%range(2) - arc%range(1))) joint = joint_after(boundary, k)
      if (joint == 0) then
        sector = sector_t(tangent_at(arc, xi), pi)
        return
      end if
    end associate
    before = merge(size(boundary%arcs), joint - 1, joint == 1)
    associate (last => boundary%arcs(before), next => boundary%arcs(joint))
      sector%edge = tangent_at(next, next%range(1))
      sector%angle = modulo(angle_between(sector%edge, -tangent_at(last, last%range(2))), 2*pi)
    end associate
  end function sector_at

  !> An edge of `a`, or the direction halfway between its edges, points into `b`.
  pure function reaches_into(a, b) result(yes)
    type(sector_t), intent(in) :: a, b
    logical :: yes
    real(wp) :: first, place
    integer :: i

    first = angle_between(b%edge, a%edge)
    yes = .false.
    do i = 0, 2
      place = modulo(first + 0.5_wp*i*a%angle, 2*pi)
      yes = yes .or. (place > same_edge .and. place < b%angle - same_edge)
    end do
  end function reaches_into

end module touching_sectors
