!> What the system reports about the processors: what they can do, which of them this process may use, how busy they are.
!>
!> Read from /proc, which Linux has; where it is missing, or has another format, nothing is known and nothing is changed.
module processors
  use kinds, only: i8, wp
  use proc_entries, only: longest_line, value_in
  use system, only: cpu_seconds, wall_seconds
  implicit none
  private
  public :: processor_use_t, read_processor_use, free_processors, free_at_start, processor_flags, is_in_list

  !> Use of the processors since the machine was started.
  type :: processor_use_t
    !> Processors that this process may use, 0: not known; are these all of the machine?
    integer :: count = 0
    logical :: all_of_machine = .false.
    !> Their idle time and all time, in ticks of the system.
    integer(i8) :: idle = 0, total = 0
    !> Processor time of this process [s], and when this was read [s].
    real(wp) :: own = 0.0_wp, instant = 0.0_wp
  end type processor_use_t

contains

  !> The present use.
  subroutine read_processor_use(times)
    type(processor_use_t), intent(out) :: times
    character(len=:), allocatable :: allowed, numbers
    character(len=longest_line) :: line
    integer(i8) :: ticks(8)   ! user, nice, system, idle, waiting for input, two kinds of interrupts, taken by other machines
    integer :: unit, status, number, present_ones

    times%own = cpu_seconds()
    times%instant = wall_seconds()
    call value_in('/proc/self/status', 'Cpus_allowed_list', allowed)
    if (allowed == '') return
    open (newunit=unit, file='/proc/stat', status='old', action='read', iostat=status)
    if (status /= 0) return
    present_ones = 0
    numbers = ''
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0 .or. line(:3) /= 'cpu') exit
      if (line(4:4) == ' ') cycle   ! the sum of all
      read (line(4:), *, iostat=status) number
      if (status /= 0) exit
      present_ones = present_ones + 1
      if (.not. is_in_list(allowed, number)) cycle
      numbers = line(index(line, ' '):len_trim(line))//repeat(' 0', size(ticks))
      read (numbers, *, iostat=status) ticks
      if (status /= 0) exit
      times%count = times%count + 1
      times%idle = times%idle + ticks(4) + ticks(5)
      times%total = times%total + sum(ticks)
    end do
    close (unit)
    times%all_of_machine = times%count == present_ones
  end subroutine read_processor_use

  !> Processors that this process used or could have used between two readings: idle ones and its own.
  pure function free_processors(before, after) result(free)
    type(processor_use_t), intent(in) :: before, after
    real(wp) :: free

    free = after%count
    if (after%total <= before%total .or. .not. after%instant > before%instant) return
    free = after%count*real(after%idle - before%idle, wp)/real(after%total - before%total, wp) &
           + (after%own - before%own)/(after%instant - before%instant)
  end function free_processors

  !> Processors that no other process is at work on right now. A single reading: the times of the processors are more exact, later.
  function free_at_start(times) result(free)
    type(processor_use_t), intent(in) :: times
    real(wp) :: free
    character(len=80) :: line
    real(wp) :: loads(3)
    integer :: unit, status, running

    free = times%count
    if (.not. times%all_of_machine) return
    open (newunit=unit, file='/proc/loadavg', status='old', action='read', iostat=status)
    if (status /= 0) return
    read (unit, '(a)', iostat=status) line
    close (unit)
    if (status /= 0 .or. index(line, '/') == 0) return
    ! three averages, then those that run now, this process among them, over all there are
    read (line(:index(line, '/') - 1), *, iostat=status) loads, running
    if (status == 0) free = times%count - max(running - 1, 0)
  end function free_at_start

  !> Flags of the first processor, separated by blanks: instruction sets of x86; '' on other processors.
  subroutine processor_flags(flags)
    character(len=:), allocatable, intent(out) :: flags

    call value_in('/proc/cpuinfo', 'flags', flags)
  end subroutine processor_flags

  !> Is a processor in a list such as 0-3,8?
  pure function is_in_list(list, number) result(found)
    character(len=*), intent(in) :: list
    integer, intent(in) :: number
    logical :: found
    integer :: first, length, dash, low, high, status

    found = .false.
    first = 1
    do while (first <= len_trim(list) .and. .not. found)
      length = index(list(first:)//',', ',') - 1
      associate (piece => list(first:first + length - 1))
        dash = index(piece, '-')
        read (piece(:merge(dash - 1, length, dash > 0)), *, iostat=status) low
        if (status /= 0) return
        read (piece(dash + 1:), *, iostat=status) high
        if (status /= 0) return
      end associate
      found = number >= low .and. number <= high
      first = first + length + 1
    end do
  end function is_in_list

end module processors
