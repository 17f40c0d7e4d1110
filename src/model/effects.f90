!> The effects a scene may call for: on because a card needs them, off otherwise.
module effects
  implicit none
  private
  public :: effect_t

  type :: effect_t
    character(len=:), allocatable :: name
    logical :: on = .false.
    !> The card that asks for it, or why it is off.
    character(len=:), allocatable :: why
    !> What it adds: unknowns, state per point.
    character(len=:), allocatable :: adds
    !> Effect whose loop does its work; empty when it has one of its own. Its seconds are counted there.
    character(len=:), allocatable :: within
  end type effect_t

end module effects
