!> A residual that is taken back in parts: a part that has equilibrium doubles the next one, one that has none halves it.
!> A continuation in the load (E.L. Allgower, K. Georg, Numerical Continuation Methods, Springer 1990, ch. 2), at the end of
!> which nothing is left.
module residual_parts
  use kinds, only: wp
  implicit none
  private
  public :: residual_parts_t, first_parts, next_part

  type :: residual_parts_t
    !> Shares of the residual: not yet taken back, the part that is tried, the smallest one to try.
    real(wp) :: left = 1.0_wp, part = 1.0_wp, smallest = 1.0_wp
    !> Parts that have been taken back.
    integer :: number = 0
    !> Parts are left to be tried.
    logical :: goes_on = .true.
  end type residual_parts_t

contains

  !> All of the residual is left.
  pure function first_parts(part, smallest) result(parts)
    real(wp), intent(in) :: part       !! the first share to try
    real(wp), intent(in) :: smallest   !! the smallest share to try
    type(residual_parts_t) :: parts

    parts%part = part
    parts%smallest = smallest
  end function first_parts

  !> After the part has been tried.
  elemental subroutine next_part(parts, converged)
    type(residual_parts_t), intent(inout) :: parts
    logical, intent(in) :: converged   !! the part has equilibrium

    if (converged) then
      parts%number = parts%number + 1
      parts%left = parts%left - parts%part
      parts%part = min(2*parts%part, parts%left)
      parts%goes_on = parts%left > 0
    else
      parts%part = 0.5_wp*parts%part
      parts%goes_on = .not. parts%part < parts%smallest
    end if
  end subroutine next_part

end module residual_parts
