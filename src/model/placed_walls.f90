!> Walls where they are: the axis of an axisymmetric scene, and the planes of symmetry that a scene has found (walls).
module placed_walls
  use bodies, only: bodies_of_nodes
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, scene_t, wall_t
  use vectors, only: length_of
  implicit none
  private
  public :: placed_wall_t, lay_sides, lift_sides, place_walls, put_on_walls, reaction_beside, support_of

  !> Depth in a wall over the size of the body: what sides, of which none is longer, dip between the wall's points; deeper ones than
  !> the wall lets in are left for checks to refuse. And that of a line that has been bent or passed before it became a wall.
  real(wp), parameter :: wall_depth = 1.0e-3_wp
  !> The same over the side that dips (wall_contact). Ways of a middle node over its side: below is round-off, above a corner.
  real(wp), parameter :: side_depth = 1.0e-4_wp, least_lift = 1.0e-9_wp, largest_lift = 0.125_wp

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

  !> The walls of a scene where they are now, each once: the axis, and the scene's list but for lines that an operation before has
  !> bent, or behind which a body lies already; these are named.
  pure subroutine place_walls(scene, x, placed, dropped)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) now [length]
    type(placed_wall_t), allocatable, intent(out) :: placed(:)   !! (nwall)
    integer, allocatable, intent(out), optional :: dropped(:)    !! (n) places in the scene's list
    type(placed_wall_t) :: one
    integer, allocatable :: body(:)
    real(wp) :: depth
    integer :: g, k

    allocate (placed(0))
    if (present(dropped)) allocate (dropped(0))
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
          if (depth > wall_depth*maxval(d, one%acts_on)) then
            if (present(dropped)) dropped = [dropped, k]
            cycle
          end if
        end associate
        if (is_listed(placed, one)) cycle
      end associate
      placed = [placed, one]
    end do
  end subroutine place_walls

  !> Largest distance of nodes of a wall's support from it. Other supports may hold its corners too.
  pure function bend_of_line(scene, wall, d) result(bend)
    type(scene_t), intent(in) :: scene
    type(wall_t), intent(in) :: wall
    real(wp), intent(in) :: d(:)   !! (nnode) before the wall [length]
    real(wp) :: bend
    integer :: f

    bend = 0
    f = support_of(scene, wall)
    if (f > 0) bend = maxval(abs(d(scene%fixations(f)%nodes)))
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

  !> Sides of a contour that lies on planes of symmetry: nodes nearer to one than what it lets in between its points are on it, so
  !> that no side is left hanging a hair above it. Nodes near the axis stay, as they have no area there that a wedge could open.
  pure subroutine lay_sides(placed, sides, acts_on, x)
    type(placed_wall_t), intent(in) :: placed(:)   !! (nwall)
    integer, intent(in) :: sides(:, :)             !! (3, nside) nodes, the middle one second
    logical, intent(in) :: acts_on(:, :)           !! (nnode, nwall) nodes of what must not cross each
    real(wp), intent(inout) :: x(:, :)             !! (2, nnode) [length]
    real(wp) :: near
    integer :: k, i, j

    do k = 1, size(placed)
      associate (wall => placed(k))
        if (wall%number == 0) cycle
        do i = 1, size(sides, 2)
          if (.not. acts_on(sides(2, i), k)) cycle
          near = side_depth*length_of(x(:, sides(3, i)) - x(:, sides(1, i)))
          do j = 1, 3
            if (abs(x(wall%component, sides(j, i)) - wall%place) <= near) x(wall%component, sides(j, i)) = wall%place
          end do
        end do
      end associate
    end do
  end subroutine lay_sides

  !> Middle nodes of sides that dip behind walls between their nodes are moved until the sides touch them. With distances d1, d2, d3
  !> of its nodes a parabola is nowhere behind where d2 >= (sqrt(d3) - sqrt(d1))**2/4: there it is a square, (a + b xi)**2.
  pure subroutine lift_sides(placed, sides, acts_on, x)
    type(placed_wall_t), intent(in) :: placed(:)   !! (nwall)
    integer, intent(in) :: sides(:, :)             !! (3, nside) nodes, the middle one second
    logical, intent(in) :: acts_on(:, :)           !! (nnode, nwall) nodes of what must not cross each
    real(wp), intent(inout) :: x(:, :)             !! (2, nnode) [length]
    real(wp) :: d(3), least, way
    integer :: k, i

    do k = 1, size(placed)
      associate (wall => placed(k))
        do i = 1, size(sides, 2)
          if (.not. acts_on(sides(2, i), k)) cycle
          d = wall%side*(x(wall%component, sides(:, i)) - wall%place)
          if (any(d < 0)) cycle
          least = 0.25_wp*(sqrt(d(3)) - sqrt(d(1)))**2
          way = (least - d(2))/length_of(x(:, sides(3, i)) - x(:, sides(1, i)))
          if (way > least_lift .and. way <= largest_lift) x(wall%component, sides(2, i)) = wall%place + wall%side*least
        end do
      end associate
    end do
  end subroutine lift_sides

  !> What the walls whose supports hold none but some nodes carry beside these; 0 where there is no such wall. Nodes that no support
  !> holds have reactions of walls alone: of the one that is nearest.
  pure function reaction_beside(scene, x, component, nodes, reaction) result(total)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)        !! (2, nnode) now [length]
    integer, intent(in) :: component       !! of the reaction: 1 = x, 2 = y
    integer, intent(in) :: nodes(:)        !! (n) whose reactions are counted already
    real(wp), intent(in) :: reaction(:)    !! (nnode) [force], per radian when axisymmetric
    real(wp) :: total                      !! [force], per radian when axisymmetric
    type(placed_wall_t), allocatable :: walls(:)
    logical :: counted(size(x, 2)), held(size(x, 2))
    real(wp) :: nearest(size(x, 2))
    integer :: wall_of(size(x, 2)), k, f

    total = 0
    if (.not. allocated(scene%walls)) return
    if (all(scene%walls%component /= component)) return
    call place_walls(scene, x, walls)
    counted = .false.
    counted(nodes) = .true.
    held = .false.
    do f = 1, size(scene%fixations)
      associate (one => scene%fixations(f))
        if (one%field == displacement_field .and. one%component == component) held(one%nodes) = .true.
      end associate
    end do
    wall_of = 0
    nearest = huge(1.0_wp)
    do k = 1, size(walls)
      if (walls(k)%component /= component) cycle
      associate (d => abs(x(component, :) - walls(k)%place))
        where (walls(k)%acts_on .and. d < nearest)
          nearest = d
          wall_of = k
        end where
      end associate
    end do
    do k = 1, size(walls)
      if (walls(k)%number == 0 .or. walls(k)%component /= component) cycle
      f = support_of(scene, scene%walls(walls(k)%number))
      if (f == 0) cycle
      if (all(counted(scene%fixations(f)%nodes))) total = total + sum(reaction, wall_of == k .and. .not. (held .or. counted))
    end do
  end function reaction_beside

  !> The support that makes a wall, 0 where none does any more.
  pure function support_of(scene, wall) result(f)
    type(scene_t), intent(in) :: scene
    type(wall_t), intent(in) :: wall
    integer :: f

    do f = 1, size(scene%fixations)
      if (scene%fixations(f)%component /= wall%component) cycle
      if (scene%fixations(f)%label == wall%label) return
    end do
    f = 0
  end function support_of

end module placed_walls
