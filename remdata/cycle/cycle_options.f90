!> The command line of `remdata --next`: which cycle, what its user asks for, and how the program ended that was called last.
module cycle_options
  use arguments, only: argument, refuse_option, value_of
  use atomic, only: read_text
  use cycle_situation, only: ended_check, ended_lagamine, ended_nothing, ended_remdata, ended_t
  use errors, only: error_t, exit_input, exit_machine, fail
  use text, only: string_t, to_text
  implicit none
  private
  public :: cycle_options_t, asks_for_next, read_cycle_options

  character(len=*), parameter :: next_option = '--next'

  type :: cycle_options_t
    !> Folder of the results and name of the deck.
    character(len=:), allocatable :: stem
    integer :: tries = -1
    logical :: fresh = .false.
    type(ended_t) :: ended
  end type cycle_options_t

contains

  !> Is the program called for this at all?
  function asks_for_next() result(asks)
    logical :: asks
    character(len=:), allocatable :: word

    asks = command_argument_count() > 0
    if (.not. asks) return
    call argument(1, word)
    asks = word == next_option
  end function asks_for_next

  subroutine read_cycle_options(options, error)
    type(cycle_options_t), intent(out) :: options
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: word, said_in
    integer :: k

    options%ended%from = ''
    k = 0
    do while (k < command_argument_count() .and. .not. allocated(error))
      k = k + 1
      call argument(k, word)
      select case (word)
      case (next_option)
        call value_of(word, k, options%stem, error)
      case ('--fresh')
        options%fresh = .true.
      case ('--tries')
        call whole_number(word, k, options%tries, error)
      case ('--ran')
        call program_of(k, options%ended%program, error)
      case ('--code')
        call whole_number(word, k, options%ended%code, error)
      case ('--late')
        call whole_number(word, k, options%ended%late, error)
      case ('--from')
        call value_of(word, k, options%ended%from, error)
      case ('--said')
        call value_of(word, k, said_in, error)
      case default
        call refuse_option(word, [string_t(next_option), string_t('--fresh'), string_t('--tries'), string_t('--ran'), &
                                  string_t('--code'), string_t('--late'), string_t('--from'), string_t('--said')], 'remdata', error)
      end select
    end do
    if (.not. allocated(error)) call read_said(said_in, options%ended)
  end subroutine read_cycle_options

  !> The value of an option as a number from 0 on.
  subroutine whole_number(option, k, number, error)
    character(len=*), intent(in) :: option
    integer, intent(inout) :: k
    integer, intent(inout) :: number
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: word
    integer :: status

    call value_of(option, k, word, error)
    if (allocated(error)) return
    status = 1
    if (verify(word, '0123456789') == 0) read (word, *, iostat=status) number
    if (status /= 0) call fail(error, exit_input, option//': expected a whole number, found '''//word//'''')
  end subroutine whole_number

  subroutine program_of(k, program, error)
    integer, intent(inout) :: k
    integer, intent(out) :: program
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: word

    program = ended_nothing
    call value_of('--ran', k, word, error)
    if (allocated(error)) return
    select case (word)
    case ('check')
      program = ended_check
    case ('lagamine')
      program = ended_lagamine
    case ('remdata')
      program = ended_remdata
    case default
      call fail(error, exit_input, '--ran: expected check, lagamine or remdata, found '''//word//'''')
    end select
  end subroutine program_of

  !> What the program said, without the end of its last line; its exit code where it said nothing.
  subroutine read_said(path, ended)
    character(len=:), allocatable, intent(in) :: path
    type(ended_t), intent(inout) :: ended
    type(error_t), allocatable :: ignored

    if (allocated(path)) then
      call read_text(path, ended%said, ignored)
      ended%said = ended%said(:verify(ended%said, ' '//new_line('a'), back=.true.))
    else
      ended%said = ''
    end if
    if (ended%said /= '') return
    ended%said = trim(merge('remdata ', 'lagamine', ended%program == ended_remdata))//': exit code '//to_text(ended%code)
    if (ended%code == exit_machine) ended%said = ended%said//' (disk full?)'
  end subroutine read_said

end module cycle_options
