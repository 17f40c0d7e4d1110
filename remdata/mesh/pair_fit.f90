!> Contact sides of bodies in contact with each other, fitted on their new meshes.
!>
!> The contour of a body in contact with a die made of sides follows the old sides of that die at the depth d = p/AKP (annex 2). The
!> die's own sides are new too: other parabolas through points of the old ones, from which they deviate between these points by a
!> share of the curvature of a side. Nodes in contact are moved along the normal by this deviation, so that each has the depth in
!> the new sides that it had in the old ones. A node at the joint with another side of its body, or another die, moves along that
!> side.
module pair_fit
  use closest_point, only: closest_point_t
  use contour_contacts, only: contact_t
  use corrected_contours, only: contour_t
  use die_closest_points, only: find_closest_point
  use dies, only: die_t, is_deformable, place_on_nodes
  use kinds, only: wp
  use new_scene, only: middle_position
  use own_contact, only: faces_itself
  use plane_vectors, only: turned
  use quadrature, only: line_rule
  use scene, only: scene_t
  use shape_functions, only: line3
  use solution, only: solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: fit_pairs, update_closest_points, moved_onto

  !> Sine of the least angle between contact and a side along which a node of both may move.
  real(wp), parameter :: least_sine = 0.3_wp

contains

  !> Move the nodes in contact with dies made of sides; `scene` has the new mesh and its dies.
  pure subroutine fit_pairs(contours, mesh, scene, largest)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(new_mesh_t), intent(inout) :: mesh
    type(scene_t), intent(inout) :: scene
    real(wp), intent(out) :: largest   !! displacement of a node divided by the length of its side
    integer :: interval(size(mesh%sides)), k, c, i

    largest = 0
    if (.not. any(is_deformable(scene%dies))) return
    do k = 1, size(mesh%sides)
      associate (position => middle_position(contours, mesh%sides(k)))
        interval(k) = contours(mesh%sides(k)%boundary)%boundary%arcs(position%arc)%interval
      end associate
    end do
    do c = 1, size(contours)
      do i = 1, size(contours(c)%contacts)
        associate (contact => contours(c)%contacts(i))
          if (.not. is_deformable(scene%dies(contact%number))) cycle
          call fit_interval(contact, mesh%sides%boundary == c .and. interval == i, scene%dies(contact%number), mesh, largest)
        end associate
        do k = 1, size(scene%dies)
          if (is_deformable(scene%dies(k))) call place_on_nodes(mesh%coordinates, scene%dies(k))
        end do
      end do
    end do
    scene%mesh%coordinates = mesh%coordinates
  end subroutine fit_pairs

  !> The nodes of one contact interval.
  pure subroutine fit_interval(contact, in_interval, die, mesh, largest)
    type(contact_t), intent(in) :: contact
    logical, intent(in) :: in_interval(:)   !! sides of the interval (nside)
    type(die_t), intent(in) :: die          !! on its new sides
    type(new_mesh_t), intent(inout) :: mesh
    real(wp), intent(inout) :: largest
    integer :: k, i, beside

    do k = 1, size(in_interval)
      if (.not. in_interval(k)) cycle
      do i = 1, 3
        beside = 0
        if (i == 1) beside = side_with(mesh, 3, mesh%sides(k)%nodes(i))
        if (i == 3) beside = side_with(mesh, 1, mesh%sides(k)%nodes(i))
        if (beside > 0) then
          if (in_interval(beside)) then
            ! the end of a side is moved with the side that it begins
            if (i == 3) cycle
            beside = 0
          end if
        end if
        call fit_node(contact, die, k, i, beside, mesh, largest)
      end do
    end do
  end subroutine fit_interval

  !> One node of a side; along the side beside it where that is not in the interval.
  pure subroutine fit_node(contact, die, side, i, beside, mesh, largest)
    type(contact_t), intent(in) :: contact
    type(die_t), intent(in) :: die
    integer, intent(in) :: side, i   !! the node's side, and which of its nodes it is
    integer, intent(in) :: beside    !! side along which it moves, 0 for none
    type(new_mesh_t), intent(inout) :: mesh
    real(wp), intent(inout) :: largest
    real(wp) :: normal(2), displacement(2), missing
    logical :: over

    associate (node => mesh%sides(side)%nodes(i))
      call find_missing_depth(contact, die, mesh%coordinates(:, node), normal, missing, over)
      if (.not. over) return
      displacement = missing*normal
      if (beside > 0) displacement = moved_onto(normal, missing, chord_of(mesh, beside))
      mesh%coordinates(:, node) = mesh%coordinates(:, node) + displacement
    end associate
    largest = max(largest, length_of(displacement)/length_of(chord_of(mesh, side)))
  end subroutine fit_node

  !> From the first to the last node of a side [length].
  pure function chord_of(mesh, side) result(chord)
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: side
    real(wp) :: chord(2)

    associate (nodes => mesh%sides(side)%nodes)
      chord = mesh%coordinates(:, nodes(3)) - mesh%coordinates(:, nodes(1))
    end associate
  end function chord_of

  !> Side of the contour that has a node as its first or last one, 0 for none.
  pure function side_with(mesh, which, node) result(side)
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: which, node
    integer :: side

    do side = size(mesh%sides), 1, -1
      if (mesh%sides(side)%nodes(which) == node) return
    end do
  end function side_with

  !> Displacement of a point along another side that has a given component along a normal; along the normal itself where the other
  !> side is nearly perpendicular to it.
  pure function moved_onto(normal, missing, beside) result(displacement)
    real(wp), intent(in) :: normal(2), missing   !! unit vector [-]; component along it [length]
    real(wp), intent(in) :: beside(2)            !! direction of the other side [length]
    real(wp) :: displacement(2)
    real(wp) :: rate

    displacement = missing*normal
    rate = dot_product(beside, normal)/length_of(beside)
    if (abs(rate) >= least_sine) displacement = (missing/rate)*beside/length_of(beside)
  end function moved_onto

  !> Depth of a point in the old sides of a die minus that in the new ones, where it projects on both; their inner normal.
  pure subroutine find_missing_depth(contact, die, point, normal, missing, over)
    type(contact_t), intent(in) :: contact
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)
    real(wp), intent(out) :: normal(2), missing
    logical, intent(out) :: over
    type(closest_point_t) :: before, after
    logical :: projected

    normal = 0
    missing = 0
    call find_closest_point(contact%die, contact%pilot, point, [1, size(contact%die%pieces, 3)], .true., before, over)
    call find_closest_point(die, contact%pilot, point, [1, size(die%pieces, 3)], .true., after, projected)
    over = over .and. projected
    if (.not. over) return
    normal = turned(after%normal, contact%pilot(3))
    missing = before%d - after%d
  end subroutine find_missing_depth

  !> Closest points of contact points on the new sides of their die: from them the solver measures the slip of the next step. Those
  !> of a body on itself are found with their state (fold_carry).
  pure subroutine update_closest_points(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: phi(3), dphi(3), still(3)
    type(closest_point_t) :: closest
    integer :: g, e, p, status, piece_row, xi_row
    logical :: over

    still = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        ! heat between them has the pairs of its contact
        if (group%pairs == 0 .or. group%host > 0 .or. faces_itself(scene, group)) cycle
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        piece_row = group%variables(find_variable(group%variables, 'die_piece'))%first
        xi_row = group%variables(find_variable(group%variables, 'die_xi'))%first
        call line_rule(group%rule, xi, weight)
        associate (die => scene%dies(group%die), state => solution%groups(g)%committed)
          do e = 1, size(group%connectivity, 2)
            do p = 1, size(xi)
              if (nint(state(status, p, e)) == 0) cycle
              call line3(xi(p), phi, dphi)
              call find_closest_point(die, still, matmul(scene%mesh%coordinates(:, group%connectivity(:, e)), phi), &
                             [1, size(die%pieces, 3)], .true., closest, over)
              state([piece_row, xi_row], p, e) = [real(closest%piece, wp), min(max(closest%xi, -1.0_wp), 1.0_wp)]
            end do
          end do
        end associate
        solution%groups(g)%trial = solution%groups(g)%committed
      end associate
    end do
  end subroutine update_closest_points

end module pair_fit
