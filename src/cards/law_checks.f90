!> Conditions of laws on their numbers beyond the range of each.
module law_checks
  use deck_cursor, only: cursor_t
  use law_api, only: find_parameter, law_t, line_choice
  use materials, only: material_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: check_numbers, check_alike, refuse_without_temperatures

contains

  !> Conditions of a law beyond the range of each number.
  subroutine check_numbers(cursor, law, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material   !! at one temperature
    type(string_t), allocatable :: problems(:)
    integer :: i

    if (cursor%failed() .or. .not. associated(law%check)) return
    call law%check(material, problems)
    do i = 1, size(problems)
      call cursor%fail(problems(i)%s)
    end do
  end subroutine check_numbers

  !> A number that grows from temperature to temperature needs some.
  subroutine refuse_without_temperatures(cursor, law)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    integer :: i, p

    do i = 1, size(law%lines)
      do p = 1, size(law%lines(i)%parameters)
        if (law%lines(i)%parameters(p)%rises) call cursor%fail(law%lines(i)%parameters(p)%name &
                                                              //' is a function of the temperature: expected rows TEMP')
      end do
    end do
  end subroutine refuse_without_temperatures

  !> The same forms at all temperatures: words of choices, points of a table, and the parts that a number turns on.
  subroutine check_alike(cursor, law, first, before, later)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: first    !! at the first temperature
    type(material_t), intent(in) :: before   !! at the temperature below
    type(material_t), intent(in) :: later
    integer :: i, k, p
    logical :: choosing

    if (cursor%failed()) return
    k = 0
    choosing = .false.
    do i = 1, size(law%lines)
      if (law%lines(i)%kind == line_choice .and. .not. choosing) then
        k = k + 1
        if (nint(first%values(k)) /= nint(later%values(k))) &
          call cursor%fail('expected '//law%lines(i - 1 + nint(first%values(k)))%word//' as at the first temperature, found ' &
                           //law%lines(i - 1 + nint(later%values(k)))%word)
      end if
      choosing = law%lines(i)%kind == line_choice
      k = k + size(law%lines(i)%parameters)
    end do
    if (size(first%curve, 2) /= size(later%curve, 2)) &
      call cursor%fail('the table has '//to_text(size(later%curve, 2))//' points, expected '//to_text(size(first%curve, 2)) &
                       //' as at the first temperature')
    do i = 1, size(law%lines)
      do p = 1, size(law%lines(i)%parameters)
        k = find_parameter(law, law%lines(i)%parameters(p)%name)
        if (law%lines(i)%parameters(p)%rises .and. .not. later%values(k) > before%values(k)) &
          call cursor%fail(law%lines(i)%parameters(p)%name//' must grow with the temperature: it is '//to_text(later%values(k)) &
                           //' after '//to_text(before%values(k)))
        if (.not. law%lines(i)%parameters(p)%turns_on) cycle
        if ((first%values(k) > 0) .neqv. (later%values(k) > 0)) &
          call cursor%fail(law%lines(i)%parameters(p)%name//' is above 0 at some temperatures only: give it at all or at none')
      end do
    end do
  end subroutine check_alike

end module law_checks
