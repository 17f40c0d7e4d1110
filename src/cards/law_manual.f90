!> Description of laws, for `lagamine --law`: the list of all; of one its card, its numbers, its state, its source.
module law_manual
  use kinds, only: wp
  use law_api, only: contact_law, find_parameter, heat_law, kind_names, law_line_t, law_t, line_choice, line_pairs, parameter_t
  use text, only: add_text, padded, string_t, to_text
  implicit none
  private
  public :: law_card, law_list

contains

  !> A line for each law, those for solids first: name, number, what it is for, purpose.
  pure subroutine law_list(laws, lines)
    type(law_t), intent(in) :: laws(:)                     !! (nlaw)
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    integer :: kind, i

    allocate (lines(0))
    do kind = 1, size(kind_names)
      do i = 1, size(laws)
        if (laws(i)%kind /= kind) cycle
        call add_text(lines, '  '//padded(laws(i)%name, 9)//padded(to_text(laws(i)%number), 6)//padded(users(laws(i)), 18) &
                 //laws(i)%purpose)
      end do
    end do
  end subroutine law_list

  !> Elements that use a law.
  pure function users(law) result(s)
    type(law_t), intent(in) :: law
    character(len=:), allocatable :: s

    select case (law%kind)
    case (contact_law)
      s = 'contact (CNT2D)'
    case (heat_law)
      s = 'heat (PL8TM)'
    case default
      s = 'solids (PL8LS)'
    end select
  end function users

  subroutine law_card(law, lines)
    type(law_t), intent(in) :: law
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    integer :: i, k

    allocate (lines(0))
    call add_text(lines, law%name//' ('//to_text(law%number)//'): '//law%purpose)
    call add_text(lines, 'source: '//law%source)
    call add_text(lines, 'for: '//users(law))
    if (law%swells_with > 0) then
      call add_text(lines, 'tangent: symmetric; unsymmetric'//only_with(law, law%swells_with))
    else if (law%symmetric .and. .not. law%symmetric_by_temperature) then
      call add_text(lines, 'tangent: symmetric, but not at several temperatures')
    else
      call add_text(lines, 'tangent: '//trim(merge('symmetric  ', 'unsymmetric', law%symmetric)))
    end if
    call add_text(lines, '')
    call add_text(lines, 'LAW name '//law%name)
    if (law%of_steel) call add_text(lines, '  STEEL file name, a steel of a .MET file')
    do i = 1, size(law%lines)
      call add_text(lines, card_line(law%lines(i)))
      do k = 1, size(law%lines(i)%parameters)
        call add_text(lines, parameter_line(law%lines(i)%parameters(k)))
      end do
    end do
    if (any_rises(law)) then
      call add_text(lines, '  all rows again for each temperature, after a row TEMP value: two at least')
    else if (law%kind /= contact_law .and. .not. law%of_steel) then
      call add_text(lines, '  all rows again for each temperature, after a row TEMP value; or once, without')
    end if
    if (allocated(law%drivers)) then
      do i = 1, size(law%drivers)
        call add_text(lines, 'driven by '//law%drivers(i)%name//only_with(law, law%drivers(i)%needs))
      end do
    end if
    call add_text(lines, '')
    if (size(law%history) == 0) call add_text(lines, 'state of a point beside that of the element: none')
    if (size(law%history) > 0) call add_text(lines, 'state of a point beside that of the element:')
    do i = 1, size(law%history)
      call add_text(lines, '  '//padded(law%history(i)%name, 18)//padded('['//law%history(i)%unit//']', 18) &
               //to_text(law%history(i)%ncomp)//' component(s), carried over as '//law%history(i)%transfer &
               //only_with(law, law%history(i)%needs, law%history(i)%or_needs))
    end do
  end subroutine law_card

  !> Some number of the card grows from temperature to temperature.
  pure function any_rises(law) result(yes)
    type(law_t), intent(in) :: law
    logical :: yes
    integer :: i

    yes = .false.
    do i = 1, size(law%lines)
      yes = yes .or. any(law%lines(i)%parameters%rises)
    end do
  end function any_rises

  !> The number of the card, or the two, without which a part of the history is not there.
  pure function only_with(law, place, or_place) result(s)
    type(law_t), intent(in) :: law
    integer, intent(in) :: place
    integer, intent(in), optional :: or_place
    character(len=:), allocatable :: s

    s = ''
    if (place == 0) return
    s = ', only with '//name_of(place)
    if (.not. present(or_place)) return
    if (or_place > 0) s = s//' or '//name_of(or_place)

  contains

    pure function name_of(number) result(name)
      integer, intent(in) :: number
      character(len=:), allocatable :: name
      integer :: i, k

      name = ''
      do i = 1, size(law%lines)
        do k = 1, size(law%lines(i)%parameters)
          if (find_parameter(law, law%lines(i)%parameters(k)%name, law%lines(i)%word) == number) &
            name = law%lines(i)%parameters(k)%name
        end do
      end do
    end function name_of

  end function only_with

  !> What a row of the card looks like.
  pure function card_line(line) result(s)
    type(law_line_t), intent(in) :: line
    character(len=:), allocatable :: s
    integer :: k

    select case (line%kind)
    case (line_pairs)
      s = '  pairs NAME value, in any order, on one or more rows'
      return
    case (line_choice)
      s = '  either '//line%word
    case default
      s = '  '
    end select
    do k = 1, size(line%parameters)
      s = s//' '//line%parameters(k)%name
    end do
    if (line%curve) s = s//', then rows of two numbers'
  end function card_line

  pure function parameter_line(parameter) result(s)
    type(parameter_t), intent(in) :: parameter
    character(len=:), allocatable :: s

    s = '    '//padded(parameter%name, 9)//padded('['//parameter%unit//']', 17)//parameter%meaning
    if (parameter%lower > -huge(1.0_wp)) &
      s = s//'; '//trim(merge('above   ', 'at least', parameter%strict))//' '//to_text(parameter%lower)
    if (parameter%upper < huge(1.0_wp)) s = s//'; at most '//to_text(parameter%upper)
    if (parameter%optional .and. parameter%default < huge(1.0_wp)) s = s//'; default '//to_text(parameter%default)
    if (parameter%optional .and. .not. parameter%default < huge(1.0_wp)) s = s//'; default: no bound'
  end function parameter_line

end module law_manual
