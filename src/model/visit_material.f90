!> The members of a material (visitors): groups of one material exchange their state, whatever its law.
module visit_material
  use materials, only: material_t
  use visitors, only: kept, visitor_t
  implicit none
  private
  public :: visit_material_members

  character(len=*), parameter :: of_the_deck = 'the solver reads it from the deck'

contains

  subroutine visit_material_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(material_t), intent(inout) :: self

    call visitor%member('name', self%name, kept)
    call visitor%derived('law', of_the_deck)
    call visitor%derived('law_id', of_the_deck)
    call visitor%derived('values', of_the_deck)
    call visitor%derived('curve', of_the_deck)
    call visitor%derived('temperatures', of_the_deck)
    call visitor%derived('values_by_temperature', of_the_deck)
    call visitor%derived('curves', of_the_deck)
    call visitor%derived('steel', of_the_deck)
    call visitor%derived('where_defined', of_the_deck)
  end subroutine visit_material_members

end module visit_material
