!> REMSH and ESTIM: when a new mesh is wanted and how it is made, and whether errors are estimated.
module cards_remesh
  use card_places, only: read_rigid_die
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use element_fields, only: body_acts_on
  use fields, only: displacement_field
  use kinds, only: wp
  use own_mesh_sizes, only: complete_options
  use remesh_defaults, only: default_corner => corner, default_narrow => narrow, set_default_limits, set_default_sizes
  use remesher_options, only: has_contours
  use remesher_rows, only: make_sizes_finer, read_remesher_row, remesher_words
  use remesher_windows, only: read_window
  use remeshing, only: aspect_ratio, jacobian_ratio, largest_angle, least_angle, middle_share, never, scaled_jacobian, stroke_t
  use scene_draft, only: close_card, draft_t, only_card, words_of
  use state_variables, only: name_of_ratio, state_variable, state_variable_t, total_components, transfer_scalar
  use text, only: string_t, to_text
  implicit none
  private
  public :: read_remesh

  !> Rows of REMSH with limits for a new mesh, one word each, and all rows.
  character(len=*), parameter :: limit_rows = 'ERROR ANGLE MIDDLE JACOB SCALED ASPECT CONTACT NARROW CORNER DISTRESS TIMES STROKE'
  character(len=*), parameter :: rows = limit_rows//' BAD LEAST WINDOW '//remesher_words
  !> The middle third of a side.
  real(wp), parameter :: middle_third = 1.0_wp/3.0_wp

contains

  subroutine read_remesh(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    integer :: k

    allocate (draft%scene%remesh%times(0), draft%scene%remesh%strokes(0), draft%scene%remesher%windows(0))
    call only_card(deck, 'ESTIM', diagnostics, k)
    if (k > 0) then
      call cursor%open(deck%cards(k), diagnostics)
      draft%scene%remesh%estimate = .true.
      call close_card(draft, cursor, deck%cards(k))
    end if
    call only_card(deck, 'REMSH', diagnostics, k)
    if (k > 0) then
      call cursor%open(deck%cards(k), diagnostics)
      draft%scene%remesh%on = .true.
      draft%scene%remesh%estimate = .true.
      draft%scene%remesher%wanted = .true.
      call read_rows(cursor, draft)
      call close_card(draft, cursor, deck%cards(k))
      if (has_contours(draft%scene%remesher)) call set_default_sizes(draft%scene%remesher)
      if (abs(draft%mesh_factor - 1) > 0) call make_sizes_finer(draft%mesh_factor, draft%scene%remesh, draft%scene%remesher)
    end if
    call complete_options(draft%mesh_factor, draft%scene%remesher)
    if (draft%groups_sound .and. draft%scene%remesh%on) call keep_volume_ratios(draft)
  end subroutine read_remesh

  !> Where bodies that conduct heat deform and get new meshes their points keep how the volume has changed: heat goes with the mass.
  subroutine keep_volume_ratios(draft)
    type(draft_t), intent(inout) :: draft
    type(state_variable_t) :: ratio
    integer :: g

    if (.not. (draft%scene%finite .and. draft%scene%fields(displacement_field)%declared)) return
    ratio = state_variable(name_of_ratio, '-', transfer_scalar)
    ratio%initial = 1
    do g = 1, size(draft%scene%groups)
      associate (group => draft%scene%groups(g))
        if (.not. (body_acts_on(draft%elems, group, 'temperature') .and. allocated(group%variables))) cycle
        ratio%first = total_components(group%variables) + 1
        group%variables = [group%variables, ratio]
      end associate
    end do
  end subroutine keep_volume_ratios

  !> Each row once, but STROKE and WINDOW. Without a limit among them the default ones hold, except where rows ask for nothing but
  !> the first mesh of contours.
  subroutine read_rows(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), allocatable :: words(:)
    logical, allocatable :: given(:)
    integer :: k
    logical :: asked

    call words_of(rows, words)
    given = spread(.false., 1, size(words))
    asked = .false.
    call cursor%end_row()
    do while (cursor%more_rows())
      call cursor%next_row('one of '//rows)
      call cursor%name('one of '//rows, words, k)
      if (k == 0) return
      if (given(k) .and. all(words(k)%s /= ['STROKE', 'WINDOW'])) call cursor%fail(words(k)%s//' is given twice')
      given(k) = .true.
      asked = asked .or. index(' '//limit_rows//' ', ' '//words(k)%s//' ') > 0
      call read_row(cursor, draft, words(k)%s)
    end do
    if (any(given)) call cursor%end_row()
    associate (rules => draft%scene%remesh)
      if (.not. asked .and. .not. (any(given) .and. has_contours(draft%scene%remesher))) &
        call set_default_limits(rules, is_given('LEAST'), size(draft%scene%dies) > 0)
      if (rules%bad_share > 0 .and. .not. any(abs(rules%shape) < never)) &
        call cursor%fail('BAD counts elements by their shape: expected one of ANGLE MIDDLE JACOB SCALED ASPECT too')
    end associate

  contains

    pure function is_given(word) result(yes)
      character(len=*), intent(in) :: word
      logical :: yes
      integer :: i

      yes = any([(words(i)%s == word .and. given(i), i=1, size(words))])
    end function is_given

  end subroutine read_rows

  subroutine read_row(cursor, draft, word)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    character(len=*), intent(in) :: word

    associate (rules => draft%scene%remesh, shape => draft%scene%remesh%shape)
      select case (word)
      case ('ERROR')
        call cursor%real('the largest error of the stress', rules%stress_error, lower=0.0_wp, strict_lower=.true.)
        if (cursor%more()) call cursor%real('the strain of an element from which on the error counts', rules%error_strain, &
                                            lower=0.0_wp)
      case ('ANGLE')
        call cursor%real('the least angle of a corner', shape(least_angle), lower=0.0_wp, upper=90.0_wp, &
                         strict_upper=.true., unit='degrees')
        call cursor%real('the largest angle of a corner', shape(largest_angle), lower=90.0_wp, upper=180.0_wp, &
                         strict_lower=.true., unit='degrees')
      case ('MIDDLE')
        shape(middle_share) = middle_third
        if (cursor%more()) call cursor%real('the part of a side over which its middle node may lie', shape(middle_share), &
                                            lower=0.0_wp, upper=0.5_wp, strict_lower=.true.)
      case ('JACOB')
        call cursor%real('the least Jacobian over the largest of an element', shape(jacobian_ratio), lower=0.0_wp, &
                         upper=1.0_wp, strict_upper=.true.)
      case ('SCALED')
        call cursor%real('the least scaled Jacobian', shape(scaled_jacobian), lower=0.0_wp, upper=1.0_wp, strict_upper=.true.)
      case ('ASPECT')
        call cursor%real('the largest aspect ratio', shape(aspect_ratio), lower=1.0_wp, strict_lower=.true.)
      case ('BAD')
        call cursor%real('the share of elements that may be bad', rules%bad_share, lower=0.0_wp, upper=1.0_wp, strict_upper=.true.)
      case ('CONTACT')
        rules%contact = 1
        if (cursor%more()) call cursor%real('the largest depth between points over the allowed penetration', rules%contact, &
                                            lower=0.0_wp, strict_lower=.true.)
        if (size(draft%scene%dies) == 0) call cursor%fail('the deck has no die')
      case ('NARROW')
        rules%narrow = default_narrow
        if (cursor%more()) call cursor%real('the sides of a narrow contact over those of a new mesh', rules%narrow, lower=1.0_wp, &
                                            strict_lower=.true.)
        if (size(draft%scene%dies) == 0) call cursor%fail('the deck has no die')
      case ('CORNER')
        rules%corner = default_corner
        if (cursor%more()) call cursor%real('the length of a side in which a corner of a die is, over its length as new', &
                                            rules%corner, lower=1.0_wp, strict_lower=.true.)
        if (size(draft%scene%dies) == 0) call cursor%fail('the deck has no die')
      case ('DISTRESS')
        call cursor%integer('the cutbacks of a step one after the other', rules%distress, lower=1)
      case ('TIMES')
        call read_times(cursor, draft)
      case ('STROKE')
        call read_strokes(cursor, draft)
      case ('LEAST')
        call cursor%integer('the least number of steps between two new meshes', rules%least_steps, lower=1)
      case ('WINDOW')
        call read_window(cursor, draft)
      case default
        call read_remesher_row(cursor, word, draft%scene%remesher)
      end select
    end associate
  end subroutine read_row

  !> Times in ascending order, before the end.
  subroutine read_times(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    real(wp) :: time, last

    last = 0
    do
      call cursor%real('a time later than the one before', time, lower=last, strict_lower=.true., unit='time')
      if (cursor%failed()) return
      associate (end_time => draft%scene%strategy%end_time)
        if (end_time > 0 .and. .not. time < end_time) &
          call cursor%fail('this time is not before the end at '//to_text(end_time)//': no mesh is made there')
      end associate
      draft%scene%remesh%times = [draft%scene%remesh%times, time]
      last = time
      if (.not. cursor%more()) exit
    end do
  end subroutine read_times

  !> `die X|Y|A`, then ways of its pilot from where it stood at the start.
  subroutine read_strokes(cursor, draft)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(inout) :: draft
    type(string_t), allocatable :: words(:)
    type(stroke_t) :: stroke

    call read_rigid_die(cursor, draft, stroke%die)
    if (stroke%die == 0) return
    call words_of('X Y A', words)
    call cursor%name('X, Y or A', words, stroke%component)
    do while (.not. cursor%failed())
      call cursor%real('a stroke of the die', stroke%value, unit='length, for A rad')
      if (.not. abs(stroke%value) > 0) call cursor%fail('expected a stroke that is not 0')
      if (cursor%failed()) return
      draft%scene%remesh%strokes = [draft%scene%remesh%strokes, stroke]
      if (.not. cursor%more()) exit
    end do
  end subroutine read_strokes

end module cards_remesh
