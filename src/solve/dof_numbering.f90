!> Unknowns of a scene get their numbers: only where an element calls for them, those of nodes first, then by field.
module dof_numbering
  use dofs, only: dofs_t, field_dofs_t
  use elem_api, only: elem_t, field_nodes, layout_t
  use element_dofs, only: list_elements
  use element_fields, only: layout_of
  use fields, only: field_t, on_nodes, on_pilots, on_section
  use prescribed_unknowns, only: list_prescribed
  use scene, only: group_t, scene_t
  use text, only: string_t
  implicit none
  private
  public :: number_dofs

  !> Unknowns are numbered by where they stand, those of nodes first, then by field.
  integer, parameter :: places(3) = [on_nodes, on_pilots, on_section]

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

end module dof_numbering
