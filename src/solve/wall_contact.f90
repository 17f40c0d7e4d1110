!> Walls that nothing crosses: the axis of an axisymmetric scene, where the sides of bodies stay at r >= 0, and planes of symmetry
!> in which supports hold a body (walls).
!>
!> Points of a side (its nodes and many between) have no area at r = 0, so that a pressure on an area holds nothing there.
!> What holds them is a nodal force without a radius in it, that of a stiff spring toward the wall where the distance d < 0:
!> f = k d, by the shape functions of the side on its nodes, without friction. k is `hardness` times Young's modulus times the depth
!> of the side across the plane: the thickness [force/length]; round the axis its chord at the axis itself, elsewhere the radius of
!> its middle, half its chord at least [force/length per radian]. Stresses of a hundredth of the modulus leave 1e-5 of the side as
!> depth. All that meets here lies on one straight line, so that many points on a side of three nodes do not constrain it too much;
!> between two of them a parabola d'' dips by d'' h**2/8, h = 2/(npoint - 1): 5e-4 d''. Source of unilateral penalties: P. Wriggers,
!> Computational Contact Mechanics, 2nd ed., Springer 2006, sec. 6.3.
!>
!> The force is added to that of the element the side belongs to, before it is gathered: pattern and order of sums stay what they
!> are, and where no point is below 0 so do all bits. Walls stand still and do no work.
module wall_contact
  use bodies, only: elements_at_middles
  use contact_overlap, only: share_of_way
  use dofs, only: dofs_t
  use elem_api, only: report_t
  use element_unknowns, only: layout_t
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: law_t
  use placed_walls, only: place_walls, placed_wall_t
  use quadrature, only: line_rule, rule_equidistant, rule_t
  use scene, only: axisymmetric, is_solid, scene_t
  use shape_functions, only: line3, quad8_side
  use sparsity, only: pattern_t
  use vectors, only: length_of
  implicit none
  private
  public :: wall_contact_t, find_wall_sides, press_on_walls

  !> Stiffness over Young's modulus and the depth of the side across the plane.
  real(wp), parameter :: hardness = 1.0e3_wp
  !> Points of a side.
  integer, parameter :: npoint = 33
  !> A point this share of its side off a wall is on it: what the wall lets in, and round-off.
  real(wp), parameter :: at_wall = 1.0e-4_wp
  !> A node of a new mesh on a wall is this share of its side off it at most: round-off.
  real(wp), parameter :: on_wall = 1.0e-9_wp

  !> Sides of bodies that walls could meet, each as a part of an element; one that could meet two walls is there twice.
  type :: wall_contact_t
    type(placed_wall_t), allocatable :: walls(:)
    !> Wall, group that moves the side, element of it, and the side's nodes among those of the element (3, nside).
    integer, allocatable :: wall(:), group(:), element(:), local(:, :)
    !> Spring of a point [force/length, per radian], chord of the side [length] (nside).
    real(wp), allocatable :: stiffness(:), length(:)
    !> Points that the wall holds now (npoint, nside).
    logical, allocatable :: held(:, :)
    !> Force of the walls on the nodes now (2, nnode), per radian; all zero where they hold none.
    real(wp), allocatable :: force(:, :)
  end type wall_contact_t

  !> Places of the component across the wall of a side's three nodes in the lists of all forces, and of all entries of matrices
  !> (row, column).
  type :: places_t
    integer :: force(3) = 0, matrix(3, 3) = 0
  end type places_t

contains

  !> The sides of the bodies of a scene that belong to one element alone, unless all their motions across a wall are prescribed.
  subroutine find_wall_sides(scene, laws, dofs, x, contact)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: x(:, :)      !! (2, nnode) nodes now, where walls are found [length]
    type(wall_contact_t), intent(out) :: contact
    integer :: sharing(size(x, 2)), w, g, e, k, n, mover

    call place_walls(scene, x, contact%walls)
    n = 4*size(contact%walls)*sum([(size(scene%groups(g)%connectivity, 2), g=1, size(scene%groups))])
    allocate (contact%wall(n), contact%group(n), contact%element(n), contact%local(3, n), contact%stiffness(n), contact%length(n))
    allocate (contact%force(2, size(sharing)), source=0.0_wp)
    if (n > 0) sharing = elements_at_middles(scene)
    n = 0
    do w = 1, size(contact%walls)
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g)) .or. .not. contact%walls(w)%of_group(g)) cycle
        mover = mover_of(scene, dofs, g)
        if (mover == 0) cycle
        do e = 1, size(scene%groups(g)%connectivity, 2)
          do k = 1, 4
            associate (nodes => scene%groups(g)%connectivity(quad8_side(:, k), e))
              if (sharing(nodes(2)) /= 1) cycle
              if (.not. any(dofs%is_free(dofs%fields(displacement_field)%number(contact%walls(w)%component, nodes)))) cycle
              n = n + 1
              contact%wall(n) = w
              contact%group(n) = mover
              contact%element(n) = e
              contact%local(:, n) = quad8_side(:, k)
              contact%length(n) = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
              contact%stiffness(n) = hardness*modulus_of(scene, laws, mover)* &
                                     depth_across(scene, contact%walls(w), nodes, contact%length(n))
            end associate
          end do
        end do
      end do
    end do
    contact%wall = contact%wall(:n)
    contact%group = contact%group(:n)
    contact%element = contact%element(:n)
    contact%local = contact%local(:, :n)
    contact%length = contact%length(:n)
    contact%stiffness = contact%stiffness(:n)
    allocate (contact%held(npoint, n), source=.false.)
  end subroutine find_wall_sides

  !> How deep a side goes on across the plane [length, per radian].
  pure function depth_across(scene, wall, nodes, chord) result(depth)
    type(scene_t), intent(in) :: scene
    type(placed_wall_t), intent(in) :: wall
    integer, intent(in) :: nodes(3)   !! of the side
    real(wp), intent(in) :: chord     !! [length]
    real(wp) :: depth

    if (scene%plane_state /= axisymmetric) then
      depth = scene%section(1)
    else if (wall%component == 1) then
      depth = chord
    else
      depth = max(scene%mesh%coordinates(1, nodes(2)), 0.5_wp*chord)
    end if
  end function depth_across

  !> The formulation that moves the elements of a body: the body's own or one added to it; 0 where none does.
  pure function mover_of(scene, dofs, body) result(mover)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    integer, intent(in) :: body   !! number of the group
    integer :: mover
    integer :: g

    do mover = 1, size(scene%groups)
      if (mover /= body .and. scene%groups(mover)%host /= body) cycle
      associate (layout => dofs%groups(mover)%layout)
        do g = 1, layout%nfield
          if (layout%field(g) == displacement_field .and. layout%acts(g)) return
        end do
      end associate
    end do
    mover = 0
  end function mover_of

  !> Young's modulus of a group, at the first temperature of its cards [stress].
  pure function modulus_of(scene, laws, g) result(young)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g
    real(wp) :: young
    real(wp) :: poisson, temperature

    young = 0
    associate (material => scene%materials(scene%groups(g)%material))
      if (.not. associated(laws(material%law_id)%elastic)) return
      temperature = 0
      if (allocated(material%temperatures)) temperature = material%temperatures(1)
      call laws(material%law_id)%elastic(material, temperature, young, poisson)
    end associate
  end function modulus_of

  !> Add the forces of the walls at a motion of the step to those of the elements, and their stiffness to their matrices.
  !> The report has the share of the step after which a point meets a wall, and how far points move that were on it.
  !> On a new mesh points on a wall have no depth yet that carries what the old one bore: `restored` gives them the stiffness of the
  !> wall, so that the state is judged, and equilibrium found, with the wall behind them.
  subroutine press_on_walls(scene, dofs, pattern, active, displacement, du, tangent, restored, contact, force, matrix, report)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(pattern_t), intent(in) :: pattern
    logical, intent(in) :: active(:)             !! (ngroup) groups of the solve
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) at the start of the step [length]
    real(wp), intent(in) :: du(:)                !! (ndof) motion of the step [unknown]
    logical, intent(in) :: tangent               !! matrices are wanted
    logical, intent(in) :: restored              !! equilibrium of what was carried to the mesh
    type(wall_contact_t), intent(inout) :: contact
    real(wp), intent(inout) :: force(:)    !! forces of all elements, one after the other [force]
    real(wp), intent(inout) :: matrix(:)   !! matrices of all elements, one after the other [force/length]
    type(report_t), intent(inout) :: report
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: start(3), motion(3)
    integer :: s, c, first, dof(3), nodes(3)

    if (size(contact%group) == 0) return
    if (any(contact%held)) contact%force = 0
    contact%held = .false.
    call line_rule(rule_t(rule_equidistant, npoint), xi, weight)
    do s = 1, size(contact%group)
      if (.not. active(contact%group(s))) cycle
      associate (group => dofs%groups(contact%group(s)), wall => contact%walls(contact%wall(s)))
        c = wall%component
        first = first_of(group%layout, c)
        nodes = group%nodes(contact%local(:, s), contact%element(s))
        dof = group%dof(first - 1 + contact%local(:, s), contact%element(s))
        start = wall%side*(scene%mesh%coordinates(c, nodes) + displacement(c, nodes) - wall%place)
        motion = wall%side*du(dof)
        ! no shape function is below -1/8, and only one at a time below 0
        if (9*minval(start + motion) - maxval(start + motion) > 0) cycle
        call press_side(s, nodes, places_of(pattern, contact, s, group%layout%ndof, first), xi, start, motion, &
                        dofs%is_free(dof), tangent, merge(on_wall*contact%length(s), 0.0_wp, restored), contact, force, matrix, &
                        report)
      end associate
    end do
  end subroutine press_on_walls

  !> Where the motions of a side's nodes across the wall stand among the forces and matrices of all elements.
  pure function places_of(pattern, contact, s, ndof, first) result(places)
    type(pattern_t), intent(in) :: pattern
    type(wall_contact_t), intent(in) :: contact
    integer, intent(in) :: s, ndof, first   !! the side; unknowns of its element, and the first displacement across among them
    type(places_t) :: places
    integer :: j, m

    places%force = pattern%force_start(contact%group(s)) + (contact%element(s) - 1)*ndof + first - 1 + contact%local(:, s)
    m = pattern%matrix_start(contact%group(s)) + (contact%element(s) - 1)*ndof**2
    do j = 1, 3
      places%matrix(:, j) = m + (first - 2 + contact%local(j, s))*ndof + first - 1 + contact%local(:, s)
    end do
  end function places_of

  !> The points of one side that could meet its wall.
  pure subroutine press_side(s, nodes, places, xi, start, motion, is_free, tangent, near, contact, force, matrix, report)
    integer, intent(in) :: s, nodes(3)           !! the side and its nodes
    type(places_t), intent(in) :: places
    real(wp), intent(in) :: xi(:)                !! (npoint) its points [-]
    real(wp), intent(in) :: start(3), motion(3)  !! distances of the nodes at the start of the step, and their motion [length]
    logical, intent(in) :: is_free(3), tangent   !! nodes whose motion across is an unknown; matrices are wanted
    real(wp), intent(in) :: near                 !! distance up to which points before the wall have its stiffness [length]
    type(wall_contact_t), intent(inout) :: contact
    real(wp), intent(inout) :: force(:), matrix(:)
    type(report_t), intent(inout) :: report
    real(wp) :: phi(3), dphi(3), d, before, part(3)
    integer :: p, j, c, side

    c = contact%walls(contact%wall(s))%component
    side = contact%walls(contact%wall(s))%side
    do p = 1, npoint
      call line3(xi(p), phi, dphi)
      if (.not. any(is_free .and. abs(phi) > 0)) cycle
      before = dot_product(phi, start)
      d = before + dot_product(phi, motion)
      if (before <= at_wall*contact%length(s) .and. min(d, before) < 0) &
        report%jump = max(report%jump, abs(d - before)/contact%length(s))
      ! a held node is on the wall anyway
      if (tangent .and. (d < 0 .or. (d < near .and. any(is_free .and. abs(phi) > on_wall)))) then
        do j = 1, 3
          matrix(places%matrix(:, j)) = matrix(places%matrix(:, j)) + contact%stiffness(s)*phi*phi(j)
        end do
      end if
      if (.not. d < 0) cycle
      if (before > at_wall*contact%length(s)) report%event = min(report%event, share_of_way(before, -d, contact%length(s)))
      contact%held(p, s) = .true.
      part = side*contact%stiffness(s)*d*phi
      do j = 1, 3
        force(places%force(j)) = force(places%force(j)) + part(j)
        contact%force(c, nodes(j)) = contact%force(c, nodes(j)) - part(j)
      end do
    end do
  end subroutine press_side

  !> Place of the first displacement in a direction among the unknowns of an element.
  pure function first_of(layout, component) result(place)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: component
    integer :: place

    place = layout%first(component, findloc(layout%field, displacement_field, 1))
  end function first_of

end module wall_contact
