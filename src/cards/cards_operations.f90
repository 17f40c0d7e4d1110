!> OPERA: operations in a chain, one after the other on the same bodies.
!>
!> Cards before the first OPERA card belong to all operations, those behind an OPERA card to its operation alone. Every operation is
!> read as a deck of its own, from the common cards and its own; names on cards of the others count as used there.
module cards_operations
  use accuracy_rules, only: fineness_t
  use card_names, only: names_t
  use cards_cuts, only: trim_keyword
  use cards_sleep, only: put_to_sleep, sleep_keyword
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use element_fields, only: body_acts_on, list_body_elems
  use fields, only: displacement_field
  use kinds, only: wp
  use remesh, only: remesh_t
  use scene, only: scene_t
  use scene_draft, only: head_location, words_of
  use scene_reader, only: read_scene
  use state_variables, only: name_of_heat_due, state_variable, state_variable_t, total_components, transfer_scalar
  use text, only: string_t
  implicit none
  private
  public :: operations_t, list_operations, read_operation

  character(len=*), parameter :: keyword = 'OPERA'

  !> The operations of a deck.
  type :: operations_t
    !> How many there are; 0 for a deck without any.
    integer :: count = 0
    type(string_t), allocatable :: names(:)
    !> First and last card of each, its own OPERA card among them.
    integer, allocatable :: first(:), last(:)
    !> Time at which each ends, all clocks added up (n) [time]: known once the operation has been read.
    real(wp), allocatable :: ends(:)
    !> Columns of the history of all of them.
    type(string_t), allocatable :: columns(:)
    !> One of them has new meshes, or the deck without any.
    logical :: remeshed = .false.
    !> How fine all of them are made, over what the deck says.
    type(fineness_t) :: fineness
    !> Bodies whose sides have met without a card that gives them contact; not allocated where there are none.
    type(string_t), allocatable :: folding(:)
  end type operations_t

contains

  !> The OPERA cards of a deck, and what must not stand behind them.
  subroutine list_operations(deck, operations, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(operations_t), intent(out) :: operations
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(string_t), allocatable :: refused(:)
    type(names_t) :: names
    type(cursor_t) :: cursor
    type(string_t) :: word(1)
    integer :: i

    do i = 1, size(deck%cards)
      operations%remeshed = operations%remeshed .or. any(deck%cards(i)%keyword == ['REMSH', 'BODY '])
    end do
    call names%clear()
    call list_refused(refused)
    allocate (operations%names(0), operations%first(0), operations%last(0))
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == sleep_keyword) then
        if (operations%count == 0) call diagnostics%add(head_location(deck%cards(i)), sleep_keyword, &
          'bodies sleep in an operation: expected behind an OPERA card')
        if (operations%remeshed) call diagnostics%add(head_location(deck%cards(i)), sleep_keyword, &
          'a body that is asleep keeps the elements of the deck: expected no REMSH and no BODY card')
      end if
      if (deck%cards(i)%keyword == trim_keyword .and. operations%count < 2) call diagnostics%add(head_location(deck%cards(i)), &
        trim_keyword, 'an operation begins with the cut of what the one before has left: expected behind the second OPERA card')
      if (deck%cards(i)%keyword == keyword) then
        call cursor%open(deck%cards(i), diagnostics)
        call names%define(cursor, 'the name of the operation', keyword, i, diagnostics, word(1)%s)
        call cursor%end_card()
        operations%count = operations%count + 1
        operations%names = [operations%names, word]
        operations%first = [operations%first, i]
        operations%last = [operations%last, i]
      else if (operations%count > 0) then
        operations%last(operations%count) = i
        call refuse_shared(deck, i, refused, diagnostics)
      end if
    end do
    allocate (operations%ends(operations%count), source=0.0_wp)
    if (operations%count == 0) return
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == 'TEMPE') call diagnostics%add(head_location(deck%cards(i)), 'TEMPE', &
        'temperatures of a deck with operations are computed: expected ADDEL and START in its place')
    end do
  end subroutine list_operations

  !> What all operations share stands before the first of them.
  subroutine refuse_shared(deck, i, refused, diagnostics)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: i   !! number of the card
    type(string_t), intent(in) :: refused(:)   !! (nkeyword)
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: k

    do k = 1, size(refused)
      if (deck%cards(i)%keyword == refused(k)%s) call diagnostics%add(head_location(deck%cards(i)), refused(k)%s, &
        'all operations share it: expected before the first OPERA card')
    end do
  end subroutine refuse_shared

  !> Keywords of cards that make bodies, their laws' formulations and their state.
  subroutine list_refused(keywords)
    type(string_t), allocatable, intent(out) :: keywords(:)   !! (nkeyword)
    type(elem_t), allocatable :: elems(:)
    type(string_t), allocatable :: made(:)

    call words_of('TITLE STATE SECTN KINEM NODES SIDES BLOCK BODY JOIN ADDEL START ACCURACY', keywords)
    call list_elems(elems)
    call list_body_elems(elems, made)
    keywords = [keywords, made]
  end subroutine list_refused

  !> The scene of an operation, by its number; on another mesh where one is given. Its clock begins where that of the operation
  !> before has ended: those before must have been read. A deck without operations is read as it is.
  subroutine read_operation(deck, operations, k, scene, diagnostics, remesh)
    type(deck_t), intent(inout), target :: deck
    type(operations_t), intent(inout) :: operations
    integer, intent(in) :: k
    type(scene_t), intent(out) :: scene
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(remesh_t), intent(in), optional :: remesh
    type(deck_t), target :: part
    real(wp) :: begins
    integer :: i, mistakes, shared

    if (operations%count == 0) then
      call read_scene(deck, scene, diagnostics, remesh, operations%fineness, operations%folding)
      return
    end if
    part = deck
    do i = operations%first(1), size(part%cards)
      if (i >= operations%first(k) .and. i <= operations%last(k)) cycle
      part%cards(i)%elsewhere = .true.
      ! no reader finds it
      part%cards(i)%keyword = '-'//part%cards(i)%keyword
    end do
    mistakes = diagnostics%count()
    call read_scene(part, scene, diagnostics, remesh, operations%fineness, operations%folding)
    if (diagnostics%count() == mistakes) call put_to_sleep(part, scene, diagnostics)
    scene%operation = k
    scene%operations = operations%count
    scene%operation_name = operations%names(k)%s
    ! multipliers stand in the order of their cards
    shared = 0
    do i = 1, operations%first(1) - 1
      if (deck%cards(i)%keyword == 'LIC') shared = shared + 1
    end do
    scene%multipliers(:min(shared, size(scene%multipliers)))%shared = .true.
    if (diagnostics%count() > mistakes) return
    if (k > 1) call keep_heat_due(scene)
    begins = 0
    if (k > 1) begins = operations%ends(k - 1)
    operations%ends(k) = begins + scene%strategy%end_time
    if (k > 1) call delay(begins, scene)
  end subroutine read_operation

  !> Bodies that deform and conduct heat take over what the operation before has left of the heat of its last step.
  subroutine keep_heat_due(scene)
    type(scene_t), intent(inout) :: scene
    type(elem_t), allocatable :: elems(:)
    type(state_variable_t) :: due
    integer :: g

    if (.not. scene%fields(displacement_field)%declared) return
    call list_elems(elems)
    due = state_variable(name_of_heat_due, 'energy/length^3', transfer_scalar)
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (.not. body_acts_on(elems, group, 'temperature')) cycle
        due%first = total_components(group%variables) + 1
        group%variables = [group%variables, due]
      end associate
    end do
  end subroutine keep_heat_due

  !> Times of an operation count from its beginning; those of a run go on.
  pure subroutine delay(begins, scene)
    real(wp), intent(in) :: begins   !! [time]
    type(scene_t), intent(inout) :: scene
    integer :: i

    scene%strategy%begins = begins
    scene%strategy%end_time = begins + scene%strategy%end_time
    scene%strategy%save_times = begins + scene%strategy%save_times
    if (allocated(scene%strategy%watch_times)) scene%strategy%watch_times = begins + scene%strategy%watch_times
    do i = 1, size(scene%multipliers)
      scene%multipliers(i)%time = begins + scene%multipliers(i)%time
    end do
    if (allocated(scene%remesh%times)) scene%remesh%times = begins + scene%remesh%times
    if (.not. allocated(scene%sources)) return
    do i = 1, size(scene%sources)
      scene%sources(i)%crossing_time = begins + scene%sources(i)%crossing_time
      if (allocated(scene%sources(i)%path)) scene%sources(i)%path(1, :) = begins + scene%sources(i)%path(1, :)
    end do
  end subroutine delay

end module cards_operations
