!> Unknowns by the scene: numbered only where an element calls for them.
!>
!> An unknown is a component of a field at a place: a displacement of a node, a motion of a die's pilot or of the section, a
!> temperature of a node. Each is free (it has an equation) or prescribed (its motion is known: elimination, no penalty).
module dofs
  use elem_api, only: elem_t, field_nodes, layout_t
  use element_fields, only: layout_of
  use fields, only: field_t, on_nodes, on_pilots, on_section
  use kinds, only: wp
  use pairs, only: most_pieces, nodes_per_piece, paired_nodes, pairs_t, start_pairs
  use scene, only: group_t, scene_t
  use text, only: string_t
  implicit none
  private
  public :: dofs_t, field_dofs_t, group_dofs_t, is_driven, number_dofs, number_pairs, prescribed_motion, move_fields

  !> Unknown of each component of a field at each place (ncomp, place), 0 where there is none.
  type :: field_dofs_t
    integer, allocatable :: number(:, :)
    !> The places are nodes of the mesh.
    logical :: at_nodes = .false.
  end type field_dofs_t

  type :: group_dofs_t
    !> Nodes and unknowns of each element, in the local order of the ELEM family (nnode, nelem), (ndof, nelem).
    integer, allocatable :: nodes(:, :), dof(:, :)
    type(layout_t) :: layout
  end type group_dofs_t

  !> An unknown whose motion, or whose value, is amplitude times multiplier; multiplier 0 holds it.
  type :: prescribed_t
    integer :: dof = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
    !> Field and place of a value that is imposed as such; 0 where the motion since the start is.
    integer :: field = 0, component = 0, place = 0
    !> History of the scene that gives the value, and the row there; 0 for others.
    integer :: history = 0, row = 0
    !> It has moved already, before the first step, by what the multiplier begins with.
    logical :: moved = .false.
  end type prescribed_t

  type :: dofs_t
    integer :: ndof = 0
    !> Unknowns of the fields of the scene.
    type(field_dofs_t), allocatable :: fields(:)
    !> Unknowns whose motion is not prescribed (ndof).
    logical, allocatable :: is_free(:)
    !> Unknowns that are angles, and tilts of the section (their forces are moments).
    logical, allocatable :: is_angle(:)
    !> Quantities of the fields, and that of each unknown (ndof).
    type(string_t), allocatable :: quantities(:)
    integer, allocatable :: quantity(:)
    type(prescribed_t), allocatable :: prescribed(:)
    type(group_dofs_t), allocatable :: groups(:)
  end type dofs_t

  !> Unknowns are numbered by where they stand, those of nodes first, then by field.
  integer, parameter :: places(3) = [on_nodes, on_pilots, on_section]

  interface
    !> Fixations, imposed displacements and pilots; an unknown held twice is listed once.
    module subroutine list_prescribed(scene, dofs)
      type(scene_t), intent(in) :: scene
      type(dofs_t), intent(inout) :: dofs
    end subroutine list_prescribed

    !> Motion of the prescribed unknowns from time t0 (or from rest) to t1, in the order of the list.
    pure module subroutine prescribed_motion(scene, dofs, fields, from_rest, t0, t1, motion)
      type(scene_t), intent(in) :: scene
      type(dofs_t), intent(in) :: dofs
      type(field_t), intent(in) :: fields(:)   !! (nfield) with their values at t0
      logical, intent(in) :: from_rest
      real(wp), intent(in) :: t0, t1       !! [time]
      real(wp), intent(out) :: motion(:)   !! (nprescribed) [unknown]
    end subroutine prescribed_motion
  end interface

contains

  !> Number the unknowns of a scene.
  subroutine number_dofs(scene, elems, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(dofs_t), intent(out) :: dofs
    integer :: f, g, k

    call mark_unknowns(scene, elems, dofs%fields)
    do k = 1, size(places)
      do f = 1, size(scene%fields)
        if (scene%fields(f)%place == places(k)) call take_numbers(dofs%fields(f)%number)
      end do
    end do

    allocate (dofs%is_angle(dofs%ndof), source=.false.)
    do f = 1, size(scene%fields)
      if (scene%fields(f)%first_angle == 0) cycle
      associate (angles => dofs%fields(f)%number(scene%fields(f)%first_angle:, :))
        do k = 1, size(angles, 2)
          do g = 1, size(angles, 1)
            if (angles(g, k) > 0) dofs%is_angle(angles(g, k)) = .true.
          end do
        end do
      end associate
    end do

    call list_quantities(scene, dofs)
    call list_prescribed(scene, dofs)
    call list_elements(scene, elems, dofs)
    call find_free(dofs)

  contains

    subroutine take_numbers(number)
      integer, intent(inout) :: number(:, :)
      integer :: i, c

      do i = 1, size(number, 2)
        do c = 1, size(number, 1)
          if (number(c, i) == 0) cycle
          dofs%ndof = dofs%ndof + 1
          number(c, i) = dofs%ndof
        end do
      end do
    end subroutine take_numbers

  end subroutine number_dofs

  !> A 1 for every component of a field at a place where some element has it among its unknowns.
  subroutine mark_unknowns(scene, elems, fields)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)
    type(field_dofs_t), allocatable, intent(out) :: fields(:)
    type(layout_t) :: layout
    integer :: g, u, f

    allocate (fields(size(scene%fields)))
    do f = 1, size(fields)
      allocate (fields(f)%number(scene%fields(f)%ncomp, places_of(scene, scene%fields(f))), source=0)
      fields(f)%at_nodes = scene%fields(f)%place == on_nodes
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        layout = layout_of(elems(group%elem_id), size(group%connectivity, 1), group%option, scene%plane_state, scene%fields)
        do u = 1, layout%nfield
          call mark_places(group, scene%fields(layout%field(u)), fields(layout%field(u))%number)
        end do
      end associate
    end do
  end subroutine mark_unknowns

  !> A 1 for every component of a field at the places of the elements of a group.
  pure subroutine mark_places(group, field, number)
    type(group_t), intent(in) :: group
    type(field_t), intent(in) :: field
    integer, intent(inout) :: number(:, :)   !! (ncomp, place)
    integer :: e

    select case (field%place)
    case (on_nodes)
      do e = 1, size(group%connectivity, 2)
        number(:, group%connectivity(field_nodes(field, size(group%connectivity, 1)), e)) = 1
      end do
    case (on_pilots)
      number(:, group%die) = 1
    case default
      number = 1
    end select
  end subroutine mark_places

  !> Quantities in the order of the fields, and that of each unknown.
  subroutine list_quantities(scene, dofs)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(inout) :: dofs
    integer :: f, q, k, c

    allocate (dofs%quantities(0), dofs%quantity(dofs%ndof))
    do f = 1, size(scene%fields)
      do q = 1, size(dofs%quantities)
        if (dofs%quantities(q)%s == scene%fields(f)%quantity) exit
      end do
      if (q > size(dofs%quantities)) call append(scene%fields(f)%quantity)
      associate (number => dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (number(c, k) > 0) dofs%quantity(number(c, k)) = q
          end do
        end do
      end associate
    end do

  contains

    subroutine append(name)
      character(len=*), intent(in) :: name
      type(string_t), allocatable :: longer(:)

      allocate (longer(size(dofs%quantities) + 1))
      longer(:size(dofs%quantities)) = dofs%quantities
      longer(size(longer))%s = name
      call move_alloc(longer, dofs%quantities)
    end subroutine append

  end subroutine list_quantities

  !> At how many places a field may have unknowns.
  pure function places_of(scene, field) result(n)
    type(scene_t), intent(in) :: scene
    type(field_t), intent(in) :: field
    integer :: n

    select case (field%place)
    case (on_nodes)
      n = size(scene%mesh%coordinates, 2)
    case (on_pilots)
      n = size(scene%dies)
    case default
      n = 1
    end select
  end function places_of

  !> Unknowns that are not prescribed, and that some element acts on: what elements only read of a field that ends beside them stays
  !> as it is.
  pure subroutine find_free(dofs)
    type(dofs_t), intent(inout) :: dofs
    integer :: g, u, c, e

    allocate (dofs%is_free(dofs%ndof), source=.false.)
    do g = 1, size(dofs%groups)
      associate (layout => dofs%groups(g)%layout, dof => dofs%groups(g)%dof)
        do u = 1, layout%nfield
          if (.not. layout%acts(u)) cycle
          do c = 1, count(layout%first(:, u) > 0)
            do e = 1, size(dof, 2)
              dofs%is_free(dof(layout%first(c, u):layout%first(c, u) + layout%count(u) - 1, e)) = .true.
            end do
          end do
        end do
      end associate
    end do
    dofs%is_free(dofs%prescribed%dof) = .false.
  end subroutine find_free

  !> Unknowns of every element.
  subroutine list_elements(scene, elems, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)
    type(dofs_t), intent(inout) :: dofs
    type(pairs_t), allocatable :: pairs(:)
    integer :: g

    allocate (dofs%groups(size(scene%groups)))
    call start_pairs(scene, pairs)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs > 0) cycle
      dofs%groups(g)%nodes = scene%groups(g)%connectivity
      call number_elements(scene, elems(scene%groups(g)%elem_id), g, dofs)
    end do
    call number_pairs(scene, elems, pairs, dofs)
  end subroutine list_elements

  !> Unknowns of the elements that face deformable dies, with the pairs of now.
  subroutine number_pairs(scene, elems, pairs, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)    !! (nelem_row)
    type(pairs_t), intent(in) :: pairs(:)   !! (npair)
    type(dofs_t), intent(inout) :: dofs
    integer :: g, e, n, npiece

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%pairs == 0) cycle
        associate (middle => pairs(group%pairs)%piece)
          npiece = most_pieces(scene%dies(group%die), middle)
          n = size(group%connectivity, 1) + nodes_per_piece*npiece
          if (allocated(dofs%groups(g)%nodes)) then
            if (size(dofs%groups(g)%nodes, 1) /= n) deallocate (dofs%groups(g)%nodes, dofs%groups(g)%dof)
          end if
          if (.not. allocated(dofs%groups(g)%nodes)) allocate (dofs%groups(g)%nodes(n, size(middle, 2)))
          do e = 1, size(middle, 2)
            dofs%groups(g)%nodes(:, e) = paired_nodes(scene%dies(group%die), group%connectivity(:, e), middle(:, e), npiece)
          end do
        end associate
        call number_elements(scene, elems(group%elem_id), g, dofs)
      end associate
    end do
  end subroutine number_pairs

  !> Unknowns of the elements of a group from their nodes.
  subroutine number_elements(scene, elem, g, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elem
    integer, intent(in) :: g
    type(dofs_t), intent(inout) :: dofs
    integer :: u, c

    associate (own => dofs%groups(g))
      own%layout = layout_of(elem, size(own%nodes, 1), scene%groups(g)%option, scene%plane_state, scene%fields)
      if (.not. allocated(own%dof)) allocate (own%dof(own%layout%ndof, size(own%nodes, 2)))
      do u = 1, own%layout%nfield
        associate (number => dofs%fields(own%layout%field(u))%number, first => own%layout%first)
          do c = 1, size(number, 1)
            call take_places(own%nodes, scene%groups(g)%die, scene%fields(own%layout%field(u)), number(c, :), &
                             own%dof(first(c, u):first(c, u) + own%layout%count(u) - 1, :))
          end do
        end associate
      end do
    end associate
  end subroutine number_elements

  !> Unknowns of one component of a field, of all elements of a group.
  pure subroutine take_places(nodes, die, field, number, dof)
    integer, intent(in) :: nodes(:, :)   !! (nnode, nelem)
    integer, intent(in) :: die           !! of the group, 0 for none
    type(field_t), intent(in) :: field
    integer, intent(in) :: number(:)     !! (place) the component's unknowns
    integer, intent(out) :: dof(:, :)    !! (count, nelem)
    integer :: local(size(dof, 1)), e

    select case (field%place)
    case (on_nodes)
      local = field_nodes(field, size(nodes, 1))
      do e = 1, size(nodes, 2)
        dof(:, e) = number(nodes(local, e))
      end do
    case (on_pilots)
      dof = number(die)
    case default
      dof = number(1)
    end select
  end subroutine take_places

  !> A support or a die moves: some prescribed unknown that is a motion.
  pure function is_driven(dofs, motion) result(yes)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)   !! (nprescribed) [unknown]
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(motion)
      associate (q => dofs%quantity(dofs%prescribed(k)%dof))
        if (dofs%quantities(q)%s == 'motion') yes = yes .or. abs(motion(k)) > 0
      end associate
    end do
  end function is_driven

  !> Advance all fields: nodes, pilots and section move, temperatures change. Places without an unknown stay as they are.
  pure subroutine move_fields(dofs, motion, fields)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)            !! (ndof) [unknown]
    type(field_t), intent(inout) :: fields(:)    !! (nfield)
    integer :: f, k, c, d

    do f = 1, size(fields)
      fields(f)%older_increment = fields(f)%last_increment
      do k = 1, size(fields(f)%value, 2)
        do c = 1, fields(f)%ncomp
          d = dofs%fields(f)%number(c, k)
          ! what was carried to a new mesh is of no step of this one
          fields(f)%last_increment(c, k) = 0
          if (d > 0) fields(f)%last_increment(c, k) = motion(d)
        end do
      end do
      fields(f)%value = fields(f)%value + fields(f)%last_increment
    end do
  end subroutine move_fields

end module dofs
