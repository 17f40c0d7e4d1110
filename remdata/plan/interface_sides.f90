!> Sides of zones between two materials follow the interface of the old mesh.
!>
!> Their corners are moved onto it: on the contour to its end, where more than two such sides meet to the end of interfaces there,
!> else to the closest position. Each interface must be followed once from end to end, or all around: otherwise the zones do not
!> separate the materials.
module interface_sides
  use block_mesh, only: polygon_area
  use boundary_curves, only: boundary_curve_t, boundary_length, closest_position, point_on, position_t, size_of_boundary
  use corrected_contours, only: contour_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use material_interfaces, only: interface_t, path_between
  use scene, only: is_solid, scene_t
  use text, only: to_text
  use vectors, only: length_of
  use zones, only: coordinates_of, follows_interface, plan_t, zone_point_t
  implicit none
  private
  public :: follow_interfaces

  !> A side of a zone between two materials, the lower material on its left.
  type :: shared_side_t
    integer :: zones(2) = 0, local(2) = 0
    integer :: points(2) = 0
    integer :: materials(2) = 0
  end type shared_side_t

  !> Tolerance of points on an interface and of its length, as a share of its size.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> Paths and corners of all sides between materials.
  pure subroutine follow_interfaces(scene, material, contours, interfaces, plan, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)               !! of each group of the scene (ngroup)
    type(contour_t), intent(in) :: contours(:)       !! (ncontour)
    type(interface_t), intent(in) :: interfaces(:)   !! (ninterface)
    type(plan_t), intent(inout) :: plan
    type(error_t), allocatable, intent(out) :: error
    type(shared_side_t), allocatable :: sides(:)
    real(wp) :: followed(size(interfaces))
    integer :: s, p, i, k

    call list_shared(contours, plan, sides)
    if (allocated(plan%paths)) deallocate (plan%paths)
    allocate (plan%paths(size(sides)))
    do p = 1, size(plan%points)
      call put_on_interface(contours, interfaces, sides, p, plan%points(p))
    end do
    followed = 0
    do s = 1, size(sides)
      call draw_path(contours, interfaces, plan%points(sides(s)%points), sides(s)%materials, i, plan%paths(s))
      if (size(plan%paths(s)%arcs) == 0) then
        call fail(error, exit_input, 'remdata: the side between the bodies '//bodies(sides(s)%materials)//' near x = ' &
                  //middle_of(sides(s), 1)//', y = '//middle_of(sides(s), 2)//' lies on no interface of theirs', &
                  'zones between two bodies share the points where their interface ends')
        return
      end if
      followed(i) = followed(i) + boundary_length(plan%paths(s))
      do k = 1, 2
        plan%zones(sides(s)%zones(k))%form(sides(s)%local(k)) = follows_interface
        plan%zones(sides(s)%zones(k))%path(sides(s)%local(k)) = s
      end do
    end do
    do i = 1, size(interfaces)
      associate (length => boundary_length(interfaces(i)%curve))
        if (abs(followed(i) - length) <= same*size(interfaces(i)%curve%arcs)*length) cycle
        call fail(error, exit_input, 'remdata: sides of zones follow '//to_text(followed(i))//' of the length '//to_text(length) &
                  //' of an interface between the bodies '//bodies(interfaces(i)%materials)//', expected all of it once', &
                  'zones of either body share points at both ends of the interface')
        return
      end associate
    end do

  contains

    !> Names of the bodies of two materials.
    pure function bodies(materials) result(names)
      integer, intent(in) :: materials(2)
      character(len=:), allocatable :: names
      logical :: solid(size(material))
      integer :: g

      solid = [(is_solid(scene%groups(g)), g=1, size(material))]
      names = scene%groups(findloc(solid .and. material == materials(1), .true., 1))%name//' and ' &
              //scene%groups(findloc(solid .and. material == materials(2), .true., 1))%name
    end function bodies

    pure function middle_of(side, axis) result(words)
      type(shared_side_t), intent(in) :: side
      integer, intent(in) :: axis
      character(len=:), allocatable :: words
      real(wp) :: ends(2, 2)

      ends(:, 1) = coordinates_of(contours%boundary, plan%points(side%points(1)))
      ends(:, 2) = coordinates_of(contours%boundary, plan%points(side%points(2)))
      words = to_text(0.5_wp*sum(ends(axis, :)), 6)
    end function middle_of

  end subroutine follow_interfaces

  !> Sides that zones of two materials have.
  pure subroutine list_shared(contours, plan, sides)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    type(shared_side_t), allocatable, intent(out) :: sides(:)
    type(shared_side_t) :: list(2*size(plan%zones))
    real(wp) :: x(2, 4)
    integer :: y, z, k, l, i, n, ends(2)

    n = 0
    do z = 1, size(plan%zones)
      do k = 1, 4
        ends = plan%zones(z)%corners([k, mod(k, 4) + 1])
        do y = 1, size(plan%zones)
          ! once for each pair, from the lower material
          if (plan%zones(z)%material >= plan%zones(y)%material) cycle
          do l = 1, 4
            associate (other => plan%zones(y)%corners([l, mod(l, 4) + 1]))
              if (minval(other) /= minval(ends) .or. maxval(other) /= maxval(ends)) cycle
            end associate
            n = n + 1
            list(n)%zones = [z, y]
            list(n)%local = [k, l]
            list(n)%materials = [plan%zones(z)%material, plan%zones(y)%material]
            do i = 1, 4
              x(:, i) = coordinates_of(contours%boundary, plan%points(plan%zones(z)%corners(i)))
            end do
            list(n)%points = ends
            if (polygon_area(x) < 0) list(n)%points = ends([2, 1])
          end do
        end do
      end do
    end do
    allocate (sides, source=list(:n))
  end subroutine list_shared

  !> Move a corner of sides between materials onto their interface.
  pure subroutine put_on_interface(contours, interfaces, sides, number, point)
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), intent(in) :: interfaces(:)
    type(shared_side_t), intent(in) :: sides(:)
    integer, intent(in) :: number
    type(zone_point_t), intent(inout) :: point
    integer :: s, i, e, valence
    real(wp) :: here(2), x(2), best(2), distance, least
    logical :: at_end, on_contour

    valence = 0
    at_end = .false.
    do s = 1, size(sides)
      if (all(sides(s)%points /= number)) cycle
      valence = valence + 1
      do i = 1, s - 1
        if (any(sides(i)%points == number)) at_end = at_end .or. any(sides(i)%materials /= sides(s)%materials)
      end do
    end do
    if (valence == 0) return
    on_contour = point%boundary > 0
    at_end = at_end .or. on_contour .or. valence /= 2
    here = coordinates_of(contours%boundary, point)
    least = huge(least)
    do i = 1, size(interfaces)
      if (.not. any([(any(sides(s)%points == number) .and. all(sides(s)%materials == interfaces(i)%materials), &
                      s=1, size(sides))])) cycle
      if (.not. at_end) then
        x = point_on(interfaces(i)%curve, closest_position(interfaces(i)%curve, here))
        distance = length_of(x - here)
        if (distance < least) best = x
        least = min(least, distance)
      else if (.not. interfaces(i)%closed) then
        do e = 1, 2
          if (interfaces(i)%contour(e) > 0 .neqv. on_contour) cycle
          x = end_of(interfaces(i)%curve, e)
          distance = length_of(x - here)
          if (.not. distance < least) cycle
          least = distance
          best = x
          if (.not. on_contour) cycle
          point%boundary = interfaces(i)%contour(e)
          point%position = interfaces(i)%position(e)
        end do
      end if
    end do
    if (.not. least < huge(least)) return   ! its sides will not be found on an interface
    point%x = best
    point%stays = .true.
  end subroutine put_on_interface

  !> Ends of an open curve [length].
  pure function end_of(curve, which) result(x)
    type(boundary_curve_t), intent(in) :: curve
    integer, intent(in) :: which
    real(wp) :: x(2)

    x = curve%arcs(1)%points(:, 1)
    if (which == 2) x = curve%arcs(size(curve%arcs))%points(:, 3)
  end function end_of

  !> The part of an interface from one point to another, with its left material on the left; without arcs where there is none.
  pure subroutine draw_path(contours, interfaces, ends, materials, number, path)
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), intent(in) :: interfaces(:)
    type(zone_point_t), intent(in) :: ends(2)
    integer, intent(in) :: materials(2)
    integer, intent(out) :: number   !! of the interface
    type(boundary_curve_t), intent(out) :: path
    type(position_t) :: positions(2)
    integer :: k
    logical :: on

    do number = 1, size(interfaces)
      if (any(interfaces(number)%materials /= materials)) cycle
      on = .true.
      do k = 1, 2
        associate (curve => interfaces(number)%curve, x => coordinates_of(contours%boundary, ends(k)))
          positions(k) = closest_position(curve, x)
          on = on .and. length_of(point_on(curve, positions(k)) - x) <= same*size_of_boundary(curve)
        end associate
      end do
      if (.not. on) cycle
      path = path_between(interfaces(number), positions(1), positions(2))
      if (size(path%arcs) > 0) return
    end do
    if (.not. allocated(path%arcs)) allocate (path%arcs(0))
  end subroutine draw_path

end module interface_sides
