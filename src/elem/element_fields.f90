!> The fields that elements have among their unknowns: which act on them, which of the scene they are, where their values stand.
module element_fields
  use elem_api, only: elem_t
  use element_unknowns, only: applies, field_nodes, layout_t
  use fields, only: field_t, find_field, mechanical_fields, on_nodes
  use scene, only: group_t, role_body, role_second, scene_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: acts_on, body_acts_on, declare_fields, has_unknown, layout_of, list_body_elems

contains

  !> An element acts on a field.
  pure function acts_on(elem, name) result(yes)
    type(elem_t), intent(in) :: elem
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(elem%unknowns)
      if (elem%unknowns(k)%acts) yes = yes .or. elem%unknowns(k)%field%name == name
    end do
  end function acts_on

  !> A group is a formulation on a body, and acts on a field.
  pure function body_acts_on(elems, group, name) result(yes)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes

    yes = any(group%role == [role_body, role_second])
    if (yes) yes = acts_on(elems(group%elem_id), name)
  end function body_acts_on

  !> An element has a field of the scene's list among its unknowns.
  pure function has_unknown(elem, name) result(yes)
    type(elem_t), intent(in) :: elem
    character(len=*), intent(in) :: name   !! of the field
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(elem%unknowns)
      yes = yes .or. elem%unknowns(k)%field%name == name
    end do
  end function has_unknown

  !> Names of the elements that bodies are made of: all, or those that act on a field.
  pure subroutine list_body_elems(elems, names, field)
    type(elem_t), intent(in) :: elems(:)                   !! (nelem_row)
    type(string_t), allocatable, intent(out) :: names(:)   !! (n)
    character(len=*), intent(in), optional :: field        !! its name
    integer :: k

    allocate (names(0))
    do k = 1, size(elems)
      if (elems(k)%role /= role_body) cycle
      if (present(field)) then
        if (.not. acts_on(elems(k), field)) cycle
      end if
      call add_text(names, elems(k)%name)
    end do
  end subroutine list_body_elems

  !> The fields that the elements of the groups of a scene have among their unknowns: those of mechanics first, declared where
  !> some element has them, then others in the order of the groups.
  pure subroutine declare_fields(elems, scene)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(scene_t), intent(inout) :: scene
    integer :: g, u, k

    if (.not. allocated(scene%fields)) scene%fields = mechanical_fields()
    scene%fields%declared = .false.
    do g = 1, size(scene%groups)
      associate (elem => elems(scene%groups(g)%elem_id))
        do u = 1, size(elem%unknowns)
          associate (unknown => elem%unknowns(u))
            if (unknown%optional .or. .not. applies(unknown, scene%plane_state, scene%groups(g)%option)) cycle
            k = find_field(scene%fields, unknown%field%name)
            if (k == 0) then
              scene%fields = [scene%fields, unknown%field]
              k = size(scene%fields)
            end if
            scene%fields(k)%declared = .true.
          end associate
        end do
      end associate
    end do
    if (.not. allocated(scene%histories)) return
    do k = 1, size(scene%histories)
      scene%fields(scene%histories(k)%field)%declared = .true.
    end do
  end subroutine declare_fields

  !> Positions of the unknowns of an element of so many nodes.
  pure function layout_of(elem, nnode, option, plane_state, fields) result(layout)
    type(elem_t), intent(in) :: elem
    integer, intent(in) :: nnode    !! of the element, with those it is paired with
    integer, intent(in) :: option   !! of the group
    integer, intent(in) :: plane_state
    type(field_t), intent(in) :: fields(:)   !! (nfield) of the scene
    type(layout_t) :: layout
    integer :: u, c, n, f

    do u = 1, size(elem%unknowns)
      associate (unknown => elem%unknowns(u))
        if (.not. applies(unknown, plane_state, option)) cycle
        f = find_field(fields, unknown%field%name)
        if (unknown%optional) then
          if (f == 0) cycle
          if (.not. fields(f)%declared) cycle
        end if
        n = layout%nfield + 1
        layout%nfield = n
        layout%field(n) = f
        layout%acts(n) = unknown%acts
        layout%count(n) = 1
        if (fields(f)%place == on_nodes) layout%count(n) = size(field_nodes(fields(f), nnode))
        do c = 1, fields(f)%ncomp
          layout%first(c, n) = layout%ndof + 1
          layout%ndof = layout%ndof + layout%count(n)
        end do
      end associate
    end do
  end function layout_of

end module element_fields
