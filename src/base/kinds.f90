!> The real kind of the system, the shorter one of factors that solves refine, and the few numbers that follow from them.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real32, real64
  implicit none
  private
  public :: wp, sp, i8, pi, eps

  !> Working precision of every real in the system.
  integer, parameter :: wp = real64
  !> Single precision, of factors only.
  integer, parameter :: sp = real32
  !> Long integer, for counters of bytes and calls.
  integer, parameter :: i8 = int64
  real(wp), parameter :: pi = 3.14159265358979323846_wp
  !> Relative round-off of one operation.
  real(wp), parameter :: eps = epsilon(1.0_wp)
end module kinds
