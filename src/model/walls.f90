!> Lines that nothing crosses: the axis of an axisymmetric scene, and planes of symmetry.
!>
!> A plane of symmetry is a straight line along X or Y in which a support holds sides of a body against motion across it, and across
!> it alone (`holds_plane`): the mirror image behind it is in no deck, but matter that comes to the line meets it. The whole line is
!> a wall for that body, provided that at the start
!> - all of the body lies on one side of it: else the line is inside the body, or the body goes on beyond a held edge;
!> - no free side of the body lies in it: a body cut along a plane of symmetry is held all along the cut. Where it is held along a
!>   part, as a plate on a pad, what is beside that part may go behind the line.
!> This is judged on the mesh that an operation begins with. Later meshes keep the verdict: sides that have come to lie on the wall
!> are free ones in the line. In an axisymmetric scene a line x = r is no plane; the axis is a wall for all bodies, without a card.
module walls
  use bodies, only: bodies_of_nodes, elements_at_middles
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, lacks_mesh, scene_t, wall_t
  use shape_functions, only: line3, quad8_side
  use support_planes, only: holds_plane
  use vectors, only: length_of
  implicit none
  private
  public :: placed_wall_t, find_walls, judge_supports, lift_sides, place_walls, put_on_walls, reaction_of_wall
  public :: no_plane, is_wall, lies_on_both_sides, has_free_sides, may_be_passed

  !> What a support is (judge_supports): it holds no plane of symmetry, it does, or it does not since the body lies on both sides of
  !> the line, has free sides in it, or the card says so.
  integer, parameter :: no_plane = 0, is_wall = 1, lies_on_both_sides = 2, has_free_sides = 3, may_be_passed = 4
  !> Distance of points that are on a line over the size of the body: round-off of points as cards give them.
  real(wp), parameter :: on_line = 1.0e-9_wp
  !> Depth in a wall over the size of the body: what sides, of which none is longer, dip between the wall's points; deeper ones than
  !> the wall lets in are left for checks to refuse. And that of a line that has been bent or passed before it became a wall.
  real(wp), parameter :: wall_depth = 1.0e-3_wp
  !> Points of a side that are looked at.
  integer, parameter :: nlook = 33

  !> A wall at an instant: points at side*(x(component) - place) < 0 are behind it.
  type :: placed_wall_t
    integer :: component = 0, side = 1
    real(wp) :: place = 0.0_wp   !! [length]
    !> Place in the scene's list, 0 for the axis.
    integer :: number = 0
    !> Nodes of what must not cross it (nnode), and groups of their elements (ngroup).
    logical, allocatable :: acts_on(:), of_group(:)
  end type placed_wall_t

contains

  !> The walls of a scene on the mesh it has now. `known` are those that an earlier mesh or operation has found: their supports
  !> stay walls where they still hold a straight line.
  pure subroutine find_walls(known, scene)
    type(wall_t), intent(in) :: known(:)   !! (nknown)
    type(scene_t), intent(inout) :: scene
    integer :: verdicts(size(scene%fixations))
    type(wall_t) :: one
    logical :: above
    integer :: f, k

    if (allocated(scene%walls)) deallocate (scene%walls)
    allocate (scene%walls(0))
    if (size(scene%mesh%coordinates, 2) == 0) return
    call judge_supports(scene, verdicts)
    do f = 1, size(verdicts)
      if (verdicts(f) == no_plane .or. verdicts(f) == may_be_passed) cycle
      associate (fixation => scene%fixations(f), x => scene%mesh%coordinates)
        one%label = fixation%label
        one%component = fixation%component
        one%node = fixation%nodes(1)
        if (any([(known(k)%label == one%label .and. known(k)%component == one%component, k=1, size(known))])) then
          do k = 1, size(known)
            if (known(k)%label == one%label) one%side = known(k)%side
          end do
        else
          if (verdicts(f) /= is_wall) cycle
          associate (body => bodies_of_nodes(scene))
            above = sum(x(one%component, :) - x(one%component, one%node), body == body(one%node)) > 0
          end associate
          one%side = merge(1, -1, above)
        end if
      end associate
      scene%walls = [scene%walls, one]
    end do
  end subroutine find_walls

  !> What each support is, on the mesh as it begins.
  pure subroutine judge_supports(scene, verdicts)
    type(scene_t), intent(in) :: scene
    integer, intent(out) :: verdicts(:)   !! (nfixation)
    integer, allocatable :: body(:), sharing(:)
    logical, allocatable :: held(:, :)
    integer :: f, c

    verdicts = no_plane
    if (size(scene%mesh%coordinates, 2) == 0 .or. .not. scene%finite) return
    do f = 1, size(verdicts)
      c = scene%fixations(f)%component
      if (.not. holds_plane(scene, f, scene%mesh%coordinates)) cycle
      if (scene%plane_state == axisymmetric .and. c == 1) cycle
      if (.not. allocated(body)) then
        body = bodies_of_nodes(scene)
        sharing = elements_at_middles(scene)
        held = held_nodes(scene)
      end if
      verdicts(f) = verdict_on(scene, f, body, sharing, held(c, :))
    end do
  end subroutine judge_supports

  !> Nodes that supports hold where they are (component, nnode).
  pure function held_nodes(scene) result(held)
    type(scene_t), intent(in) :: scene
    logical :: held(2, size(scene%mesh%coordinates, 2))
    integer :: f

    held = .false.
    do f = 1, size(scene%fixations)
      associate (one => scene%fixations(f))
        if (one%field == displacement_field .and. .not. abs(one%amplitude) > 0) held(one%component, one%nodes) = .true.
      end associate
    end do
  end function held_nodes

  !> One support that holds nodes on a straight line.
  pure function verdict_on(scene, f, body, sharing, held) result(verdict)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: f                       !! the support
    integer, intent(in) :: body(:), sharing(:)     !! (nnode) as `bodies_of_nodes` and `elements_at_middles` say
    logical, intent(in) :: held(:)                 !! (nnode) nodes held across the line
    integer :: verdict
    real(wp) :: d(3), low, high, near, phi(3), dphi(3)
    logical :: sides, free
    integer :: g, e, k, p, c

    c = scene%fixations(f)%component
    verdict = no_plane
    associate (nodes => scene%fixations(f)%nodes, x => scene%mesh%coordinates)
      ! a support of several bodies holds each of them in another plane, or it is no cut
      if (any(body(nodes) /= body(nodes(1)))) return
      near = on_line*length_of([(maxval(x(k, :), body == body(nodes(1))) - minval(x(k, :), body == body(nodes(1))), k=1, 2)])
      low = 0
      high = 0
      sides = .false.
      free = .false.
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g))) cycle
        do e = 1, size(scene%groups(g)%connectivity, 2)
          if (body(scene%groups(g)%connectivity(1, e)) /= body(nodes(1))) cycle
          do k = 1, 4
            associate (side => scene%groups(g)%connectivity(quad8_side(:, k), e))
              d = x(c, side) - x(c, nodes(1))
              if (sharing(side(2)) == 1 .and. maxval(abs(d)) <= near) then
                sides = sides .or. all(held(side))
                free = free .or. .not. all(held(side))
              end if
              do p = 1, merge(nlook, 3, sharing(side(2)) == 1)
                call line3(-1 + 2*(p - 1)/merge(nlook - 1.0_wp, 2.0_wp, sharing(side(2)) == 1), phi, dphi)
                low = min(low, dot_product(phi, d))
                high = max(high, dot_product(phi, d))
              end do
            end associate
          end do
        end do
      end do
    end associate
    if (.not. sides) return
    verdict = is_wall
    if (free) verdict = has_free_sides
    if (low < -near .and. high > near) verdict = lies_on_both_sides
    if (scene%fixations(f)%may_pass) verdict = may_be_passed
  end function verdict_on

  !> The walls of a scene where they are now, each once: the axis, and the scene's list but for lines that an operation before has
  !> bent, or behind which a body lies already.
  pure subroutine place_walls(scene, x, placed)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) now [length]
    type(placed_wall_t), allocatable, intent(out) :: placed(:)   !! (nwall)
    type(placed_wall_t) :: one
    integer, allocatable :: body(:)
    real(wp) :: depth
    integer :: g, k

    allocate (placed(0))
    allocate (one%acts_on(size(x, 2)), one%of_group(size(scene%groups)), source=.true.)
    if (scene%plane_state == axisymmetric) then
      one%component = 1
      placed = [one]
    end if
    if (.not. allocated(scene%walls)) return
    do k = 1, size(scene%walls)
      if (.not. allocated(body)) body = bodies_of_nodes(scene)
      associate (wall => scene%walls(k))
        one = placed_wall_t(wall%component, wall%side, x(wall%component, wall%node), k, body == body(wall%node), &
                            [(.false., g=1, size(scene%groups))])
        do g = 1, size(one%of_group)
          if (is_solid(scene%groups(g))) one%of_group(g) = one%acts_on(scene%groups(g)%connectivity(1, 1))
        end do
        associate (d => one%side*(x(one%component, :) - one%place))
          depth = max(-minval(d, one%acts_on), bend_of_line(scene, wall, d))
          if (depth > wall_depth*maxval(d, one%acts_on)) cycle
        end associate
        if (is_listed(placed, one)) cycle
      end associate
      placed = [placed, one]
    end do
  end subroutine place_walls

  !> Largest distance of nodes of a wall's support from it.
  pure function bend_of_line(scene, wall, d) result(bend)
    type(scene_t), intent(in) :: scene
    type(wall_t), intent(in) :: wall
    real(wp), intent(in) :: d(:)   !! (nnode) before the wall [length]
    real(wp) :: bend
    integer :: f

    bend = 0
    do f = 1, size(scene%fixations)
      associate (one => scene%fixations(f))
        if (one%field /= displacement_field .or. one%component /= wall%component) cycle
        if (any(one%nodes == wall%node)) bend = max(bend, maxval(abs(d(one%nodes))))
      end associate
    end do
  end function bend_of_line

  !> Two supports may hold parts of one line.
  pure function is_listed(placed, one) result(yes)
    type(placed_wall_t), intent(in) :: placed(:), one
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(placed)
      yes = yes .or. (placed(k)%number > 0 .and. placed(k)%component == one%component .and. placed(k)%side == one%side .and. &
                      all(placed(k)%acts_on .eqv. one%acts_on))
    end do
  end function is_listed

  !> Nodes behind walls go to the walls: their depth in stiff springs.
  pure subroutine put_on_walls(placed, x, acts_on)
    type(placed_wall_t), intent(in) :: placed(:)   !! (nwall)
    real(wp), intent(inout) :: x(:, :)             !! (2, nnode) [length]
    logical, intent(in) :: acts_on(:, :)           !! (nnode, nwall) nodes of what must not cross each
    integer :: k

    if (size(x, 2) == 0) return
    do k = 1, size(placed)
      associate (wall => placed(k), d => placed(k)%side*(x(placed(k)%component, :) - placed(k)%place))
        where (acts_on(:, k) .and. d < 0 .and. d >= -wall_depth*maxval(d, acts_on(:, k))) x(wall%component, :) = wall%place
      end associate
    end do
  end subroutine put_on_walls

  !> Middle nodes of sides that dip behind walls between their nodes are moved until the sides touch them. With distances d1, d2, d3
  !> of its nodes a parabola is nowhere behind where d2 >= (sqrt(d3) - sqrt(d1))**2/4: there it is a square, (a + b xi)**2.
  pure subroutine lift_sides(placed, sides, acts_on, x)
    type(placed_wall_t), intent(in) :: placed(:)   !! (nwall)
    integer, intent(in) :: sides(:, :)             !! (3, nside) nodes, the middle one second
    logical, intent(in) :: acts_on(:, :)           !! (nnode, nwall) nodes of what must not cross each
    real(wp), intent(inout) :: x(:, :)             !! (2, nnode) [length]
    real(wp) :: d(3), least, deepest
    integer :: k, i

    do k = 1, size(placed)
      associate (wall => placed(k))
        deepest = wall_depth*maxval(wall%side*(x(wall%component, :) - wall%place), acts_on(:, k))
        do i = 1, size(sides, 2)
          if (.not. acts_on(sides(2, i), k)) cycle
          d = wall%side*(x(wall%component, sides(:, i)) - wall%place)
          if (any(d < 0)) cycle
          least = 0.25_wp*(sqrt(d(3)) - sqrt(d(1)))**2
          if (d(2) < least .and. least - d(2) <= deepest) x(wall%component, sides(2, i)) = wall%place + wall%side*least
        end do
      end associate
    end do
  end subroutine lift_sides

  !> What a wall carries beside the nodes of its support: reactions of free nodes, which walls alone have.
  pure function reaction_of_wall(wall, x, held, reaction) result(total)
    type(placed_wall_t), intent(in) :: wall
    real(wp), intent(in) :: x(:, :)          !! (2, nnode) now [length]
    logical, intent(in) :: held(:)           !! (nnode) nodes of the support, which are left out
    real(wp), intent(in) :: reaction(:)      !! (nnode) across the wall [force]
    real(wp) :: total                        !! [force]

    associate (d => abs(x(wall%component, :) - wall%place))
      total = sum(reaction, wall%acts_on .and. .not. held .and. d <= wall_depth*maxval(d, wall%acts_on))
    end associate
  end function reaction_of_wall

end module walls
