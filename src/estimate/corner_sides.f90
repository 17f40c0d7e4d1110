!> Sides of a mesh that a sharp corner of a rigid die presses into.
!>
!> Such a side stays nearly straight: what of it lies beyond the corner makes the die act as if it were larger, the more the longer
!> the side is and the nearer the corner is to its middle. Where the part slides past the corner the force goes up and down with
!> every side, and is that of finer meshes where a node stands at the corner, as it does on every new mesh (decks/can_sharp).
module corner_sides
  use contact_state, only: at_piece, at_status, at_xi, contact_block
  use dies, only: die_t
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use law_api, only: contact_open
  use own_contact, only: faces_itself
  use scene, only: scene_t
  use shape_functions, only: line3
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: corner_side_t, find_corner_side

  !> What is known of the sides of a group that sharp corners press into.
  type :: corner_side_t
    !> Side that has grown most since the mesh began (0: there is none), and its length over that.
    integer :: side = 0
    real(wp) :: growth = 0.0_wp
    !> Time until a node stands at a corner, by the motion of the last step: the shortest of all corners; 0 where one does.
    real(wp) :: until_node = huge(1.0_wp)
  end type corner_side_t

  !> Cosine of 30 degrees: a vertex that turns by more is a sharp corner.
  real(wp), parameter :: cosine_of_corner = 0.866_wp
  !> A node stands at a corner that is no farther off than a sixteenth of the side.
  real(wp), parameter :: at_node = 0.125_wp
  !> A corner stands in a side along which it moves by less than this share in a step.
  real(wp), parameter :: standing = 1.0e-6_wp

contains

  !> Sides of a group that sharp corners of its die press into.
  pure subroutine find_corner_side(scene, g, solution, found)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    type(corner_side_t), intent(out) :: found
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), growth
    integer :: e, p, n, place
    logical :: sharp

    place = find_variable(scene%groups(g)%variables, 'corner_place')
    if (place == 0 .or. faces_itself(scene, scene%groups(g))) return
    place = scene%groups(g)%variables(place)%first
    x = present_coordinates(scene, solution)
    n = contact_block(.true., size(solution%groups(g)%committed, 1))
    do e = 1, size(scene%groups(g)%connectivity, 2)
      associate (state => solution%groups(g)%committed(:, :, e), nodes => scene%groups(g)%connectivity(:, e))
        sharp = .false.
        do p = 1, size(state, 2)
          ! a node on the axis has the state of a corner, at the end of its side (axis_contact)
          if (nint(state(n + at_status, p)) == contact_open .or. abs(state(place, p)) >= 1) cycle
          if (.not. is_sharp(scene%dies(scene%groups(g)%die), nint(state(n + at_piece, p)), state(n + at_xi, p))) cycle
          sharp = .true.
          found%until_node = min(found%until_node, time_to_node(scene, solution, scene%groups(g)%die, nodes, x(:, nodes), &
                                                                state(place, p)))
        end do
        if (.not. sharp) cycle
        growth = length_of(x(:, nodes(3)) - x(:, nodes(1))) &
                 /length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
        if (.not. growth > found%growth) cycle
        found%growth = growth
        found%side = e
      end associate
    end do
  end subroutine find_corner_side

  !> Time until an end of a side reaches a corner, as it slid past it in the last step [time].
  pure function time_to_node(scene, solution, die, nodes, x, place) result(time)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: die, nodes(3)   !! that has the corner; of the side
    real(wp), intent(in) :: x(2, 3)        !! of these nodes at present [length]
    real(wp), intent(in) :: place          !! of the corner on the side [-]
    real(wp) :: time
    real(wp) :: phi(3), dphi(3), arm(2), tangent(2), slip(2), way

    time = 0
    if (1 - abs(place) <= at_node) return
    call line3(place, phi, dphi)
    tangent = matmul(x, dphi)
    associate (pilot => solution%fields(pilot_field)%value(1:2, die), moved => solution%fields(pilot_field)%last_increment(:, die))
      arm = matmul(x, phi) - pilot
      slip = matmul(solution%fields(displacement_field)%last_increment(:, nodes), phi) - moved(1:2) &
             - moved(3)*[-arm(2), arm(1)]
    end associate
    ! the side slides forward, the corner goes back on it
    way = -dot_product(slip, tangent)/dot_product(tangent, tangent)
    time = huge(1.0_wp)
    if (abs(way) > standing) time = (1 - sign(1.0_wp, way)*place)/abs(way)*solution%last_step
  end function time_to_node

  !> A corner of a die, at an end of one of its pieces, turns by more than a polygon that follows a curve.
  pure function is_sharp(die, piece, xi) result(yes)
    type(die_t), intent(in) :: die
    integer, intent(in) :: piece
    real(wp), intent(in) :: xi   !! of the end [-]
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(die%corners, 2)
      if (die%corner_piece(k) /= piece .or. die%corner_xi(k)*xi < 0) cycle
      yes = yes .or. dot_product(die%corners(3:4, k), die%corners(5:6, k)) < cosine_of_corner
    end do
  end function is_sharp

end module corner_sides
