!> START PHASES: the mixture of phases that bodies of steel begin with.
module cards_start_phases
  use cards_fields, only: read_body
  use deck_cursor, only: cursor_t
  use kinds, only: wp
  use phase_state, only: at_coldest, cold_as_mixture, state_names
  use scene, only: group_t, host_of
  use scene_draft, only: draft_t
  use state_variables, only: find_variable
  use steels, only: austenite, martensite, phase_count, phase_names, steel_t, tempered, unknown_temperature
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_start_phases

  !> Shares that are written with few digits may miss 1 by this.
  real(wp), parameter :: slack = 1.0e-9_wp

contains

  !> `PHASES phase share ... [body]`: of one body, or of all. `given` marks the bodies that have such a card.
  subroutine read_start_phases(cursor, draft, given)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    logical, intent(inout) :: given(:)   !! (ngroup)
    type(string_t) :: words(phase_count)
    character(len=:), allocatable :: word
    real(wp) :: z(phase_count)
    integer :: body, g, k, n

    do k = 1, phase_count
      words(k)%s = trim(phase_names(k))
    end do
    call cursor%word('PHASES', word)
    z = -1
    body = 0
    do
      call cursor%name('a phase', words, k)
      if (k == 0) return
      if (z(k) >= 0) call cursor%fail(words(k)%s//' is given twice')
      call cursor%real('the share of '//words(k)%s, z(k), lower=0.0_wp, upper=1.0_wp)
      if (cursor%failed()) return
      if (.not. cursor%more()) exit
      if (any(phase_names == cursor%peek_word())) cycle
      call read_body(cursor, draft, body)
      if (body == 0) return
      exit
    end do
    z = max(0.0_wp, z)
    if (abs(sum(z) - 1) > slack) call cursor%fail('the shares add up to '//to_text(sum(z), 6)//', expected 1')
    if (cursor%failed() .or. .not. draft%groups_sound) return
    n = 0
    do g = 1, size(draft%scene%groups)
      if (body > 0 .and. host_of(draft%scene, g) /= body) cycle
      if (.not. has_phases(draft%scene%groups(g))) cycle
      if (given(g)) call cursor%fail('the phases of '''//draft%scene%groups(host_of(draft%scene, g))%name//''' are given twice')
      if (cursor%failed()) return
      given(g) = .true.
      n = n + 1
      ! a file with mistakes, told at the law, has no steel
      associate (material => draft%scene%materials(draft%scene%groups(g)%material))
        if (allocated(material%steel)) call start_with(material%steel, z/sum(z), draft%scene%groups(g))
      end associate
    end do
    call ask_for_data(cursor, draft, body, z > 0)
    if (n == 0) call cursor%fail('there are no phases to begin with: expected a law that keeps them '// &
                                 '(META, METAMEC, ARBTHMET with TIME)')
  end subroutine read_start_phases

  !> Laws of the body, or of all, that have data of phases have those of the given ones, which need not be among the phases that
  !> form.
  subroutine ask_for_data(cursor, draft, body, given)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: body        !! 0: all
    logical, intent(in) :: given(:)    !! (phase_count)
    type(string_t), allocatable :: problems(:)
    character(len=:), allocatable :: all
    logical :: asked(size(draft%scene%materials))
    integer :: g, i, m

    asked = .false.
    all = ''
    do g = 1, size(draft%scene%groups)
      if (body > 0 .and. host_of(draft%scene, g) /= body) cycle
      m = draft%scene%groups(g)%material
      if (m == 0) cycle
      if (asked(m) .or. draft%scene%materials(m)%law_id == 0) cycle
      asked(m) = .true.
      if (.not. allocated(draft%scene%materials(m)%steel)) cycle
      associate (law => draft%laws(draft%scene%materials(m)%law_id))
        if (.not. associated(law%check_phases)) cycle
        call law%check_phases(draft%scene%materials(m), given, problems)
      end associate
      do i = 1, size(problems)
        all = all//merge('; ', ': ', all /= '')//problems(i)%s
      end do
    end do
    if (all /= '') call cursor%fail('the body begins with phases without numbers'//all)
  end subroutine ask_for_data

  !> The state of a group holds phases.
  pure function has_phases(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = .false.
    if (allocated(group%variables)) yes = find_variable(group%variables, trim(state_names(at_coldest))) > 0
  end function has_phases

  !> The mixture of a group; one with martensite has been cold (phase_step).
  subroutine start_with(steel, z, group)
    type(steel_t), intent(in) :: steel
    real(wp), intent(in) :: z(:)   !! (phase_count) [-]
    type(group_t), intent(inout) :: group
    integer :: k

    do k = 1, phase_count
      group%variables(find_variable(group%variables, trim(state_names(k))))%initial = z(k)
    end do
    if (.not. (any(z([martensite, tempered]) > 0) .and. z(austenite) > 0 .and. steel%ms > unknown_temperature)) return
    group%variables(find_variable(group%variables, trim(state_names(at_coldest))))%initial = cold_as_mixture
  end subroutine start_with

end module cards_start_phases
