!> The requested size of elements of a body at a point: that of squares, and in thin parts a length that is larger.
!>
!> Squares (`square_sizes`) have a largest size for want of anything better where neither the error nor the geometry asks for less.
!> In a part of few such elements across, as a strip, a wall or a flash, this keeps a number of them across; along it, elements
!> may be longer, so many times as wide at most, as far as the error, bends and contacts let them: sizes of squares for
!> a largest size that is so many times larger.
module body_sizes
  use directed_sizes, only: no_stretch
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use square_sizes, only: size_at, square_field_t
  use thin_parts, only: direction_along, set_up_thin, thin_field_t, thin_point_t
  implicit none
  private
  public :: body_sizes_t, lengthen, directed_size_of

  type, extends(square_field_t) :: body_sizes_t
    !> Elements may be longer than wide: lengths, and where and along which directions.
    logical :: is_directed = .false.
    type(square_field_t) :: lengths
    type(thin_field_t) :: thin
  end type body_sizes_t

contains

  !> Let elements be longer than wide in thin parts.
  pure subroutine lengthen(lengths, thin, field)
    type(square_field_t), intent(in) :: lengths   !! sizes of squares with a larger limit
    type(thin_point_t), intent(in) :: thin(:)     !! (nthin)
    class(body_sizes_t), intent(inout) :: field

    field%is_directed = size(thin) > 0
    if (.not. field%is_directed) return
    field%lengths = lengths
    call set_up_thin(thin, field%limits%largest, field%thin)
  end subroutine lengthen

  !> Width and stretch (`directed_sizes`) requested at a point of a material.
  pure subroutine directed_size_of(field, material, x, across, stretch)
    class(body_sizes_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)          !! [length]
    real(wp), intent(out) :: across       !! [length]
    real(wp), intent(out) :: stretch(2)   !! [-]
    real(wp) :: direction(2), reach, along

    across = size_at(field, material, x)
    stretch = no_stretch
    if (.not. field%is_directed) return
    call direction_along(field%thin, x, direction, reach)
    if (.not. any(abs(direction) > 0)) return
    along = size_at(field%lengths, material, x)
    ! where the width has limits of its own, so many times that as elsewhere
    along = min(along, across*field%lengths%limits%largest/field%limits%largest)
    ! from squares at the ends of the part it grows as sizes do
    if (along > across) along = min(along, across + slope_of(field%limits%gradation)*reach)
    stretch = 0.5_wp*log(max(along/across, 1.0_wp))*direction
  end subroutine directed_size_of

end module body_sizes
