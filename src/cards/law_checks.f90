!> What laws ask of their numbers beyond the range of each.
module law_checks
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use law_api, only: find_parameter, law_t, line_choice
  use materials, only: material_t
  use text, only: to_text
  implicit none
  private
  public :: check_numbers, check_alike

contains

  !> What a law asks for beyond the range of each number.
  subroutine check_numbers(cursor, law, material)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer :: k

    if (cursor%failed()) return
    if (law%name == 'EPLA' .and. size(material%curve, 2) > 0) then
      if (abs(material%curve(1, 1)) > 0) then
        call cursor%fail('the first plastic strain of the table must be 0, found '//to_text(material%curve(1, 1)))
      else if (any(.not. material%curve(2, :) > 0)) then
        call cursor%fail('all yield stresses of the table must be above 0, found '//to_text(minval(material%curve(2, :))))
      end if
    end if
    if (find_parameter(law, 'RATE0') > 0) then
      if ((given('COWPER') .or. given('JOHNSON')) .and. .not. given('RATE0')) then
        call cursor%fail('COWPER and JOHNSON need a RATE0 above 0')
      else if (given('RATE0') .and. (given('COWPER') .eqv. given('JOHNSON'))) then
        call cursor%fail('RATE0 wants one of COWPER and JOHNSON above 0')
      end if
    end if
    if (find_parameter(law, 'PENETR') > 0 .and. find_parameter(law, 'AKP') > 0) then
      if (.not. (given('PENETR') .or. given('AKP'))) &
        call cursor%fail('PENETR and AKP are both zero: one of them must be above 0')
    end if
    if (find_parameter(law, 'PHI') > 0 .and. find_parameter(law, 'M') > 0) then
      if (.not. min(material%values(find_parameter(law, 'PHI')), material%values(find_parameter(law, 'M'))) < huge(1.0_wp)) &
        call cursor%fail('neither PHI nor M is given: one of them says what friction there is (PHI 0. for none)')
    end if
    k = find_parameter(law, 'AUGMENT')
    if (k == 0) return
    if (abs(material%values(k) - anint(material%values(k))) > 0) call cursor%fail('AUGMENT must be a whole number')

  contains

    logical function given(name)
      character(len=*), intent(in) :: name

      given = material%values(find_parameter(law, name)) > 0
    end function given

  end subroutine check_numbers

  !> The same forms at all temperatures: words of choices, points of a table, and whether there is an effect of the rate.
  subroutine check_alike(cursor, law, first, later)
    type(cursor_t), intent(inout) :: cursor
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: first, later
    character(len=*), parameter :: rates(3) = [character(len=7) :: 'RATE0', 'COWPER', 'JOHNSON']
    integer :: i, k
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
    do i = 1, size(rates)
      k = find_parameter(law, trim(rates(i)))
      if (k == 0) cycle
      if ((first%values(k) > 0) .neqv. (later%values(k) > 0)) &
        call cursor%fail(trim(rates(i))//' is above 0 at some temperatures only: give it at all or at none')
    end do
  end subroutine check_alike

end module law_checks
