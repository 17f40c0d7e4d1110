!> Threads of a run, as many as there are processors for them.
!>
!> Threads of one team wait for each other: on a processor that another process is at work on, one of them holds up all, and a
!> run on two threads then takes longer than on one. So their number follows the load of the machine, unless the user has set it.
!> Results do not depend on it.
module threads
!$ use omp_lib, only: omp_get_max_threads, omp_set_num_threads
  use kinds, only: wp
  use processors, only: free_at_start, free_processors, processor_use_t, read_processor_use
  use system, only: in_environment, wall_seconds
  implicit none
  private
  public :: set_threads, number_of_threads, team_t, start_team, fit_to_load, threads_for

  !> The threads of a run.
  type :: team_t
    !> The most it may have.
    integer :: most = 1
    !> The load decides how many it has.
    logical, private :: by_load = .false.
    type(processor_use_t), private :: last
  end type team_t

  !> Seconds between two readings of the load: some ten ticks of the system's clock.
  real(wp), parameter :: look_every = 0.25_wp

  !> With one of these set, the user has settled how many threads there are, or where.
  character(len=*), parameter :: settled_by(6) = [character(len=18) :: 'OMP_NUM_THREADS', 'OMP_THREAD_LIMIT', 'OMP_DYNAMIC', &
                                                  'OMP_PROC_BIND', 'OMP_PLACES', 'GOMP_CPU_AFFINITY']

contains

  !> Use n threads; 0 keeps the number of the environment.
  subroutine set_threads(n)
    integer, intent(in) :: n

!$  if (n > 0) call omp_set_num_threads(n)
  end subroutine set_threads

  !> Threads that the next parallel region will have.
  function number_of_threads() result(n)
    integer :: n

    n = 1
!$  n = omp_get_max_threads()
  end function number_of_threads

  !> Begin with the threads asked for, or with what the load allows where none are.
  subroutine start_team(team, asked)
    type(team_t), intent(out) :: team
    integer, intent(in) :: asked   !! 0: no number was asked for

    call set_threads(asked)
    team%most = number_of_threads()
    if (asked > 0 .or. team%most == 1) return
    team%by_load = .not. in_environment(settled_by)
    if (.not. team%by_load) return
    call read_processor_use(team%last)
    team%by_load = team%last%count > 0
    if (team%by_load) call set_threads(threads_for(free_at_start(team%last), team%most))
  end subroutine start_team

  !> Read the load at intervals, and adapt the number of threads to it. Not for use inside parallel regions.
  subroutine fit_to_load(team)
    type(team_t), intent(inout) :: team
    type(processor_use_t) :: now

    if (.not. team%by_load) return
    if (wall_seconds() - team%last%instant < look_every) return
    call read_processor_use(now)
    if (now%count > 0) call set_threads(threads_for(free_processors(team%last, now), team%most))
    team%last = now
  end subroutine fit_to_load

  !> Threads for so many free processors.
  pure function threads_for(free, most) result(n)
    real(wp), intent(in) :: free
    integer, intent(in) :: most
    integer :: n

    n = max(1, min(most, nint(min(free, real(most, wp)))))
  end function threads_for

end module threads
