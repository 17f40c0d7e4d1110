!> Bodies that touch one another, fitted on their new meshes.
!>
!> The contour of a body in contact with a die made of sides follows the old sides of that die at the depth d = p/AKP (annex 2). The
!> die's own sides are new too: other parabolas through points of the old ones, which they leave between these points by a share
!> of what a side is bent. Nodes in contact are moved along the normal by that much, so that each is as deep in the new sides
!> as it was to be in the old ones. A node where contact meets another side of its body, or another die, moves along that.
module pair_fit
  use contact_knots, only: find_knot
  use contact_stretches, only: knot_t, placed_piece
  use contour_assembly, only: contact_t
  use dies, only: die_t, is_deformable, place_on_nodes
  use kinds, only: wp
  use new_scene, only: middle_place
  use part_contour, only: contour_t
  use quadrature, only: line_rule
  use scene, only: scene_t
  use shape_functions, only: line3
  use solution, only: solution_t
  use state_variables, only: find_variable
  use stretches, only: stretch_t, tangent_at
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: fit_pairs, find_feet, moved_onto

  !> Sine of the least angle between contact and a side along which a node of both may move.
  real(wp), parameter :: least_sine = 0.3_wp

contains

  !> Move the nodes in contact with dies made of sides; `scene` has the new mesh and its dies.
  pure subroutine fit_pairs(contours, mesh, scene, largest)
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(inout) :: mesh
    type(scene_t), intent(inout) :: scene
    real(wp), intent(out) :: largest   !! way of a node over the length of its side
    integer :: run(size(mesh%sides)), k, c, i

    largest = 0
    if (.not. any(is_deformable(scene%dies))) return
    do k = 1, size(mesh%sides)
      associate (place => middle_place(contours, mesh%sides(k)))
        run(k) = contours(mesh%sides(k)%chain)%chain%stretches(place%stretch)%run
      end associate
    end do
    do c = 1, size(contours)
      do i = 1, size(contours(c)%contacts)
        associate (contact => contours(c)%contacts(i))
          if (.not. is_deformable(scene%dies(contact%number))) cycle
          call fit_run(contact, mesh%sides%chain == c .and. run == i, scene%dies(contact%number), mesh, largest)
        end associate
        do k = 1, size(scene%dies)
          if (is_deformable(scene%dies(k))) call place_on_nodes(mesh%coordinates, scene%dies(k))
        end do
      end do
    end do
    scene%mesh%coordinates = mesh%coordinates
  end subroutine fit_pairs

  !> The nodes of one run of contact.
  pure subroutine fit_run(contact, mine, die, mesh, largest)
    type(contact_t), intent(in) :: contact
    logical, intent(in) :: mine(:)     !! sides of the run
    type(die_t), intent(in) :: die     !! on its new sides
    type(new_mesh_t), intent(inout) :: mesh
    real(wp), intent(inout) :: largest
    real(wp) :: normal(2), way(2), beside(2), missing
    integer :: k, i, other
    logical :: over

    do k = 1, size(mine)
      if (.not. mine(k)) cycle
      do i = 1, 3
        associate (node => mesh%sides(k)%nodes(i))
          other = 0
          if (i == 1) other = side_with(mesh, 3, node)
          if (i == 3) other = side_with(mesh, 1, node)
          ! the end of a side is moved with the side that it begins
          if (i == 3 .and. other > 0) then
            if (mine(other)) cycle
          end if
          call miss(contact, die, mesh%coordinates(:, node), normal, missing, over)
          if (.not. over) cycle
          way = missing*normal
          if (other > 0) then
            if (.not. mine(other)) then
              associate (nodes => mesh%sides(other)%nodes)
                beside = mesh%coordinates(:, nodes(3)) - mesh%coordinates(:, nodes(1))
              end associate
              way = moved_onto(normal, missing, beside)
            end if
          end if
          mesh%coordinates(:, node) = mesh%coordinates(:, node) + way
          associate (nodes => mesh%sides(k)%nodes)
            largest = max(largest, length_of(way)/length_of(mesh%coordinates(:, nodes(3)) - mesh%coordinates(:, nodes(1))))
          end associate
        end associate
      end do
    end do
  end subroutine fit_run

  !> Side of the contour that has a node as its first or last one, 0 for none.
  pure function side_with(mesh, which, node) result(side)
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: which, node
    integer :: side

    do side = size(mesh%sides), 1, -1
      if (mesh%sides(side)%nodes(which) == node) return
    end do
  end function side_with

  !> The way that takes a point along another side until it has gone so far along a normal; along the normal itself where the
  !> other side runs nearly across it.
  pure function moved_onto(normal, missing, beside) result(way)
    real(wp), intent(in) :: normal(2), missing   !! [-, length]
    real(wp), intent(in) :: beside(2)            !! direction of the other side
    real(wp) :: way(2)
    real(wp) :: rate

    way = missing*normal
    rate = dot_product(beside, normal)/length_of(beside)
    if (abs(rate) >= least_sine) way = (missing/rate)*beside/length_of(beside)
  end function moved_onto

  !> Depth that a point has on the old sides of a die and lacks on the new ones, where it lies over both; their inner normal.
  pure subroutine miss(contact, die, point, normal, missing, over)
    type(contact_t), intent(in) :: contact
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: point(2)
    real(wp), intent(out) :: normal(2), missing
    logical, intent(out) :: over
    type(knot_t) :: before, after
    type(stretch_t) :: piece
    logical :: sound

    normal = 0
    missing = 0
    call find_knot(contact%die, contact%pilot, point, [1, size(contact%die%pieces, 3)], .true., before, over)
    call find_knot(die, contact%pilot, point, [1, size(die%pieces, 3)], .true., after, sound)
    over = over .and. sound
    if (.not. over) return
    piece = placed_piece(die, contact%pilot, after%piece)
    normal = tangent_at(piece, after%xi)
    normal = [normal(2), -normal(1)]/length_of(normal)
    missing = before%depth - after%depth
  end subroutine miss

  !> Where closed points stand on the new sides of their die: what tells a run that goes on where each came from.
  pure subroutine find_feet(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: phi(3), dphi(3), still(3)
    type(knot_t) :: knot
    integer :: g, e, p, status, piece, place
    logical :: over

    still = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%pairs == 0) cycle
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        piece = group%variables(find_variable(group%variables, 'die_piece'))%first
        place = group%variables(find_variable(group%variables, 'die_xi'))%first
        call line_rule(group%npoint, xi, weight)
        associate (die => scene%dies(group%die), state => solution%groups(g)%committed)
          do e = 1, size(group%connectivity, 2)
            do p = 1, size(xi)
              if (nint(state(status, p, e)) == 0) cycle
              call line3(xi(p), phi, dphi)
              call find_knot(die, still, matmul(scene%mesh%coordinates(:, group%connectivity(:, e)), phi), &
                             [1, size(die%pieces, 3)], .true., knot, over)
              state([piece, place], p, e) = [real(knot%piece, wp), min(max(knot%xi, -1.0_wp), 1.0_wp)]
            end do
          end do
        end associate
        solution%groups(g)%trial = solution%groups(g)%committed
      end associate
    end do
  end subroutine find_feet

end module pair_fit
