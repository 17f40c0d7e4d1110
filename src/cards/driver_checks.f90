!> What drives the laws of a scene must be there.
module driver_checks
  use diagnostics, only: diagnostics_t
  use driver_lookup, only: driver_of_others, missing_driver
  use element_fields, only: acts_on
  use law_api, only: find_parameter, heat_law, solid_law
  use materials, only: has_number
  use scene, only: host_of, role_body, role_second
  use scene_draft, only: draft_t
  use strategy, only: coupling_monolithic
  implicit none
  private
  public :: refuse_missing_drivers

contains

  !> What drives the law of a body, or of its sides, must be there.
  subroutine refuse_missing_drivers(draft, diagnostics)
    type(draft_t), intent(in) :: draft
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable :: name
    logical :: reported(size(draft%materials%words))
    integer :: g, k

    reported = .false.
    do g = 1, size(draft%scene%groups)
      name = missing_driver(draft%scene, draft%laws, g)
      if (name == 'plastic_work') then
        call refuse(''' (QUINNEY), and its body has none: expected a LAW for solids that flows on the same body')
      else if (name /= '' .and. follows_phases(draft, g)) then
        call refuse(''': expected phases of META on the same body (ADDEL), or TIME here, by which the law finds them itself')
      else if (name /= '') then
        call refuse(''': expected a field, or a state of another element, of that name on its body, found none')
      else if (heats_by_volume(draft, g)) then
        name = 'the change of volume'
        call refuse(''' (SOURCE), and no body of it moves: expected PL8LS on the same body')
      end if
      if (name /= '' .or. draft%scene%strategy%coupling /= coupling_monolithic) cycle
      name = driver_of_others(draft%scene, draft%laws, g)
      if (name /= '') call refuse(''' of another element, which answers to the body that it drives: SOLVE MONOLITHIC cannot '// &
                                  'follow both; expected SOLVE ONCE, or a law that finds it by itself (TIME)')
    end do

  contains

    subroutine refuse(why)
      character(len=*), intent(in) :: why

      do k = 1, size(reported)
        if (draft%materials%item(k) /= draft%scene%groups(g)%material .or. reported(k)) cycle
        reported(k) = .true.
        call diagnostics%add(draft%materials%location(k), 'LAW', ''''//draft%materials%words(k)%s//''' is driven by '''//name//why)
      end do
    end subroutine refuse

  end subroutine refuse_missing_drivers

  !> A law for solids of a steel, which is driven by phases.
  pure function follows_phases(draft, g) result(yes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g   !! number of a group of this law
    logical :: yes

    yes = .false.
    if (draft%scene%groups(g)%material == 0) return
    associate (material => draft%scene%materials(draft%scene%groups(g)%material))
      if (material%law_id == 0) return
      yes = draft%laws(material%law_id)%of_steel .and. draft%laws(material%law_id)%kind == solid_law
    end associate
  end function follows_phases

  !> SOURCE in a law whose bodies all stand still.
  pure function heats_by_volume(draft, g) result(yes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: g   !! number of a group of this law
    logical :: yes
    integer :: k, n, p

    yes = .false.
    if (draft%scene%groups(g)%material == 0) return
    associate (material => draft%scene%materials(draft%scene%groups(g)%material))
      if (material%law_id == 0) return
      p = find_parameter(draft%laws(material%law_id), 'SOURCE')
      if (p == 0 .or. draft%laws(material%law_id)%kind /= heat_law) return
      yes = has_number(material, p)
    end associate
    do n = 1, size(draft%scene%groups)
      if (draft%scene%groups(n)%material /= draft%scene%groups(g)%material) cycle
      do k = 1, size(draft%scene%groups)
        if (host_of(draft%scene, k) /= host_of(draft%scene, n)) cycle
        if (all(draft%scene%groups(k)%role /= [role_body, role_second])) cycle
        yes = yes .and. .not. acts_on(draft%elems(draft%scene%groups(k)%elem_id), 'displacement')
      end do
    end do
  end function heats_by_volume

end module driver_checks
