!> The list of laws. Only its submodule uses the members.
module law_registry
  use law_api, only: law_t
  use text, only: string_t
  implicit none
  private
  public :: list_laws, law_names

  interface
    !> All laws, in a fixed order: a law's position is its `law_id`.
    module subroutine list_laws(laws)
      type(law_t), allocatable, intent(out) :: laws(:)   !! (nlaw)
    end subroutine list_laws
  end interface

contains

  !> Names of laws of a kind, for messages and choices.
  subroutine law_names(laws, names)
    type(law_t), intent(in) :: laws(:)                     !! (nlaw)
    type(string_t), allocatable, intent(out) :: names(:)   !! (nname)
    integer :: i

    allocate (names(size(laws)))
    do i = 1, size(laws)
      names(i)%s = laws(i)%name
    end do
  end subroutine law_names

end module law_registry
