!> The members of a field: what an element declares of it, and its values (visitors).
module visit_field
  use fields, only: field_t, on_nodes, on_section
  use kinds, only: wp
  use visitors, only: kept, nodal, of_the_mesh, visitor_t
  implicit none
  private
  public :: visit_field_declaration, visit_field_values

contains

  !> Of a field of a scene, which has no values.
  subroutine visit_field_declaration(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(field_t), intent(inout) :: self

    call visitor%member('name', self%name, kept)
    call visitor%member('unit', self%unit, kept)
    call visitor%member('dual', self%dual, kept)
    call visitor%member('dual_unit', self%dual_unit, kept)
    call visitor%member('place', self%place, kept, low=on_nodes, high=on_section)
    call visitor%member('at_corners', self%at_corners, kept)
    call visitor%member('components', self%ncomp, kept, low=1, high=3)
    call visitor%member('first_angle', self%first_angle, kept, low=0, high=3)
    call visitor%member('quantity', self%quantity, kept)
    call visitor%member('imposed_as_value', self%imposed_as_value, kept)
    call visitor%member('transfer', self%transfer, kept)
    call visitor%member('word', self%word, kept)
    call visitor%member('initial', self%initial, kept, self%unit)
    call visitor%member('declared', self%declared, kept)
    call visitor%member('given', self%given, kept)
  end subroutine visit_field_declaration

  !> Of a field of a solution that was started. Values on nodes are carried by shape functions, forces on nodes belong to their
  !> mesh; pilots and the section do not depend on the mesh.
  subroutine visit_field_values(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(field_t), intent(inout) :: self
    character(len=:), allocatable :: values, effects

    values = nodal
    effects = of_the_mesh
    if (self%place /= on_nodes) then
      values = kept
      effects = kept
    end if
    call visitor%member('floor', self%floor, effects, self%dual_unit, low=0.0_wp)
    call visitor%member('value', self%value, values, 'component, place', self%unit)
    call visitor%member('last_increment', self%last_increment, values, 'component, place', self%unit)
    call visitor%member('older_increment', self%older_increment, effects, 'component, place', self%unit)
    call visitor%member('applied', self%applied, effects, 'component, place', self%dual_unit)
    call visitor%member('reaction', self%reaction, effects, 'component, place', self%dual_unit)
  end subroutine visit_field_values

end module visit_field
