!> From the cards TITLE, KINEM, LAW and PATH of a deck to the path of a material point.
module point_reader
  use cards_head, only: read_kinematics, read_title
  use cards_laws, only: read_laws, read_material
  use cards_temperature, only: knows_temperature
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t, refuse_unknown
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use law_api, only: driver_count, law_of_material, law_t, solid_law
  use point_paths, only: point_path_t, ramp_t
  use scene_draft, only: close_card, draft_t, only_card, start_draft, words_of
  use state_variables, only: find_variable
  use text, only: string_t
  implicit none
  private
  public :: read_point

  !> More steps than this between two rows are an error of input.
  integer, parameter :: most_steps = 1000000

contains

  !> Fill `path` from the cards. It is only of use when `diagnostics` has no mistakes afterwards.
  subroutine read_point(deck, path, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(point_path_t), intent(out) :: path
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(draft_t) :: draft
    type(string_t), allocatable :: keywords(:)
    type(cursor_t) :: cursor
    integer :: k

    call start_draft(draft)
    call words_of('TITLE KINEM LAW PATH', keywords)
    call refuse_unknown(deck, keywords, diagnostics)
    call read_title(deck, draft, diagnostics)
    call read_kinematics(deck, draft, diagnostics)
    call read_laws(deck, draft, diagnostics)
    path%title = draft%scene%title
    path%kinematics_id = draft%scene%kinematics_id
    allocate (path%ramps(0))
    call only_card(deck, 'PATH', diagnostics, k, 'the name of a law, and rows with the way of its stress or strain')
    if (k > 0) then
      call cursor%open(deck%cards(k), diagnostics)
      call read_path(cursor, draft, diagnostics, path)
      call close_card(draft, cursor, deck%cards(k))
    end if
    call draft%materials%refuse_unused('LAW', '', diagnostics)
  end subroutine read_point

  !> `law [T temperature]`, then rows.
  subroutine read_path(cursor, draft, diagnostics, path)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(in), target :: diagnostics
    type(point_path_t), intent(inout) :: path
    type(string_t), allocatable :: words(:)
    type(ramp_t) :: ramp
    integer :: material, k

    call words_of('T', words)
    call read_material(cursor, draft, solid_law, material)
    if (cursor%more()) then
      call cursor%name('T and the temperature at the start', words, k)
      call cursor%real('the temperature at the start', path%temperature)
      path%has_temperature = .true.
    end if
    if (material > 0) then
      path%material = draft%scene%materials(material)
      call check_temperature(cursor, draft, path)
      call check_drivers(cursor, draft, path)
    end if
    ramp%temperature = path%temperature
    do
      call cursor%next_row('time, number of steps, then E or S and a value for each of xx, yy, xy, zz')
      call read_ramp(cursor, path, ramp)
      if (cursor%failed()) return
      ramp%where_defined = diagnostics%place(cursor%where())
      path%ramps = [path%ramps, ramp]
      if (.not. cursor%more_rows()) exit
    end do
  end subroutine read_path

  !> A temperature is given where the law wants one, and nowhere else.
  subroutine check_temperature(cursor, draft, path)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(point_path_t), intent(in) :: path

    if (path%material%law_id == 0 .or. size(path%material%values) == 0) return
    if (knows_temperature(draft%laws(path%material%law_id), path%material) .eqv. path%has_temperature) return
    if (path%has_temperature) then
      call cursor%fail('LAW '//path%material%name//' does not depend on the temperature')
    else
      call cursor%fail('LAW '//path%material%name//' depends on the temperature: expected T and the one at the start')
    end if
  end subroutine check_temperature

  !> A point has no other formulation that could drive its law.
  subroutine check_drivers(cursor, draft, path)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(point_path_t), intent(in) :: path
    type(law_t) :: law
    integer :: k

    if (path%material%law_id == 0 .or. size(path%material%values) == 0) return
    ! a file with mistakes is reported already, and what the law needs depends on the steel
    if (draft%laws(path%material%law_id)%of_steel .and. .not. allocated(path%material%steel)) return
    law = law_of_material(draft%laws(path%material%law_id), path%material)
    do k = 1, driver_count(law) - 1
      if (find_variable(law%history, law%drivers(k)%name) > 0) cycle
      call cursor%fail('LAW '//path%material%name//' is driven by '''//law%drivers(k)%name//''', which a point alone does not have')
      return
    end do
  end subroutine check_drivers

  !> `time steps  E|S xx  E|S yy  E|S xy  E|S zz  [T temperature]`; `ramp` comes with the time and temperature before it.
  subroutine read_ramp(cursor, path, ramp)
    type(cursor_t), intent(inout) :: cursor
    type(point_path_t), intent(in) :: path
    type(ramp_t), intent(inout) :: ramp
    character(len=2), parameter :: names(4) = ['xx', 'yy', 'xy', 'zz']
    type(string_t), allocatable :: words(:), more(:)
    real(wp) :: before
    integer :: c, k

    call words_of('E S', words)
    call words_of('T', more)
    before = ramp%time
    call cursor%real('a time later than the one before', ramp%time, lower=before, strict_lower=.true., unit='time')
    call cursor%integer('the number of steps', ramp%steps, lower=1, upper=most_steps)
    do c = 1, 4
      call cursor%name('E (strain) or S (stress) for '//names(c), words, k)
      ramp%stress(c) = k == 2
      if (k == 2) then
        call cursor%real('the stress '//names(c), ramp%values(c), unit='stress')
      else
        call cursor%real('the strain '//names(c), ramp%values(c), unit='-')
      end if
    end do
    if (.not. cursor%more()) return
    call cursor%name('T and a temperature, or the end of the line', more, k)
    if (.not. path%has_temperature) call cursor%fail('a temperature on a row wants one at the start, on the line of PATH: T value')
    call cursor%real('the temperature at this time', ramp%temperature)
  end subroutine read_ramp

end module point_reader
