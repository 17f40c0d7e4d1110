!> Ends of elements along the sides of zones, which equidistribute 1/h, the integral of which is the number of elements.
module curve_divisions
  use ascending, only: count_up_to
  use boundary_curves, only: boundary_curve_t, position_t
  use directed_sizes, only: size_along
  use kinds, only: wp
  use side_curves, only: curve_point, curve_t
  use size_field, only: directed_size_at, size_at, size_field_t
  implicit none
  private
  public :: measure_density, divide_curve, shares_of

  !> Bounds of the number of steps along a part in which 1/h is integrated; two steps per element otherwise.
  integer, parameter :: fewest = 8, most = 4000

contains

  !> Integrate 1/h along the curve by the trapezoidal rule, in steps of half the requested size.
  pure subroutine measure_density(boundaries, field, material, curve, other)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    integer, optional, intent(in) :: other   !! material on the other side: the smaller size of both is used
    real(wp), allocatable :: at(:), count(:)
    real(wp) :: h, h_next, s, step, part, x(2), last(2)
    type(position_t) :: position
    integer :: p, n

    n = (most + 1)*ubound(curve%breaks, 1)
    allocate (at(0:n), count(0:n), curve%needs(ubound(curve%breaks, 1)))
    at(0) = 0
    count(0) = 0
    n = 0
    call curve_point(boundaries, curve, 0.0_wp, x, position)
    h = requested(x)
    last = x
    do p = 1, ubound(curve%breaks, 1)
      part = curve%breaks(p) - curve%breaks(p - 1)
      do
        step = min(max(0.5_wp*h, part/most), part/fewest)
        s = at(n) + step
        ! no short step is left before the break
        if (s + 0.5_wp*step > curve%breaks(p)) s = curve%breaks(p)
        call curve_point(boundaries, curve, s, x, position)
        h_next = requested(x)
        n = n + 1
        at(n) = s
        count(n) = count(n - 1) + 0.5_wp*(s - at(n - 1))*(1/along(last, x - last, h) + 1/along(x, x - last, h_next))
        h = h_next
        last = x
        if (.not. s < curve%breaks(p)) exit
      end do
      curve%needs(p) = count(n) - sum(curve%needs(:p - 1))
    end do
    allocate (curve%at(0:n), source=at(0:n))
    allocate (curve%count(0:n), source=count(0:n))

  contains

    pure function requested(point) result(size)
      real(wp), intent(in) :: point(2)
      real(wp) :: size

      size = size_at(field, material, point)
      if (present(other)) size = min(size, size_at(field, other, point))
    end function requested

    !> Size along the curve, where elements may be longer than wide.
    pure function along(point, direction, square) result(size)
      real(wp), intent(in) :: point(2), direction(2), square   !! `requested` there
      real(wp) :: size
      real(wp) :: across, stretch(2)

      size = square
      if (.not. field%is_directed) return
      call directed_size_at(field, material, point, across, stretch)
      size = size_along(across, stretch, direction)
      if (.not. present(other)) return
      call directed_size_at(field, other, point, across, stretch)
      size = min(size, size_along(across, stretch, direction))
    end function along

  end subroutine measure_density

  !> Elements of each part of n along the curve: by need, at least one.
  pure function shares_of(curve, n) result(shares)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: n   !! not less than there are parts
    integer :: shares(size(curve%needs))
    integer :: k, p

    shares = 1
    do k = size(shares) + 1, n
      p = maxloc(curve%needs/shares, 1)
      shares(p) = shares(p) + 1
    end do
  end function shares_of

  !> Lengths of the n + 1 ends of n elements (0:n).
  pure subroutine divide_curve(curve, n, ends)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: n            !! not less than there are parts
    real(wp), intent(out) :: ends(0:)   !! (0:n) [length]
    integer :: shares(size(curve%needs)), p, k, i
    real(wp) :: from

    shares = shares_of(curve, n)
    k = 0
    ends(0) = 0
    from = 0
    do p = 1, size(shares)
      do i = 1, shares(p) - 1
        ends(k + i) = length_at(curve, from + curve%needs(p)*i/shares(p))
      end do
      from = from + curve%needs(p)
      k = k + shares(p)
      ends(k) = curve%breaks(p)
    end do
  end subroutine divide_curve

  !> Arc length at a number of elements from the start: linear between the steps of the integration.
  pure function length_at(curve, n) result(s)
    type(curve_t), intent(in) :: curve
    real(wp), intent(in) :: n
    real(wp) :: s
    integer :: k

    k = count_up_to(curve%count(1:ubound(curve%count, 1) - 1), n)
    s = curve%at(k) + (curve%at(k + 1) - curve%at(k))*(n - curve%count(k))/(curve%count(k + 1) - curve%count(k))
  end function length_at

end module curve_divisions
