!> Rigid dies that go, by the motions a deck gives them, where supports hold the part in place: what is there cannot give way, and
!> the die goes into it against the penalty of contact alone.
module pressed_supports
  use contact_check, only: largest_overlap
  use contact_outlook, only: depth_of_node, moves
  use dies, only: is_deformable
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: group_t, lacks_mesh, pilot_at, scene_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: judge_pressed_supports

  !> Instants at which a die is looked at.
  integer, parameter :: ninstant = 200

contains

  !> A line for each contact with a rigid die that gets deeper, by its motion, in a node that supports hold along X and Y than a
  !> part may begin in it.
  subroutine judge_pressed_supports(scene, warnings)
    type(scene_t), intent(in) :: scene                          !! as the deck gives it
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    logical :: held(2, size(scene%mesh%coordinates, 2))
    integer :: f, g

    if (lacks_mesh(scene)) return
    held = .false.
    do f = 1, size(scene%fixations)
      associate (support => scene%fixations(f))
        if (support%field /= displacement_field .or. abs(support%amplitude) > 0) cycle
        held(support%component, support%nodes) = .true.
      end associate
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        if (is_deformable(scene%dies(group%die)) .or. .not. moves(scene, group%die)) cycle
        if (any(scene%die_forces%die == group%die)) cycle
        call judge_group(scene, group, all(held, 1), warnings)
      end associate
    end do
  end subroutine judge_pressed_supports

  !> The first instant at which a die is too deep in a held node, and the node.
  subroutine judge_group(scene, group, held, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    logical, intent(in) :: held(:)   !! (nnode) along X and Y
    type(string_t), allocatable, intent(inout) :: warnings(:)
    logical, dimension(3, size(group%connectivity, 2)) :: free_before
    real(wp) :: time, over_side
    integer :: i, e, k

    free_before = .false.
    do i = 0, ninstant
      time = scene%strategy%begins + (scene%strategy%end_time - scene%strategy%begins)*i/ninstant
      do e = 1, size(group%connectivity, 2)
        do k = 1, 3
          associate (node => group%connectivity(k, e))
            if (.not. held(node)) cycle
            call depth_of_node(scene, group, e, k, pilot_at(scene, group%die, time), over_side)
            if (over_side <= largest_overlap) then
              free_before(k, e) = .true.
            else if (free_before(k, e)) then
              associate (place => scene%mesh%coordinates(:, node))
                call add(warnings, group%name//': by its motion die '//scene%dies(group%die)%name//' goes, from about time ' &
                         //to_text(time, 3)//' on, into a node at '//to_text(place(1), 4)//' '//to_text(place(2), 4) &
                         //' that supports hold (FIXED): it cannot give way, and forces are those of the penalty')
              end associate
              return
            end if
          end associate
        end do
      end do
    end do
  end subroutine judge_group

end module pressed_supports
