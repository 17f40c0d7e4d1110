!> What speaks against the result of a run: its warnings, each with the operation it comes from.
!>
!> Those of earlier operations and meshes are part of the solution, so that the end of the run knows them all, whatever checkpoint
!> it was resumed from. Of what is judged again at the end of every operation, by records or a state that go on, the last word
!> counts.
module run_warnings
  use text, only: string_t
  implicit none
  private
  public :: add_warning, join_warnings, warning_t, with_operation

  type :: warning_t
    !> Name of the operation; empty in a deck without any.
    character(len=:), allocatable :: operation
    !> The check of the summary that does not hold; empty where it is none.
    character(len=:), allocatable :: check
    character(len=:), allocatable :: text
    !> Judged again at the end of the next operation.
    logical :: again = .false.
  end type warning_t

contains

  !> Add one to a list.
  pure subroutine add_warning(list, operation, text, check, again)
    type(warning_t), allocatable, intent(inout) :: list(:)   !! (nwarning)
    character(len=*), intent(in) :: operation, text
    character(len=*), intent(in), optional :: check
    logical, intent(in), optional :: again
    type(warning_t), allocatable :: longer(:)
    integer :: k, n

    n = 0
    if (allocated(list)) n = size(list)
    allocate (longer(n + 1))
    do k = 1, n
      longer(k) = list(k)
    end do
    longer(n + 1)%operation = operation
    longer(n + 1)%text = text
    longer(n + 1)%check = ''
    if (present(check)) longer(n + 1)%check = check
    if (present(again)) longer(n + 1)%again = again
    call move_alloc(longer, list)
  end subroutine add_warning

  !> Earlier ones, and later ones behind them, each once: of two that are the same the later text counts, of the operation that it
  !> was first seen in; the earlier one with its advice where nothing new is found.
  pure subroutine join_warnings(earlier, later, list)
    type(warning_t), intent(in) :: earlier(:), later(:)      !! (nwarning)
    type(warning_t), allocatable, intent(out) :: list(:)     !! (nwarning)
    integer :: k, j

    allocate (list(0))
    do k = 1, size(earlier)
      if (any([(are_same(earlier(k), later(j)) .and. .not. is_found_alike(earlier(k), later(j)), j=1, size(later))])) cycle
      call add_warning(list, earlier(k)%operation, earlier(k)%text, earlier(k)%check, earlier(k)%again)
    end do
    do k = 1, size(later)
      do j = 1, size(earlier)
        if (are_same(earlier(j), later(k))) exit
      end do
      if (j <= size(earlier)) then
        if (is_found_alike(earlier(j), later(k))) cycle
        call add_warning(list, earlier(j)%operation, later(k)%text, later(k)%check, later(k)%again)
      else
        call add_warning(list, later(k)%operation, later(k)%text, later(k)%check, later(k)%again)
      end if
    end do
  end subroutine join_warnings

  !> Of one text; or of one check, or judged again, whatever the numbers.
  pure function are_same(one, other) result(same)
    type(warning_t), intent(in) :: one, other
    logical :: same

    same = one%text == other%text
    if (len(one%check) > 0) same = same .or. one%check == other%check
    if (one%again .and. other%again) same = same .or. without_numbers(one%text) == without_numbers(other%text)
  end function are_same

  !> What both say before their advice is the same, with its numbers.
  pure function is_found_alike(one, other) result(alike)
    type(warning_t), intent(in) :: one, other
    logical :: alike

    alike = one%text == other%text
    if (len(one%check) > 0 .and. one%check == other%check) &
      alike = one%text(:index(one%text//':', ':') - 1) == other%text(:index(other%text//':', ':') - 1)
  end function is_found_alike

  pure function without_numbers(text) result(words)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: words
    integer :: k

    words = ''
    do k = 1, len(text)
      if (scan(text(k:k), '0123456789.+-') == 0) words = words//text(k:k)
    end do
  end function without_numbers

  !> Texts that say which operation they come from, unless it is this one.
  pure subroutine with_operation(list, present, lines)
    type(warning_t), intent(in) :: list(:)                      !! (nwarning)
    character(len=*), intent(in) :: present                     !! operation whose name goes without saying
    type(string_t), allocatable, intent(out) :: lines(:)        !! (nwarning)
    integer :: k

    allocate (lines(size(list)))
    do k = 1, size(list)
      lines(k)%s = list(k)%text
      if (list(k)%operation /= present) lines(k)%s = 'operation '//list(k)%operation//': '//list(k)%text
    end do
  end subroutine with_operation

end module run_warnings
