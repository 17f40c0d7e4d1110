!> `lagamine --law NAME`: the cards of laws.
module law_print
  use errors, only: error_t, exit_input, fail
  use law_api, only: law_t
  use law_manual, only: law_card, law_list
  use law_registry, only: law_names, list_laws
  use standard_streams, only: print_lines
  use text, only: join, nearest_word, string_t
  implicit none
  private
  public :: print_law

contains

  !> The card of a law, or all laws in a list where the name is ''.
  subroutine print_law(name, error)
    character(len=*), intent(in) :: name
    type(error_t), allocatable, intent(out) :: error
    type(law_t), allocatable :: laws(:)
    type(string_t), allocatable :: names(:), lines(:)
    character(len=:), allocatable :: nearest
    integer :: k

    call list_laws(laws)
    if (name == '') then
      call law_list(laws, lines)
      call print_lines(lines, error)
      return
    end if
    do k = 1, size(laws)
      if (laws(k)%name /= name) cycle
      call law_card(laws(k), lines)
      call print_lines(lines, error)
      return
    end do
    call law_names(laws, names)
    nearest = nearest_word(name, names)
    if (nearest /= '') nearest = '; nearest: '''//nearest//''''
    call law_list(laws, lines)
    call fail(error, exit_input, 'no law is called '''//name//''''//nearest, 'the laws:'//new_line('a')//join(lines, new_line('a')))
  end subroutine print_law

end module law_print
