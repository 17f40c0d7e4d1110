!> Contact of a body with itself: sides that face a die which they are pieces of.
!>
!> Where two sides of the curve meet, the points of the one that comes later along the die are pressed on the other, so that each
!> contact acts once. A side meets no piece that it is itself.
module own_contact
  use bodies, only: bodies_of_nodes
  use dies, only: is_deformable
  use scene, only: group_t, is_solid, scene_t
  use text, only: add_text, string_t
  implicit none
  private
  public :: faces_itself, first_group, group_named, list_folding, met_by_itself, passes_itself_advice, passes_itself_words
  public :: pieces_to_meet
  public :: thins_out_advice, thins_out_words

  !> Why a run ends whose body passes through itself where no contact is asked for, and what it needs.
  character(len=*), parameter :: passes_itself_words = 'a body passes through itself', passes_itself_advice = &
    'sides of one body that meet need contact as those of two bodies do, DIE name SIDES place and CNT2D place name law'
  !> Why one ends whose body has thinned to nothing between two of its sides.
  character(len=*), parameter :: thins_out_words = 'a body parts', thins_out_advice = &
    'it has necked there and tears: what holds it back is too much (friction, the gap or the force of a holder, the size of the ' &
    //'blank); PIERC parts a web under a die'

contains

  !> The sides of a group are pieces of their own die: all of them where the first one is.
  pure function faces_itself(scene, group) result(yes)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    logical :: yes

    yes = .false.
    if (group%die == 0 .or. size(group%connectivity, 2) == 0) return
    if (.not. is_deformable(scene%dies(group%die))) return
    yes = any(scene%dies(group%die)%nodes(2, :) == group%connectivity(2, 1))
  end function faces_itself

  !> Sides of a body face this die, which they are pieces of.
  pure function met_by_itself(scene, die) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == die) yes = yes .or. faces_itself(scene, scene%groups(g))
    end do
  end function met_by_itself

  !> Pieces of the die that sides of such a group may meet.
  pure subroutine pieces_to_meet(scene, group, first, may)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: first          !! the sides follow this one in the group
    logical, intent(out) :: may(:, :)   !! (npiece, nside)
    logical :: is_of_group(size(scene%mesh%coordinates, 2))
    integer :: e, k, own

    is_of_group = .false.
    is_of_group(group%connectivity(2, :)) = .true.
    associate (nodes => scene%dies(group%die)%nodes)
      do e = 1, size(may, 2)
        own = findloc(nodes(2, :), group%connectivity(2, first + e - 1), 1)
        do k = 1, size(may, 1)
          may(k, e) = k < own .or. .not. is_of_group(nodes(2, k))
        end do
      end do
    end associate
  end subroutine pieces_to_meet

  !> Bodies whose sides have met without a card that gives them contact, by the name of the first group of each.
  pure subroutine list_folding(scene, names)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: names(:)   !! (nbody)
    integer :: body(size(scene%mesh%coordinates, 2)), d, g

    allocate (names(0))
    if (.not. any(scene%dies%unasked)) return
    body = bodies_of_nodes(scene)
    do g = 1, size(scene%groups)
      do d = 1, size(scene%dies)
        if (.not. scene%dies(d)%unasked) cycle
        if (first_group(scene, body, body(scene%dies(d)%nodes(1, 1))) == g) exit
      end do
      if (d <= size(scene%dies)) call add_text(names, scene%groups(g)%name)
    end do
  end subroutine list_folding

  !> The first group of elements of a body, 0 where there is none.
  pure function first_group(scene, body, b) result(g)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: body(:)   !! (nnode) the body of every node
    integer, intent(in) :: b
    integer :: g

    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g)) .or. size(scene%groups(g)%connectivity, 2) == 0) cycle
      if (body(scene%groups(g)%connectivity(1, 1)) == b) return
    end do
    g = 0
  end function first_group

  !> The group of elements of a name, 0 where there is none, or it has no elements.
  pure function group_named(scene, name) result(g)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    integer :: g

    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g)) .or. size(scene%groups(g)%connectivity, 2) == 0) cycle
      if (scene%groups(g)%name == name) return
    end do
    g = 0
  end function group_named

end module own_contact
