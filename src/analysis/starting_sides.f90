!> Sides of a contact as a deck gives them: those of its mesh, or of contours of which the remesher will make one.
module starting_sides
  use kinds, only: wp
  use parabolas, only: part_of
  use plane_vectors, only: cross, left_of
  use scene, only: group_t, is_solid, lacks_mesh, scene_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: sides_at_start, extent_of

  !> Parts of a row of a contour, each as a side of an element.
  integer, parameter :: parts = 16

contains

  !> Nodes of every side, the part on their left, and a point in the part behind it.
  pure subroutine sides_at_start(scene, group, sides, behind)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group                !! of contact
    real(wp), allocatable, intent(out) :: sides(:, :, :)   !! (2, 3, nside) [length]
    real(wp), allocatable, intent(out) :: behind(:, :)     !! (2, nside) [length]

    if (lacks_mesh(scene)) then
      call sides_of_contours(scene, group, sides, behind)
    else
      call sides_of_mesh(scene, group, sides, behind)
    end if
  end subroutine sides_at_start

  pure subroutine sides_of_mesh(scene, group, sides, behind)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), allocatable, intent(out) :: sides(:, :, :), behind(:, :)
    real(wp) :: centre(2, size(scene%mesh%coordinates, 2))
    integer :: g, e, k

    centre = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e))
          do k = 5, 8
            centre(:, nodes(k)) = sum(scene%mesh%coordinates(:, nodes(1:4)), 2)/4
          end do
        end associate
      end do
    end do
    allocate (sides(2, 3, size(group%connectivity, 2)), behind(2, size(group%connectivity, 2)))
    do e = 1, size(group%connectivity, 2)
      sides(:, :, e) = scene%mesh%coordinates(:, group%connectivity(:, e))
      behind(:, e) = centre(:, group%connectivity(2, e))
    end do
  end subroutine sides_of_mesh

  !> The rows of BODY cards that the name of the group has (BODY.1+2/DIE), each in parts.
  pure subroutine sides_of_contours(scene, group, sides, behind)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), allocatable, intent(out) :: sides(:, :, :), behind(:, :)
    real(wp) :: chord(2), depth
    integer :: c, k, i, n, first

    allocate (sides(2, 3, parts*sum([(size(scene%remesher%contours(c)%row), c=1, size(scene%remesher%contours))])))
    allocate (behind(2, size(sides, 3)))
    n = 0
    do c = 1, size(scene%remesher%contours)
      associate (contour => scene%remesher%contours(c))
        first = n + 1
        do k = 1, size(contour%row)
          if (.not. has_row(group%name, scene%groups(contour%group)%name, contour%row(k))) cycle
          do i = 1, parts
            n = n + 1
            sides(:, :, n) = part_of(contour%pieces(:, :, k), -1 + 2*real(i - 1, wp)/parts, -1 + 2*real(i, wp)/parts)
          end do
        end do
        depth = 0.5_wp*mean_thickness(contour%pieces)
        do i = first, n
          chord = sides(:, 3, i) - sides(:, 1, i)
          behind(:, i) = sides(:, 2, i) + depth*left_of(chord)
        end do
      end associate
    end do
    sides = sides(:, :, :n)
    behind = behind(:, :n)
  end subroutine sides_of_contours

  !> Twice the area of a closed contour over its length: the thickness of a strip, half the side of a square [length].
  pure function mean_thickness(pieces) result(thickness)
    real(wp), intent(in) :: pieces(:, :, :)
    real(wp) :: thickness
    real(wp) :: length
    integer :: k

    thickness = 0
    length = 0
    do k = 1, size(pieces, 3)
      thickness = thickness + cross(pieces(:, 1, k) - pieces(:, 1, 1), pieces(:, 3, k) - pieces(:, 1, 1))
      length = length + length_of(pieces(:, 3, k) - pieces(:, 1, k))
    end do
    thickness = abs(thickness)/length
  end function mean_thickness

  !> A group's name has a side of a body: BODY.1+2/DIE has 1 and 2.
  pure function has_row(name, body, row) result(yes)
    character(len=*), intent(in) :: name, body
    integer, intent(in) :: row
    logical :: yes

    yes = index(name, body//'.') == 1 .and. index(name, '/') > len(body) + 1
    if (.not. yes) return
    yes = index('+'//name(len(body) + 2:index(name, '/') - 1)//'+', '+'//to_text(row)//'+') > 0
  end function has_row

  !> Diagonal of the box around all parts [length].
  pure function extent_of(scene) result(diagonal)
    type(scene_t), intent(in) :: scene
    real(wp) :: diagonal
    real(wp) :: low(2), high(2)
    integer :: c

    if (lacks_mesh(scene)) then
      low = huge(low)
      high = -huge(high)
      do c = 1, size(scene%remesher%contours)
        associate (pieces => scene%remesher%contours(c)%pieces)
          low = min(low, minval(minval(pieces, 3), 2))
          high = max(high, maxval(maxval(pieces, 3), 2))
        end associate
      end do
    else
      low = minval(scene%mesh%coordinates, 2)
      high = maxval(scene%mesh%coordinates, 2)
    end if
    diagonal = length_of(high - low)
  end function extent_of

end module starting_sides
