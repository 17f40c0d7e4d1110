!> Thickness of the web under a die: the shortest way through a body from where it touches the die to its surface on the other side.
!>
!> From points along the sides in contact the closest points on all free sides of the body are found that lie across: the way leaves
!> the one surface inwards and the other outwards, and the surfaces face away from each other. A side that is off the die by little
!> beside the thickness looked for counts as one that touches: a sheet that is dished leaves the edge of the punch by some
!> micrometres, and its web is there.
module web_thickness
  use bodies, only: elements_at_middles
  use cuts, only: cut_t
  use kinds, only: wp
  use offset_parabolas, only: closest_xi, offset_parabola_t, point_at, tangent_at
  use plane_vectors, only: right_of
  use scene, only: role_contact, scene_t
  use shape_functions, only: quad8_side
  use solution, only: present_coordinates, solution_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: web_t, measure_web

  !> A way through the web, from the die to the other surface.
  type :: web_t
    real(wp) :: thickness = huge(1.0_wp)   !! [length]
    real(wp) :: from(2) = 0.0_wp, to(2) = 0.0_wp   !! [length]
  end type web_t

  !> Points along a side.
  integer, parameter :: samples = 9
  !> Cosine of the angle between the normals of both surfaces, at most: 120 degrees.
  real(wp), parameter :: facing_away = -0.5_wp
  !> Cosine of the angle between the way and the normals, at least: 70 degrees.
  real(wp), parameter :: steepest = 0.34_wp
  !> Gap between the die and a side that counts as touching, as a share of the thickness at which the web parts.
  real(wp), parameter :: near = 0.05_wp

contains

  !> The way from each point in contact with the die of the cut; huge thickness where none leads across.
  pure subroutine measure_web(scene, solution, cut, ways)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(cut_t), intent(in) :: cut
    type(web_t), allocatable, intent(out) :: ways(:)   !! (npoint)
    type(offset_parabola_t), allocatable :: sides(:)
    type(offset_parabola_t) :: side
    real(wp) :: x(2, size(scene%mesh%coordinates, 2))
    logical :: of_body(size(x, 2))
    integer :: g, e, i, n, status, depth

    x = present_coordinates(scene, solution)
    call list_sides(scene, cut%group, x, sides)
    of_body = .false.
    of_body([scene%groups(cut%group)%connectivity]) = .true.
    n = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == cut%die) n = n + samples*size(scene%groups(g)%connectivity, 2)
    end do
    allocate (ways(n))
    n = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), state => solution%groups(g)%committed)
        if (group%die /= cut%die .or. group%role /= role_contact .or. group%material == 0) cycle
        status = group%variables(find_variable(group%variables, 'contact_status'))%first
        depth = group%variables(find_variable(group%variables, 'penetration'))%first
        do e = 1, size(group%connectivity, 2)
          if (.not. of_body(group%connectivity(2, e))) cycle
          ! a point out of reach of the die has no depth
          if (.not. any(nint(state(status, :, e)) > 0 .or. state(depth, :, e) < 0 .and. &
                        state(depth, :, e) >= -near*cut%thickness)) cycle
          side%points = x(:, group%connectivity(:, e))
          do i = 1, samples
            n = n + 1
            ways(n) = way_from(side, -1.0_wp + 2.0_wp*(i - 1)/(samples - 1), sides)
          end do
        end do
      end associate
    end do
    ways = ways(:n)
  end subroutine measure_web

  !> Free sides of a body, it on their left.
  pure subroutine list_sides(scene, body, x, sides)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: body
    real(wp), intent(in) :: x(:, :)
    type(offset_parabola_t), allocatable, intent(out) :: sides(:)
    integer :: sharing(size(x, 2)), e, k, n

    sharing = elements_at_middles(scene, only_of=body)
    allocate (sides(count(sharing == 1)))
    associate (connectivity => scene%groups(body)%connectivity)
      n = 0
      do e = 1, size(connectivity, 2)
        do k = 1, 4
          if (sharing(connectivity(quad8_side(2, k), e)) /= 1) cycle
          n = n + 1
          sides(n)%points = x(:, connectivity(quad8_side(:, k), e))
        end do
      end do
    end associate
  end subroutine list_sides

  !> The shortest way across from a point of a side.
  pure function way_from(side, xi, sides) result(way)
    type(offset_parabola_t), intent(in) :: side
    real(wp), intent(in) :: xi
    type(offset_parabola_t), intent(in) :: sides(:)
    type(web_t) :: way
    real(wp) :: from(2), to(2), inwards(2), outwards(2), along(2), at, distance
    integer :: k

    from = point_at(side, xi)
    inwards = -right_of(tangent_at(side, xi))
    do k = 1, size(sides)
      ! a side lies within its length from its middle
      if (length_of(sides(k)%points(:, 2) - from) - length_of(sides(k)%points(:, 3) - sides(k)%points(:, 1)) > way%thickness) cycle
      at = closest_xi(sides(k), from)
      to = point_at(sides(k), at)
      distance = length_of(to - from)
      if (.not. (distance > 0 .and. distance < way%thickness)) cycle
      along = (to - from)/distance
      outwards = right_of(tangent_at(sides(k), at))
      if (dot_product(along, inwards) < steepest .or. dot_product(along, outwards) < steepest) cycle
      if (-dot_product(inwards, outwards) > facing_away) cycle
      way = web_t(distance, from, to)
    end do
  end function way_from

end module web_thickness
