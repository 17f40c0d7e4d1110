!> Bodies that have passed through the plane in which a side of theirs is held.
!>
!> A support in one direction alone along a straight side, with all of the body on one side of it, is mostly a plane of symmetry.
!> Nothing keeps free sides from passing it: the mirror image that they would meet is in no deck, and the run ends with code 0.
module passed_planes
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_passed_planes

  !> Depth behind the plane that is reported, and distance of nodes from one that is straight, over the size of the body.
  real(wp), parameter :: deep = 1.0e-3_wp, straight = 1.0e-9_wp
  character(len=*), parameter :: axes = 'xy'

contains

  !> A line for each body and plane, added to the warnings of a run at its end.
  subroutine warn_of_passed_planes(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), plane, below, above, depth
    logical :: body(size(scene%mesh%coordinates, 2))
    integer :: f, g, c

    if (.not. scene%finite .or. .not. allocated(scene%mesh%origin)) return
    x = present_coordinates(scene, solution)
    do f = 1, size(scene%fixations)
      c = scene%fixations(f)%component
      if (.not. is_plane(scene, f)) cycle
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g))) cycle
        body = .false.
        body([scene%groups(g)%connectivity]) = .true.
        if (.not. any(body(scene%fixations(f)%nodes))) cycle
        associate (first => scene%mesh%origin(c, :), node => scene%fixations(f)%nodes(1))
          below = first(node) - minval(first, body)
          above = maxval(first, body) - first(node)
        end associate
        ! all of it was on one side
        if (min(below, above) > straight*max(below, above)) cycle
        plane = x(c, scene%fixations(f)%nodes(1))
        if (above > below) then
          depth = plane - minval(x(c, :), body)
        else
          depth = maxval(x(c, :), body) - plane
        end if
        if (depth <= deep*max(above, below)) cycle
        call add_text(warnings, scene%groups(g)%name//' has passed the plane '//axes(c:c)//' = '//to_text(plane, 4)// &
                      ' in which it is held ('//scene%fixations(f)%label//'), by '//to_text(depth, 3)// &
                      ': a plane of symmetry has the mirror image there, let the body face a DIE along it')
      end do
    end do
  end subroutine warn_of_passed_planes

  !> Does a support hold nodes on a straight line against motion across it, and across it alone? The axis is a wall already.
  pure function is_plane(scene, number) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: number
    logical :: yes
    real(wp) :: extent(2)
    integer :: c, f

    associate (one => scene%fixations(number))
      c = one%component
      yes = one%field == displacement_field .and. .not. abs(one%amplitude) > 0 .and. size(one%nodes) > 2
      if (.not. yes) return
      associate (first => scene%mesh%origin(:, one%nodes))
        extent = maxval(first, 2) - minval(first, 2)
        yes = extent(c) <= straight*extent(3 - c)
        if (c == 1 .and. scene%plane_state == axisymmetric) yes = yes .and. any(abs(first(1, :)) > straight*extent(2))
      end associate
      do f = 1, size(scene%fixations)
        associate (other => scene%fixations(f))
          if (other%field /= displacement_field .or. other%component == c .or. size(other%nodes) /= size(one%nodes)) cycle
          yes = yes .and. any(other%nodes /= one%nodes)
        end associate
      end do
    end associate
  end function is_plane

end module passed_planes
