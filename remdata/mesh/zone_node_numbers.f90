!> Numbering of the nodes of a mesh of zones.
!>
!> Ends of elements come first: zone points, then side by side, then zone by zone and row by row; middle nodes follow in the same
!> order. Nodes on a side are numbered by the side alone, so that two zones share them.
module zone_node_numbers
  use zone_divisions, only: division_t, is_forward
  use zones, only: zone_layout_t
  implicit none
  private
  public :: node_numbers_t, number_nodes, ends_of_side, middles_of_side, divisions_of, ends_of_zone, middles_of_zone, row_beside

  type :: node_numbers_t
    !> Node of each zone point, 0 where no zone has it.
    integer, allocatable :: point(:)
    !> Number before the first: ends inside sides and zones, middles of sides and inside zones.
    integer, allocatable :: side_ends(:), zone_ends(:), side_middles(:), zone_middles(:)
    !> Ends of elements are nodes 1 ... nend.
    integer :: nend = 0, nnode = 0
  end type node_numbers_t

contains

  pure function number_nodes(layout, division) result(numbers)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t) :: numbers
    integer :: n, p, s, z, m(2)

    allocate (numbers%point(size(layout%points)))
    allocate (numbers%side_ends(size(layout%sides)), numbers%side_middles(size(layout%sides)))
    allocate (numbers%zone_ends(size(layout%zones)), numbers%zone_middles(size(layout%zones)))
    numbers%point = 0
    do z = 1, size(layout%zones)
      numbers%point(layout%zones(z)%corners) = 1
    end do
    n = 0
    do p = 1, size(layout%points)
      n = n + numbers%point(p)
      if (numbers%point(p) > 0) numbers%point(p) = n
    end do
    do s = 1, size(layout%sides)
      numbers%side_ends(s) = n
      n = n + division%count(s) - 1
    end do
    do z = 1, size(layout%zones)
      m = divisions_of(layout, division, z)
      numbers%zone_ends(z) = n
      n = n + (m(1) - 1)*(m(2) - 1)
    end do
    numbers%nend = n
    do s = 1, size(layout%sides)
      numbers%side_middles(s) = n
      n = n + division%count(s)
    end do
    do z = 1, size(layout%zones)
      m = divisions_of(layout, division, z)
      numbers%zone_middles(z) = n
      n = n + m(1)*(m(2) - 1) + (m(1) - 1)*m(2)
    end do
    numbers%nnode = n
  end function number_nodes

  !> Divisions along sides 1 and 3 of a zone, and along sides 2 and 4.
  pure function divisions_of(layout, division, zone) result(n)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    integer, intent(in) :: zone
    integer :: n(2)

    n = division%count(layout%zone_sides(1:2, zone))
  end function divisions_of

  !> Ends of elements along a side (0:n), in its own direction.
  pure function ends_of_side(layout, division, numbers, side) result(nodes)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, intent(in) :: side
    integer :: nodes(0:division%count(side))
    integer :: k

    nodes = [(numbers%side_ends(side) + k, k=0, division%count(side))]
    nodes([0, division%count(side)]) = numbers%point(layout%sides(side)%points)
  end function ends_of_side

  pure function middles_of_side(division, numbers, side) result(nodes)
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, intent(in) :: side
    integer :: nodes(division%count(side))
    integer :: k

    nodes = [(numbers%side_middles(side) + k, k=1, division%count(side))]
  end function middles_of_side

  !> Ends of elements of a zone (0:n, 0:m): from corner 1 toward corner 2, and toward corner 4.
  pure subroutine ends_of_zone(layout, division, numbers, zone, grid)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, intent(in) :: zone
    integer, allocatable, intent(out) :: grid(:, :)   !! (0:n, 0:m)
    integer :: n, m, i, j, k, side
    integer, allocatable :: nodes(:)

    n = division%count(layout%zone_sides(1, zone))
    m = division%count(layout%zone_sides(2, zone))
    allocate (grid(0:n, 0:m))
    do j = 1, m - 1
      do i = 1, n - 1
        grid(i, j) = numbers%zone_ends(zone) + (j - 1)*(n - 1) + i
      end do
    end do
    do k = 1, 4
      side = layout%zone_sides(k, zone)
      nodes = ends_of_side(layout, division, numbers, side)
      if (.not. is_forward(layout, zone, k)) nodes = nodes(size(nodes):1:-1)
      select case (k)
      case (1)
        grid(:, 0) = nodes
      case (2)
        grid(n, :) = nodes
      case (3)
        grid(n:0:-1, m) = nodes
      case (4)
        grid(0, m:0:-1) = nodes
      end select
    end do
  end subroutine ends_of_zone

  !> Middle nodes of a zone: between (i - 1, j) and (i, j), and between (i, j - 1) and (i, j).
  pure subroutine middles_of_zone(layout, division, numbers, zone, along, across)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, intent(in) :: zone
    integer, allocatable, intent(out) :: along(:, :)    !! (1:n, 0:m)
    integer, allocatable, intent(out) :: across(:, :)   !! (0:n, 1:m)
    integer :: n, m, i, j, k, side
    integer, allocatable :: nodes(:)

    n = division%count(layout%zone_sides(1, zone))
    m = division%count(layout%zone_sides(2, zone))
    allocate (along(1:n, 0:m), across(0:n, 1:m))
    do j = 1, m - 1
      do i = 1, n
        along(i, j) = numbers%zone_middles(zone) + (j - 1)*n + i
      end do
    end do
    do j = 1, m
      do i = 1, n - 1
        across(i, j) = numbers%zone_middles(zone) + n*(m - 1) + (j - 1)*(n - 1) + i
      end do
    end do
    do k = 1, 4
      side = layout%zone_sides(k, zone)
      nodes = middles_of_side(division, numbers, side)
      if (.not. is_forward(layout, zone, k)) nodes = nodes(size(nodes):1:-1)
      select case (k)
      case (1)
        along(:, 0) = nodes
      case (2)
        across(n, :) = nodes
      case (3)
        along(n:1:-1, m) = nodes
      case (4)
        across(0, m:1:-1) = nodes
      end select
    end do
  end subroutine middles_of_zone

  !> The ends of elements of a zone that lie one row in from its side k, in the direction of the zone.
  pure function row_beside(grid, k) result(row)
    integer, intent(in) :: grid(0:, 0:)   !! (0:n, 0:m)
    integer, intent(in) :: k
    integer, allocatable :: row(:)
    integer :: n, m

    n = ubound(grid, 1)
    m = ubound(grid, 2)
    select case (k)
    case (1)
      row = grid(:, 1)
    case (2)
      row = grid(n - 1, :)
    case (3)
      row = grid(n:0:-1, m - 1)
    case default
      row = grid(1, m:0:-1)
    end select
  end function row_beside

end module zone_node_numbers
