!> The requested element size at a point.
!>
!> On the old mesh: from the error of each of its elements, h (limit/error)^(1/p), as values at its corners; around points
!> with a size requirement (a bend of the contour, contact): the required size, growing with the distance. Limited by the smallest
!> and largest size, and from one element to the next by the gradation.
module size_field
  use box_tree, only: box_tree_t, build_tree, nearest_items
  use graded_sizes, only: grade, slope_of
  use kinds, only: wp
  use locate_point, only: element_location_t, locate
  use shape_functions, only: quad4
  use transfer_mesh, only: build_element_trees, set_up_mesh, transfer_mesh_t
  implicit none
  private
  public :: size_limits_t, need_t, size_field_t, old_mesh_t, requested_size, set_up_sizes, size_at

  type :: size_limits_t
    real(wp) :: smallest = 0.0_wp              !! [length]
    real(wp) :: largest = sqrt(huge(1.0_wp))   !! [length]
    !> Largest ratio of an element to its neighbour.
    real(wp) :: gradation = 1.5_wp
  end type size_limits_t

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
  end type old_mesh_t

  type :: size_field_t
    type(size_limits_t) :: limits
    logical :: has_mesh = .false.
    type(transfer_mesh_t) :: mesh
    real(wp), allocatable :: sizes(:)   !! (nnode) at corners of the old mesh [length]
    type(need_t), allocatable :: needs(:)
    type(box_tree_t) :: need_tree
  end type size_field_t

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
  pure subroutine set_up_sizes(limits, needs, field, old)
    type(size_limits_t), intent(in) :: limits
    type(need_t), intent(in) :: needs(:)   !! (nneed)
    type(size_field_t), intent(out) :: field
    type(old_mesh_t), intent(in), optional :: old
    real(wp), allocatable :: boxes(:, :)
    integer :: i

    field%limits = limits
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
    call sizes_of_corners(limits, old, field%sizes)
    do i = 1, size(field%sizes)
      field%sizes(i) = min(field%sizes(i), size_by_needs(field, old%nodes(:, i)))
    end do
    call grade(old%nodes, old%connectivity, slope_of(limits%gradation), field%sizes)
  end subroutine set_up_sizes

  !> Geometric mean of the sizes requested around a corner.
  pure subroutine sizes_of_corners(limits, old, sizes)
    type(size_limits_t), intent(in) :: limits
    type(old_mesh_t), intent(in) :: old
    real(wp), allocatable, intent(out) :: sizes(:)
    integer, allocatable :: valence(:)
    integer :: e

    allocate (sizes(size(old%nodes, 2)), valence(size(old%nodes, 2)))
    sizes = 0
    valence = 0
    do e = 1, size(old%requested)
      associate (corners => old%connectivity(1:4, e))
        sizes(corners) = sizes(corners) + log(within(limits, old%requested(e)))
        valence(corners) = valence(corners) + 1
      end associate
    end do
    sizes = merge(exp(sizes/max(valence, 1)), limits%largest, valence > 0)
  end subroutine sizes_of_corners

  !> Size requested at a point of a material [length].
  pure function size_at(field, material, x) result(h)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: x(2)   !! [length]
    real(wp) :: h
    type(element_location_t) :: location
    real(wp) :: phi(4)

    h = size_by_needs(field, x)
    if (field%has_mesh) then
      call locate(field%mesh, material, x, 0.0_wp, location)
      if (location%element > 0) then
        call quad4(location%xi(1), location%xi(2), phi)
        h = min(h, dot_product(phi, field%sizes(field%mesh%connectivity(1:4, location%element))))
      end if
    end if
    h = within(field%limits, h)
  end function size_at

  !> Smallest size allowed by the nearest requirements.
  pure function size_by_needs(field, x) result(h)
    type(size_field_t), intent(in) :: field
    real(wp), intent(in) :: x(2)
    real(wp) :: h
    real(wp) :: squares(asked)
    integer :: items(asked), found, i

    h = field%limits%largest
    if (field%need_tree%n == 0) return
    call nearest_items(field%need_tree, x, found, items, squares)
    do i = 1, found
      associate (need => field%needs(items(i)))
        h = min(h, need%size + slope_of(field%limits%gradation)*max(0.0_wp, sqrt(squares(i)) - need%radius))
      end associate
    end do
  end function size_by_needs

  pure function within(limits, h) result(kept)
    type(size_limits_t), intent(in) :: limits
    real(wp), intent(in) :: h
    real(wp) :: kept

    kept = min(max(h, limits%smallest), limits%largest)
  end function within

end module size_field
