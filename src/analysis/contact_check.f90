!> How a part stands to a die before the run: in words, and what is seldom meant.
module contact_check
  use acting_causes, only: expands, unloaded
  use contact_outlook, only: lies_on, moves, outlook_t
  use dies, only: is_deformable
  use kinds, only: wp
  use law_api, only: law_t
  use resting_dies, only: has_spring
  use scene, only: group_t, scene_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: judge_contact, largest_overlap, words_of

  !> A part that begins deeper in a rigid die than this share of its side was not meant to.
  real(wp), parameter :: largest_overlap = 0.01_wp

contains

  !> How a group stands to its die.
  function words_of(scene, group, outlook) result(words)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(outlook_t), intent(in) :: outlook
    character(len=:), allocatable :: words

    if (is_deformable(scene%dies(group%die))) then
      words = 'between two bodies'
      return
    else if (.not. outlook%faces) then
      words = 'no side faces the die at the start'
    else if (abs(outlook%over_side) < lies_on) then
      words = 'touches at the start'
    else if (outlook%depth > 0) then
      words = to_text(outlook%depth, 4)//' deep at the start'
    else
      words = 'gap '//to_text(-outlook%depth, 4)//' at the start'
    end if
    if (outlook%faces .and. outlook%depth < 0 .and. is_pushed(scene, group%die, outlook)) words = words//', which its FORCE closes'
    if (.not. moves(scene, group%die) .or. abs(outlook%first) <= 0) return
    if (outlook%first > 0) then
      words = words//', met at about time '//to_text(outlook%first, 3)//' by the die''s motion'
    else
      words = words//', not met by the die''s motion'
    end if
  end function words_of

  !> A force pushes what is free of a die along X or Y to the sides that face it, and no spring holds it there (seating).
  pure function is_pushed(scene, die, outlook) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    type(outlook_t), intent(in) :: outlook
    logical :: yes
    real(wp) :: force
    integer :: k

    yes = .false.
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        if (load%die /= die .or. load%component > 2 .or. load%multiplier == 0) cycle
        if (has_spring(scene, die, load%component)) cycle
        associate (value => scene%multipliers(load%multiplier)%value)
          force = load%amplitude*value(maxloc(abs(value), 1))
        end associate
        yes = yes .or. force*outlook%least_push(load%component) > 0 .or. force*outlook%largest_push(load%component) > 0
      end associate
    end do
  end function is_pushed

  !> Parts in dies, dies walked the wrong way, dies that miss.
  subroutine judge_contact(scene, laws, group, outlook, met, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(group_t), intent(in) :: group
    type(outlook_t), intent(in) :: outlook
    logical, intent(in) :: met   !! its die meets some sides
    type(string_t), allocatable, intent(inout) :: warnings(:)

    associate (die => scene%dies(group%die))
      if (is_deformable(die)) return
      if (2*outlook%inside > outlook%seen) then
        call add(warnings, group%name//': the part begins within the body of die '//die%name &
                 //': a die is walked with the part on the left (DIE)')
      else if (outlook%faces .and. outlook%over_side > largest_overlap) then
        call add(warnings, group%name//': the part begins '//to_text(outlook%depth, 3)//' deep in die '//die%name &
                 //', '//to_text(100*outlook%over_side, 3)//' % of a side, all of it in the first step, however short: let ' &
                 //'the die come from that far off (MOVE), or round what sticks in it')
      else if (moves(scene, group%die) .and. outlook%first < 0) then
        if (.not. met .and. unloaded(scene, group%die) .and. .not. expands(scene, laws)) &
          call add(warnings, group%name//': die '//die%name//' does not meet the part on all its way: moved the other way, ' &
                   //'or the stroke is too short')
      else if (moves(scene, group%die) .and. outlook%faces .and. .not. outlook%faces_at_end) then
        call add(warnings, group%name//': at the end of its motion die '//die%name//' no longer faces the part: the stroke ' &
                 //'leaves it')
      end if
    end associate
  end subroutine judge_contact

end module contact_check
