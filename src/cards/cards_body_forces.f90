!> BFORC, CENTR and SPRNG on bodies: forces on the volume of bodies, a group of load elements each.
module cards_body_forces
  use card_groups, only: close_group, refuse_second, start_group
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_body_springs, only: volume_of_body
  use field_places, only: refuse_without_field
  use fields, only: displacement_field
  use kinds, only: pi, wp
  use scene, only: axisymmetric, group_t
  use scene_draft, only: draft_t, words_of
  use text, only: string_t
  implicit none
  private
  public :: names_body, read_body_forces

  !> Gauss points of an element: b dv is of the fifth degree along a side.
  integer, parameter :: npoint = 9

contains

  !> All cards `BFORC body X|Y amplitude lic`, `CENTR body density omega lic`, and `SPRNG body X|Y stiffness`.
  subroutine read_body_forces(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t) :: group
    type(string_t), allocatable :: directions(:)
    real(wp) :: omega
    integer :: i, k

    call words_of('X Y', directions)
    do i = 1, size(deck%cards)
      associate (keyword => deck%cards(i)%keyword)
        if (all(keyword /= ['BFORC', 'CENTR', 'SPRNG'])) cycle
        if (keyword == 'SPRNG' .and. .not. names_body(deck, draft, i)) cycle
        call cursor%open(deck%cards(i), diagnostics)
        call start_group(merge('BSPRG', keyword(:5), keyword == 'SPRNG'), draft, group)
        group%rule%n = npoint
        call read_body(cursor, draft, group)
        if (group%is_spring) then
          call read_springs(cursor, draft, directions, group)
        else if (keyword == 'BFORC') then
          call cursor%name('a direction', directions, group%direction)
          call cursor%real('the amplitude of the force per volume', group%amplitude, unit='force/length^3')
          if (group%direction > 0) group%name = group%name//'.'//directions(group%direction)%s
        else
          call cursor%real('the density', group%amplitude, lower=0.0_wp, strict_lower=.true., unit='mass/length^3')
          call cursor%real('the angular velocity', omega, unit='1/time')
          group%amplitude = group%amplitude*omega**2
        end if
      end associate
      k = 0
      if (.not. group%is_spring) call draft%multipliers%find(cursor, 'the name of a LIC', k)
      if (k > 0) then
        group%multiplier = draft%multipliers%item(k)
        group%name = group%name//'/'//draft%multipliers%words(k)%s
      end if
      if (.not. cursor%failed()) call refuse_second(cursor, draft, group, 'this load', diagnostics)
      call close_group(draft, cursor, deck%cards(i), group)
    end do
  end subroutine read_body_forces

  !> The card names a body, not a die: its first field is the name of one.
  pure function names_body(deck, draft, card) result(yes)
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: card
    logical :: yes
    integer :: k

    yes = .false.
    if (size(deck%cards(card)%head%fields) == 0) return
    do k = 1, size(draft%places%words)
      if (draft%places%words(k)%s == deck%cards(card)%head%fields(1)%text) &
        yes = all(draft%places%keywords(k)%s /= ['SIDES', 'DIE  '])
    end do
  end function names_body

  !> Direction, and stiffness of all springs of a body together.
  subroutine read_springs(cursor, draft, directions, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(string_t), intent(in) :: directions(:)
    type(group_t), intent(inout) :: group
    real(wp) :: volume

    call cursor%name('a direction', directions, group%direction)
    if (group%direction == 1 .and. draft%scene%plane_state == axisymmetric) &
      call cursor%fail('the axis holds an axisymmetric body along X, expected Y')
    call cursor%real('the stiffness of the body''s springs', group%stiffness, lower=0.0_wp, strict_lower=.true., &
                     unit='force/length; of the full circumference')
    if (cursor%failed()) return
    group%name = group%name//'/spring.'//directions(group%direction)%s
    if (.not. draft%mesh_sound) return
    volume = volume_of_body(draft%scene, group%connectivity)
    if (draft%scene%plane_state == axisymmetric) volume = 2*pi*volume
    if (volume > 0) group%stiffness = group%stiffness/volume
  end subroutine read_springs

  !> The body whose elements carry the load.
  subroutine read_body(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(group_t), intent(inout) :: group
    integer :: k, g

    allocate (group%connectivity(8, 0))
    call draft%places%find(cursor, 'the name of a body', k, not_of='DIE SIDES')
    if (k == 0) return
    group%name = draft%places%words(k)%s
    if (any(draft%places%keywords(k)%s == ['SIDES', 'DIE  '])) then
      call cursor%fail(''''//group%name//''' is a '//draft%places%keywords(k)%s//', expected a body')
    else
      ! bodies are known before they have a mesh
      do g = 1, size(draft%scene%groups)
        if (draft%scene%groups(g)%name /= group%name) cycle
        group%connectivity = draft%scene%groups(g)%connectivity
        group%host = g
      end do
      call refuse_without_field(cursor, draft, displacement_field, &
                                reshape(group%connectivity, [size(group%connectivity)]), group%name, own=.true.)
    end if
  end subroutine read_body

end module cards_body_forces
