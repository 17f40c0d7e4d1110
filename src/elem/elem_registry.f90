!> The list of elements. Only its submodule uses the members.
module elem_registry
  use elem_api, only: elem_t
  implicit none
  private
  public :: list_elems

  interface
    !> All elements, in a fixed order: an element's position is its `elem_id`.
    module subroutine list_elems(elems)
      type(elem_t), allocatable, intent(out) :: elems(:)   !! (nelem_row)
    end subroutine list_elems
  end interface
end module elem_registry
