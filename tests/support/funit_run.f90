!> Runs tests one after another and ends the program with what they say.
module funit_run
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
  use funit_report, only: failed_asserts, open_test
  implicit none
  private
  public :: start_run, run_test, end_run

  abstract interface
    !> A test, or what comes before or after each of them.
    subroutine test_i()
    end subroutine test_i
  end interface

  !> What the command line asks for.
  logical, save :: verbose = .false.
  character(len=:), allocatable, save :: filter
  !> Tests run, tests failed, tests disabled.
  integer, save :: ran = 0, failed = 0, disabled_tests = 0

contains

  !> Read the command line: `-v` names each test before it runs, `-f TEXT` runs those with TEXT in their name.
  subroutine start_run()
    character(len=:), allocatable :: word
    integer :: i

    filter = ''
    i = 1
    do while (i <= command_argument_count())
      word = argument(i)
      select case (word)
      case ('-v', '--verbose')
        verbose = .true.
      case ('-f', '--filter')
        i = i + 1
        if (i > command_argument_count()) call refuse('-f wants a part of a test name')
        filter = argument(i)
      case ('-h', '--help')
        write (output_unit, '(a)') 'usage: TESTS [-v] [-f PART-OF-A-TEST-NAME]'
        stop
      case default
        call refuse('unknown option '//word//'; known: -v, -f TEXT, -h')
      end select
      i = i + 1
    end do
  end subroutine start_run

  !> Run one test, unless it is filtered out or disabled.
  subroutine run_test(name, test, disabled, before, after)
    !> `module%test`
    character(len=*), intent(in) :: name
    procedure(test_i) :: test
    logical, intent(in) :: disabled
    procedure(test_i), optional :: before, after

    if (index(name, filter) == 0) return
    if (disabled) then
      disabled_tests = disabled_tests + 1
      write (output_unit, '("disabled: ",a)') name
      return
    end if
    if (verbose) then
      write (output_unit, '(a)') name
      ! A test may crash: its name must be out by then.
      flush (output_unit)
    end if
    call open_test(name)
    if (present(before)) call before()
    if (failed_asserts() == 0) call test()
    if (present(after)) call after()
    ran = ran + 1
    if (failed_asserts() > 0) failed = failed + 1
  end subroutine run_test

  !> Print the sum and end the program: 0 only if a test ran and none failed.
  subroutine end_run()
    write (output_unit, '(i0," tests, ",i0," failures")', advance='no') ran, failed
    if (disabled_tests > 0) write (output_unit, '(", ",i0," disabled")', advance='no') disabled_tests
    write (output_unit, '()')
    if (ran == 0) write (output_unit, '(a)') 'no test ran: this is a failure'
    flush (output_unit)
    if (ran == 0 .or. failed > 0) stop 1
  end subroutine end_run

  !> The command line cannot be read: say why and stop.
  subroutine refuse(reason)
    character(len=*), intent(in) :: reason

    write (error_unit, '(a)') reason
    stop 2
  end subroutine refuse

  function argument(i) result(word)
    integer, intent(in) :: i
    character(len=:), allocatable :: word
    integer :: length

    call get_command_argument(i, length=length)
    allocate (character(len=length) :: word)
    call get_command_argument(i, word)
  end function argument

end module funit_run
