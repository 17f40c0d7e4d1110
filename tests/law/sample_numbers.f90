!> The same "random" numbers on every machine: the minimal standard generator.
!> Source: S.K. Park, K.W. Miller, Commun. ACM 31 (1988) 1192-1201.
module sample_numbers
  use kinds, only: i8, wp
  implicit none
  private
  public :: sample_t

  type :: sample_t
    integer(i8) :: seed = 20080229_i8
  contains
    procedure :: draw
    procedure :: fill
  end type sample_t

contains

  !> One number, evenly spread between two bounds.
  subroutine draw(self, lower, upper, number)
    class(sample_t), intent(inout) :: self
    real(wp), intent(in) :: lower, upper
    real(wp), intent(out) :: number

    self%seed = mod(16807_i8*self%seed, 2147483647_i8)
    number = lower + (upper - lower)*real(self%seed, wp)/2147483647.0_wp
  end subroutine draw

  !> Many of them.
  subroutine fill(self, lower, upper, numbers)
    class(sample_t), intent(inout) :: self
    real(wp), intent(in) :: lower, upper
    real(wp), intent(out) :: numbers(:)
    integer :: i

    do i = 1, size(numbers)
      call self%draw(lower, upper, numbers(i))
    end do
  end subroutine fill

end module sample_numbers
