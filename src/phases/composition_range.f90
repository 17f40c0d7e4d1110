!> Compositions that formulas were found for: what of a composition is beyond them.
module composition_range
  use kinds, only: wp
  use steels, only: composition_t, element_names
  use text, only: to_text
  implicit none
  private
  public :: beyond

contains

  !> Elements of a composition that are beyond a range, ' C 1 (0.1 to 0.5)'; empty where none is.
  pure function beyond(composition, elements, least, most, slack) result(words)
    type(composition_t), intent(in) :: composition
    integer, intent(in) :: elements(:)           !! (n) places among the elements
    real(wp), intent(in) :: least(:), most(:)    !! (n) [mass per cent]
    real(wp), intent(in) :: slack                !! share of the range's ends by which they may be passed
    character(len=:), allocatable :: words
    character(len=:), allocatable :: from
    integer :: k

    words = ''
    do k = 1, size(elements)
      associate (w => composition%w(elements(k)))
        if (w <= (1 + slack)*most(k) .and. w >= (1 - slack)*least(k)) cycle
        from = ''
        if (least(k) > 0) from = to_text(least(k))//' '
        words = words//' '//trim(element_names(elements(k)))//' '//to_text(w)//' ('//from//'to '//to_text(most(k))//')'
      end associate
    end do
  end function beyond

end module composition_range
