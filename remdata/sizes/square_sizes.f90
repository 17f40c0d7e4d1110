!> The requested size of elements that are as long as wide, at a point.
!>
!> On the old mesh: from the error of each of its elements, h (limit/error)^(1/p), as values at its corners; around points
!> with a size requirement (a bend of the contour, contact): the required size, growing with the distance. Limited by the smallest
!> and largest size, those of its window for a point in one, and from one element to the next by the gradation. Where a die bends
!> the smallest size is another.
module square_sizes
  use box_tree, only: box_tree_t, build_tree, nearest_items
  use graded_sizes, only: grade, slope_of
  use kinds, only: wp
  use locate_point, only: element_location_t, locate
  use shape_functions, only: quad4
  use size_windows, only: is_in_any, limits_around, limits_within, size_by_windows, size_limits_t, size_window_t
  use transfer_mesh, only: build_element_trees, set_up_mesh, transfer_mesh_t
  implicit none
  private
  public :: size_limits_t, need_t, square_field_t, old_mesh_t, requested_size, set_up_squares, size_at, is_in_window

  !> A point where the geometry requires a size.
  type :: need_t
    real(wp) :: x(2) = 0.0_wp   !! [length]
    real(wp) :: size = 0.0_wp   !! [length]
    !> The size holds within this radius; it grows from there on [length].
    real(wp) :: radius = 0.0_wp
  end type need_t

  !> The previous mesh, and the size requested in place of each of its elements.
  type :: old_mesh_t
    real(wp), allocatable :: nodes(:, :)         !! (2, nnode) where they are now [length]
    integer, allocatable :: connectivity(:, :)   !! (8, nelem)
    integer, allocatable :: material(:)          !! (nelem) from 1
    real(wp), allocatable :: requested(:)        !! (nelem) [length]
    real(wp), allocatable :: origin(:, :)        !! (2, nnode) where their matter was at the start; for windows alone [length]
  end type old_mesh_t

  type :: square_field_t
    type(size_limits_t) :: limits
    logical :: has_mesh = .false.
    type(transfer_mesh_t) :: mesh
    real(wp), allocatable :: sizes(:)       !! (nnode) at corners of the old mesh [length]
    real(wp), allocatable :: origin(:, :)   !! (2, nnode) of the old mesh [length]
    type(size_window_t), allocatable :: windows(:)
    type(need_t), allocatable :: needs(:)
    type(box_tree_t) :: need_tree
  end type square_field_t

  !> Number of nearest requirements evaluated: both neighbours on a contour and on the one it lies on, and one more.
  integer, parameter :: asked = 6

contains

  !> Size at which the error equals its limit when it varies with size to the power `order`; unlimited where there is no error.
  pure elemental function requested_size(size_now, error, limit, order) result(requested)
    real(wp), intent(in) :: size_now   !! [length]
    real(wp), intent(in) :: error, limit, order
    real(wp) :: requested

    requested = huge(1.0_wp)
    if (error > 0) requested = size_now*exp(min(log(limit/error)/order, 0.25_wp*log(huge(1.0_wp))))
  end function requested_size

  !> The size field of an old mesh and of size requirements; for a first mesh there is no old one.
  pure subroutine set_up_squares(limits, needs, field, old, windows)
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(in) :: needs(:)   !! (nneed)
    type(square_field_t), intent(out) :: field
    type(old_mesh_t), intent(in), optional :: old
    type(size_window_t), intent(in), optional :: windows(:)   !! (nwindow)
    real(wp), allocatable :: boxes(:, :), sizes(:)
    integer :: i

    field%limits = limits
    if (.not. any(needs%size < limits%smallest)) field%limits%at_corners = limits%smallest
    allocate (field%windows(0))
    if (present(windows)) field%windows = windows
    allocate (field%needs, source=needs)
    allocate (boxes(4, size(needs)))
    do i = 1, size(needs)
      boxes(:, i) = needs(i)%x([1, 2, 1, 2])
    end do
    call build_tree(boxes, [(i, i=1, size(needs))], field%need_tree)
    if (.not. present(old)) return
    field%has_mesh = .true.
    call set_up_mesh(old%nodes, old%connectivity, old%material, spread(1, 1, size(old%material)), .false., field%mesh)
    call build_element_trees(field%mesh)
    field%origin = old%nodes
    if (allocated(old%origin)) field%origin = old%origin
    call sizes_of_corners(field, old, sizes)
    do i = 1, size(sizes)
      sizes(i) = min(sizes(i), size_by_needs(field, old%nodes(:, i)))
    end do
    call grade(old%nodes, old%connectivity, slope_of(limits%gradation), sizes)
    call move_alloc(sizes, field%sizes)
  end subroutine set_up_squares

  !> Geometric mean of the sizes requested around a corner.
  pure subroutine sizes_of_corners(field, old, sizes)
    type(square_field_t), intent(in) :: field   !! its limits, windows and origin
    type(old_mesh_t), intent(in) :: old
    real(wp), allocatable, intent(out) :: sizes(:)
    integer, allocatable :: valence(:)
    type(size_limits_t) :: limits
    integer :: e, k

    allocate (sizes(size(old%nodes, 2)), valence(size(old%nodes, 2)))
    sizes = 0
    valence = 0
    do e = 1, size(old%requested)
      associate (corners => old%connectivity(1:4, e))
        do k = 1, 4
          limits = limits_at(field, old%nodes(:, corners(k)), field%origin(:, corners(k)))
          sizes(corners(k)) = sizes(corners(k)) + log(within(limits, old%requested(e)))
        end do
        valence(corners) = valence(corners) + 1
      end associate
    end do
    sizes = merge(exp(sizes/max(valence, 1)), field%limits%largest, valence > 0)
  end subroutine sizes_of_corners

  !> Size requested at a point of a material: of a square, or the width [length].
  pure function size_at(field, material, x) result(h)
    class(square_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)   !! [length]
    real(wp) :: h
    real(wp) :: origin(2), on_mesh
    type(size_limits_t) :: limits

    h = size_by_needs(field, x)
    call look_up(field, material, x, origin, on_mesh)
    h = min(h, on_mesh)
    h = min(h, size_by_windows(field%limits, field%windows, x, origin))
    limits = limits_at(field, x, origin)
    ! what is smaller than the smallest size here comes from a need at a bend or a corner, on the mesh as by itself
    limits%smallest = min(limits%smallest, limits%at_bends, limits%at_corners)
    h = within(limits, h)
  end function size_at

  !> A point of a material is in a window.
  pure function is_in_window(field, material, x) result(yes)
    class(square_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)   !! (2) [length]
    logical :: yes
    real(wp) :: origin(2), on_mesh

    yes = size(field%windows) > 0
    if (.not. yes) return
    call look_up(field, material, x, origin, on_mesh)
    yes = is_in_any(field%windows, x, origin)
  end function is_in_window

  !> Where the matter at a point was at the start, and the size at it by the corners of the old mesh: the point itself and no limit
  !> where there is none.
  pure subroutine look_up(field, material, x, origin, h)
    type(square_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)               !! (2) [length]
    real(wp), intent(out) :: origin(2), h      !! (2) [length]
    type(element_location_t) :: location
    real(wp) :: phi(4)

    origin = x
    h = huge(h)
    if (.not. field%has_mesh) return
    call locate(field%mesh, material, x, 0.0_wp, location)
    if (location%element == 0) return
    call quad4(location%xi(1), location%xi(2), phi)
    associate (corners => field%mesh%connectivity(1:4, location%element))
      h = dot_product(phi, field%sizes(corners))
      if (size(field%windows) > 0) origin = matmul(field%origin(:, corners), phi)
    end associate
  end subroutine look_up

  !> Smallest size allowed by the nearest requirements.
  pure function size_by_needs(field, x) result(h)
    type(square_field_t), intent(in) :: field
    real(wp), intent(in) :: x(2)
    real(wp) :: h
    real(wp) :: squares(asked)
    integer :: items(asked), found, i
    type(size_limits_t) :: wide

    wide = limits_around(field%limits, field%windows)
    h = wide%largest
    if (field%need_tree%n == 0) return
    call nearest_items(field%need_tree, x, found, items, squares)
    do i = 1, found
      associate (need => field%needs(items(i)))
        h = min(h, need%size + slope_of(field%limits%gradation)*max(0.0_wp, sqrt(squares(i)) - need%radius))
      end associate
    end do
  end function size_by_needs

  !> Limits of the size at a point.
  pure function limits_at(field, x, origin) result(limits)
    type(square_field_t), intent(in) :: field
    real(wp), intent(in) :: x(2), origin(2)   !! (2) the point, and where its matter was at the start [length]
    type(size_limits_t) :: limits

    limits = field%limits
    if (size(field%windows) > 0) limits = limits_within(limits, field%windows, x, origin)
  end function limits_at

  pure function within(limits, h) result(kept)
    type(size_limits_t), intent(in) :: limits
    real(wp), intent(in) :: h
    real(wp) :: kept

    kept = min(max(h, limits%smallest), limits%largest)
  end function within

end module square_sizes
