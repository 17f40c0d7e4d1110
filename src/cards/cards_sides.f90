!> CNT2D and PRES2D: elements that lie on sides of bodies.
module cards_sides
  use card_groups, only: append_group, close_group, refuse_second, start_group
  use card_places, only: numbers_after_name, read_sides
  use cards_laws, only: read_material
  use contact_penalties, only: tangential_share
  use contact_rule, only: rule_on_body, rule_on_die
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use dies, only: is_deformable
  use kinds, only: wp
  use law_api, only: contact_law, find_parameter, is_complete, law_of_material
  use quadrature, only: rule_along, rule_control, rule_of_number, rule_t
  use scene, only: group_t
  use scene_draft, only: close_card, draft_t, find_elem
  use text, only: to_text, upper_case
  implicit none
  private
  public :: read_contacts, read_pressures, refuse_inner_sides

  !> Points of a side: Gauss, or at equal distances with the ends (negative).
  integer, parameter :: rules(10) = [2, 3, 4, -3, -5, -9, -17, -33, -65, -129]
  !> A body that faces another one presses as if it were so many times stiffer than that at most.
  real(wp), parameter :: bears = 10.0_wp
  character(len=*), parameter :: equal_distances = '-3, -5, -9, -17, -33, -65 or -129'

contains

  !> All CNT2D cards: `place die npoint law`, a group each.
  subroutine read_contacts(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t) :: group
    character(len=:), allocatable :: label
    integer :: i, k, law

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'CNT2D') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call start_group('CNT2D', draft, group)
      if (is_side_die(draft, cursor%peek_word())) then
        call read_own_sides(cursor, draft, label, group%connectivity)
      else
        call read_sides(cursor, draft, huge(k), label, group%connectivity)
      end if
      call refuse_inner_sides(cursor, draft, group%connectivity)
      call draft%places%find(cursor, 'the name of a DIE', k, of='DIE')
      if (k > 0) then
        if (draft%places%keywords(k)%s /= 'DIE') &
          call cursor%fail(''''//draft%places%words(k)%s//''' is a '//draft%places%keywords(k)%s//', expected a DIE')
        group%die = draft%places%item(k)
        group%name = label//'/'//draft%places%words(k)%s
      end if
      if (.not. cursor%failed() .and. draft%mesh_sound) call face_sides(cursor, draft, group)
      if (cursor%next_is_number()) then
        call read_rule(cursor, group%rule)
      else if (cursor%peek_word() == 'ALONG') then
        call read_along(cursor, group)
      else if (cursor%peek_word() == 'BEZIER') then
        call read_bezier(cursor, group)
      else if (.not. cursor%failed()) then
        group%rule_is_chosen = .true.
      end if
      call read_material(cursor, draft, contact_law, group%material)
      if (.not. cursor%failed()) call refuse_glued_control_points(cursor, draft, group)
      if (.not. cursor%failed()) call refuse_second_contact(cursor, draft, group, diagnostics)
      if (.not. cursor%failed()) call refuse_bodies_without_flow(cursor, draft, group)
      call close_card(draft, cursor, deck%cards(i))
      law = 0
      if (.not. cursor%failed()) law = draft%scene%materials(group%material)%law_id
      if (law == 0) then
        draft%groups_sound = .false.
        cycle
      end if
      if (group%rule_is_chosen .and. group%pairs > 0) then
        group%rule = rule_on_body(draft%scene, group)
      else if (group%rule_is_chosen) then
        group%rule = rule_on_die(draft%scene, group%die, draft%laws(law)%lasts)
      end if
      deallocate (group%variables)
      call draft%elems(group%elem_id)%variables(law_of_material(draft%laws(law), draft%scene%materials(group%material)), &
                                                       draft%scene%plane_state, group%variables)
      group%modulus = modulus_behind(draft, group%connectivity)
      if (group%pairs > 0 .and. draft%mesh_sound) &
        group%modulus = borne_by_other(group%modulus, modulus_behind(draft, draft%scene%dies(group%die)%nodes))
      group%tangential_share = tangential_share(draft%laws(law), draft%scene%materials(group%material))
      call append_group(draft, group, cursor%where())
    end do
  end subroutine read_contacts

  !> Contact by end nodes and control points is one that opens: what is glued does not fold.
  subroutine refuse_glued_control_points(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(group_t), intent(in) :: group

    if (group%rule%family /= rule_control) return
    associate (law => draft%laws(draft%scene%materials(group%material)%law_id))
      if (law%lasts) call cursor%fail('BEZIER is for laws whose contact opens, '//law%name//' holds what it has touched: -3')
    end associate
  end subroutine refuse_glued_control_points

  !> A word is the name of a die made of sides.
  pure function is_side_die(draft, word) result(yes)
    type(draft_t), intent(in) :: draft
    character(len=*), intent(in) :: word
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(draft%scene%dies)
      associate (die => draft%scene%dies(k))
        if (is_deformable(die)) yes = yes .or. upper_case(die%name) == word
      end associate
    end do
  end function is_side_die

  !> The sides of a die, which face one another.
  subroutine read_own_sides(cursor, draft, label, sides)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    character(len=:), allocatable, intent(out) :: label
    integer, allocatable, intent(out) :: sides(:, :)   !! (3, nside)
    integer :: k

    call draft%places%find(cursor, 'the name of a DIE', k, of='DIE')
    allocate (sides(3, 0))
    label = draft%places%words(k)%s
    if (draft%mesh_sound) sides = draft%scene%dies(draft%places%item(k))%nodes([3, 2, 1], :)
  end subroutine read_own_sides

  !> A die made of sides: another ELEM. Sides that face sides of their own body are all among these, or none.
  subroutine face_sides(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(group_t), intent(inout) :: group
    integer :: k, own

    associate (die => draft%scene%dies(group%die))
      if (.not. is_deformable(die)) return
      group%elem = 'CNTDF'
      group%elem_id = find_elem(draft%elems, group%elem)
      group%pairs = maxval([0, draft%scene%groups%pairs]) + 1
      own = 0
      do k = 1, size(group%connectivity, 2)
        if (any(die%nodes(2, :) == group%connectivity(2, k))) own = own + 1
      end do
      if (own > 0 .and. own < size(group%connectivity, 2)) &
        call cursor%fail('some of these sides belong to the DIE '''//die%name//''' themselves: expected all of them, or none')
    end associate
  end subroutine face_sides

  !> All PRES2D cards: `place npoint amplitude lic`, a group each.
  subroutine read_pressures(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(group_t) :: group
    character(len=:), allocatable :: label
    integer :: i, k

    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'PRES2D') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call start_group('PRES2D', draft, group)
      ! The two numbers before the multiplier are not sides.
      call read_sides(cursor, draft, numbers_after_name(deck%cards(i)) - 2, label, group%connectivity)
      call refuse_inner_sides(cursor, draft, group%connectivity)
      call read_rule(cursor, group%rule)
      call cursor%real('the amplitude of the pressure', group%amplitude, unit='stress')
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      if (k > 0) then
        group%multiplier = draft%multipliers%item(k)
        group%name = label//'/'//draft%multipliers%words(k)%s
        call refuse_second(cursor, draft, group, 'this pressure', diagnostics)
      end if
      call close_group(draft, cursor, deck%cards(i), group)
    end do
  end subroutine read_pressures

  !> The word for the nodes of a side and what is deeper between them (contact_between).
  subroutine read_along(cursor, group)
    type(cursor_t), intent(inout) :: cursor
    type(group_t), intent(inout) :: group
    character(len=:), allocatable :: word

    call cursor%word('ALONG', word)
    if (group%pairs > 0) call cursor%fail('ALONG is for rigid dies; against a body the points are chosen without it')
    group%rule = rule_t(rule_along, 3)
  end subroutine read_along

  !> The word for the nodes of a side with a control point in place of the middle one.
  subroutine read_bezier(cursor, group)
    type(cursor_t), intent(inout) :: cursor
    type(group_t), intent(inout) :: group
    character(len=:), allocatable :: word

    call cursor%word('BEZIER', word)
    if (group%pairs > 0) call cursor%fail('BEZIER is for rigid dies; against a body the points are chosen without it')
    group%rule = rule_t(rule_control, 3)
  end subroutine read_bezier

  subroutine read_rule(cursor, rule)
    type(cursor_t), intent(inout) :: cursor
    type(rule_t), intent(out) :: rule
    integer :: npoint

    call cursor%integer('the number of integration points, 2, 3, 4, '//equal_distances, npoint)
    if (all(rules /= npoint)) call cursor%fail('expected 2, 3 or 4 Gauss points, or '//equal_distances &
                                               //' for points at equal distances, found '//to_text(npoint))
    rule = rule_of_number(npoint)
  end subroutine read_rule

  !> Nothing from outside can act on a side between two elements, nor on one of an element that is not there. Beside a body that is
  !> asleep a side is free, such as the top of a weld pass before the next one is laid.
  subroutine refuse_inner_sides(cursor, draft, sides)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: sides(:, :)   !! (3, nside)
    integer :: k

    do k = 1, size(sides, 2)
      if (draft%sharing(sides(2, k)) == 1 .and. draft%beginning(sides(2, k)) == sides(1, k)) cycle
      if (draft%sharing(sides(2, k)) > 1) then
        call cursor%fail('this place is inside the part: one of its sides belongs to two elements')
      else
        call cursor%fail('one of its sides belongs to a body that is asleep: expected it in operations that have the body')
      end if
      return
    end do
  end subroutine refuse_inner_sides

  !> A side faces a die once.
  subroutine refuse_second_contact(cursor, draft, group, diagnostics)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(group_t), intent(in) :: group
    type(diagnostics_t), intent(in), target :: diagnostics
    logical :: facing(size(draft%scene%mesh%labels))
    integer :: g

    if (.not. draft%mesh_sound) return
    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%die /= group%die) cycle
      facing = .false.
      facing(draft%scene%groups(g)%connectivity(2, :)) = .true.
      if (any(facing(group%connectivity(2, :)))) &
        call cursor%fail('one of these sides faces this die already, see '//diagnostics%place(draft%group_where(g)))
    end do
  end subroutine refuse_second_contact

  !> Friction by the factor M is a share of the flow stress behind the side: the body's law must have one.
  subroutine refuse_bodies_without_flow(cursor, draft, group)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(group_t), intent(in) :: group
    integer :: s, place

    associate (material => draft%scene%materials(group%material))
      if (material%law_id == 0) return
      place = find_parameter(draft%laws(material%law_id), 'M')
      if (place == 0) return
      if (.not. material%values(place) < huge(1.0_wp)) return
    end associate
    do s = 1, size(group%connectivity, 2)
      associate (material => draft%scene%materials(draft%owner(group%connectivity(2, s))))
        if (material%law_id == 0) cycle
        if (associated(draft%laws(material%law_id)%flow_stress)) cycle
        call cursor%fail('its friction M is a share of the flow stress, and LAW '''//material%name//''' ('//material%law &
                         //') of the body has none')
        return
      end associate
    end do
  end subroutine refuse_bodies_without_flow

  !> Largest Young's modulus of the bodies that the sides belong to, at the first temperature of their cards.
  pure function modulus_behind(draft, sides) result(modulus)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: sides(:, :)
    real(wp) :: modulus
    integer :: k
    real(wp) :: young, poisson, temperature

    modulus = 0
    do k = 1, size(sides, 2)
      associate (material => draft%scene%materials(draft%owner(sides(2, k))))
        if (material%law_id == 0) cycle
        associate (law => draft%laws(material%law_id))
          if (.not. associated(law%elastic) .or. .not. is_complete(law, material)) cycle
          temperature = 0
          if (allocated(material%temperatures)) temperature = material%temperatures(1)
          call law%elastic(material, temperature, young, poisson)
        end associate
        modulus = max(modulus, young)
      end associate
    end do
  end function modulus_behind

  !> The modulus of a body that faces another one, no more than `bears` times that of the other where this is known: what is so much
  !> softer bears no more pressure than makes the allowed penetration, and a contact stiffer than both of them changes its forces by
  !> round-off of the depth.
  elemental function borne_by_other(own, other) result(modulus)
    real(wp), intent(in) :: own, other   !! 0: not known [stress]
    real(wp) :: modulus

    modulus = own
    if (other > 0) modulus = min(own, bears*other)
  end function borne_by_other

end module cards_sides
