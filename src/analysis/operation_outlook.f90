!> How the part stands to the dies of a later operation as that begins: only the run knows its form then, the deck does not.
module operation_outlook
  use contact_check, only: largest_overlap, words_of
  use contact_outlook, only: look_at_contact, outlook_t
  use dies, only: is_deformable
  use fields, only: displacement_field, pilot_field
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: look_at_beginning, warn_of_overlap

contains

  !> Lines of the table of places and dies. The die that the part begins deepest in is noted, over the length of the side, where it
  !> does so by more than was meant; a contact that goes on from the operation before has a depth of its own.
  subroutine look_at_beginning(scene, solution, table)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(string_t), allocatable, intent(out) :: table(:)   !! (nline)
    type(scene_t) :: now
    type(outlook_t) :: outlook
    integer :: g, k

    allocate (table(0))
    if (.not. scene%fields(displacement_field)%declared) return
    now = scene
    now%mesh%coordinates = present_coordinates(scene, solution)
    do k = 1, size(scene%die_forces)
      associate (die => scene%die_forces(k)%die, component => scene%die_forces(k)%component)
        now%dies(die)%pilot(component) = solution%fields(pilot_field)%value(component, die)
      end associate
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        call look_at_contact(now, group, outlook)
        call add(table, 'contact    '//group%name//': '//words_of(now, group, outlook))
        if (is_deformable(scene%dies(group%die)) .or. maxval(abs(solution%groups(g)%committed)) > 0) cycle
        if (2*outlook%inside > outlook%seen) then
          solution%sunk_group = g
          solution%sunk_depth = 0
          solution%sunk_share = huge(solution%sunk_share)
        else if (outlook%faces .and. outlook%over_side > max(largest_overlap, solution%sunk_share)) then
          solution%sunk_group = g
          solution%sunk_depth = outlook%depth
          solution%sunk_share = outlook%over_side
        end if
      end associate
    end do
  end subroutine look_at_beginning

  !> One line where the part began deep in a die.
  subroutine warn_of_overlap(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)

    if (solution%sunk_group == 0) return
    associate (group => scene%groups(solution%sunk_group))
      if (solution%sunk_depth > 0) then
        call add(warnings, group%name//': the part, as the operation before left it, begins '//to_text(solution%sunk_depth, 3) &
                 //' deep in die '//scene%dies(group%die)%name//', '//to_text(100*solution%sunk_share, 3) &
                 //' % of a side: give the die the height that the part has then, or let it come from further off')
      else
        call add(warnings, group%name//': the part, as the operation before left it, begins within the body of die ' &
                 //scene%dies(group%die)%name//': a die is walked with the part on the left (DIE)')
      end if
    end associate
  end subroutine warn_of_overlap

end module operation_outlook
