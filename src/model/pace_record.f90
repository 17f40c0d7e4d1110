!> What short steps take, and whether longer ones are tried (module `step_pace`).
module pace_record
  use kinds, only: wp
  implicit none
  private
  public :: pace_t

  type :: pace_t
    !> Steps aim at so many iterations beyond NOPTI.
    integer :: beyond_nopti = 0
    !> Short steps one after the other, their iterations, in a trial those of failed attempts too, and the time they made [time].
    integer :: steps = 0
    real(wp) :: iterations = 0.0_wp, time = 0.0_wp
    !> In a trial: iterations over time that steps took before it, else 0 [1/time].
    real(wp) :: cost = 0.0_wp
    !> A trial has not paid.
    logical :: settled = .false.
  end type pace_t

end module pace_record
