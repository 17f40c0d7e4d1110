!> Supports that hold straight sides against motion across them, and across them alone: mostly planes of symmetry.
module support_planes
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: axisymmetric, scene_t
  use text, only: to_text
  implicit none
  private
  public :: holds_plane, plane_beside, wall_beside

  !> Distance of nodes from a straight line, and of a point that is beside one, over the length of the line.
  real(wp), parameter :: straight = 1.0e-9_wp, beside = 1.0e-3_wp
  character(len=*), parameter :: axes = 'xy'

contains

  !> The plane through a point, as `y = 0`; empty where there is none.
  pure function plane_beside(scene, point) result(words)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: point(2)   !! [length]
    character(len=:), allocatable :: words
    integer :: c, f

    words = ''
    if (.not. allocated(scene%mesh%origin)) return
    do f = 1, size(scene%fixations)
      if (.not. holds_plane(scene, f)) cycle
      c = scene%fixations(f)%component
      associate (first => scene%mesh%origin(:, scene%fixations(f)%nodes))
        if (abs(point(c) - first(c, 1)) > beside*(maxval(first(3 - c, :)) - minval(first(3 - c, :)))) cycle
        words = axes(c:c)//' = '//to_text(first(c, 1), 4)
        return
      end associate
    end do
  end function plane_beside

  !> Is the plane through a point a wall?
  pure function wall_beside(scene, point) result(yes)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: point(2)   !! [length]
    logical :: yes
    integer :: k

    yes = .false.
    if (.not. (allocated(scene%walls) .and. allocated(scene%mesh%origin))) return
    do k = 1, size(scene%walls)
      associate (first => scene%mesh%origin(scene%walls(k)%component, :), wall => scene%walls(k))
        yes = yes .or. abs(point(wall%component) - first(wall%node)) <= beside*(maxval(first) - minval(first))
      end associate
    end do
  end function wall_beside

  !> Does a support hold nodes on a straight line against motion across it, and across it alone? The axis is a wall already.
  pure function holds_plane(scene, number, x) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: number
    real(wp), intent(in), optional :: x(:, :)   !! (2, nnode) where nodes are; otherwise where their material began [length]
    logical :: yes
    real(wp) :: extent(2), first(2, size(scene%fixations(number)%nodes))
    integer :: c, f

    associate (one => scene%fixations(number))
      c = one%component
      yes = one%field == displacement_field .and. .not. abs(one%amplitude) > 0 .and. size(one%nodes) > 2
      if (.not. yes) return
      if (present(x)) then
        first = x(:, one%nodes)
      else
        first = scene%mesh%origin(:, one%nodes)
      end if
      extent = maxval(first, 2) - minval(first, 2)
      yes = extent(c) <= straight*extent(3 - c)
      if (c == 1 .and. scene%plane_state == axisymmetric) yes = yes .and. any(abs(first(1, :)) > straight*extent(2))
      do f = 1, size(scene%fixations)
        associate (other => scene%fixations(f))
          if (other%field /= displacement_field .or. other%component == c .or. size(other%nodes) /= size(one%nodes)) cycle
          yes = yes .and. any(other%nodes /= one%nodes)
        end associate
      end do
    end associate
  end function holds_plane

end module support_planes
