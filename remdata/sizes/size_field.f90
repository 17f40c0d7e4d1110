!> The requested size of elements at a point: that of squares, and in thin parts a length that is larger.
!>
!> Squares (`square_sizes`) have a largest size for want of anything better where neither the error nor the geometry asks for less.
!> In a part of few such elements across, as a strip, a wall or a flash, this keeps a number of them across; along it, elements
!> may be longer, so many times as wide at most, as far as the error, bends and contacts let them: sizes of squares for
!> a largest size that
!> is so many times larger.
module size_field
  use block_mesh, only: polygon_area
  use directed_sizes, only: no_stretch, ratio_of
  use graded_sizes, only: slope_of
  use kinds, only: wp
  use square_sizes, only: is_in_window, need_t, old_mesh_t, requested_size, set_up_squares, size_at, size_limits_t, square_field_t
  use size_windows, only: size_window_t
  use thin_parts, only: direction_along, set_up_thin, thin_field_t, thin_point_t
  implicit none
  private
  public :: size_limits_t, need_t, size_field_t, old_mesh_t, requested_size
  public :: set_up_sizes, lengthen, of_squares, size_at, directed_size_at, is_in_window, elements_needed

  type, extends(square_field_t) :: size_field_t
    !> Elements may be longer than wide: lengths, and where and along which directions.
    logical :: is_directed = .false.
    type(square_field_t) :: lengths
    type(thin_field_t) :: thin
  end type size_field_t

contains

  !> The size field of an old mesh and of size requirements; for a first mesh there is no old one.
  pure subroutine set_up_sizes(limits, needs, field, old, windows)
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(in) :: needs(:)   !! (nneed)
    type(size_field_t), intent(out) :: field
    type(old_mesh_t), intent(in), optional :: old
    type(size_window_t), intent(in), optional :: windows(:)   !! (nwindow)

    call set_up_squares(limits, needs, field%square_field_t, old, windows)
  end subroutine set_up_sizes

  !> Let elements be longer than wide in thin parts.
  pure subroutine lengthen(lengths, thin, field)
    type(square_field_t), intent(in) :: lengths   !! sizes of squares with a larger limit
    type(thin_point_t), intent(in) :: thin(:)     !! (nthin)
    type(size_field_t), intent(inout) :: field

    field%is_directed = size(thin) > 0
    if (.not. field%is_directed) return
    field%lengths = lengths
    call set_up_thin(thin, field%limits%largest, field%thin)
  end subroutine lengthen

  !> The same sizes for squares.
  pure function of_squares(field) result(squares)
    type(size_field_t), intent(in) :: field
    type(size_field_t) :: squares

    squares%square_field_t = field%square_field_t
  end function of_squares

  !> Width and stretch (`directed_sizes`) requested at a point of a material.
  pure subroutine directed_size_at(field, material, x, across, stretch)
    type(size_field_t), intent(in) :: field
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
  end subroutine directed_size_at

  !> Elements that the sizes need, by the elements of the old mesh: the integral of 1/(width length). 0 where there is no old mesh.
  pure function elements_needed(field) result(number)
    type(size_field_t), intent(in) :: field
    real(wp) :: number
    real(wp) :: x(2, 4), across, stretch(2)
    integer :: e

    number = 0
    if (.not. field%has_mesh) return
    do e = 1, size(field%mesh%material)
      x = field%mesh%nodes(:, field%mesh%connectivity(1:4, e))
      call directed_size_at(field, field%mesh%material(e), 0.25_wp*sum(x, 2), across, stretch)
      number = number + max(polygon_area(x), 0.0_wp)/(across**2*ratio_of(stretch))
    end do
  end function elements_needed

end module size_field
