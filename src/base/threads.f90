!> Threads of the element loop.
module threads
!$ use omp_lib, only: omp_get_max_threads, omp_set_num_threads
  implicit none
  private
  public :: set_threads, number_of_threads

contains

  !> Use n threads; 0 leaves what the environment says.
  subroutine set_threads(n)
    integer, intent(in) :: n

!$  if (n > 0) call omp_set_num_threads(n)
  end subroutine set_threads

  function number_of_threads() result(n)
    integer :: n

    n = 1
!$  n = omp_get_max_threads()
  end function number_of_threads

end module threads
