!> What can be said of the kinetics of steels before a run: compositions beyond those that Li's formulas were compared with.
module kinetics_check
  use li_range, only: beyond_li
  use scene, only: scene_t
  use steels, only: kinetics_li, steel_t
  use text, only: add_new_text, string_t
  implicit none
  private
  public :: judge_kinetics, words_of_li

contains

  !> Warnings, one line each: of two laws of one steel once.
  subroutine judge_kinetics(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)
    integer :: m

    do m = 1, size(scene%materials)
      if (allocated(scene%materials(m)%steel)) call add_new_text(warnings, words_of_li(scene%materials(m)%steel))
    end do
  end subroutine judge_kinetics

  !> A composition beyond that range; empty where it is none, or all phases have kinetics of their own.
  pure function words_of_li(steel) result(words)
    type(steel_t), intent(in) :: steel
    character(len=:), allocatable :: words
    character(len=:), allocatable :: beyond

    words = ''
    if (.not. any(steel%kinetics%kind == kinetics_li)) return
    beyond = beyond_li(steel%composition)
    if (beyond == '') return
    words = 'the steel '//steel%name//':'//beyond//' is beyond the mass per cent of the steels that Li''s kinetics (LI) were ' &
            //'compared with: it may harden far too deeply, the more so the more carbon it has; TTT or AVRAMI of its phases take ' &
            //'their place'
  end function words_of_li

end module kinetics_check
