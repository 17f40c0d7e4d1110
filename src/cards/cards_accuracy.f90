!> ACCURACY: which error a run may have; and what a run of another fineness than the deck's is.
module cards_accuracy
  use accuracy_rules, only: fineness_t, stress_name
  use contact_penalties, only: allowed_by_side, scale_penalties
  use deck_cursor, only: cursor_t
  use deck_reader, only: card_t, deck_t
  use diagnostics, only: diagnostics_t
  use element_fields, only: body_acts_on
  use kinds, only: wp
  use law_api, only: contact_law
  use mesh_parts, only: mesh_parts_t
  use remesher_options, only: has_contours
  use remeshing, only: never
  use scene, only: generalised_plane_strain, scene_t
  use scene_draft, only: close_card, draft_t, only_card, words_of
  use sections, only: section_loads, section_motions
  use strategy, only: order_in_time
  use text, only: add_text, string_t
  implicit none
  private
  public :: make_finer, read_accuracy

  !> Instants that all runs of a deck with ACCURACY hit, at most; fewer where its steps are longer.
  integer, parameter :: most_instants = 8
  !> Percent in one.
  real(wp), parameter :: hundred = 100.0_wp
  !> Columns of the history of any scene, and of each die before its name, that may be judged.
  character(len=*), parameter :: of_scenes = 'external_work elastic_energy plastic_work friction_work'
  character(len=*), parameter :: of_dies = 'force_x_ force_y_ moment_ displacement_x_ displacement_y_ rotation_ temperature_ ' &
                                           //'heat_flow_'

contains

  !> `ACCURACY p [%] [OF name ...]`.
  subroutine read_accuracy(deck, draft, parts, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(mesh_parts_t), intent(in) :: parts
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    real(wp) :: percent
    integer :: k, card

    call only_card(deck, 'ACCURACY', diagnostics, card)
    if (card == 0) return
    call cursor%open(deck%cards(card), diagnostics)
    call cursor%real('the largest error, in percent', percent, lower=0.0_wp, upper=hundred, strict_lower=.true., &
                     strict_upper=.true.)
    associate (rules => draft%scene%accuracy)
      rules%asked = percent/hundred
      allocate (rules%columns(0))
      call read_names(cursor, deck, draft)
      rules%divisible = parts%divisible
      rules%halvable = parts%divisible .and. parts%even .and. .not. has_contours(draft%scene%remesher)
      rules%of_sides = .true.
      do k = 1, size(draft%scene%materials)
        if (is_contact_law(draft, k)) rules%of_sides = rules%of_sides .and. allowed_by_side(draft%scene%materials(k))
      end do
    end associate
    if (.not. cursor%failed()) call set_instants(draft%scene)
    call close_card(draft, cursor, deck%cards(card))
  end subroutine read_accuracy

  pure logical function is_contact_law(draft, material)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: material

    associate (id => draft%scene%materials(material)%law_id)
      is_contact_law = id > 0
      if (is_contact_law) is_contact_law = draft%laws(id)%kind == contact_law
    end associate
  end function is_contact_law

  !> `%`, `OF` and names of columns of the history, or STRESS.
  subroutine read_names(cursor, deck, draft)
    type(cursor_t), intent(inout) :: cursor
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(inout) :: draft
    type(string_t), allocatable :: words(:), names(:)
    integer :: k, i

    if (cursor%failed() .or. .not. cursor%more()) return
    call words_of('% OF', words)
    call cursor%name('% or OF', words, k)
    if (k == 1) then
      if (.not. cursor%more()) return
      call words_of('OF', words)
      call cursor%name('OF', words, k)
    end if
    if (cursor%failed()) return
    call possible_names(deck, draft, names)
    associate (rules => draft%scene%accuracy)
      do
        call cursor%name('the name of a column of the history, or '//stress_name, names, k)
        if (k == 0) return
        if ((k == 1 .and. rules%stress) .or. any([(rules%columns(i)%s == names(k)%s, i=1, size(rules%columns))])) &
          call cursor%fail(''''//names(k)%s//''' is given twice')
        if (k == 1 .and. .not. has_motion(draft)) call cursor%fail('no body of the deck has a stress')
        if (k == 1) then
          rules%stress = .true.
        else
          rules%columns = [rules%columns, names(k:k)]
        end if
        if (.not. cursor%more()) exit
      end do
    end associate
  end subroutine read_names

  !> A body deforms.
  pure function has_motion(draft) result(yes)
    type(draft_t), intent(in) :: draft
    logical :: yes
    integer :: g

    yes = any([(body_acts_on(draft%elems, draft%scene%groups(g), 'displacement'), g=1, size(draft%scene%groups))])
  end function has_motion

  !> STRESS, columns of any scene, of dies, of the section, and of LOADF and probes, those of other operations too.
  subroutine possible_names(deck, draft, names)
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(in) :: draft
    type(string_t), allocatable, intent(out) :: names(:)   !! (n)
    type(string_t), allocatable :: fronts(:)
    integer :: i, k

    call words_of(stress_name//' '//of_scenes, names)
    if (draft%scene%plane_state == generalised_plane_strain) then
      do k = 1, size(section_motions)
        call add_text(names, trim(section_motions(k)))
        call add_text(names, trim(section_loads(k)))
      end do
    end if
    call words_of(of_dies, fronts)
    do k = 1, size(draft%scene%dies)
      do i = 1, size(fronts)
        call add_text(names, fronts(i)%s//draft%scene%dies(k)%name)
      end do
    end do
    do i = 1, size(deck%cards)
      if (names_column(deck%cards(i))) call add_text(names, deck%cards(i)%head%fields(1)%text)
    end do
  end subroutine possible_names

  !> A PROBE or LOADF card with a name, which is that of a column; one of another operation has a mark before its keyword.
  pure function names_column(card) result(yes)
    type(card_t), intent(in) :: card
    logical :: yes

    yes = any(card%keyword == ['PROBE ', '-PROBE', 'LOADF ', '-LOADF'])
    if (yes) yes = size(card%head%fields) > 0
  end function names_column

  !> Instants at equal times, so that runs can be compared there.
  pure subroutine set_instants(scene)
    type(scene_t), intent(inout) :: scene
    integer :: n, k

    associate (strategy => scene%strategy)
      if (.not. (strategy%largest_step > 0 .and. strategy%end_time > 0)) return
      n = most_instants
      if (strategy%largest_step*most_instants > strategy%end_time) n = max(int(strategy%end_time/strategy%largest_step), 1)
      strategy%watch_times = [(strategy%end_time*k/n, k=1, n)]
    end associate
  end subroutine set_instants

  !> Steps and penetrations of a run of another fineness, and limits of REMSH that count the one or the other: new meshes are then
  !> due at about the same instants. What bounds the error of a single step is of one order more than the
  !> scheme.
  subroutine make_finer(fineness, draft)
    type(fineness_t), intent(in) :: fineness
    type(draft_t), intent(inout) :: draft
    integer :: k

    associate (strategy => draft%scene%strategy, share => fineness%steps)
      strategy%first_step = share*strategy%first_step
      strategy%largest_step = share*strategy%largest_step
      strategy%least_step = share*strategy%least_step
      strategy%path_bound = share*strategy%path_bound
      strategy%rate_bound = share*strategy%rate_bound
      strategy%travel_bound = share*strategy%travel_bound
      strategy%time_tolerance = share**(order_in_time(strategy) + 1)*strategy%time_tolerance
      associate (rules => draft%scene%remesh)
        if (rules%least_steps > 1) rules%least_steps = nint(rules%least_steps/share)
        if (rules%contact < never) rules%contact = rules%contact/fineness%depth
      end associate
    end associate
    do k = 1, size(draft%scene%materials)
      if (is_contact_law(draft, k)) call scale_penalties(fineness%depth, draft%scene%materials(k))
    end do
  end subroutine make_finer

end module cards_accuracy
