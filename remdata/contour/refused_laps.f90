!> Why contours that cross themselves or each other get no new mesh, and what to try.
module refused_laps
  use bodies, only: bodies_of_nodes
  use boundary_curves, only: boundary_curve_t
  use boundary_sides, only: loop_t
  use contour_laps, only: find_laps, lap_t
  use errors, only: error_t, exit_no_convergence, fail
  use loop_group, only: group_of_element
  use scene, only: scene_t
  use side_tags, only: side_tags_t
  use support_planes, only: plane_beside, wall_beside
  use text, only: to_text
  implicit none
  private
  public :: refuse_laps

contains

  !> A contour that crosses itself or another one cannot be meshed.
  subroutine refuse_laps(scene, boundaries, loops, tags, laps, error)
    type(scene_t), intent(in) :: scene
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (ncontour)
    type(loop_t), intent(in) :: loops(:)                  !! (ncontour) sides of the old mesh, and what they are in
    type(side_tags_t), intent(in) :: tags(:)              !! (ncontour)
    type(lap_t), allocatable, intent(inout) :: laps(:)    !! (nlap) found
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: on_die(:, :)
    logical, allocatable :: faces(:, :, :)
    character(len=:), allocatable :: place, plane
    integer :: groups(2), bodies(2), body_of(size(scene%mesh%coordinates, 2)), k, i, g

    allocate (on_die(maxval([1, (size(loops(k)%sides, 2), k=1, size(loops))]), size(loops)), source=0)
    allocate (faces(size(scene%dies), size(on_die, 1), size(loops)), source=.false.)
    do k = 1, size(loops)
      do i = 1, size(loops(k)%sides, 2)
        on_die(i, k) = findloc(tags(k)%on_die(:, i), .true., 1)
        do g = 1, size(scene%groups)
          if (scene%groups(g)%die > 0 .and. tags(k)%on_group(g, i)) faces(scene%groups(g)%die, i, k) = .true.
        end do
      end do
    end do
    call find_laps(boundaries, on_die, faces, laps)
    if (size(laps) == 0) return
    place = 'x = '//to_text(laps(1)%point(1))//', y = '//to_text(laps(1)%point(2))
    groups = [(group_beside(laps(1)%boundaries(k), laps(1)%arcs(k)), k=1, 2)]
    ! groups that are joined are one body
    body_of = bodies_of_nodes(scene)
    bodies = [(body_of(scene%groups(groups(k))%connectivity(1, 1)), k=1, 2)]
    plane = plane_beside(scene, laps(1)%point)
    if (bodies(1) /= bodies(2)) then
      call fail(error, exit_no_convergence, scene%groups(groups(1))%name//' and '//scene%groups(groups(2))%name// &
                ' have gone through each other, at '//place//': their sides there are in no contact with each other', &
                'name these sides of the one body in a die, DIE name SIDES place, and those of the other in its CNT2D')
    else if (len(plane) > 0 .and. wall_beside(scene, laps(1)%point)) then
      call fail(error, exit_no_convergence, &
                'the contour folds over itself on the plane '//plane//' in which '//scene%groups(groups(1))%name// &
                ' is held, at '//place, &
                'remesh earlier, or with smaller elements (SIZE), before the sides that lie on the plane fold')
    else if (len(plane) > 0) then
      call fail(error, exit_no_convergence, &
                'the contour folds onto the plane '//plane//' in which '//scene%groups(groups(1))%name//' is held, at '//place// &
                ': give a DIE along it and a CNT2D of the sides that reach it', &
                'a plane of symmetry has the mirror image there, but a support holds its own side alone')
    else
      call fail(error, exit_no_convergence, &
                'the contour has '//to_text(size(laps))//trim(merge(' laps', ' lap ', size(laps) > 1))//', the first at '//place, &
                'remesh earlier, before the sides fold over each other; sides of one body that meet need contact as those of '// &
                'two bodies do, DIE name SIDES place and CNT2D place name law, those beside the mouth of a fold too')
    end if

  contains

    !> The group of elements behind an arc.
    pure function group_beside(boundary, arc) result(group)
      integer, intent(in) :: boundary, arc
      integer :: group

      associate (elements => loops(boundary)%element)
        group = group_of_element(scene, elements(min(boundaries(boundary)%arcs(arc)%side, size(elements))))
      end associate
    end function group_beside

  end subroutine refuse_laps

end module refused_laps
