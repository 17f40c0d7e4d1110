!> Contacts that are narrow beside the sides of elements there: what such a die bears goes with the sides, not with its contact.
!>
!> A die that begins to touch, with its point, at a bend or along a line, is borne by a node or two. The force of a plastic body
!> goes with the width of contact (R. Hill, The Mathematical Theory of Plasticity, Oxford 1950, ch. IX), which is then that of the
!> sides. A new mesh has sides there of the contact over ACROSS, or the smallest of SIZE. It counts where the elements behind the
!> contact alone make an error of the stress above the limit of ERROR: where a narrow contact bends a strip the force follows from
!> the bending, and no finer sides change it.
module narrow_contacts
  use bearing_nodes, only: bears_load
  use block_mesh, only: polygon_area
  use bodies_behind, only: find_bodies_behind
  use fields, only: displacement_field
  use kinds, only: wp
  use quadrature, only: line_rule
  use remesher_options, only: bodies_have_sizes
  use scene, only: axisymmetric, is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: few_sides, narrow_t, measure_narrow

  !> Sides of the narrowest contact over those that a new mesh would have (0: no die bears a load), how many there are across it,
  !> the longest of them, and the error of the stress that the elements behind them make [-].
  type :: narrow_t
    real(wp) :: ratio = 0.0_wp, across = huge(1.0_wp), error = 0.0_wp
    integer :: die = 0, group = 0, side = 0
  end type narrow_t

  !> Contact over fewer sides is known to within a third of its width at best: a node more or less is half a side.
  real(wp), parameter :: few_sides = 1.5_wp

contains

  !> Of the dies that bear the load the one with the narrowest contact; of a die that presses at several places the widest counts.
  pure function measure_narrow(scene, solution) result(narrow)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution   !! at an accepted instant
    type(narrow_t) :: narrow
    type(narrow_t) :: of_die
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))
    logical :: bears(size(scene%dies))
    integer :: d

    if (scene%remesher%across_contact == 0 .or. size(scene%dies) == 0) return
    if (.not. scene%fields(displacement_field)%declared) return
    bears = bears_load(scene, solution)
    if (.not. any(bears)) return
    x = present_coordinates(scene, solution)
    do d = 1, size(bears)
      if (.not. bears(d)) cycle
      call measure_die(scene, solution, x, d, of_die)
      if (of_die%across < narrow%across) narrow = of_die
    end do
  end function measure_narrow

  !> The widest place where a die presses: sides that press and share an end are one place.
  pure subroutine measure_die(scene, solution, x, d, narrow)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)   !! present coordinates (2, nnode) [length]
    integer, intent(in) :: d          !! number of the die
    type(narrow_t), intent(out) :: narrow
    real(wp), allocatable :: share(:)
    real(wp), dimension(size(x, 2)) :: width, longest
    real(wp) :: length
    integer, allocatable :: middles(:), ends(:, :), group(:), side(:)
    integer :: place(size(x, 2)), g, e, k, n, widest

    allocate (middles(0), group(0), side(0))
    width = 0
    longest = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die /= d .or. scene%groups(g)%material == 0) cycle
      associate (sides => scene%groups(g)%connectivity)
        share = pressed_share(scene, g, solution%groups(g)%committed)
        n = count(share > 0)
        middles = [middles, pack(sides(2, :), share > 0)]
        group = [group, spread(g, 1, n)]
        side = [side, pack([(e, e=1, size(share))], share > 0)]
        do e = 1, size(share)
          if (.not. share(e) > 0) cycle
          length = length_of(x(:, sides(3, e)) - x(:, sides(1, e)))
          width(sides(2, e)) = share(e)*length
          longest(sides(2, e)) = length
        end do
      end associate
    end do
    if (size(side) == 0) return
    ends = reshape([(scene%groups(group(k))%connectivity([1, 3], side(k)), k=1, size(side))], [2, size(side)])
    call find_places(ends, place)
    ! width and longest side of a place, kept at its least node
    do k = 1, size(side)
      associate (least => place(ends(1, k)), middle => middles(k))
        if (least == middle) cycle
        width(least) = width(least) + width(middle)
        longest(least) = max(longest(least), longest(middle))
      end associate
    end do
    widest = 0
    do k = 1, size(side)
      associate (least => place(ends(1, k)))
        if (widest == 0) widest = least
        if (width(least)/longest(least) > width(widest)/longest(widest)) widest = least
      end associate
    end do
    narrow%die = d
    narrow%across = width(widest)/longest(widest)
    narrow%ratio = longest(widest)/max(least_size(scene, middles), width(widest)/scene%remesher%across_contact)
    do k = 1, size(side)
      if (place(ends(1, k)) /= widest .or. longest(middles(k)) < longest(widest)) cycle
      narrow%group = group(k)
      narrow%side = side(k)
      exit
    end do
    if (narrow%ratio > 1 .or. narrow%across < few_sides) narrow%error = error_behind(scene, solution, x, middles)
  end subroutine measure_die

  !> The smallest element that the bodies behind sides may have [length].
  pure function least_size(scene, middles) result(least)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: middles(:)     !! nodes in the middle of the sides
    real(wp) :: least
    integer, allocatable :: body(:), element(:), side(:)
    integer :: k

    least = scene%remesher%smallest
    if (.not. bodies_have_sizes(scene%remesher)) return
    call find_bodies_behind(scene, middles, body, element, side)
    least = huge(least)
    associate (cards => scene%remesher%contours)
      do k = 1, size(cards)
        if (any(body == cards(k)%group)) least = min(least, cards(k)%smallest)
      end do
    end associate
  end function least_size

  !> Share of the length of each side that its points in contact stand for: those at its ends for a quarter each, in the middle for
  !> half, others by their weight.
  pure function pressed_share(scene, g, state) result(share)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                    !! a group that faces a die
    real(wp), intent(in) :: state(:, :, :)      !! (component, point, side) [unit of each component]
    real(wp) :: share(size(state, 3))
    real(wp), allocatable :: xi(:), weight(:)
    integer :: pressure, of_corner, e, p

    call line_rule(scene%groups(g)%rule, xi, weight)
    pressure = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, 'pressure'))%first
    of_corner = find_variable(scene%groups(g)%variables, 'corner_pressure')
    if (of_corner > 0) of_corner = scene%groups(g)%variables(of_corner)%first
    share = 0
    do e = 1, size(share)
      do p = 1, size(state, 2)
        if (state(pressure, p, e) > 0) share(e) = share(e) + part_of(xi(p), weight(p))
        if (of_corner == 0) cycle
        if (state(of_corner, p, e) > 0) share(e) = share(e) + part_of(1.0_wp, 0.0_wp)
      end do
    end do
    share = min(share, 1.0_wp)

  contains

    pure function part_of(at, points_weight) result(part)
      real(wp), intent(in) :: at, points_weight
      real(wp) :: part

      if (abs(at) >= 1) then
        part = 0.25_wp
      else if (abs(at) > 0) then
        part = 0.5_wp*points_weight
      else
        part = 0.5_wp
      end if
    end function part_of

  end function pressed_share

  !> For each end of sides the least node that sides which share ends lead to.
  pure subroutine find_places(ends, place)
    integer, intent(in) :: ends(:, :)    !! nodes (2, nside)
    integer, intent(out) :: place(:)     !! (nnode), 0 elsewhere
    integer :: k, least
    logical :: moved

    place = 0
    do k = 1, size(ends, 2)
      place(ends(:, k)) = ends(:, k)
    end do
    moved = .true.
    do while (moved)
      moved = .false.
      do k = 1, size(ends, 2)
        least = minval(place(ends(:, k)))
        moved = moved .or. any(place(ends(:, k)) > least)
        place(ends(:, k)) = least
      end do
    end do
  end subroutine find_places

  !> Error of the stress that the elements behind sides make, over the stress of the whole.
  pure function error_behind(scene, solution, x, middles) result(error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)       !! present coordinates (2, nnode) [length]
    integer, intent(in) :: middles(:)     !! nodes in the middle of the sides
    real(wp) :: error
    integer, allocatable :: body(:), element(:), side(:)
    real(wp) :: volume, all
    integer :: g, e, n

    call find_bodies_behind(scene, middles, body, element, side)
    error = 0
    all = 0
    n = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        n = n + 1
        associate (corners => x(:, scene%groups(g)%connectivity(1:4, e)))
          volume = polygon_area(corners)
          if (scene%plane_state == axisymmetric) volume = 0.25_wp*sum(corners(1, :))*volume
        end associate
        all = all + volume
        if (any(body == g .and. element == e)) error = error + solution%estimate%stress_of(n)**2*volume
      end do
    end do
    error = sqrt(max(error, 0.0_wp)/all)
  end function error_behind

end module narrow_contacts
