!> Bodies that have passed through the plane in which a side of theirs is held.
!>
!> A support in one direction alone along a straight side, with all of the body on one side of it, is mostly a plane of symmetry.
!> Where it is no wall (walls) nothing keeps free sides from passing it: the mirror image that they would meet is in no deck, and
!> the run ends with code 0.
module passed_planes
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use support_planes, only: holds_plane
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_passed_planes

  !> Depth behind the plane that is reported, and what counts as none, over the size of the body.
  real(wp), parameter :: deep = 1.0e-3_wp, none = 1.0e-9_wp
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
      if (.not. holds_plane(scene, f)) cycle
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
        if (min(below, above) > none*max(below, above)) cycle
        plane = x(c, scene%fixations(f)%nodes(1))
        if (above > below) then
          depth = plane - minval(x(c, :), body)
        else
          depth = maxval(x(c, :), body) - plane
        end if
        if (depth <= deep*max(above, below)) cycle
        call add_text(warnings, scene%groups(g)%name//' has passed the plane '//axes(c:c)//' = '//to_text(plane, 4)// &
                      ' in which it is held ('//scene%fixations(f)%label//'), by '//to_text(depth, 3)// &
                      advice(scene%fixations(f)%may_pass))
      end do
    end do
  end subroutine warn_of_passed_planes

  !> What follows for the deck.
  pure function advice(may_pass) result(words)
    logical, intent(in) :: may_pass   !! the card lets it
    character(len=:), allocatable :: words

    if (may_pass) then
      words = ', as NOWALL lets it'
    else
      words = ': a plane of symmetry has the mirror image there, let the body face a DIE along it'
    end if
  end function advice

end module passed_planes
