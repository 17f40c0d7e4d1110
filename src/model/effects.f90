!> The effects a scene may call for: on because a card needs them, off otherwise.
module effects
  implicit none
  private
  public :: effect_t, find_effect

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

contains

  !> Position of an effect in a list, 0 when it is not listed.
  pure function find_effect(effects, name) result(k)
    type(effect_t), intent(in) :: effects(:)   !! (neffect)
    character(len=*), intent(in) :: name
    integer :: k

    do k = 1, size(effects)
      if (effects(k)%name == name) return
    end do
    k = 0
  end function find_effect

end module effects
