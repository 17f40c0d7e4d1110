!> Smoothing of the ends of elements of all zones.
!>
!> First each zone by itself, from a coarse grid to its own; then all together: the sides between zones move too, so that grid lines
!> are smooth across them, and corners of zones inside move to the mean of the adjacent ends of elements, weighted by the density.
!> Contours and sides between materials are fixed.
module zone_lines
  use grid_lines, only: interpolate_inside, relaxed, smooth_inside
  use kinds, only: wp
  use size_field, only: size_at, size_field_t
  use zone_divisions, only: division_t
  use zone_node_numbers, only: ends_of_side, ends_of_zone, node_numbers_t, row_beside
  use zones, only: zone_layout_t
  implicit none
  private
  public :: interpolate_zones, smooth_zones, find_movable

contains

  !> Ends of elements inside zones, from those on the sides.
  pure subroutine interpolate_zones(layout, division, numbers, x)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    real(wp), intent(inout) :: x(:, :)   !! (2, nnode) [length]
    integer, allocatable :: grid(:, :)
    real(wp), allocatable :: inside(:, :, :)
    integer :: z

    do z = 1, size(layout%zones)
      call ends_of_zone(layout, division, numbers, z, grid)
      call gather(grid, x, inside)
      call interpolate_inside(inside)
      call scatter(grid, inside, x)
    end do
  end subroutine interpolate_zones

  pure subroutine smooth_zones(layout, division, numbers, field, passes, x)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: passes
    real(wp), intent(inout) :: x(:, :)   !! (2, nnode) [length]
    integer, allocatable :: grid(:, :), around(:, :), next(:, :)
    real(wp), allocatable :: inside(:, :, :), density(:, :), log_density(:), control(:, :)
    logical, allocatable :: known(:)
    integer :: z, i, j, pass, k, n

    allocate (around(9, numbers%nend), known(numbers%nend), log_density(numbers%nend), control(2, numbers%nend))
    known = .false.
    n = 0
    do z = 1, size(layout%zones)
      call ends_of_zone(layout, division, numbers, z, grid)
      allocate (density(0:ubound(grid, 1), 0:ubound(grid, 2)))
      do j = 0, ubound(grid, 2)
        do i = 0, ubound(grid, 1)
          k = grid(i, j)
          if (.not. known(k)) log_density(k) = -log(size_at(field, layout%zones(z)%material, x(:, k)))
          known(k) = .true.
          density(i, j) = log_density(k)
        end do
      end do
      call gather(grid, x, inside)
      call smooth_inside(density, passes, inside)
      call scatter(grid, inside, x)
      call list_inside(grid, around, n)
      deallocate (density)
    end do
    call list_between(layout, division, numbers, around, n)
    if (size(layout%zones) == 1) return
    call list_next(layout, division, numbers, next)
    do k = 1, n
      control(:, k) = 0.5_wp*(log_density(around([6, 8], k)) - log_density(around([4, 2], k)))
    end do
    do pass = 1, passes
      do k = 1, n
        x(:, around(5, k)) = relaxed(x(:, around(:, k)), control(1, k), control(2, k))
      end do
      call relax_points(next, log_density, x)
    end do
  end subroutine smooth_zones

  !> Ends of elements that may move: inside zones and sides, and zone points, as far as these move.
  pure subroutine find_movable(layout, division, numbers, may_move)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    logical, allocatable, intent(out) :: may_move(:)   !! (nend)
    integer :: p, s

    allocate (may_move(numbers%nend))
    may_move = .true.
    do s = 1, size(layout%sides)
      may_move(numbers%side_ends(s) + 1:numbers%side_ends(s) + division%count(s) - 1) = layout%sides(s)%moves
    end do
    do p = 1, size(layout%points)
      if (numbers%point(p) > 0) may_move(numbers%point(p)) = layout%point_moves(p)
    end do
  end subroutine find_movable

  !> The points inside a zone with the eight around each, row by row.
  pure subroutine list_inside(grid, around, n)
    integer, intent(in) :: grid(0:, 0:)
    integer, intent(inout) :: around(:, :), n
    integer :: i, j

    do j = 1, ubound(grid, 2) - 1
      do i = 1, ubound(grid, 1) - 1
        n = n + 1
        around(:, n) = reshape(grid(i - 1:i + 1, j - 1:j + 1), [9])
      end do
    end do
  end subroutine list_inside

  !> The points inside sides that may move: the row to the right of the side, the side, the row to its left.
  pure subroutine list_between(layout, division, numbers, around, n)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, intent(inout) :: around(:, :), n
    integer, allocatable :: grid(:, :), rows(:, :)
    integer :: s, k, m

    do s = 1, size(layout%sides)
      associate (side => layout%sides(s))
        if (.not. side%moves) cycle
        m = division%count(s)
        allocate (rows(0:m, 3))
        rows(:, 2) = ends_of_side(layout, division, numbers, s)
        call ends_of_zone(layout, division, numbers, side%zones(1), grid)
        rows(:, 3) = row_beside(grid, side%local(1))
        call ends_of_zone(layout, division, numbers, side%zones(2), grid)
        rows(m:0:-1, 1) = row_beside(grid, side%local(2))
        do k = 1, m - 1
          n = n + 1
          around(:, n) = reshape(rows(k - 1:k + 1, :), [9])
        end do
        deallocate (rows)
      end associate
    end do
  end subroutine list_between

  !> Pairs of a zone point that moves and the end of element next to it on each of its sides (2, n), point by point.
  pure subroutine list_next(layout, division, numbers, next)
    type(zone_layout_t), intent(in) :: layout
    type(division_t), intent(in) :: division
    type(node_numbers_t), intent(in) :: numbers
    integer, allocatable, intent(out) :: next(:, :)
    integer :: list(2, 2*size(layout%sides)), s, i, k, n
    integer, allocatable :: nodes(:)

    n = 0
    do s = 1, size(layout%sides)
      nodes = ends_of_side(layout, division, numbers, s)
      do i = 1, 2
        if (.not. layout%point_moves(layout%sides(s)%points(i))) cycle
        if (i == 2) nodes = nodes(size(nodes):1:-1)
        k = n
        do while (k > 0)
          if (list(1, k) <= nodes(1)) exit
          list(:, k + 1) = list(:, k)
          k = k - 1
        end do
        list(:, k + 1) = nodes(1:2)
        n = n + 1
      end do
    end do
    allocate (next(2, n), source=list(:, :n))
  end subroutine list_next

  !> Springs to the neighbours, as stiff as the density halfway: the sum of w (x' - x) is zero.
  pure subroutine relax_points(next, log_density, x)
    integer, intent(in) :: next(:, :)
    real(wp), intent(in) :: log_density(:)
    real(wp), intent(inout) :: x(:, :)
    real(wp) :: stiffness, total, weighted(2)
    integer :: k

    total = 0
    weighted = 0
    do k = 1, size(next, 2)
      stiffness = exp(0.5_wp*(log_density(next(2, k)) + log_density(next(1, k))))
      total = total + stiffness
      weighted = weighted + stiffness*x(:, next(2, k))
      if (k < size(next, 2)) then
        if (next(1, k + 1) == next(1, k)) cycle
      end if
      x(:, next(1, k)) = weighted/total
      total = 0
      weighted = 0
    end do
  end subroutine relax_points

  pure subroutine gather(grid, x, inside)
    integer, intent(in) :: grid(0:, 0:)
    real(wp), intent(in) :: x(:, :)
    real(wp), allocatable, intent(out) :: inside(:, :, :)
    integer :: j

    allocate (inside(2, 0:ubound(grid, 1), 0:ubound(grid, 2)))
    do j = 0, ubound(grid, 2)
      inside(:, :, j) = x(:, grid(:, j))
    end do
  end subroutine gather

  pure subroutine scatter(grid, inside, x)
    integer, intent(in) :: grid(0:, 0:)
    real(wp), intent(in) :: inside(:, 0:, 0:)
    real(wp), intent(inout) :: x(:, :)
    integer :: j

    do j = 1, ubound(grid, 2) - 1
      x(:, grid(1:ubound(grid, 1) - 1, j)) = inside(:, 1:ubound(grid, 1) - 1, j)
    end do
  end subroutine scatter

end module zone_lines
