!> The sides of a fold, moved apart for the mesher (folded_sides), moved back on their new mesh: they have the depth of contact
!> again, and with it the pressure.
module fold_closing
  use boundary_curves, only: position_t
  use corrected_contours, only: contour_t
  use dies, only: is_deformable, place_on_nodes
  use kinds, only: wp
  use new_scene, only: middle_position
  use scene, only: scene_t
  use shape_functions, only: line3
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: close_folds

contains

  !> Take back the moves of the old contour's nodes, interpolated where the new nodes are; `scene` has the new mesh and its dies.
  pure subroutine close_folds(contours, opened, mesh, scene)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    real(wp), intent(in) :: opened(:, :)         !! (2, nnode) by which nodes of the old mesh were moved [length]
    type(new_mesh_t), intent(inout) :: mesh
    type(scene_t), intent(inout) :: scene
    logical :: done(size(mesh%coordinates, 2))
    type(position_t) :: position
    real(wp) :: phi(3), dphi(3)
    integer :: k, i

    done = .false.
    do k = 1, size(mesh%sides)
      associate (contour => contours(mesh%sides(k)%boundary), nodes => mesh%sides(k)%nodes)
        do i = 1, 2
          if (done(nodes(i))) cycle
          done(nodes(i)) = .true.
          position = mesh%sides(k)%from
          if (i == 2) position = middle_position(contours, mesh%sides(k))
          associate (arc => contour%boundary%arcs(position%arc))
            if (arc%die > 0 .or. arc%side > size(contour%loop%sides, 2)) cycle   ! not of the old contour
            call line3(position%xi, phi, dphi)
            mesh%coordinates(:, nodes(i)) = mesh%coordinates(:, nodes(i)) - matmul(opened(:, contour%loop%sides(:, arc%side)), phi)
          end associate
        end do
      end associate
    end do
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) call place_on_nodes(mesh%coordinates, scene%dies(k))
    end do
    scene%mesh%coordinates = mesh%coordinates
  end subroutine close_folds

end module fold_closing
