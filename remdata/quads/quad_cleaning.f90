!> Changes of the connection of quadrilaterals that bring the number around each point closer to the angle there.
!>
!> A point is charged with the square of the number of its quadrilaterals less its angle in right angles. Four changes are tried:
!> a point with two quadrilaterals is removed; the hexagon of two is divided in another way; a quadrilateral is collapsed along a
!> diagonal; a point is opened to a new quadrilateral along two of its sides (P. Kinney, CleanUp: improving quadrilateral finite
!> element meshes, 6th International Meshing Roundtable, 1997, 449-461). Each must lower the sum of charges, or in a second phase
!> improve the worst corner around, and is undone where smoothing around it does not give a good shape. Passes are bounded.
module quad_cleaning
  use kinds, only: wp
  use quad_changes, only: change_hexagon, collapse, open_point, remove_doublet
  use quad_charges, only: is_flat
  use quad_layers, only: insert_layer
  use quad_memory, only: change_rule_t
  use quad_mesh, only: quad_mesh_t
  use quad_smoothing, only: worst_sine
  implicit none
  private
  public :: clean_quads

  !> Passes over the mesh at most.
  integer, parameter :: passes = 30
  !> First what costs less, then what is of better shape even if it costs more.
  type(change_rule_t), parameter :: rules(2) = [change_rule_t(), &
                                                change_rule_t(gain=-8.0_wp, good=2.0_wp, better=0.01_wp, below=0.8_wp)]

contains

  pure subroutine clean_quads(mesh)
    type(quad_mesh_t), intent(inout) :: mesh
    logical :: active(size(mesh%x, 2)), next(size(mesh%x, 2))
    integer :: phase, pass

    do phase = 1, size(rules)
      active = .true.
      do pass = 1, passes
        next = .false.
        call pass_over_points(mesh, rules(phase), active, next)
        call pass_over_quads(mesh, rules(phase), active, next)
        if (.not. any(next)) exit
        active = next
      end do
    end do
  end subroutine clean_quads

  pure subroutine pass_over_points(mesh, rule, active, next)
    type(quad_mesh_t), intent(inout) :: mesh
    type(change_rule_t), intent(in) :: rule
    logical, intent(in) :: active(:)       !! points around which something has changed (npoint)
    logical, intent(inout) :: next(:)
    integer :: point

    do point = 1, mesh%npoint
      if (.not. mesh%fixed(point) .and. active(point) .and. mesh%count(point) == 2) &
        call remove_doublet(mesh, point, rule, next)
    end do
    do point = 1, mesh%npoint
      if (mesh%fixed(point) .or. .not. active(point) .or. mesh%count(point) < 5) cycle
      if (worst_sine(mesh, mesh%around(:mesh%count(point), point)) < rule%below) call open_point(mesh, point, rule, next)
    end do
  end subroutine pass_over_points

  pure subroutine pass_over_quads(mesh, rule, active, next)
    type(quad_mesh_t), intent(inout) :: mesh
    type(change_rule_t), intent(in) :: rule
    logical, intent(in) :: active(:)
    logical, intent(inout) :: next(:)
    integer :: e, k, way

    do e = 1, mesh%nquad
      if (mesh%corner(1, e) == 0) cycle
      if (.not. any(active(mesh%corner(:, e)))) cycle
      if (.not. worst_sine(mesh, [e]) < rule%below) cycle
      do k = 1, 2
        if (mesh%corner(1, e) > 0) call collapse(mesh, e, k, rule, next)
      end do
      do k = 1, 4
        if (mesh%corner(1, e) == 0) exit
        if (is_flat(mesh, mesh%corner(k, e))) call insert_layer(mesh, e, k, rule, next)
      end do
      do k = 1, 4
        do way = 1, 4
          if (mesh%corner(1, e) > 0) &
            call change_hexagon(mesh, mesh%corner(k, e), mesh%corner(mod(k, 4) + 1, e), way, rule, next)
        end do
      end do
    end do
  end subroutine pass_over_quads

end module quad_cleaning
