!> The unknowns that an element declares, and where they stand among its local ones.
!>
!> An element declares which field, on which of its nodes, pilot or section (unknown_t). Its local unknowns stand in the order of
!> its declaration, each component of a field contiguous: x of all nodes, y of all nodes, pilot (x, y, angle), section, ...;
!> `layout_t` says where each begins.
module element_unknowns
  use fields, only: displacement_field, field_t, has_corners_only, mechanical_fields, pilot_field, section_field
  use kinds, only: wp
  use scene, only: generalised_plane_strain
  implicit none
  private
  public :: layout_t, unknown_t
  public :: applies, field_nodes, first_unknown, of_displacement, of_pilot, of_section, section_motion, that_reads
  public :: most_components

  !> Most components of a field, and most fields among the unknowns of an element.
  integer, parameter :: most_components = 3, most_fields = 4

  !> A field among the unknowns of an element.
  type :: unknown_t
    type(field_t) :: field
    !> Option of the element with which alone it has it, -1 for any (0: without an option).
    integer :: option = -1
    !> Only where other elements of the scene have the field: what the element reads of other fields.
    logical :: optional = .false.
    !> Plane state in which alone the element has it, 0 for any.
    integer :: plane_state = 0
    !> The element acts on it (has forces, heat flows there); otherwise it only reads it.
    logical :: acts = .true.
  end type unknown_t

  !> Where the unknowns of an element stand among its local ones, in the order of the declaration.
  type :: layout_t
    integer :: ndof = 0, nfield = 0
    !> Place of each field in the scene's list.
    integer :: field(most_fields) = 0
    !> The element acts on the field.
    logical :: acts(most_fields) = .false.
    !> Local place of the first value of a component, and how many values a component has.
    integer :: first(most_components, most_fields) = 0, count(most_fields) = 0
  end type layout_t

contains

  !> Displacements of all nodes of an element.
  pure function of_displacement() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(displacement_field)
  end function of_displacement

  !> The pilot of the die that an element faces.
  pure function of_pilot() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(pilot_field)
  end function of_pilot

  !> The section, an unknown in generalised plane strain.
  pure function of_section() result(unknown)
    type(unknown_t) :: unknown

    unknown = of_mechanics(section_field)
    unknown%plane_state = generalised_plane_strain
  end function of_section

  !> A field that the element only reads, where the scene has it.
  pure function that_reads(name) result(unknown)
    character(len=*), intent(in) :: name   !! of the field
    type(unknown_t) :: unknown

    unknown%field%name = name
    unknown%optional = .true.
    unknown%acts = .false.
  end function that_reads

  pure function of_mechanics(k) result(unknown)
    integer, intent(in) :: k   !! place in the list of the fields of mechanics
    type(unknown_t) :: unknown
    type(field_t) :: list(3)

    list = mechanical_fields()
    unknown%field = list(k)
  end function of_mechanics

  !> The element has this unknown in a plane state with an option.
  elemental function applies(unknown, plane_state, option) result(yes)
    type(unknown_t), intent(in) :: unknown
    integer, intent(in) :: plane_state, option
    logical :: yes

    yes = (unknown%plane_state == 0 .or. unknown%plane_state == plane_state) &
          .and. (unknown%option < 0 .or. unknown%option == option)
  end function applies

  !> Nodes of an element where a field has values of its own: all, or the corners of a quadrilateral and the ends of sides.
  pure function field_nodes(field, nnode) result(nodes)
    type(field_t), intent(in) :: field   !! on nodes
    integer, intent(in) :: nnode
    integer, allocatable :: nodes(:)
    integer :: k

    if (has_corners_only(field) .and. nnode == 8) then
      nodes = [1, 2, 3, 4]
    else if (has_corners_only(field) .and. mod(nnode, 3) == 0) then
      ! a side, and those that it is paired with
      nodes = [(3*(k/2) + merge(1, 0, mod(k, 2) == 1), k=1, 2*(nnode/3))]
    else
      nodes = [(k, k=1, nnode)]
    end if
  end function field_nodes

  !> Local place of the first unknown of a field, 0 where the element has none.
  pure function first_unknown(layout, field) result(first)
    type(layout_t), intent(in) :: layout
    integer, intent(in) :: field   !! position in the scene's list
    integer :: first
    integer :: k

    first = 0
    do k = 1, layout%nfield
      if (layout%field(k) == field) first = layout%first(1, k)
    end do
  end function first_unknown

  !> Motion of the section in the step, 0 where it is no unknown.
  pure function section_motion(layout, du) result(motion)
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the local unknowns of an element [unknown]
    real(wp) :: motion(3)
    integer :: first

    motion = 0
    first = first_unknown(layout, section_field)
    if (first > 0) motion = du(first:first + 2)
  end function section_motion

end module element_unknowns
