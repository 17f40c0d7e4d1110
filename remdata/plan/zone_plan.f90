!> Zones of a scene on its corrected contours: where their corners go.
!>
!> The blocks of a deck are its zones (block_zones). ZONE cards replace them: their points are defined by ZPNT cards
!> (marked_points), and all zones that name a point share it. Sets of sides are kept along the contour only. A body that is no block
!> and has four corners is one zone.
!>
!> Zones with a corner that has become flat are divided (flat_corners). Sides between two materials follow their interface, and its
!> ends on the contour are the corners of zones there (interface_sides).
module zone_plan
  use block_mesh, only: polygon_area
  use block_zones, only: are_blocks, zones_of_blocks
  use body_outlines, only: refuse_inner_sets
  use boundary_curves, only: arc_length_at, boundary_length, position_t
  use corrected_contours, only: contour_t
  use derived_zones, only: one_zone
  use errors, only: error_t, exit_input, fail
  use flat_corners, only: divide_flat_zones
  use interface_sides, only: follow_interfaces
  use kinds, only: wp
  use marked_points, only: find_points
  use material_interfaces, only: interface_t
  use remesher_options, only: has_zones
  use scene, only: is_solid, lacks_mesh, scene_t
  use text, only: to_text
  use zones, only: coordinates_of, follows_contour, plan_t, zone_point_t
  implicit none
  private
  public :: plan_zones

  !> Corners of zones no farther apart than this share of the contour coincide: the end of an arc and the start of the next are one
  !> point, but for round-off.
  real(wp), parameter :: coincidence_tolerance = 1.0e-9_wp

contains

  !> Zones of all solid groups.
  pure subroutine plan_zones(scene, x, pilots, material, contours, interfaces, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)                  !! nodes now (2, nnode) [length]
    real(wp), intent(in) :: pilots(:, :)             !! (3, ndie) x, y, angle of the dies now [length and radian]
    integer, intent(in) :: material(:)               !! of each group of the scene, as for the sizes (ngroup)
    type(contour_t), intent(in) :: contours(:)       !! (ncontour)
    type(interface_t), intent(in) :: interfaces(:)   !! (ninterface) between materials of the old mesh
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error

    if (has_zones(scene%remesher)) then
      call zones_of_cards(scene, x, pilots, material, contours, plan, error)
    else if (are_blocks(scene)) then
      call zones_of_blocks(scene, x, material, contours, plan, error)
    else
      call zone_of_corners(scene, material, contours, plan, error)
    end if
    if (.not. allocated(error)) call refuse_coincident_points(contours, plan, error)
    if (allocated(error)) return
    call divide_flat_zones(contours, plan)
    if (.not. lacks_mesh(scene)) call follow_interfaces(scene, material, contours, interfaces, plan, error)
  end subroutine plan_zones

  !> Zones as the cards give them.
  pure subroutine zones_of_cards(scene, x, pilots, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :), pilots(:, :)
    integer, intent(in) :: material(:)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error
    integer :: corners(4), z, k

    call find_points(scene, x, pilots, contours, plan%points, error)
    if (allocated(error)) return
    associate (cards => scene%remesher%zones)
      allocate (plan%zones(size(cards)), plan%group(size(cards)))
      allocate (plan%sets(4, size(cards)), source=0)
      do z = 1, size(cards)
        plan%group(z) = cards(z)%group
        plan%zones(z)%name = cards(z)%name
        plan%zones(z)%corners = cards(z)%marks
        plan%zones(z)%material = material(cards(z)%group)
        corners = cards(z)%marks
        if (polygon_area(reshape([(plan%points(corners(k))%x, k=1, 4)], [2, 4])) < 0) plan%zones(z)%corners = corners([1, 4, 3, 2])
      end do
    end associate
  end subroutine zones_of_cards

  !> The zone of a body that has four corners and is no block. They are marked by the sets of sides that meet there, if these are
  !> four too.
  pure subroutine zone_of_corners(scene, material, contours, plan, error)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(out) :: plan
    type(error_t), allocatable, intent(out) :: error
    type(position_t), allocatable :: marked(:)
    integer :: c, k, n

    call refuse_inner_sets(scene, contours, error)
    if (allocated(error)) return
    allocate (marked(0))
    if (size(contours) == 1) then
      associate (boundary => contours(1)%boundary, tags => contours(1)%tags)
        n = size(boundary%arcs)
        do k = 1, n
          associate (one => boundary%arcs(modulo(k - 2, n) + 1)%side, other => boundary%arcs(k)%side)
            if (all(tags%on_set(:, one) .eqv. tags%on_set(:, other))) cycle
          end associate
          marked = [marked, position_t(k, boundary%arcs(k)%range(1))]
        end do
      end associate
    end if
    if (size(marked) /= 4) marked = [position_t ::]
    call one_zone([(contours(c)%boundary, c=1, size(contours))], marked, plan%points, plan%zones, error)
    if (allocated(error)) return
    allocate (plan%group(1), source=findloc([(is_solid(scene%groups(k)), k=1, size(scene%groups))], .true., 1))
    plan%zones%material = material(plan%group(1))
    plan%zones(1)%form = follows_contour
    allocate (plan%sets(4, 1), source=0)
  end subroutine zone_of_corners

  !> Two corners of zones may not coincide.
  pure subroutine refuse_coincident_points(contours, plan, error)
    type(contour_t), intent(in) :: contours(:)
    type(plan_t), intent(in) :: plan
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: length, apart, at(2)
    integer :: i, k

    do k = 2, size(plan%points)
      do i = 1, k - 1
        associate (a => plan%points(i), b => plan%points(k))
          if (a%boundary == 0 .or. a%boundary /= b%boundary) cycle
          length = boundary_length(contours(a%boundary)%boundary)
          apart = modulo(arc_length_at(contours(a%boundary)%boundary, a%position) &
                         - arc_length_at(contours(b%boundary)%boundary, b%position), length)
          if (min(apart, length - apart) > coincidence_tolerance*length) cycle
          at = coordinates_of(contours%boundary, a)
          call fail(error, exit_input, 'two corners of zones'//names_of(a, b)//' coincide at x = '//to_text(at(1)) &
                    //', y = '//to_text(at(2))//': the contour has lost a corner there', &
                    'give zones that fit the new shape, or remesh earlier')
          return
        end associate
      end do
    end do

  contains

    pure function names_of(a, b) result(names)
      type(zone_point_t), intent(in) :: a, b
      character(len=:), allocatable :: names

      names = ''
      if (a%name /= '') names = ' ('//trim(a%name)//', '//trim(b%name)//')'
    end function names_of

  end subroutine refuse_coincident_points

end module zone_plan
