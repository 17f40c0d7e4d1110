!> Acceptance of a new mesh: shape of the elements, distance to the contour, nodes at the ends of contact.
!>
!> At a corner of the contour that is sharper than the limits no element can be better than the corner itself: there the limits are
!> a share of its own angle and sine. So it is in the corner of a material, where an interface meets the contour or another one.
module new_mesh_check
  use boundary_curves, only: closest_position, joint_point, kind_entry, kind_exit, point_on, size_of_boundary
  use corrected_contours, only: contour_t
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: pi, wp
  use mesh_quality, only: mesh_shape
  use plane_vectors, only: cross
  use remeshing, only: aspect_ratio, largest_angle, least_angle, middle_share, ncriteria, scaled_jacobian
  use sharp_corners, only: share_of_corner
  use text, only: to_text
  use vectors, only: length_of
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: mesh_check_t, check_new_mesh, check_shape

  type :: mesh_check_t
    !> Worst of all elements.
    real(wp) :: scaled_jacobian = 1.0_wp, least_angle = 90.0_wp, largest_angle = 90.0_wp, middle_share = 0.0_wp
    !> Largest ratio of the medians of an element.
    real(wp) :: aspect_ratio = 1.0_wp
    !> Largest distance of a node of the contour from it, over the length of its side.
    real(wp) :: off_contour = 0.0_wp
    !> Largest distance from an end of contact to a node that is an end of sides, a share of the contour.
    real(wp) :: off_ends = 0.0_wp
    !> Angle between two sides of the sharpest corner of the contour, or of a material [degree].
    real(wp) :: sharpest_corner = 180.0_wp
  end type mesh_check_t

  !> Limits of every element; a new mesh stays some way from those at which another one is due (remesh_defaults).
  real(wp), parameter :: least_scaled_jacobian = 0.25_wp, least_angle_allowed = 20.0_wp
  !> Middle nodes lie in the middle third.
  real(wp), parameter :: largest_middle_share = 1.0_wp/3
  !> Nodes lie on the contour within this share of their side.
  real(wp), parameter :: on_contour = 1.0e-8_wp

contains

  subroutine check_new_mesh(contours, mesh, check, error)
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(new_mesh_t), intent(in) :: mesh
    type(mesh_check_t), intent(out) :: check
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: x(2, 3)
    integer :: k, i

    do k = 1, size(mesh%sides)
      x = mesh%coordinates(:, mesh%sides(k)%nodes)
      do i = 1, 3
        associate (boundary => contours(mesh%sides(k)%boundary)%boundary)
          check%off_contour = max(check%off_contour, length_of(point_on(boundary, closest_position(boundary, x(:, i))) - x(:, i)) &
                                  /length_of(x(:, 3) - x(:, 1)))
        end associate
      end do
    end do
    check%off_ends = distance_of_ends(contours, mesh)
    call check_shape(mesh, check, error)
    if (.not. allocated(error) .and. check%off_contour > on_contour) &
      call fail(error, exit_no_convergence, 'remdata: nodes lie off the contour by '//to_text(check%off_contour, 3) &
                //' of their sides')
  end subroutine check_new_mesh

  pure function distance_of_ends(contours, mesh) result(farthest)
    type(contour_t), intent(in) :: contours(:)
    type(new_mesh_t), intent(in) :: mesh
    real(wp) :: farthest
    real(wp) :: point(2), nearest
    integer :: c, k, i

    farthest = 0
    do c = 1, size(contours)
      associate (boundary => contours(c)%boundary)
        do k = 1, size(boundary%arcs)
          if (all(boundary%kinds(k) /= [kind_entry, kind_exit])) cycle
          point = joint_point(boundary, k)
          nearest = huge(nearest)
          do i = 1, size(mesh%sides)
            if (mesh%sides(i)%boundary == c) nearest = min(nearest, length_of(mesh%coordinates(:, mesh%sides(i)%nodes(1)) - point))
          end do
          farthest = max(farthest, nearest/size_of_boundary(boundary))
        end do
      end associate
    end do
  end function distance_of_ends

  !> Shape of the elements alone.
  subroutine check_shape(mesh, check, error)
    type(new_mesh_t), intent(in) :: mesh
    type(mesh_check_t), intent(inout) :: check
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: measures(:, :)
    real(wp) :: corner(size(mesh%connectivity, 2))
    real(wp) :: jacobian_limit(size(mesh%connectivity, 2)), angle_limit(size(mesh%connectivity, 2)), angle
    integer :: e, worst

    allocate (measures(ncriteria, size(mesh%connectivity, 2)))
    call mesh_shape(mesh%coordinates, mesh%connectivity, measures)
    call sharpest_corners(mesh, corner)
    check%scaled_jacobian = minval(measures(scaled_jacobian, :))
    check%least_angle = minval(measures(least_angle, :))
    check%largest_angle = maxval(measures(largest_angle, :))
    check%aspect_ratio = maxval(measures(aspect_ratio, :))
    check%middle_share = maxval(measures(middle_share, :))
    check%sharpest_corner = minval(corner)
    do e = 1, size(angle_limit)
      angle = share_of_corner*corner(e)
      angle_limit(e) = min(least_angle_allowed, angle)
      jacobian_limit(e) = least_scaled_jacobian
      if (angle < least_angle_allowed) jacobian_limit(e) = min(least_scaled_jacobian, sin(angle*pi/180))
    end do
    if (any(measures(scaled_jacobian, :) < jacobian_limit)) then
      worst = minloc(measures(scaled_jacobian, :) - jacobian_limit, 1)
      call refuse('scaled Jacobian '//to_text(measures(scaled_jacobian, worst), 3)//', at least ' &
                  //to_text(jacobian_limit(worst), 3), worst)
    else if (any(measures(least_angle, :) < angle_limit)) then
      worst = minloc(measures(least_angle, :) - angle_limit, 1)
      call refuse('an angle of '//to_text(measures(least_angle, worst), 3)//' degrees, at least ' &
                  //to_text(angle_limit(worst), 3), worst)
    else if (check%middle_share > largest_middle_share) then
      worst = maxloc(measures(middle_share, :), 1)
      call refuse('a middle node outside the middle third of its side', worst)
    end if

  contains

    subroutine refuse(what, element)
      character(len=*), intent(in) :: what
      integer, intent(in) :: element
      real(wp) :: middle(2)

      middle = sum(mesh%coordinates(:, mesh%connectivity(1:4, element)), 2)/4
      call fail(error, exit_no_convergence, 'remdata: the new mesh is of bad shape: '//what//', element at x = ' &
                //to_text(middle(1))//', y = '//to_text(middle(2)), &
                'remesh earlier, or give zones that fit the shape better')
    end subroutine refuse

  end subroutine check_shape

  !> The sharpest corner of its material that an element lies in; 180 where it lies in none [degree].
  pure subroutine sharpest_corners(mesh, sharpest)
    type(new_mesh_t), intent(in) :: mesh
    real(wp), intent(out) :: sharpest(:)   !! (nelem) [degree]
    integer :: material(size(sharpest)), e, m
    integer, allocatable :: sides(:, :), side_of(:)
    real(wp) :: angle(size(mesh%coordinates, 2))

    material = materials_of(mesh)
    call outer_sides(mesh, material, sides, side_of)
    sharpest = 180
    do m = minval(material), maxval(material)
      if (.not. any(material == m)) cycle
      call corners_of(mesh%coordinates, sides(:, pack([(e, e=1, size(side_of))], side_of == m)), angle)
      do e = 1, size(sharpest)
        if (material(e) == m) sharpest(e) = minval(angle(mesh%connectivity(1:4, e)))
      end do
    end do
  end subroutine sharpest_corners

  !> Number of the material of each element; one for all where no zones are known.
  pure function materials_of(mesh) result(material)
    type(new_mesh_t), intent(in) :: mesh
    integer :: material(size(mesh%connectivity, 2))

    material = 1
    if (allocated(mesh%zone) .and. allocated(mesh%layout%zones)) material = mesh%layout%zones(mesh%zone)%material
  end function materials_of

  !> Sides around each material, which lies on their left: of the contour, and of elements that share them with another material.
  pure subroutine outer_sides(mesh, material, sides, side_of)
    type(new_mesh_t), intent(in) :: mesh
    integer, intent(in) :: material(:)                 !! (nelem)
    integer, allocatable, intent(out) :: sides(:, :)   !! (3, nside)
    integer, allocatable, intent(out) :: side_of(:)    !! the material (nside)
    integer :: leaving(size(mesh%coordinates, 2)), next(4*size(material)), e, k, n, other
    integer :: interface_sides(3, 4*size(material)), interface_of(4*size(material))

    leaving = 0
    do e = 1, size(material)
      do k = 1, 4
        n = 4*(e - 1) + k
        next(n) = leaving(mesh%connectivity(k, e))
        leaving(mesh%connectivity(k, e)) = n
      end do
    end do
    n = 0
    do e = 1, size(material)
      do k = 1, 4
        ! the same side of the neighbour begins where this one ends
        other = element_at(mesh%connectivity(mod(k, 4) + 1, e), mesh%connectivity(4 + k, e))
        if (other == 0) cycle
        if (material(other) == material(e)) cycle
        n = n + 1
        interface_sides(:, n) = mesh%connectivity([k, 4 + k, mod(k, 4) + 1], e)
        interface_of(n) = material(e)
      end do
    end do
    allocate (sides(3, size(mesh%sides) + n), side_of(size(mesh%sides) + n))
    do k = 1, size(mesh%sides)
      sides(:, k) = mesh%sides(k)%nodes
      side_of(k) = material(element_at(mesh%sides(k)%nodes(1), mesh%sides(k)%nodes(2)))
    end do
    sides(:, size(mesh%sides) + 1:) = interface_sides(:, :n)
    side_of(size(mesh%sides) + 1:) = interface_of(:n)

  contains

    !> Element with a side that begins at a node and has this middle node; 0 for none.
    pure function element_at(begins, middle) result(element)
      integer, intent(in) :: begins, middle
      integer :: element
      integer :: i

      element = 0
      i = leaving(begins)
      do while (i > 0)
        if (mesh%connectivity(5 + mod(i - 1, 4), (i + 3)/4) == middle) element = (i + 3)/4
        i = next(i)
      end do
    end function element_at

  end subroutine outer_sides

  !> Angle on the left between the two sides that meet at a node; 180 at all other nodes.
  pure subroutine corners_of(x, sides, angle)
    real(wp), intent(in) :: x(:, :)        !! (2, nnode) [length]
    integer, intent(in) :: sides(:, :)     !! (3, nside)
    real(wp), intent(out) :: angle(:)      !! (nnode) [degree]
    real(wp) :: leaving(2, size(angle)), arriving(2, size(angle))
    logical, dimension(size(angle)) :: leaves, arrives
    integer :: k, n

    leaves = .false.
    arrives = .false.
    do k = 1, size(sides, 2)
      ! tangents of the parabola through three nodes at its ends
      associate (first => sides(1, k), middle => sides(2, k), last => sides(3, k))
        leaving(:, first) = 4*x(:, middle) - 3*x(:, first) - x(:, last)
        arriving(:, last) = 3*x(:, last) + x(:, first) - 4*x(:, middle)
        leaves(first) = .true.
        arrives(last) = .true.
      end associate
    end do
    angle = 180
    do n = 1, size(angle)
      if (.not. (leaves(n) .and. arrives(n))) cycle
      angle(n) = 180 - 180/pi*atan2(cross(arriving(:, n), leaving(:, n)), dot_product(arriving(:, n), leaving(:, n)))
    end do
  end subroutine corners_of

end module new_mesh_check
