!> Fit of the sides of a mesh to the dies they touch.
!>
!> Two things that no pressure corrects: a side whose parabola is deeper in the die between its points than at them, or, with ALONG,
!> spans a bend of the die from one place in contact to another, and a corner of the die that sticks into a side. All are measured
!> over the penetration that the side's law allows. Where a body faces itself neither is known: the depth of a side below its own
!> body's contour says nothing (own_contact), and is left out as it is of `max_penetration_sampled`.
module contact_quality
  use contact_penalties, only: allowed_penetration
  use contact_scan, only: deepest_sample, is_near, widest_gap
  use contact_state, only: at_penetration, at_piece, at_status, at_xi, contact_block
  use dies, only: die_t, in_pilot_axes, present_die
  use fields, only: pilot_field
  use kinds, only: wp
  use quadrature, only: is_control_point, rule_along, rule_t
  use law_api, only: contact_open
  use own_contact, only: faces_itself
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: find_corner_side, misfit_t, measure_misfit, misfit_of_sides

  !> The worst of a group, over the allowed penetration, and the sides where it is (0: none).
  type :: misfit_t
    real(wp) :: between = 0.0_wp, corner = 0.0_wp
    integer :: between_side = 0, corner_side = 0
  end type misfit_t

  !> What is nearer to a die than this share of the side touches it: multipliers hold points as much above it as below.
  real(wp), parameter :: touching = 5.0e-4_wp
  !> Cosine of 30 degrees: a vertex that turns by more is a sharp corner.
  real(wp), parameter :: cosine_of_corner = 0.866_wp

contains

  !> Misfit of the sides of a contact group; none where its law states no penetration.
  pure function measure_misfit(scene, g, solution) result(misfit)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    type(misfit_t) :: misfit
    real(wp) :: of_sides(2, size(scene%groups(g)%connectivity, 2)), allowed
    integer :: e

    allowed = allowed_penetration(scene%materials(scene%groups(g)%material))
    if (.not. allowed > 0) return
    of_sides = misfit_of_sides(scene, g, solution)/allowed
    do e = 1, size(of_sides, 2)
      call keep(of_sides(1, e), e, misfit%between, misfit%between_side)
      call keep(of_sides(2, e), e, misfit%corner, misfit%corner_side)
    end do
  end function measure_misfit

  !> The depth of each side over its length: between its points, and at a corner of the die.
  pure function misfit_of_sides(scene, g, solution) result(of_sides)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    real(wp) :: of_sides(2, size(scene%groups(g)%connectivity, 2))   !! [-]
    type(die_t) :: die
    real(wp) :: side(2, 3), x(2, size(scene%mesh%coordinates, 2)), length, known, deep
    logical :: corners
    integer :: e, n

    of_sides = 0
    if (faces_itself(scene, scene%groups(g))) return
    corners = find_variable(scene%groups(g)%variables, 'corner_place') > 0
    x = present_coordinates(scene, solution)
    die = present_die(scene%dies(scene%groups(g)%die), x)
    do e = 1, size(scene%groups(g)%connectivity, 2)
      associate (nodes => scene%groups(g)%connectivity(:, e), state => solution%groups(g)%committed(:, :, e))
        side = in_pilot_axes(x(:, nodes), solution%fields(pilot_field)%value(:, scene%groups(g)%die))
        length = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
        if (.not. is_near(die, side, length)) cycle
        n = contact_block(corners, size(state, 1))
        known = depth_of(state(:n, :), rule=scene%groups(g)%rule)
        if (corners) then
          deep = depth_of(state(n + 1:2*n, :))
          of_sides(2, e) = deep/length
          known = max(known, deep)
        end if
        deep = deepest_sample(die, side, length) - known
        if (scene%groups(g)%rule%family == rule_along) deep = max(deep, widest_gap(die, side, length, touching*length))
        of_sides(1, e) = deep/length
      end associate
    end do
  end function misfit_of_sides

  !> The side of a group that a sharp corner of the die presses into and that has grown most since the mesh began. It stays nearly
  !> straight while the corner is in it: what of it lies beyond the corner makes the die act as if it were larger.
  pure subroutine find_corner_side(scene, g, solution, growth, side)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                   !! a group that faces a die
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    real(wp), intent(out) :: growth            !! its length over that when the mesh began [-]
    integer, intent(out) :: side               !! 0: there is none
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))
    integer :: e, p, n, place
    logical :: sharp

    growth = 0
    side = 0
    place = find_variable(scene%groups(g)%variables, 'corner_place')
    if (place == 0 .or. faces_itself(scene, scene%groups(g))) return
    place = scene%groups(g)%variables(place)%first
    x = present_coordinates(scene, solution)
    n = contact_block(.true., size(solution%groups(g)%committed, 1))
    do e = 1, size(scene%groups(g)%connectivity, 2)
      ! a node on the axis has the state of a corner, at the end of its side (axis_contact)
      associate (state => solution%groups(g)%committed(:, :, e))
        sharp = .false.
        do p = 1, size(state, 2)
          if (nint(state(n + at_status, p)) == contact_open .or. abs(state(place, p)) >= 1) cycle
          sharp = sharp .or. is_sharp(scene%dies(scene%groups(g)%die), nint(state(n + at_piece, p)), state(n + at_xi, p))
        end do
        if (.not. sharp) cycle
      end associate
      associate (first => scene%groups(g)%connectivity(1, e), last => scene%groups(g)%connectivity(3, e))
        call keep(length_of(x(:, last) - x(:, first)) &
                  /length_of(scene%mesh%coordinates(:, last) - scene%mesh%coordinates(:, first)), e, growth, side)
      end associate
    end do
  end subroutine find_corner_side

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

  !> Largest penetration of points in contact, of a rule or of corners [length].
  pure function depth_of(state, rule) result(depth)
    real(wp), intent(in) :: state(:, :)   !! (nstate, npoint) of contact_point
    type(rule_t), intent(in), optional :: rule
    real(wp) :: depth
    integer :: p

    depth = 0
    do p = 1, size(state, 2)
      if (nint(state(at_status, p)) == contact_open) cycle
      if (present(rule)) then
        if (is_control_point(rule, p)) cycle
      end if
      depth = max(depth, state(at_penetration, p))
    end do
  end function depth_of

  pure subroutine keep(value, side, worst, worst_side)
    real(wp), intent(in) :: value
    integer, intent(in) :: side
    real(wp), intent(inout) :: worst
    integer, intent(inout) :: worst_side

    if (.not. value > worst) return
    worst = value
    worst_side = side
  end subroutine keep

end module contact_quality
