!> Sides of zones between two materials follow the interface of the old mesh.
!>
!> Their corners go onto it: on the contour to its end, where more than two such sides meet to the end of interfaces there, else to
!> the nearest place. Each interface is followed once from end to end, or around, or the zones do not keep the materials apart.
module interface_sides
  use block_mesh, only: polygon_area
  use contour_chain, only: chain_length, chain_t, closest_place, place_t, point_on, size_of_chain
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use material_interfaces, only: interface_t, path_between
  use part_contour, only: contour_t
  use scene, only: is_solid, scene_t
  use text, only: to_text
  use vectors, only: length_of
  use zone_places, only: coordinates
  use zones, only: follows_interface, plan_t, zone_point_t
  implicit none
  private
  public :: follow_interfaces

  !> A side of a zone, the lower material on its left.
  type :: shared_side_t
    integer :: zones(2) = 0, local(2) = 0
    integer :: points(2) = 0
    integer :: materials(2) = 0
  end type shared_side_t

  !> Points lie on an interface, and lengths are one, within this share of its size.
  real(wp), parameter :: same = 1.0e-9_wp

contains

  !> Paths and corners of all sides between materials.
  pure subroutine follow_interfaces(scene, material, contours, interfaces, plan, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)             !! of each group of the scene (ngroup)
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), intent(in) :: interfaces(:)
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
      if (size(plan%paths(s)%stretches) == 0) then
        call fail(error, exit_input, 'remdata: the side between the bodies '//bodies(sides(s)%materials)//' near x = ' &
                  //middle_of(sides(s), 1)//', y = '//middle_of(sides(s), 2)//' lies on no interface of theirs', &
                  'zones between two bodies share the points where their interface ends')
        return
      end if
      followed(i) = followed(i) + chain_length(plan%paths(s))
      do k = 1, 2
        plan%zones(sides(s)%zones(k))%form(sides(s)%local(k)) = follows_interface
        plan%zones(sides(s)%zones(k))%path(sides(s)%local(k)) = s
      end do
    end do
    do i = 1, size(interfaces)
      associate (length => chain_length(interfaces(i)%chain))
        if (abs(followed(i) - length) <= same*size(interfaces(i)%chain%stretches)*length) cycle
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

      ends(:, 1) = coordinates(contours, plan%points(side%points(1)))
      ends(:, 2) = coordinates(contours, plan%points(side%points(2)))
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
          ! seen from the lower material
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
              x(:, i) = coordinates(contours, plan%points(plan%zones(z)%corners(i)))
            end do
            list(n)%points = ends
            if (polygon_area(x) < 0) list(n)%points = ends([2, 1])
          end do
        end do
      end do
    end do
    allocate (sides, source=list(:n))
  end subroutine list_shared

  !> A corner of sides between materials goes onto their interface.
  pure subroutine put_on_interface(contours, interfaces, sides, number, point)
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), intent(in) :: interfaces(:)
    type(shared_side_t), intent(in) :: sides(:)
    integer, intent(in) :: number
    type(zone_point_t), intent(inout) :: point
    integer :: s, i, e, meeting
    real(wp) :: here(2), x(2), best(2), distance, least
    logical :: at_end, on_contour

    meeting = 0
    at_end = .false.
    do s = 1, size(sides)
      if (all(sides(s)%points /= number)) cycle
      meeting = meeting + 1
      do i = 1, s - 1
        if (any(sides(i)%points == number)) at_end = at_end .or. any(sides(i)%materials /= sides(s)%materials)
      end do
    end do
    if (meeting == 0) return
    on_contour = point%chain > 0
    at_end = at_end .or. on_contour .or. meeting /= 2
    here = coordinates(contours, point)
    least = huge(least)
    do i = 1, size(interfaces)
      if (.not. any([(any(sides(s)%points == number) .and. all(sides(s)%materials == interfaces(i)%materials), &
                      s=1, size(sides))])) cycle
      if (.not. at_end) then
        x = point_on(interfaces(i)%chain, closest_place(interfaces(i)%chain, here))
        distance = length_of(x - here)
        if (distance < least) best = x
        least = min(least, distance)
      else if (.not. interfaces(i)%closed) then
        do e = 1, 2
          if (interfaces(i)%contour(e) > 0 .neqv. on_contour) cycle
          x = end_of(interfaces(i)%chain, e)
          distance = length_of(x - here)
          if (.not. distance < least) cycle
          least = distance
          best = x
          if (.not. on_contour) cycle
          point%chain = interfaces(i)%contour(e)
          point%place = interfaces(i)%place(e)
        end do
      end if
    end do
    if (.not. least < huge(least)) return   ! its sides will not be found on an interface
    point%x = best
    point%stays = .true.
  end subroutine put_on_interface

  !> Where an open chain begins and ends [length].
  pure function end_of(chain, which) result(x)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: which
    real(wp) :: x(2)

    x = chain%stretches(1)%points(:, 1)
    if (which == 2) x = chain%stretches(size(chain%stretches))%points(:, 3)
  end function end_of

  !> The part of an interface from one point to another, with its left material on the left; without stretches where there is none.
  pure subroutine draw_path(contours, interfaces, ends, materials, number, path)
    type(contour_t), intent(in) :: contours(:)
    type(interface_t), intent(in) :: interfaces(:)
    type(zone_point_t), intent(in) :: ends(2)
    integer, intent(in) :: materials(2)
    integer, intent(out) :: number           !! of the interface
    type(chain_t), intent(out) :: path
    type(place_t) :: places(2)
    integer :: k
    logical :: on

    do number = 1, size(interfaces)
      if (any(interfaces(number)%materials /= materials)) cycle
      on = .true.
      do k = 1, 2
        associate (chain => interfaces(number)%chain, x => coordinates(contours, ends(k)))
          places(k) = closest_place(chain, x)
          on = on .and. length_of(point_on(chain, places(k)) - x) <= same*size_of_chain(chain)
        end associate
      end do
      if (.not. on) cycle
      path = path_between(interfaces(number), places(1), places(2))
      if (size(path%stretches) > 0) return
    end do
    if (.not. allocated(path%stretches)) allocate (path%stretches(0))
  end subroutine draw_path

end module interface_sides
