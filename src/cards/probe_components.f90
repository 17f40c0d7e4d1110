!> Components of the state of points, measures of stress and words of nodal fields on PROBE cards.
module probe_components
  use cards_fields, only: field_words
  use deck_cursor, only: cursor_t
  use probes, only: probe_t
  use scene, only: group_t
  use scene_draft, only: draft_t
  use state_variables, only: component_names, find_variable, state_variable_t
  use stress_measures, only: measure_names, nmeasure
  use text, only: string_t
  implicit none
  private
  public :: find_component, read_component, set_component

contains

  !> A component of the state of any group; or, where `field` is there, the word of a field of nodes.
  subroutine read_component(cursor, draft, component, field)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    character(len=:), allocatable, intent(out) :: component
    integer, intent(out), optional :: field   !! its place in the scene's list, 0 for a component
    type(string_t), allocatable :: known(:), names(:)
    integer, allocatable :: place(:)
    integer :: g, k

    if (present(field)) field = 0

    if (.not. draft%groups_sound) then
      call cursor%word('a component of the state', component)
      return
    end if
    allocate (known(0))
    if (present(field)) then
      call field_words(draft%scene%fields, place, known)
      do k = 1, size(known)
        if (known(k)%s == cursor%peek_word()) field = place(k)
      end do
    end if
    do g = 1, size(draft%scene%groups)
      call component_names(draft%scene%groups(g)%variables, names)
      known = [known, names]
      if (find_variable(draft%scene%groups(g)%variables, 'stress') == 0) cycle
      do k = 1, nmeasure
        known = [known, string_t(trim(measure_names(k)))]
      end do
    end do
    call cursor%name('a component of the state', known, k)
    component = ''
    if (k > 0) component = known(k)%s
  end subroutine read_component

  pure function find_component(group, component) result(k)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: component
    type(string_t), allocatable :: names(:)
    integer :: k

    call component_names(group%variables, names)
    do k = 1, size(names)
      if (names(k)%s == component) return
    end do
    k = 0
    if (find_measure(component) == 0) return
    k = find_variable(group%variables, 'stress')
    if (k > 0) k = group%variables(k)%first
  end function find_component

  !> Place of a word among the measures of stress, 0 where it is none.
  pure function find_measure(word) result(k)
    character(len=*), intent(in) :: word
    integer :: k

    do k = nmeasure, 1, -1
      if (measure_names(k) == word) return
    end do
  end function find_measure

  !> What the probe reads of a group that has it.
  pure subroutine set_component(group, component, probe)
    type(group_t), intent(in) :: group
    character(len=*), intent(in) :: component
    type(probe_t), intent(inout) :: probe

    probe%component = find_component(group, component)
    probe%measure = find_measure(component)
    probe%unit = unit_of(group%variables, probe%component)
  end subroutine set_component

  pure function unit_of(variables, component) result(unit)
    type(state_variable_t), intent(in) :: variables(:)
    integer, intent(in) :: component
    character(len=:), allocatable :: unit
    integer :: k

    unit = '-'
    do k = 1, size(variables)
      if (component >= variables(k)%first .and. component < variables(k)%first + variables(k)%ncomp) unit = variables(k)%unit
    end do
  end function unit_of

end module probe_components
