!> The sides of zones as curves walked by length, and nodes along them where 1/h is shared out evenly.
!>
!> A side along the contour is broken where the contour has a corner, where contact begins or ends, and where another set of sides
!> begins: these stay ends of elements. So is one along an interface where that has a corner.
module side_curves
  use contour_chain, only: arc_at, chain_length, chain_t, joint_after, kind_corner, kind_entry, kind_exit, kind_joint, &
                           place_at_arc, place_t, point_on
  use kinds, only: wp
  use size_field, only: size_at, size_field_t
  use stretches, only: length_between, point_at, straight, stretch_t, tangent_at, xi_at_length
  use vectors, only: length_of
  use zones, only: arc_along, coordinates_of, exact_point, follows_contour, follows_interface, layout_t, on_chain, runs_curved, &
                   side_t, zone_point_t, zone_t
  implicit none
  private
  public :: curve_t, snap_to_joints, draw_side, curve_point, measure_density, divide_curve, shares_of, has_course

  type :: curve_t
    integer :: chain = 0
    !> Arc length on the chain where it begins [length].
    real(wp) :: start = 0.0_wp
    !> Open chain along an interface, from the start to the end of the curve.
    type(chain_t) :: path
    !> Straight line or parabola of a side inside.
    type(stretch_t) :: line
    real(wp) :: ends(2, 2) = 0.0_wp        !! [length]
    real(wp) :: length = 0.0_wp            !! [length]
    !> Lengths where elements must end, both ends of the curve among them (0:npart).
    real(wp), allocatable :: breaks(:)
    !> Integral of 1/h: at lengths `at`, with breaks among them, `count` elements from the start.
    real(wp), allocatable :: at(:), count(:)
    !> Elements each part between breaks needs (npart).
    real(wp), allocatable :: needs(:)
  end type curve_t

  !> Breaks that are closer than this share of a chain are one, and so are an entry and a corner.
  real(wp), parameter :: same = 1.0e-9_wp
  !> No zone point beside a corner, and no entry or exit beside another break, leaves an element shorter than this share of the
  !> wanted size.
  real(wp), parameter :: least_share = 0.1_wp
  !> 1/h is looked at twice in an element, and no less and no more often along a part than this.
  integer, parameter :: fewest = 8, most = 4000

contains

  !> Zone points on a contour go to a corner of it, or to where contact begins or ends, that is so near that no element fits
  !> between, unless they are to stay.
  pure subroutine snap_to_joints(chains, zones, field, points)
    type(chain_t), intent(in) :: chains(:)
    type(zone_t), intent(in) :: zones(:)
    type(size_field_t), intent(in) :: field
    type(zone_point_t), intent(inout) :: points(:)
    real(wp) :: arc, apart, most
    integer :: z, i, k, pass

    do z = 1, size(zones)
      do i = 1, 4
        associate (point => points(zones(z)%corners(i)))
          if (point%chain == 0 .or. point%stays) cycle
          associate (chain => chains(point%chain))
            arc = arc_at(chain, point%place)
            most = least_share*size_at(field, zones(z)%material, on_chain(chain, point%place))
            look: do pass = 1, 2
              do k = 1, size(chain%stretches)
                if (pass == 1 .and. chain%kinds(k) /= kind_corner) cycle
                if (pass == 2 .and. all(chain%kinds(k) /= [kind_entry, kind_exit])) cycle
                apart = modulo(chain%arc(k - 1) - arc, chain_length(chain))
                if (min(apart, chain_length(chain) - apart) > most) cycle
                point%place = place_t(k, chain%stretches(k)%range(1))
                exit look
              end do
            end do look
          end associate
        end associate
      end do
    end do
  end subroutine snap_to_joints

  !> The curve of a side, with its breaks.
  pure subroutine draw_side(chains, layout, side, field, curve)
    type(chain_t), intent(in) :: chains(:)
    type(layout_t), intent(in) :: layout
    type(side_t), intent(in) :: side
    type(size_field_t), intent(in) :: field
    type(curve_t), intent(out) :: curve
    real(wp) :: arc(2)
    integer :: i

    do i = 1, 2
      curve%ends(:, i) = coordinates_of(chains, layout%points(side%points(i)))
    end do
    if (side%form == follows_contour) then
      curve%chain = side%chain
      arc = arc_along(chains, layout, side)
      curve%start = arc(1)
      curve%length = arc(2) - arc(1)
      call find_breaks(chains(side%chain), field, layout%zones(side%zones(1))%material, curve)
      return
    end if
    if (side%form == follows_interface) then
      call draw_path(layout%paths(side%path), field, layout%zones(side%zones(1))%material, curve)
      return
    end if
    curve%line = straight(curve%ends(:, 1), curve%ends(:, 2))
    if (side%form == runs_curved) curve%line%points(:, 2) = side%middle
    curve%length = length_between(curve%line, -1.0_wp, 1.0_wp)
    allocate (curve%breaks(0:1), source=[0.0_wp, curve%length])
  end subroutine draw_side

  !> A path as the side walks it, with its corners as breaks.
  pure subroutine draw_path(path, field, material, curve)
    type(chain_t), intent(in) :: path
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    real(wp) :: start(2)

    curve%path = path
    start = point_on(path, place_t(1, path%stretches(1)%range(1)))
    if (length_of(start - curve%ends(:, 1)) > length_of(start - curve%ends(:, 2))) curve%path = turned(path)
    curve%length = chain_length(curve%path)
    call find_breaks(curve%path, field, material, curve)
  end subroutine draw_path

  !> An open chain walked backwards.
  pure function turned(path) result(back)
    type(chain_t), intent(in) :: path
    type(chain_t) :: back
    integer :: k, n

    n = size(path%stretches)
    allocate (back%stretches(n), back%kinds(n), back%arc(0:n))
    do k = 1, n
      back%stretches(k) = path%stretches(n + 1 - k)
      back%stretches(k)%points = back%stretches(k)%points(:, [3, 2, 1])
      back%stretches(k)%range = -back%stretches(k)%range([2, 1])
      back%stretches(k)%depth = back%stretches(k)%depth([2, 1])
    end do
    back%kinds(1) = path%kinds(1)
    back%kinds(2:) = path%kinds(n:2:-1)
    back%arc = path%arc(n) - path%arc(n:0:-1)
  end function turned

  !> Whether the course of a curve is given by a mesh, so that each of its parts gets what it needs.
  pure elemental function has_course(curve) result(yes)
    type(curve_t), intent(in) :: curve
    logical :: yes

    yes = curve%chain > 0 .or. allocated(curve%path%stretches)
  end function has_course

  !> Corners between the ends of the curve, then joints, entries and exits that are not too close to others.
  pure subroutine find_breaks(chain, field, material, curve)
    type(chain_t), intent(in) :: chain
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    real(wp) :: found(0:size(chain%stretches) + 1), s, apart
    integer :: k, n, pass, i

    found(0:1) = [0.0_wp, curve%length]
    n = 1
    do pass = 1, 2
      do k = 1, size(chain%stretches)
        if (pass == 1 .and. chain%kinds(k) /= kind_corner) cycle
        if (pass == 2 .and. all(chain%kinds(k) /= [kind_joint, kind_entry, kind_exit])) cycle
        s = modulo(chain%arc(k - 1) - curve%start, chain_length(chain))
        if (s >= curve%length) cycle
        apart = same*chain_length(chain)
        if (pass == 2) apart = max(apart, least_share*size_at(field, material, &
                                                              point_at(chain%stretches(k), chain%stretches(k)%range(1))))
        if (minval(abs(found(:n) - s)) <= apart) cycle
        i = count(found(:n) < s)
        found(i + 1:n + 1) = found(i:n)
        found(i) = s
        n = n + 1
      end do
    end do
    allocate (curve%breaks(0:n), source=found(0:n))
  end subroutine find_breaks

  !> Point at a length from the start [length]; on a chain also its place. The ends are exactly those of the side.
  pure subroutine curve_point(chains, curve, s, x, place)
    type(chain_t), intent(in) :: chains(:)
    type(curve_t), intent(in) :: curve
    real(wp), intent(in) :: s
    real(wp), intent(out) :: x(2)
    type(place_t), intent(out) :: place
    type(place_t) :: along

    if (curve%chain > 0) then
      place = place_at_arc(chains(curve%chain), curve%start + s)
      ! a break is the start of a stretch, not the last bit of the one before
      associate (chain => chains(curve%chain))
        if (abs(chain%arc(place%stretch) - modulo(curve%start + s, chain_length(chain))) <= same*chain_length(chain)) then
          place%stretch = joint_after(chain, place%stretch)
          place%xi = chain%stretches(place%stretch)%range(1)
        end if
      end associate
      x = on_chain(chains(curve%chain), place)
    else if (.not. s > 0) then
      x = curve%ends(:, 1)
    else if (.not. s < curve%length) then
      x = curve%ends(:, 2)
    else if (allocated(curve%path%stretches)) then
      along = place_at_arc(curve%path, s)
      x = on_chain(curve%path, along)
    else
      x = exact_point(curve%line, xi_at_length(curve%line, s))
    end if
  end subroutine curve_point

  !> Integrate 1/h along the curve by the trapezoidal rule, in steps of half the size that is wanted there.
  pure subroutine measure_density(chains, field, material, curve, other)
    type(chain_t), intent(in) :: chains(:)
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    type(curve_t), intent(inout) :: curve
    integer, optional, intent(in) :: other   !! material on the other hand: the smaller size of both counts
    real(wp), allocatable :: at(:), count(:)
    real(wp) :: h, h_next, s, step, part, x(2)
    type(place_t) :: place
    integer :: p, n

    n = (most + 1)*ubound(curve%breaks, 1)
    allocate (at(0:n), count(0:n), curve%needs(ubound(curve%breaks, 1)))
    at(0) = 0
    count(0) = 0
    n = 0
    call curve_point(chains, curve, 0.0_wp, x, place)
    h = wanted(x)
    do p = 1, ubound(curve%breaks, 1)
      part = curve%breaks(p) - curve%breaks(p - 1)
      do
        step = min(max(0.5_wp*h, part/most), part/fewest)
        s = at(n) + step
        ! no crumb is left before the break
        if (s + 0.5_wp*step > curve%breaks(p)) s = curve%breaks(p)
        call curve_point(chains, curve, s, x, place)
        h_next = wanted(x)
        n = n + 1
        at(n) = s
        count(n) = count(n - 1) + 0.5_wp*(s - at(n - 1))*(1/h + 1/h_next)
        h = h_next
        if (.not. s < curve%breaks(p)) exit
      end do
      curve%needs(p) = count(n) - sum(curve%needs(:p - 1))
    end do
    allocate (curve%at(0:n), source=at(0:n))
    allocate (curve%count(0:n), source=count(0:n))

  contains

    pure function wanted(point) result(size)
      real(wp), intent(in) :: point(2)
      real(wp) :: size

      size = size_at(field, material, point)
      if (present(other)) size = min(size, size_at(field, other, point))
    end function wanted

  end subroutine measure_density

  !> Elements of each part of n along the curve: by need, at least one.
  pure function shares_of(curve, n) result(shares)
    type(curve_t), intent(in) :: curve
    integer, intent(in) :: n              !! not less than there are parts
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
    integer, intent(in) :: n                !! not less than there are parts
    real(wp), intent(out) :: ends(0:)
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

  !> Length at a number of elements from the start: straight between those where it was looked at.
  pure function length_at(curve, n) result(s)
    type(curve_t), intent(in) :: curve
    real(wp), intent(in) :: n
    real(wp) :: s
    integer :: low, high, middle

    low = 0
    high = ubound(curve%count, 1)
    do while (high - low > 1)
      middle = (low + high)/2
      if (curve%count(middle) <= n) then
        low = middle
      else
        high = middle
      end if
    end do
    s = curve%at(low) + (curve%at(high) - curve%at(low))*(n - curve%count(low))/(curve%count(high) - curve%count(low))
  end function length_at

end module side_curves
