!> Free nodes of a new mesh that lie in a rigid die, moved out of it.
!>
!> Contact holds the nodes of a side; between them a free side may be in the die, where this bends by a radius that is small beside
!> the side. A node of the new mesh at such a place would press with all of its depth at once: a thousandth of a side is ten times
!> what the penalty of PENETR allows, and more than the part can bear. So it stands on the die's surface. One at the joint with a
!> side that does not face the die, as on a line of symmetry, moves along that side. (What the contour follows beside an end of
!> contact is left to contact_overlaps.)
module free_nodes_out
  use closest_point, only: closest_point_t
  use corrected_contours, only: contour_t
  use die_closest_points, only: find_closest_point
  use dies, only: is_deformable, place_on_nodes
  use kinds, only: wp
  use new_scene, only: middle_position
  use plane_vectors, only: turned
  use scene, only: scene_t
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: move_free_nodes_out

  !> At most so deep, over the side: deeper ones are beyond the opposite face of a thin die.
  real(wp), parameter :: deepest = 0.1_wp
  !> A node nearer than this to a point of contact is that point, over the side.
  real(wp), parameter :: same_place = 1.0e-6_wp
  !> Sine of the least angle between a die and a side along which a node moves out of it.
  real(wp), parameter :: least_sine = 0.3_wp

contains

  !> `scene` has the new mesh.
  pure subroutine move_free_nodes_out(contours, pilots, mesh, scene, largest)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    real(wp), intent(in) :: pilots(:, :)         !! (3, ndie) where they are now [length and radian]
    type(new_mesh_t), intent(inout) :: mesh
    type(scene_t), intent(inout) :: scene
    real(wp), intent(out) :: largest             !! move of a node over the length of its side
    logical :: in_contact(size(mesh%coordinates, 2))
    integer :: side_of(size(mesh%sides)), k, i
    real(wp) :: moves(2, size(mesh%coordinates, 2)), length

    largest = 0
    in_contact = .false.
    side_of = 0
    do k = 1, size(mesh%sides)
      associate (contour => contours(mesh%sides(k)%boundary), position => middle_position(contours, mesh%sides(k)))
        associate (arc => contour%boundary%arcs(position%arc))
          if (arc%die > 0) then
            in_contact(mesh%sides(k)%nodes) = .true.
          else if (arc%side <= size(contour%loop%sides, 2)) then
            side_of(k) = arc%side
          end if
        end associate
      end associate
    end do
    ! the ends of sides, then their middles, which go with the ends
    do i = 1, 2
      moves = 0
      do k = 1, size(mesh%sides)
        associate (nodes => mesh%sides(k)%nodes)
          length = length_of(mesh%coordinates(:, nodes(3)) - mesh%coordinates(:, nodes(1)))
          if (i == 1) then
            call find_way_out(k, nodes(1), length, moves(:, nodes(1)))
            call find_way_out(k, nodes(3), length, moves(:, nodes(3)))
          else
            call find_way_out(k, nodes(2), length, moves(:, nodes(2)))
          end if
          largest = max(largest, maxval(hypot(moves(1, nodes), moves(2, nodes)))/length)
        end associate
      end do
      mesh%coordinates = mesh%coordinates + moves
      if (i == 2) exit
      do k = 1, size(mesh%sides)
        associate (nodes => mesh%sides(k)%nodes)
          mesh%coordinates(:, nodes(2)) = mesh%coordinates(:, nodes(2)) + 0.5_wp*(moves(:, nodes(1)) + moves(:, nodes(3)))
        end associate
      end do
    end do
    if (.not. largest > 0) return
    scene%mesh%coordinates = mesh%coordinates
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) call place_on_nodes(mesh%coordinates, scene%dies(k))
    end do

  contains

    !> The move of a node out of the dies that its side faces.
    pure subroutine find_way_out(k, node, length, move)
      integer, intent(in) :: k, node
      real(wp), intent(in) :: length       !! of the side [length]
      real(wp), intent(inout) :: move(2)   !! [length]
      type(closest_point_t) :: closest
      real(wp) :: normal(2)
      logical :: over
      integer :: g, other

      if (side_of(k) == 0 .or. in_contact(node)) return
      associate (contour => contours(mesh%sides(k)%boundary), x => mesh%coordinates(:, node))
        do g = 1, size(contour%points)
          if (length_of(contour%points(g)%point - x) < same_place*length) return
        end do
        do g = 1, size(scene%groups)
          if (scene%groups(g)%die == 0) cycle
          if (is_deformable(scene%dies(scene%groups(g)%die)) .or. .not. faces(k, g)) cycle
          associate (die => scene%dies(scene%groups(g)%die), pilot => pilots(:, scene%groups(g)%die))
            call find_closest_point(die, pilot, x, [1, size(die%pieces, 3)], .true., closest, over)
            if (.not. over .or. closest%d <= 0 .or. closest%d > deepest*length) cycle
            normal = turned(closest%normal, pilot(3))
            move = -closest%d*normal
            other = side_beside(k, node)
            if (other > 0) then
              if (.not. faces(other, g)) move = along_side(other, normal, closest%d)
            end if
          end associate
        end do
      end associate
    end subroutine find_way_out

    !> The other side that ends at a node, 0 for a middle node.
    pure function side_beside(k, node) result(other)
      integer, intent(in) :: k, node
      integer :: other

      do other = size(mesh%sides), 1, -1
        if (other /= k .and. any(mesh%sides(other)%nodes([1, 3]) == node)) return
      end do
    end function side_beside

    !> The way out along another side; none where that hardly leads out.
    pure function along_side(k, normal, depth) result(move)
      integer, intent(in) :: k
      real(wp), intent(in) :: normal(2), depth   !! of the die, into it [-]; [length]
      real(wp) :: move(2), along(2), rate

      along = mesh%coordinates(:, mesh%sides(k)%nodes(3)) - mesh%coordinates(:, mesh%sides(k)%nodes(1))
      along = along/length_of(along)
      rate = dot_product(along, normal)
      move = 0
      if (abs(rate) >= least_sine) move = -(depth/rate)*along
    end function along_side

    !> A free side faces the die of a group.
    pure function faces(k, group) result(yes)
      integer, intent(in) :: k, group
      logical :: yes

      yes = side_of(k) > 0
      if (yes) yes = contours(mesh%sides(k)%boundary)%tags%on_group(group, side_of(k))
    end function faces

  end subroutine move_free_nodes_out

end module free_nodes_out
