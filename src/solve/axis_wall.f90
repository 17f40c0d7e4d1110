!> The axis of an axisymmetric scene is a wall that nothing crosses: the sides of bodies stay at r >= 0.
!>
!> Points of a side (its nodes and many between) have no area at r = 0, so that a pressure on an area holds nothing there.
!> What holds them is a nodal force without a radius in it, that of a stiff spring toward the axis where r < 0:
!> f = k r, by the shape functions of the side on its nodes, without friction. k is `hardness` times Young's modulus times the
!> chord of the side [force/length per radian]: stresses of a hundredth of the modulus leave a depth of 1e-5 of the side. All that
!> meets here lies on one straight line, so that many points on a side of three nodes do not constrain it too much; between two of
!> them a parabola r'' dips by r'' h**2/8, h = 2/(npoint - 1): 5e-4 r''. Source of unilateral penalties: P. Wriggers, Computational
!> Contact Mechanics, 2nd ed., Springer 2006, sec. 6.3.
!>
!> The force is added to that of the element the side belongs to, before it is gathered: pattern and order of sums stay what they
!> are, and where no point is below 0 so do all bits. The wall stands still and does no work.
module axis_wall
  use bodies, only: elements_at_middles
  use contact_overlap, only: share_of_way
  use dofs, only: dofs_t
  use elem_api, only: report_t
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: law_t
  use quadrature, only: line_rule, rule_equidistant, rule_t
  use scene, only: axisymmetric, is_solid, scene_t
  use shape_functions, only: line3, quad8_side
  use sparsity, only: pattern_t
  use vectors, only: length_of
  implicit none
  private
  public :: axis_wall_t, find_axis_wall, press_on_axis

  !> Stiffness over Young's modulus and side.
  real(wp), parameter :: hardness = 1.0e3_wp
  !> Points of a side.
  integer, parameter :: npoint = 33
  !> A point this share of its side off the axis is on it: what the wall lets in, and round-off.
  real(wp), parameter :: at_axis = 1.0e-4_wp

  !> Sides of bodies that the axis could meet, each as a part of an element.
  type :: axis_wall_t
    !> Group that moves the side, element of it, and the side's nodes among those of the element (3, nside).
    integer, allocatable :: group(:), element(:), local(:, :)
    !> Spring of a point [force/length per radian], chord of the side [length] (nside).
    real(wp), allocatable :: stiffness(:), length(:)
    !> Points that the wall holds now (npoint, nside).
    logical, allocatable :: held(:, :)
    !> Force of the wall on the nodes now, in x, per radian (nnode); all zero where it holds none.
    real(wp), allocatable :: force(:)
  end type axis_wall_t

  !> Places of the x of a side's three nodes in the lists of all forces, and of all entries of matrices (row, column).
  type :: places_t
    integer :: force(3) = 0, matrix(3, 3) = 0
  end type places_t

contains

  !> The sides of the bodies of an axisymmetric scene that belong to one element alone, unless all their radii are prescribed.
  subroutine find_axis_wall(scene, laws, dofs, wall)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(dofs_t), intent(in) :: dofs
    type(axis_wall_t), intent(out) :: wall
    integer :: sharing(size(scene%mesh%coordinates, 2)), g, e, k, n, mover
    logical :: wanted

    n = 0
    if (scene%plane_state == axisymmetric) n = 4*sum([(size(scene%groups(g)%connectivity, 2), g=1, size(scene%groups))])
    allocate (wall%group(n), wall%element(n), wall%local(3, n), wall%stiffness(n), wall%length(n))
    allocate (wall%force(size(sharing)), source=0.0_wp)
    sharing = elements_at_middles(scene)
    n = 0
    do g = 1, size(scene%groups)
      if (size(wall%group) == 0) exit
      if (.not. is_solid(scene%groups(g))) cycle
      mover = mover_of(scene, dofs, g)
      if (mover == 0) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          associate (nodes => scene%groups(g)%connectivity(quad8_side(:, k), e))
            wanted = sharing(nodes(2)) == 1 .and. any(dofs%is_free(dofs%fields(displacement_field)%number(1, nodes)))
            if (.not. wanted) cycle
            n = n + 1
            wall%group(n) = mover
            wall%element(n) = e
            wall%local(:, n) = quad8_side(:, k)
            wall%length(n) = length_of(scene%mesh%coordinates(:, nodes(3)) - scene%mesh%coordinates(:, nodes(1)))
            wall%stiffness(n) = hardness*modulus_of(scene, laws, mover)*wall%length(n)
          end associate
        end do
      end do
    end do
    wall%group = wall%group(:n)
    wall%element = wall%element(:n)
    wall%local = wall%local(:, :n)
    wall%length = wall%length(:n)
    wall%stiffness = wall%stiffness(:n)
    allocate (wall%held(npoint, n), source=.false.)
  end subroutine find_axis_wall

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

  !> Add the forces of the wall at a motion of the step to those of the elements, and its stiffness to their matrices.
  !> The report has the share of the step after which a point meets the wall, and how far points move that were on it.
  subroutine press_on_axis(scene, dofs, pattern, active, displacement, du, tangent, wall, force, matrix, report)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(pattern_t), intent(in) :: pattern
    logical, intent(in) :: active(:)             !! (ngroup) groups of the solve
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode) at the start of the step [length]
    real(wp), intent(in) :: du(:)                !! (ndof) motion of the step [unknown]
    logical, intent(in) :: tangent               !! matrices are wanted
    type(axis_wall_t), intent(inout) :: wall
    real(wp), intent(inout) :: force(:)    !! forces of all elements, one after the other [force]
    real(wp), intent(inout) :: matrix(:)   !! matrices of all elements, one after the other [force/length]
    type(report_t), intent(inout) :: report
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: start(3), motion(3)
    integer :: s, first, dof(3), nodes(3)

    if (size(wall%group) == 0) return
    if (any(wall%held)) wall%force = 0
    wall%held = .false.
    call line_rule(rule_t(rule_equidistant, npoint), xi, weight)
    do s = 1, size(wall%group)
      if (.not. active(wall%group(s))) cycle
      associate (group => dofs%groups(wall%group(s)))
        first = first_of_x(group%layout%field, group%layout%first(1, :))
        nodes = group%nodes(wall%local(:, s), wall%element(s))
        dof = group%dof(first - 1 + wall%local(:, s), wall%element(s))
        start = scene%mesh%coordinates(1, nodes) + displacement(1, nodes)
        motion = du(dof)
        ! no shape function is below -1/8, and only one at a time below 0
        if (9*minval(start + motion) - maxval(start + motion) > 0) cycle
        call press_side(s, nodes, first_places(pattern, wall, s, group%layout%ndof, first), xi, start, motion, &
                        dofs%is_free(dof), tangent, wall, force, matrix, report)
      end associate
    end do
  end subroutine press_on_axis

  !> Where the x of a side's nodes stand among the forces and matrices of all elements.
  pure function first_places(pattern, wall, s, ndof, first) result(places)
    type(pattern_t), intent(in) :: pattern
    type(axis_wall_t), intent(in) :: wall
    integer, intent(in) :: s, ndof, first   !! the side; unknowns of its element, and the first radial displacement among them
    type(places_t) :: places
    integer :: j, m

    places%force = pattern%force_start(wall%group(s)) + (wall%element(s) - 1)*ndof + first - 1 + wall%local(:, s)
    m = pattern%matrix_start(wall%group(s)) + (wall%element(s) - 1)*ndof**2
    do j = 1, 3
      places%matrix(:, j) = m + (first - 2 + wall%local(j, s))*ndof + first - 1 + wall%local(:, s)
    end do
  end function first_places

  !> The points of one side that could meet the wall.
  pure subroutine press_side(s, nodes, places, xi, start, motion, is_free, tangent, wall, force, matrix, report)
    integer, intent(in) :: s, nodes(3)           !! the side and its nodes
    type(places_t), intent(in) :: places
    real(wp), intent(in) :: xi(:)                !! (npoint) its points [-]
    real(wp), intent(in) :: start(3), motion(3)  !! radii of the nodes at the start of the step, and their motion [length]
    logical, intent(in) :: is_free(3), tangent   !! nodes whose radius is an unknown; matrices are wanted
    type(axis_wall_t), intent(inout) :: wall
    real(wp), intent(inout) :: force(:), matrix(:)
    type(report_t), intent(inout) :: report
    real(wp) :: phi(3), dphi(3), r, before, part(3)
    integer :: p, j

    do p = 1, npoint
      call line3(xi(p), phi, dphi)
      if (.not. any(is_free .and. abs(phi) > 0)) cycle
      before = dot_product(phi, start)
      r = before + dot_product(phi, motion)
      if (before <= at_axis*wall%length(s) .and. min(r, before) < 0) &
        report%jump = max(report%jump, abs(r - before)/wall%length(s))
      if (.not. r < 0) cycle
      if (before > at_axis*wall%length(s)) report%event = min(report%event, share_of_way(before, -r, wall%length(s)))
      wall%held(p, s) = .true.
      part = wall%stiffness(s)*r*phi
      do j = 1, 3
        force(places%force(j)) = force(places%force(j)) + part(j)
        wall%force(nodes(j)) = wall%force(nodes(j)) - part(j)
        if (tangent) matrix(places%matrix(:, j)) = matrix(places%matrix(:, j)) + wall%stiffness(s)*phi*phi(j)
      end do
    end do
  end subroutine press_side

  !> Place of the first radial displacement among the unknowns of an element.
  pure function first_of_x(field, first) result(place)
    integer, intent(in) :: field(:), first(:)
    integer :: place

    place = first(findloc(field, displacement_field, 1))
  end function first_of_x

end module axis_wall
