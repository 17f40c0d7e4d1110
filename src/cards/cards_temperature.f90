!> TEMPE: the temperature of a body, and the check that laws which need one have it.
module cards_temperature
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: acts_on
  use kinds, only: wp
  use law_api, only: asks_for, law_t
  use materials, only: material_t
  use scene_draft, only: close_card, draft_t
  implicit none
  private
  public :: read_temperatures_of_bodies, knows_temperature

contains

  !> All TEMPE cards: `body amplitude lic`.
  subroutine read_temperatures_of_bodies(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    real(wp) :: amplitude
    integer :: i, k, g, before

    before = diagnostics%count()
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'TEMPE') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call draft%places%find(cursor, 'the name of a body', k)
      g = 0
      if (k > 0) g = body_group(draft, draft%places%words(k)%s)
      if (k > 0 .and. g == 0) call cursor%fail(''''//draft%places%words(k)%s//''' is a '//draft%places%keywords(k)%s &
                                               //', expected a body')
      if (g > 0) call check_body(cursor, draft, g)
      call cursor%real('the amplitude of the temperature', amplitude, unit='temperature')
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      call close_card(draft, cursor, deck%cards(i))
      if (cursor%failed()) cycle
      draft%scene%groups(g)%temperature_amplitude = amplitude
      draft%scene%groups(g)%temperature_multiplier = draft%multipliers%item(k)
    end do
    if (diagnostics%count() == before) call refuse_bodies_without(draft, diagnostics)
  end subroutine read_temperatures_of_bodies

  !> The group of a body, 0 for other places.
  pure function body_group(draft, name) result(g)
    type(draft_t), intent(in) :: draft
    character(len=*), intent(in) :: name
    integer :: g

    do g = 1, size(draft%scene%groups)
      if (draft%scene%groups(g)%name == name .and. draft%scene%groups(g)%die == 0) return
    end do
    g = 0
  end function body_group

  !> One temperature for a body, and only where its law uses it.
  subroutine check_body(cursor, draft, g)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g
    integer :: law

    associate (group => draft%scene%groups(g))
      if (has_field(draft, g)) call cursor%fail('the temperature of '//group%name//' is an unknown of this scene')
      if (group%temperature_multiplier > 0) call cursor%fail('the temperature of '''//group%name//''' is given twice')
      if (group%material == 0) return
      associate (material => draft%scene%materials(group%material))
        law = material%law_id
        if (law == 0) return
        if (size(material%values) == 0) return
        if (.not. knows_temperature(draft%laws(law), material)) &
          call cursor%fail('LAW '//material%name//' of body '//group%name//' is given at no temperature')
      end associate
    end associate
  end subroutine check_body

  !> A formulation on the body has the temperature among its unknowns.
  pure function has_field(draft, g) result(yes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g   !! number of a body
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(draft%scene%groups)
      if (k /= g .and. draft%scene%groups(k)%host /= g) cycle
      yes = yes .or. acts_on(draft%elems(draft%scene%groups(k)%elem_id), 'temperature')
    end do
  end function has_field

  subroutine refuse_bodies_without(draft, diagnostics)
    type(draft_t), intent(in) :: draft
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: g, k

    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        if (group%material == 0 .or. group%temperature_multiplier > 0 .or. has_field(draft, g)) cycle
        associate (material => draft%scene%materials(group%material))
          if (material%law_id == 0) cycle
          if (.not. knows_temperature(draft%laws(material%law_id), material)) cycle
          do k = 1, size(draft%places%words)
            if (draft%places%words(k)%s /= group%name) cycle
            call diagnostics%add(draft%places%location(k), draft%places%keywords(k)%s, 'LAW '//material%name//reason(material) &
                                 //': body '//group%name//' needs a TEMPE card')
          end do
        end associate
      end associate
    end do
  end subroutine refuse_bodies_without

  pure function reason(material) result(s)
    type(material_t), intent(in) :: material
    character(len=:), allocatable :: s

    if (allocated(material%temperatures)) then
      s = ' is given at several temperatures'
    else
      s = ' asks for the temperature'
    end if
  end function reason

  !> The response of a material depends on the temperature.
  pure function knows_temperature(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes

    yes = allocated(material%temperatures) .or. asks_for(law, 'temperature')
  end function knows_temperature

end module cards_temperature
