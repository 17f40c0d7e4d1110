!> Whether two operations have a die of the same shape, at the same place.
module same_dies
  use dies, only: die_t, is_deformable
  use kinds, only: eps, wp
  implicit none
  private
  public :: same_place, same_die

  !> What many small motions leave of their sum, over the size of what moves.
  real(wp), parameter :: round_off = 1.0e4_wp*eps

contains

  !> Does a die stand at one place, but for round-off of its motion?
  pure function same_place(die, one, other) result(same)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: one(3), other(3)   !! x, y, angle [length], [length], [rad]
    logical :: same
    real(wp) :: size_of_die

    size_of_die = max(maxval(abs(die%pieces)), maxval(abs(one(1:2))))
    same = all(abs(one - other) <= round_off*[size_of_die, size_of_die, 1.0_wp])
  end function same_place

  !> Two dies of one name and one shape.
  pure function same_die(a, b) result(same)
    type(die_t), intent(in) :: a, b
    logical :: same

    same = a%name == b%name .and. (is_deformable(a) .eqv. is_deformable(b))
    if (.not. same) return
    if (is_deformable(a)) then
      same = all(shape(a%nodes) == shape(b%nodes))
      if (same) same = all(a%nodes == b%nodes)
    else
      same = all(shape(a%pieces) == shape(b%pieces))
      if (same) same = .not. any(abs(a%pieces - b%pieces) > 0)
    end if
  end function same_die

end module same_dies
