!> Middle nodes: on the contour for sides along it, at midpoints elsewhere, and curved like the contour close to it.
!>
!> Where the contour is curved and the next grid line is straight, a thin element would be inverted (its Jacobian is positive only
!> while the bulge is less than the thickness), so the adjacent lines take a share of the bulge that decreases with the distance.
module side_middles
  use boundary_curves, only: boundary_curve_t, position_t
  use kinds, only: wp
  use side_curves, only: curve_point, curve_t
  use vectors, only: length_of
  implicit none
  private
  public :: place_middle, bend_lines

  !> The middle node of a parabola must lie in the middle third of its chord; bisections to find its half.
  real(wp), parameter :: third = 1.0_wp/3
  integer, parameter :: halvings = 50
  !> Bulges decrease to zero over so many lengths of their side.
  real(wp), parameter :: reach = 2.0_wp

contains

  !> Middle node of a side from length s(1) to s(2) of a curve: at half the length, or over half the chord where half the length
  !> is outside its middle third.
  pure subroutine place_middle(boundaries, curve, s, ends, x, position)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(curve_t), intent(in) :: curve
    real(wp), intent(in) :: s(2)         !! [length]
    real(wp), intent(in) :: ends(2, 2)   !! [length]
    real(wp), intent(out) :: x(2)        !! [length]
    type(position_t), intent(out) :: position
    real(wp) :: low, high
    integer :: halving

    call curve_point(boundaries, curve, 0.5_wp*(s(1) + s(2)), x, position)
    if (share(x) > third .and. share(x) < 1 - third) return
    low = s(1)
    high = s(2)
    do halving = 1, halvings
      call curve_point(boundaries, curve, 0.5_wp*(low + high), x, position)
      if (share(x) > 0.5_wp) then
        high = 0.5_wp*(low + high)
      else
        low = 0.5_wp*(low + high)
      end if
    end do

  contains

    !> Projection of a point on the chord, from 0 to 1.
    pure function share(point) result(t)
      real(wp), intent(in) :: point(2)
      real(wp) :: t

      associate (chord => ends(:, 2) - ends(:, 1))
        t = dot_product(point - ends(:, 1), chord)/dot_product(chord, chord)
      end associate
    end function share

  end subroutine place_middle

  !> Middle nodes of a zone, except those on curved sides, which are placed already.
  pure subroutine bend_lines(grid, along, across, straight, x)
    integer, intent(in) :: grid(0:, 0:)     !! (0:n, 0:m) ends
    integer, intent(in) :: along(1:, 0:)    !! (n, 0:m) middles
    integer, intent(in) :: across(0:, 1:)   !! (0:n, m) middles
    logical, intent(in) :: straight(4)      !! sides
    real(wp), intent(inout) :: x(:, :)      !! (2, nnode) [length]
    integer :: i, j, n, m

    n = ubound(grid, 1)
    m = ubound(grid, 2)
    do i = 1, n
      call bend_stack(grid(i - 1, :), grid(i, :), along(i, :), straight([1, 3]), x)
    end do
    do j = 1, m
      call bend_stack(grid(:, j - 1), grid(:, j), across(:, j), straight([4, 2]), x)
    end do
  end subroutine bend_lines

  !> Middles of a stack of sides between two lines that cross the zone.
  pure subroutine bend_stack(first, second, middle, straight, x)
    integer, intent(in) :: first(0:), second(0:), middle(0:)
    logical, intent(in) :: straight(2)
    real(wp), intent(inout) :: x(:, :)
    real(wp) :: bulge(2), half(2, 0:ubound(middle, 1)), share, chord(2)
    integer :: k, i, n, ends(2)

    n = ubound(middle, 1)
    half = 0.5_wp*(x(:, first) + x(:, second))
    ends = [0, n]
    bulge = 0
    do i = 1, 2
      k = ends(i)
      chord = x(:, second(k)) - x(:, first(k))
      if (straight(i)) then
        x(:, middle(k)) = half(:, k)
      else
        bulge(i) = dot_product(x(:, middle(k)) - half(:, k), left_of(chord))/dot_product(chord, chord)
      end if
    end do
    do k = 1, n - 1
      chord = x(:, second(k)) - x(:, first(k))
      share = 0
      do i = 1, 2
        share = share + bulge(i)*max(0.0_wp, 1 - length_of(half(:, k) - half(:, ends(i))) &
                                     /(reach*length_of(x(:, second(ends(i))) - x(:, first(ends(i))))))
      end do
      x(:, middle(k)) = half(:, k) + share*left_of(chord)
    end do
  end subroutine bend_stack

  !> A vector rotated to the left by a right angle.
  pure function left_of(v) result(n)
    real(wp), intent(in) :: v(2)
    real(wp) :: n(2)

    n = [-v(2), v(1)]
  end function left_of

end module side_middles
