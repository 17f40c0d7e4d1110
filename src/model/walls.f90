!> Lines that nothing crosses: the axis of an axisymmetric scene, and planes of symmetry.
!>
!> A plane of symmetry is a straight line along X or Y in which a support holds sides of a body against motion across it, and across
!> it alone (`holds_plane`): the mirror image behind it is in no deck, but matter that comes to the line meets it. The whole line is
!> a wall for that body, provided that at the start
!> - all of the body lies on one side of it: else the line is inside the body, or the body goes on beyond a held edge;
!> - no free side of the body lies in it: a body cut along a plane of symmetry is held all along the cut. Where it is held along a
!>   part, as a plate on a pad, what is beside that part may go behind the line;
!> - no sides of the body face a rigid die that lies along it: that is there for them, with its friction and its forces.
!> This is judged on the mesh that an operation begins with. Later meshes keep the verdict: sides that have come to lie on the wall
!> are free ones in the line. In an axisymmetric scene a line x = r is no plane; the axis is a wall for all bodies, without a card.
module walls
  use bodies, only: bodies_of_nodes, elements_at_middles
  use dies, only: is_deformable
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, scene_t, wall_t
  use shape_functions, only: line3, quad8_side
  use support_planes, only: holds_plane
  use vectors, only: length_of
  implicit none
  private
  public :: find_walls, judge_supports
  public :: no_plane, is_wall, lies_on_both_sides, has_free_sides, has_die, may_be_passed

  !> What a support is (judge_supports): it holds no plane of symmetry, it does, or it does not since the body lies on both sides of
  !> the line, has free sides in it, faces a die that lies along it, or the card says so.
  integer, parameter :: no_plane = 0, is_wall = 1, lies_on_both_sides = 2, has_free_sides = 3, has_die = 4, may_be_passed = 5
  !> Distance of points that are on a line over the size of the body: round-off of points as cards give them.
  real(wp), parameter :: on_line = 1.0e-9_wp
  !> Points of a side that are looked at.
  integer, parameter :: nlook = 33

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
    if (verdict == is_wall .and. faces_die(scene, f, body, near)) verdict = has_die
    if (scene%fixations(f)%may_pass) verdict = may_be_passed
  end function verdict_on

  !> Sides of the body that a support holds face a rigid die, a piece of which lies along the line as the scene begins.
  pure function faces_die(scene, f, body, near) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: f         !! the support
    integer, intent(in) :: body(:)   !! (nnode) as `bodies_of_nodes` says
    real(wp), intent(in) :: near     !! distance of points that are on the line [length]
    logical :: yes
    real(wp) :: place
    integer :: g, k, c

    yes = .false.
    c = scene%fixations(f)%component
    place = scene%mesh%coordinates(c, scene%fixations(f)%nodes(1))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. size(group%connectivity) == 0) cycle
        if (body(group%connectivity(1, 1)) /= body(scene%fixations(f)%nodes(1))) cycle
        if (is_deformable(scene%dies(group%die))) cycle
        associate (die => scene%dies(group%die))
          do k = 1, size(die%pieces, 3)
            yes = yes .or. all(abs(die%pieces(c, :, k) + die%pilot(c) - place) <= near)
          end do
        end associate
      end associate
    end do
  end function faces_die

end module walls
