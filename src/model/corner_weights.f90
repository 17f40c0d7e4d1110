!> The length that a corner of a die stands for where it presses into a side between two points (corner_contact).
!>
!> It is that of the interval between them. Facing another body a side has many points, and the corner is an edge of that body
!> (edge_contact): it has half of the side, as between nodes, since a side does not resolve less. Toward an end of the
!> side the weight goes to zero: the load of a corner that a node slides past goes over to the node gradually, and back again; a
!> sudden change would leave positions without equilibrium.
!>
!> An edge of another body goes over to the next side: on its way past the node it acts on both, on each as if that went on beyond
!> its end, with shares whose sum is one. Where the body is bent round the edge, with one side along either face, each side needs
!> the force of its own face; the points of the node, on one of them, cannot give both. A corner of a rigid die does the
!> same where both of its faces turn away from the side (passing_corners).
!>
!> A node on the axis, which has the state of a corner at exactly -1 or 1 (axis_contact), stands for the disc that reaches to the
!> middle of its side.
module corner_weights
  use kinds, only: wp
  implicit none
  private
  public :: area_of_disc, corner_length, handing_over, interval_before, place_within, share_at_node, share_past_node

  !> A corner nearer than this to an end of the side, in xi, has lost a part of its weight to the node there; an edge of a body one
  !> that is nearer to it or as far beyond it to the next side.
  real(wp), parameter :: handing_over = 0.05_wp
  !> Half the length of a side in xi.
  real(wp), parameter :: half_of_side = 1.0_wp

contains

  !> Share of its weight that a corner at a position on the side has, whose load the node takes over.
  elemental function share_at_node(place) result(share)
    real(wp), intent(in) :: place   !! [-]
    real(wp) :: share

    share = max(0.0_wp, min(1.0_wp, (1 - abs(place))/handing_over))
  end function share_at_node

  !> The same of one that passes the node, from this side to the next.
  elemental function share_past_node(place) result(share)
    real(wp), intent(in) :: place   !! [-]
    real(wp) :: share

    share = max(0.0_wp, min(1.0_wp, (1 + handing_over - abs(place))/(2*handing_over)))
  end function share_past_node

  !> Where an edge is on the side itself: that of one beyond an end is the end.
  elemental function place_within(place) result(within)
    real(wp), intent(in) :: place   !! [-]
    real(wp) :: within

    within = max(-1.0_wp, min(1.0_wp, place))
  end function place_within

  !> Area per radian of the disc of a node on the axis, whose side has this chord: (L/2)**2/2.
  elemental function area_of_disc(chord) result(area)
    real(wp), intent(in) :: chord   !! [length]
    real(wp) :: area                !! [length**2]

    area = 0.125_wp*chord**2
  end function area_of_disc

  !> Length in xi of a corner in the interval before a point.
  pure function corner_length(xi, p, of_body) result(length)
    real(wp), intent(in) :: xi(:)    !! (npoint) of the side [-]
    integer, intent(in) :: p
    logical, intent(in) :: of_body   !! the corner is an edge of another body
    real(wp) :: length
    real(wp) :: from, to

    call interval_before(xi, p, from, to)
    length = to - from
    if (of_body) length = half_of_side
  end function corner_length

  !> The part of the side between a point and the one before; the last one goes on to the end of the side.
  pure subroutine interval_before(xi, p, from, to)
    real(wp), intent(in) :: xi(:)   !! (npoint) [-]
    integer, intent(in) :: p
    real(wp), intent(out) :: from, to   !! [-]

    from = -1
    if (p > 1) from = xi(p - 1)
    to = xi(p)
    if (p == size(xi)) to = 1
  end subroutine interval_before

end module corner_weights
