!> How much of its old depth in a rigid die a node of a new side needs to bear the old pressure.
!>
!> A penalty that comes of PENETR goes with 1 over the length of the side as its mesh began (contact_point): a depth that bears a
!> pressure goes with that length. Where two sides meet, each bears a part that goes with its length too: the mean of both counts.
!> Where a run begins and ends the contour is kept. With multipliers depth bears next to nothing, and is left as it is; so it is
!> where bodies touch one another, whose volumes would change.
module depth_shares
  use contour_assembly, only: contact_t
  use dies, only: is_deformable
  use kinds, only: wp
  use new_scene, only: middle_place
  use part_contour, only: contour_t
  use scene, only: scene_t
  use stretches, only: closest_xi, point_at, stretch_t
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: shares_of_depth

contains

  !> Of all nodes of all sides of a new mesh (3, nside).
  pure function shares_of_depth(old, x, contours, mesh) result(share)
    type(scene_t), intent(in) :: old
    real(wp), intent(in) :: x(:, :)              !! nodes of the old mesh now (2, nnode) [length]
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(in) :: mesh
    real(wp) :: share(3, size(mesh%sides))
    real(wp) :: ends(2, size(mesh%coordinates, 2))
    integer :: run(size(mesh%sides)), at(2, size(mesh%coordinates, 2)), k, i

    share = 1
    ends = 1
    at = 0
    do k = 1, size(mesh%sides)
      associate (side => mesh%sides(k), contour => contours(mesh%sides(k)%chain))
        associate (place => middle_place(contours, side))
          run(k) = contour%chain%stretches(place%stretch)%run
        end associate
        if (run(k) == 0) cycle
        associate (contact => contour%contacts(run(k)))
          if (is_deformable(contact%die) .or. .not. old%groups(contact%run%group)%penalty_of_sides) cycle
        end associate
        share(:, k) = length_of(mesh%coordinates(:, side%nodes(3)) - mesh%coordinates(:, side%nodes(1))) &
                      /old_length(old, x, contour, contour%contacts(run(k)), mesh%coordinates(:, side%nodes(2)))
        ends(1, side%nodes(1)) = share(1, k)
        at(1, side%nodes(1)) = k
        ends(2, side%nodes(3)) = share(3, k)
        at(2, side%nodes(3)) = k
      end associate
    end do
    do k = 1, size(mesh%sides)
      do i = 1, 3, 2
        associate (node => mesh%sides(k)%nodes(i))
          share(i, k) = 1
          if (any(at(:, node) == 0)) cycle
          if (run(at(1, node)) /= run(at(2, node)) .or. mesh%sides(at(1, node))%chain /= mesh%sides(at(2, node))%chain) cycle
          share(i, k) = 0.5_wp*sum(ends(:, node))
        end associate
      end do
    end do
  end function shares_of_depth

  !> Chord, as its mesh began, of the side of a run that is closest to a point [length].
  pure function old_length(old, x, contour, contact, point) result(length)
    type(scene_t), intent(in) :: old
    real(wp), intent(in) :: x(:, :)
    type(contour_t), intent(in) :: contour
    type(contact_t), intent(in) :: contact
    real(wp), intent(in) :: point(2)
    real(wp) :: length
    type(stretch_t) :: side
    real(wp) :: least, distance
    integer :: k, s

    least = huge(least)
    length = 1
    do k = contact%run%from%side, contact%run%to%side
      s = modulo(k - 1, size(contour%loop%sides, 2)) + 1
      associate (nodes => contour%loop%sides(:, s))
        side%points = x(:, nodes)
        ! no point of a side is much farther from its middle than its ends
        if (length_of(side%points(:, 2) - point) - length_of(side%points(:, 3) - side%points(:, 1)) > least) cycle
        distance = length_of(point_at(side, closest_xi(side, point)) - point)
        if (.not. distance < least) cycle
        least = distance
        length = length_of(old%mesh%coordinates(:, nodes(3)) - old%mesh%coordinates(:, nodes(1)))
      end associate
    end do
  end function old_length

end module depth_shares
