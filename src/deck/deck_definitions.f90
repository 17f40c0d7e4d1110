!> PARAM lines, overrides `-p NAME=VALUE`, and the value of a field which may use parameters.
module deck_definitions
  use deck_expression, only: evaluate, fill_in
  use deck_field, only: deck_field_t, scan_fields
  use deck_parameters, only: parameter_t, parameters_t, valid_name
  use diagnostics, only: diagnostics_t, location_t
  use expression_forms, only: is_formula, looks_numeric
  use text, only: nearest_word, string_t
  implicit none
  private
  public :: override_t, merge_overrides, interpret, define, refuse_unused

  !> One `-p NAME=VALUE`.
  type :: override_t
    character(len=:), allocatable :: name, value
    type(location_t) :: where
    !> It comes from a stored text, and a new one may replace it.
    logical :: stored = .false.
    !> Some PARAM line has its name.
    logical :: declared = .false.
  end type override_t

contains

  !> `stored` becomes the overrides in force, old and new; `options` are the same in their parts.
  subroutine merge_overrides(stored, new, options, diagnostics)
    type(string_t), allocatable, intent(inout) :: stored(:)      !! (noverride) texts NAME=VALUE
    type(string_t), intent(in) :: new(:)                         !! (nnew) texts NAME=VALUE
    type(override_t), allocatable, intent(inout) :: options(:)   !! (noverride)
    type(diagnostics_t), intent(inout) :: diagnostics
    type(string_t), allocatable :: all(:)
    type(override_t), allocatable :: parts(:)
    integer :: i, n, equal, old

    allocate (all(size(stored) + size(new)), parts(size(stored) + size(new)))
    n = 0
    do i = 1, size(all)
      parts(n + 1)%stored = i <= size(stored)
      if (parts(n + 1)%stored) then
        all(n + 1)%s = trim(adjustl(stored(i)%s))
      else
        all(n + 1)%s = trim(adjustl(new(i - size(stored))%s))
      end if
      call diagnostics%register('-p '//all(n + 1)%s, parts(n + 1)%where%file)
      equal = index(all(n + 1)%s, '=')
      if (equal < 2 .or. equal == len(all(n + 1)%s)) then
        call diagnostics%add(parts(n + 1)%where, '', 'expected NAME=VALUE')
        cycle
      end if
      parts(n + 1)%name = trim(all(n + 1)%s(:equal - 1))
      parts(n + 1)%value = all(n + 1)%s(equal + 1:)
      do old = 1, n
        if (parts(old)%name == parts(n + 1)%name) exit
      end do
      if (old > n) then
        n = n + 1
      else if (.not. parts(old)%stored) then
        call diagnostics%add(parts(n + 1)%where, '', ''''//parts(old)%name//''' is given twice')
      else
        parts(old) = parts(n + 1)
        all(old)%s = all(n + 1)%s
      end if
    end do
    if (allocated(options)) deallocate (options)
    allocate (options(n))
    deallocate (stored)
    allocate (stored(n))
    do i = 1, n
      options(i) = parts(i)
      call move_alloc(all(i)%s, stored(i)%s)
    end do
  end subroutine merge_overrides

  !> Find out whether a field is a number, a formula in x and y, or a word, and its value.
  subroutine interpret(field, where, keyword, parameters, diagnostics)
    type(deck_field_t), intent(inout) :: field
    type(location_t), intent(in) :: where
    character(len=*), intent(in) :: keyword
    type(parameters_t), intent(inout) :: parameters
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable :: message
    integer :: position, i

    if (field%quoted) return
    call parameters%mark_used(field%text)
    if (field%faulty) return
    if (field%text(1:1) == '$') then
      i = parameters%find(field%text(2:))
      if (i > 0) then
        field%faulty = parameters%items(i)%faulty
        field%numeric = parameters%items(i)%numeric
        field%value = parameters%items(i)%value
        if (.not. field%numeric .and. .not. field%faulty) field%text = parameters%items(i)%text
        return
      end if
    end if
    field%numeric = looks_numeric(field%text)
    if (keyword /= 'PARAM' .and. is_formula(field%text)) then
      field%numeric = .false.
      call fill_in(field%text, parameters, field%formula, field%faulty, message, position)
    else if (field%numeric) then
      call evaluate(field%text, parameters, field%value, field%faulty, message, position)
    else
      message = 'a parameter must be a field of its own or stand in an expression, not inside the word '''//field%text//''''
      position = index(field%text, '$')
      field%faulty = position > 0
    end if
    if (field%faulty .and. message /= '') &
      call diagnostics%add(location_t(where%file, where%line, merge(field%column + position - 1, 0, where%line > 0)), &
                           keyword, message)
  end subroutine interpret

  !> `PARAM name value`, or what an override puts in place of the value.
  subroutine define(line, where, options, parameters, diagnostics)
    character(len=*), intent(in) :: line
    type(location_t), intent(in) :: where
    type(override_t), intent(inout) :: options(:)   !! (noverride)
    type(parameters_t), intent(inout) :: parameters
    type(diagnostics_t), intent(inout) :: diagnostics
    type(deck_field_t), allocatable :: fields(:), given(:)
    type(parameter_t) :: item
    integer :: i, old

    call scan_fields(line, 6, where, 'PARAM', fields, diagnostics)
    ! The name is no expression; all the rest may use parameters, even where the line is wrong.
    do i = 2, size(fields)
      call interpret(fields(i), where, 'PARAM', parameters, diagnostics)
    end do
    if (size(fields) == 0) then
      call refuse(len(line) + 1, 'expected the name of a parameter, found the end of the line')
      return
    else if (fields(1)%faulty) then
      return
    else if (fields(1)%quoted .or. .not. valid_name(fields(1)%text)) then
      call refuse(fields(1)%column, 'expected the name of a parameter (a letter, then letters, digits, underscores), found '''// &
                  fields(1)%text//'''')
      return
    end if
    item%name = fields(1)%text
    item%where = location_t(where%file, where%line, fields(1)%column)
    do i = 1, size(options)
      if (options(i)%name == item%name) options(i)%declared = .true.
    end do
    old = parameters%find(item%name)
    if (old > 0) then
      call refuse(fields(1)%column, ''''//item%name//''' is already defined at '//diagnostics%place(parameters%items(old)%where))
      return
    end if
    item%faulty = size(fields) /= 2
    if (size(fields) == 1) then
      call refuse(len(line) + 1, 'expected the value of '''//item%name//''', found the end of the line')
    else if (size(fields) > 2) then
      call refuse(fields(3)%column, 'expected the end of the line, found '''//fields(3)%text//'''')
    else
      call set_value(fields(2))
    end if
    do i = 1, size(options)
      if (options(i)%name /= item%name) cycle
      call scan_fields(options(i)%value, 1, options(i)%where, '', given, diagnostics)
      if (size(given) /= 1) then
        item%faulty = .true.
        call diagnostics%add(options(i)%where, '', 'expected one number or word, found '''//trim(options(i)%value)//'''')
      else
        call interpret(given(1), options(i)%where, '', parameters, diagnostics)
        call set_value(given(1))
      end if
    end do
    call parameters%append(item)

  contains

    subroutine set_value(field)
      type(deck_field_t), intent(in) :: field

      item%text = field%text
      item%numeric = field%numeric
      item%value = field%value
      item%faulty = field%faulty
    end subroutine set_value

    subroutine refuse(column, message)
      integer, intent(in) :: column
      character(len=*), intent(in) :: message

      call diagnostics%add(location_t(where%file, where%line, column), 'PARAM', message)
    end subroutine refuse

  end subroutine define

  !> Nothing is silently ignored: a parameter must be used, an override must have its PARAM.
  subroutine refuse_unused(parameters, options, diagnostics)
    type(parameters_t), intent(in) :: parameters
    type(override_t), intent(in) :: options(:)   !! (noverride)
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable :: nearest
    integer :: i

    do i = 1, parameters%n
      if (parameters%items(i)%used .or. parameters%items(i)%faulty) cycle
      call diagnostics%add(parameters%items(i)%where, 'PARAM', ''''//parameters%items(i)%name//''' is defined and never used')
    end do
    do i = 1, size(options)
      if (options(i)%declared) cycle
      nearest = nearest_word(options(i)%name, parameters%declared)
      if (nearest /= '') nearest = '; nearest: '''//nearest//''''
      call diagnostics%add(options(i)%where, '', 'the deck has no PARAM '''//options(i)%name//''''//nearest)
    end do
  end subroutine refuse_unused

end module deck_definitions
