!> What the summary of a scene says of walls: planes of symmetry that nothing of a body crosses, and why others are none.
module wall_summary
  use bodies, only: bodies_of_nodes
  use scene, only: axisymmetric, is_solid, scene_t
  use text, only: add_text, padded, string_t, to_text
  use walls, only: has_die, has_free_sides, judge_supports, lies_on_both_sides, may_be_passed
  implicit none
  private
  public :: add_walls

  character(len=*), parameter :: axes = 'xy'

contains

  !> A line for the axis, for each wall, and for each straight line in which a body is held that is none.
  subroutine add_walls(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)   !! (nline)
    integer :: verdicts(size(scene%fixations)), body(size(scene%mesh%coordinates, 2)), k, i
    logical :: listed

    if (scene%plane_state == axisymmetric) call add_text(lines, 'wall       '//padded('the axis', 24)//'no body crosses x = 0')
    if (.not. allocated(scene%walls)) return
    body = bodies_of_nodes(scene)
    do k = 1, size(scene%walls)
      associate (wall => scene%walls(k))
        call add_text(lines, 'wall       '//padded(wall%label, 24)//name_of(scene, body == body(wall%node))//' does not cross ' &
                      //line_words(scene, wall%component, wall%node))
      end associate
    end do
    call judge_supports(scene, verdicts)
    do k = 1, size(verdicts)
      associate (fixation => scene%fixations(k))
        listed = any([(scene%walls(i)%label == fixation%label, i=1, size(scene%walls))])
        if (listed) cycle
        select case (verdicts(k))
        case (lies_on_both_sides)
          call add_none('the body lies on both sides of it')
        case (has_free_sides)
          call add_none('free sides of the body lie in it')
        case (has_die)
          call add_none('the body faces a die along it')
        case (may_be_passed)
          call add_none('NOWALL')
        end select
      end associate
    end do

  contains

    subroutine add_none(reason)
      character(len=*), intent(in) :: reason

      associate (fixation => scene%fixations(k))
        call add_text(lines, 'no wall    '//padded(fixation%label, 24) &
                      //line_words(scene, fixation%component, fixation%nodes(1))//': '//reason)
      end associate
    end subroutine add_none

  end subroutine add_walls

  !> The line through a node, as `y = 0`.
  pure function line_words(scene, component, node) result(words)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: component, node
    character(len=:), allocatable :: words

    words = axes(component:component)//' = '//to_text(scene%mesh%coordinates(component, node), 6)
  end function line_words

  !> The bodies of some nodes by their names.
  pure function name_of(scene, is_part) result(words)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: is_part(:)   !! (nnode)
    character(len=:), allocatable :: words
    integer :: g

    words = ''
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      if (.not. is_part(scene%groups(g)%connectivity(1, 1))) cycle
      if (len(words) > 0) words = words//', '
      words = words//scene%groups(g)%name
    end do
  end function name_of

end module wall_summary
