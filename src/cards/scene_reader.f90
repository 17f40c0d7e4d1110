!> From the cards of a deck to a scene. Cards may come in any order; all mistakes are reported together.
module scene_reader
  use accuracy_rules, only: fineness_t
  use cards_accuracy, only: make_finer, read_accuracy
  use cards_blocks, only: join_blocks, read_blocks
  use cards_body_forces, only: read_body_forces
  use cards_contours, only: read_contours, refuse_half_contours
  use cards_cuts, only: read_cuts
  use cards_dies, only: read_dies
  use cards_fields, only: read_coupling, read_formulations, read_imposed_values
  use cards_head, only: read_kinematics, read_title
  use cards_heat, only: read_exchanges, read_time_scheme
  use cards_heat_contact, only: read_heat_contacts
  use cards_laws, only: read_laws
  use cards_load_factor, only: name_load_factor, read_load_factor
  use cards_loads, only: read_loads, read_multipliers
  use cards_mesh, only: read_elements, read_nodes, read_side_sets
  use cards_pilots, only: read_pilots
  use cards_probes, only: read_probes
  use cards_remesh, only: read_remesh
  use cards_section, only: read_section, read_state
  use cards_side_dies, only: read_side_dies
  use cards_sides, only: read_contacts, read_pressures
  use cards_sleep, only: list_sleepers
  use cards_start, only: read_start_values
  use cards_strategy, only: read_strategy
  use cards_temperature, only: read_temperatures_of_bodies, refuse_short_histories
  use cards_tractions, only: read_tractions
  use cards_weld, only: read_torches
  use cards_zones, only: read_zones
  use deck_reader, only: deck_t, refuse_unknown, row_t
  use diagnostics, only: diagnostics_t, location_t
  use driver_checks, only: refuse_missing_drivers
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use element_fields, only: declare_fields, list_body_elems
  use folding_bodies, only: give_own_contact
  use mesh_finish, only: finish_mesh
  use mesh_parts, only: mesh_parts_t, start_parts
  use own_mesh_sizes, only: measure_own_mesh
  use patch_checks, only: settle_patches
  use remesh, only: remesh_t
  use remeshed_parts, only: order_as_remeshed, replace_parts
  use remesher_options, only: has_contours
  use scene, only: lacks_mesh, role_die_heat, scene_t, wall_t
  use scene_draft, only: draft_t, start_draft, words_of
  use scene_effects, only: list_effects
  use text, only: string_t
  use walls, only: find_walls
  implicit none
  private
  public :: read_scene, known_cards

contains

  !> Fill `scene` from the cards. It is only of use when `diagnostics` has no mistakes afterwards. `remesh` replaces the mesh
  !> the cards make; `fineness` is over what the cards say (none: as they say).
  subroutine read_scene(deck, scene, diagnostics, remesh, fineness, folding)
    type(deck_t), intent(inout), target :: deck
    type(scene_t), intent(out) :: scene
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(remesh_t), intent(in), optional :: remesh
    type(fineness_t), intent(in), optional :: fineness
    type(string_t), intent(in), optional :: folding(:)   !! names of bodies whose sides have met
    type(draft_t) :: draft
    type(mesh_parts_t) :: parts
    type(string_t), allocatable :: keywords(:)
    type(wall_t), allocatable :: known(:)
    logical :: has_own_mesh
    integer :: k

    allocate (known(0))
    has_own_mesh = .not. present(remesh)
    call start_draft(draft)
    if (present(fineness)) draft%mesh_factor = fineness%mesh
    call start_parts(parts)
    call known_cards(keywords)
    call refuse_unknown(deck, keywords, diagnostics)

    call read_title(deck, draft, diagnostics)
    call read_state(deck, draft, diagnostics)
    call read_kinematics(deck, draft, diagnostics)
    call read_multipliers(deck, draft, diagnostics)
    call name_load_factor(deck, draft, diagnostics)
    call read_section(deck, draft, diagnostics)
    call read_laws(deck, draft, diagnostics)
    call read_dies(deck, draft, diagnostics)

    allocate (draft%scene%mesh%sides(0))
    call read_nodes(deck, draft, parts, diagnostics)
    call read_elements(deck, draft, parts, diagnostics)
    call read_blocks(deck, draft, parts, diagnostics, has_own_mesh)
    call read_contours(deck, draft, parts, diagnostics)
    call read_side_sets(deck, draft, parts, diagnostics)
    call join_blocks(deck, draft, parts, diagnostics)
    ! asked of the cards: on a new mesh no body is a block
    parts%divisible = size(parts%bodies) > 0 .and. (all(parts%bodies%is_block) .or. has_contours(draft%scene%remesher))
    if (abs(draft%mesh_factor - 1) > 0 .and. .not. parts%divisible .and. size(parts%bodies) > 0) &
      call refuse_written_out(deck, diagnostics)
    if (present(remesh)) then
      draft%scene%remesher%own_mesh = remesh%own_mesh
      call replace_parts(remesh, draft, parts)
    else
      draft%scene%remesher%own_mesh = measure_own_mesh(parts)
    end if
    ! without a mesh cards are read as where it has mistakes: nothing is searched in it
    if (has_contours(draft%scene%remesher) .and. has_own_mesh) parts%sound = .false.
    call list_sleepers(deck, draft%sleepers)
    call finish_mesh(draft, parts, diagnostics)
    if (size(parts%bodies) == 0) call refuse_empty(deck, diagnostics)

    call read_formulations(deck, draft, diagnostics)
    call read_start_values(deck, draft, diagnostics)
    call read_temperatures_of_bodies(deck, draft, diagnostics)
    call read_side_dies(deck, draft, diagnostics)
    call read_zones(deck, draft, diagnostics)
    call read_contacts(deck, draft, diagnostics)
    call read_pressures(deck, draft, diagnostics)
    call read_exchanges(deck, draft, diagnostics)
    call read_torches(deck, draft, diagnostics)
    call read_body_forces(deck, draft, diagnostics)
    call read_loads(deck, draft, diagnostics)
    call read_heat_contacts(deck, draft, diagnostics)
    call read_imposed_values(deck, draft, diagnostics)
    call read_tractions(deck, draft, diagnostics)
    call read_pilots(deck, draft, diagnostics)
    call read_strategy(deck, draft, diagnostics)
    call refuse_short_histories(deck, draft, diagnostics)
    call read_coupling(deck, draft, diagnostics)
    call read_time_scheme(deck, draft, diagnostics)
    call read_remesh(deck, draft, diagnostics)
    call read_cuts(deck, draft, diagnostics)
    call read_load_factor(deck, draft, diagnostics)
    call refuse_half_contours(deck, draft, parts, diagnostics)
    call read_probes(deck, draft, diagnostics)
    call read_accuracy(deck, draft, parts, diagnostics)
    if (present(fineness)) call make_finer(fineness, draft)
    call refuse_unused_names(deck, draft, keywords, diagnostics)

    if (present(folding) .and. diagnostics%count() == 0) then
      do k = 1, size(folding)
        call give_own_contact(folding(k)%s, remesh, draft)
      end do
    end if
    if (present(remesh)) call order_as_remeshed(remesh, draft%scene%groups)
    if (diagnostics%count() == 0) call declare_fields(draft%elems, draft%scene)
    if (diagnostics%count() == 0) call refuse_missing_drivers(draft, diagnostics)
    if (diagnostics%count() == 0) call settle_patches(deck, draft, diagnostics)
    if (diagnostics%count() == 0) call list_effects(deck, draft%laws, draft%elems, diagnostics, draft%scene)
    if (present(remesh)) then
      if (allocated(remesh%walls)) known = remesh%walls
    end if
    if (diagnostics%count() == 0 .and. .not. lacks_mesh(draft%scene)) call find_walls(known, draft%scene)
    scene = draft%scene
  end subroutine read_scene

  !> Keywords that have a meaning, those of body elements last.
  subroutine known_cards(keywords)
    type(string_t), allocatable, intent(out) :: keywords(:)   !! (nkeyword)
    type(elem_t), allocatable :: elems(:)
    type(string_t), allocatable :: made(:)

    call list_elems(elems)
    call words_of('TITLE STATE SECTN KINEM NODES SIDES BLOCK BODY JOIN ADDEL LAW DIE CNT2D PRES2D BFORC CENTR TRACT TEMPE START ' &
                  //'OPERA ASLEEP FLUX CONVE RADIA HEATS GOLDAK COU2DC TDIE THETA FIXED MOVE IMPOS SOLVE FORCE FREE SPRNG ' &
                  //'LIC LOADF STRAT NORMS ACCURACY SOLVR STOP SAVE CKPT PROBE ESTIM REMSH TRIM PIERC ZPNT ZONE', keywords)
    call list_body_elems(elems, made)
    keywords = [keywords, made]
  end subroutine known_cards

  subroutine refuse_empty(deck, diagnostics)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: where

    call diagnostics%register(deck%path, where%file)
    call diagnostics%add(where, 'BLOCK', 'the deck has no body: expected a BLOCK, PL8LS or BODY card')
  end subroutine refuse_empty

  !> Elements that are written out cannot be made more.
  subroutine refuse_written_out(deck, diagnostics)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(inout) :: diagnostics
    type(location_t) :: where

    call diagnostics%register(deck%path, where%file)
    call diagnostics%add(where, 'PL8LS', '--fineness: the elements of this deck are written out: expected BLOCK or BODY ' &
                         //'cards alone, or 1 for elements along a line')
  end subroutine refuse_written_out

  !> What is defined must be used. Words on cards of unknown keywords count as uses.
  subroutine refuse_unused_names(deck, draft, keywords, diagnostics)
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(inout) :: draft
    type(string_t), intent(in) :: keywords(:)
    type(diagnostics_t), intent(inout) :: diagnostics
    integer :: i, k, g

    do i = 1, size(deck%cards)
      do k = 1, size(keywords)
        if (keywords(k)%s == deck%cards(i)%keyword) exit
      end do
      if (k <= size(keywords)) cycle
      call mention_words(deck%cards(i)%head, draft)
    end do
    call draft%materials%refuse_unused('LAW', '', diagnostics)
    call draft%multipliers%refuse_unused('LIC', '', diagnostics)
    call draft%places%refuse_unused('SIDES', '', diagnostics)
    call draft%places%refuse_unused('DIE', ': a CNT2D card must name it', diagnostics)
    if (.not. draft%groups_sound) return
    do k = 1, size(draft%places%words)
      if (draft%places%keywords(k)%s /= 'DIE' .or. .not. draft%places%used(k)) cycle
      if (is_named_elsewhere(deck, draft%places%words(k)%s)) cycle
      do g = 1, size(draft%scene%groups)
        if (draft%scene%groups(g)%die == draft%places%item(k) .and. draft%scene%groups(g)%role /= role_die_heat) exit
      end do
      if (g > size(draft%scene%groups)) call diagnostics%add(draft%places%location(k), 'DIE', ''''//draft%places%words(k)%s &
                                                               //''' touches nothing: a CNT2D card must name it')
    end do
  end subroutine refuse_unused_names

  !> Words of a card that is not read count as uses.
  subroutine mention_words(row, draft)
    type(row_t), intent(in) :: row
    type(draft_t), intent(inout) :: draft
    integer :: k

    do k = 1, size(row%fields)
      call draft%materials%mention(row%fields(k)%text)
      call draft%multipliers%mention(row%fields(k)%text)
      call draft%places%mention(row%fields(k)%text)
    end do
  end subroutine mention_words

  !> Another operation names it.
  pure function is_named_elsewhere(deck, word) result(yes)
    type(deck_t), intent(in) :: deck
    character(len=*), intent(in) :: word
    logical :: yes
    integer :: i, k

    yes = .false.
    do i = 1, size(deck%cards)
      if (.not. deck%cards(i)%elsewhere) cycle
      do k = 1, size(deck%cards(i)%head%fields)
        yes = yes .or. deck%cards(i)%head%fields(k)%text == word
      end do
    end do
  end function is_named_elsewhere

end module scene_reader
