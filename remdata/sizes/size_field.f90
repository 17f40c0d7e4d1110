!> The requested size of elements at a point of a body.
!>
!> All bodies have it from one field with one set of limits, or each of them has its own (`of_body`): a pad that a fine sheet lies
!> on is made for its own shape, and fine only near the sheet.
module size_field
  use block_mesh, only: polygon_area
  use body_sizes, only: body_sizes_t, directed_size_of, lengthen
  use directed_sizes, only: no_stretch, ratio_of
  use kinds, only: wp
  use size_windows, only: size_window_t
  use square_sizes, only: is_in_window, need_t, old_mesh_t, requested_size, set_up_squares, size_limits_t, square_size => size_at
  implicit none
  private
  public :: size_limits_t, need_t, size_field_t, old_mesh_t, requested_size
  public :: set_up_sizes, lengthen, join_bodies, of_squares, size_at, directed_size_at, is_in_window, elements_needed

  type, extends(body_sizes_t) :: size_field_t
    !> Sizes of each body by the number of its material; not allocated: those of this field hold for all.
    type(body_sizes_t), allocatable :: of_body(:)
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

  !> One field of bodies that have sizes of their own, all on the same old mesh or none.
  pure subroutine join_bodies(bodies, field)
    type(body_sizes_t), intent(in) :: bodies(:)   !! (nbody) by material, at least one
    type(size_field_t), intent(out) :: field
    integer :: b, e

    field%square_field_t = bodies(1)%square_field_t
    field%is_directed = any(bodies%is_directed)
    allocate (field%of_body, source=bodies)
    if (.not. field%has_mesh) return
    ! bodies with sizes of their own share no nodes
    do e = 1, size(field%mesh%material)
      b = field%mesh%material(e)
      associate (corners => field%mesh%connectivity(1:4, e))
        field%sizes(corners) = bodies(b)%sizes(corners)
      end associate
    end do
  end subroutine join_bodies

  !> The same sizes for squares.
  pure function of_squares(field) result(squares)
    type(size_field_t), intent(in) :: field
    type(size_field_t) :: squares
    integer :: b

    squares%square_field_t = field%square_field_t
    if (.not. allocated(field%of_body)) return
    allocate (squares%of_body(size(field%of_body)))
    do b = 1, size(field%of_body)
      squares%of_body(b)%square_field_t = field%of_body(b)%square_field_t
    end do
  end function of_squares

  !> Size requested at a point of a material: of a square, or the width [length].
  pure function size_at(field, material, x) result(h)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)   !! [length]
    real(wp) :: h

    if (allocated(field%of_body)) then
      h = square_size(field%of_body(material), material, x)
    else
      h = square_size(field, material, x)
    end if
  end function size_at

  !> Width and stretch (`directed_sizes`) requested at a point of a material.
  pure subroutine directed_size_at(field, material, x, across, stretch)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)          !! [length]
    real(wp), intent(out) :: across       !! [length]
    real(wp), intent(out) :: stretch(2)   !! [-]

    if (allocated(field%of_body)) then
      call directed_size_of(field%of_body(material), material, x, across, stretch)
    else
      call directed_size_of(field, material, x, across, stretch)
    end if
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
