!> Effects of a scene: each on because a card needs it, and off otherwise.
module scene_effects
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: elem_t
  use element_fields, only: has_unknown
  use kinds, only: wp
  use law_api, only: asks_for, find_parameter, law_of_material, law_t
  use materials, only: material_t
  use scene, only: generalised_plane_strain, scene_t
  use scene_draft, only: head_location
  use state_variables, only: find_variable, total_components
  use text, only: to_text
  implicit none
  private
  public :: has_effect, list_effects

  !> Effects in the order of the summary, with the reason why each is off where no card needs it.
  character(len=*), parameter :: names(13) = [character(len=15) :: 'displacement', 'large strain', 'plasticity', 'contact', &
                                              'friction', 'pressure', 'body force', 'heat', 'phases', 'temperature', &
                                              'error estimates', 'remeshing', 'load factor']
  character(len=*), parameter :: missing(13) = [character(len=40) :: 'no body', 'KINEM', 'no LAW with a yield stress is used', &
                                                'no CNT2D card', 'no contact law with friction is used', 'no PRES2D card', &
                                                'no BFORC, CENTR or SPRNG of a body', 'no card asks for it', &
                                                'no LAW META, no ARBTHMET with TIME', 'no TEMPE card', 'no ESTIM or REMSH card', &
                                                'no REMSH card', 'no LOADF card']
  !> The effect that another one is a part of.
  character(len=*), parameter :: within(13) = [character(len=12) :: '', 'displacement', 'displacement', '', 'contact', '', '', '', &
                                               '', 'displacement', '', '', '']

contains

  !> All effects in a fixed order. The scene is without mistakes.
  subroutine list_effects(deck, laws, elems, diagnostics, scene)
    type(deck_t), intent(in) :: deck
    type(law_t), intent(in) :: laws(:)     !! (nlaw)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(diagnostics_t), intent(in) :: diagnostics
    type(scene_t), intent(inout) :: scene
    integer :: g, k

    call start_effects(scene)
    if (scene%finite) call switch_on(deck, diagnostics, scene, 'large strain', 'KINEM', scene%kinematics, &
                                     'geometry that follows, geometric matrix')
    if (scene%remesh%estimate) call switch_on(deck, diagnostics, scene, 'error estimates', &
                                              trim(merge('REMSH', 'ESTIM', scene%remesh%on)), '', &
                                              '2 sums per element, an estimate per step')
    if (scene%remesh%on) call switch_on(deck, diagnostics, scene, 'remeshing', 'REMSH', '', 'a look at the mesh after every step')
    do g = 1, size(scene%groups)
      call add_effect_of_element(deck, diagnostics, elems(scene%groups(g)%elem_id), g, scene)
      if (max(scene%groups(g)%temperature_multiplier, scene%groups(g)%temperature_history) > 0) &
        call switch_on(deck, diagnostics, scene, 'temperature', 'TEMPE', scene%groups(g)%name, &
                       'numbers of laws at the temperature given')
      k = scene%groups(g)%material
      if (k > 0) call add_effects_of_law(deck, diagnostics, laws(scene%materials(k)%law_id), k, scene)
    end do
    scene%follows_path = has_effect(scene, 'plasticity') .and. (scene%strategy%path_bound > 0 .or. scene%strategy%rate_bound > 0)
    do k = 1, size(scene%effects)
      if (.not. scene%effects(k)%on) scene%effects(k)%adds = 'nothing'
    end do
  end subroutine list_effects

  !> All of them off.
  pure subroutine start_effects(scene)
    type(scene_t), intent(inout) :: scene
    integer :: k

    allocate (scene%effects(size(names)))
    do k = 1, size(names)
      scene%effects(k)%name = trim(names(k))
      scene%effects(k)%why = trim(missing(k))
      scene%effects(k)%adds = ''
      scene%effects(k)%within = trim(within(k))
    end do
    scene%effects(place_of('large strain'))%why = 'KINEM '//scene%kinematics
  end subroutine start_effects

  pure function place_of(name) result(place)
    character(len=*), intent(in) :: name   !! of an effect
    integer :: place

    place = findloc(names == name, .true., 1)
  end function place_of

  pure function has_effect(scene, name) result(on)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    logical :: on

    on = scene%effects(place_of(name))%on
  end function has_effect

  !> The first card that needs an effect is the one named.
  subroutine switch_on(deck, diagnostics, scene, name, keyword, first_field, adds)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(in) :: diagnostics
    type(scene_t), intent(inout) :: scene
    character(len=*), intent(in) :: name                        !! of the effect
    character(len=*), intent(in) :: keyword, first_field, adds  !! of the card; what the effect adds to a run

    if (has_effect(scene, name)) return
    associate (effect => scene%effects(place_of(name)))
      effect%on = .true.
      effect%why = card_text(deck, diagnostics, scene%groups(1)%elem, keyword, first_field)
      effect%adds = adds
    end associate
  end subroutine switch_on

  !> The effect that the element of a group declares.
  subroutine add_effect_of_element(deck, diagnostics, elem, g, scene)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(in) :: diagnostics
    type(elem_t), intent(in) :: elem   !! of the group
    integer, intent(in) :: g           !! the group
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: card, name, adds

    associate (group => scene%groups(g))
      card = group%elem
      name = before_slash(group%name)
      select case (elem%effect)
      case ('displacement')
        name = group%name
        adds = to_text(2*size(scene%mesh%labels) + merge(3, 0, scene%plane_state == generalised_plane_strain)) &
               //' unknowns, 8 state per point (stress, elastic strain)'
      case ('contact')
        card = 'CNT2D'
        adds = unknowns_of(has_unknown(elem, 'pilot'))//', '//to_text(total_components(group%variables))//' state per point'
      case ('body force')
        adds = 'forces and matrix of the loaded elements'
      case ('heat')
        card = trim(merge('ADDEL', 'BLOCK', group%host > 0))
        adds = 'a temperature on every node or corner, a solve of its own'
      case ('load factor')
        adds = 'an unknown, a row and a column of the matrix'
      case ('pressure')
        adds = 'forces and matrix of the loaded sides'
      case default
        return
      end select
    end associate
    call switch_on(deck, diagnostics, scene, elem%effect, card, name, adds)
  end subroutine add_effect_of_element

  !> Plasticity, phases and friction, as a law and the numbers of its material ask for.
  subroutine add_effects_of_law(deck, diagnostics, law, k, scene)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(in) :: diagnostics
    type(law_t), intent(in) :: law   !! of the material
    integer, intent(in) :: k         !! the material
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: name, state

    name = scene%materials(k)%name
    state = to_text(state_of_law(law, scene%materials(k)))//' state per point'
    if (asks_for(law, 'plasticity')) call switch_on(deck, diagnostics, scene, 'plasticity', 'LAW', name, state)
    if (follows_phases(law, scene%materials(k))) call switch_on(deck, diagnostics, scene, 'phases', 'LAW', name, state)
    if (.not. asks_for(law, 'friction')) return
    if (has_friction(law, scene%materials(k)%values)) then
      call switch_on(deck, diagnostics, scene, 'friction', 'LAW', name, 'unsymmetric matrix, friction work')
    else if (.not. has_effect(scene, 'friction')) then
      scene%effects(place_of('friction'))%why = 'PHI and PBOUE of every contact law are 0'
    end if
  end subroutine add_effects_of_law

  !> A card in messages: keyword, first field, file and line. A body may come from a BLOCK or a BODY.
  function card_text(deck, diagnostics, body, keyword, first_field) result(s)
    type(deck_t), intent(in) :: deck
    type(diagnostics_t), intent(in) :: diagnostics
    character(len=*), intent(in) :: body   !! element that the bodies are made of
    character(len=*), intent(in) :: keyword, first_field
    character(len=:), allocatable :: s
    integer :: i

    s = keyword//' '//first_field
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= keyword .and. .not. (any(deck%cards(i)%keyword == ['BLOCK', 'BODY ']) .and. keyword == body)) &
        cycle
      if (size(deck%cards(i)%head%fields) > 0) then
        if (deck%cards(i)%head%fields(1)%text /= first_field) cycle
      else if (first_field /= '') then
        cycle
      end if
      s = trim(deck%cards(i)%keyword//' '//first_field)//' at '//diagnostics%place(head_location(deck%cards(i)))
      s = s(:index(s, ':', back=.true.) - 1)
      return
    end do
  end function card_text

  pure function unknowns_of(pilot) result(s)
    logical, intent(in) :: pilot   !! the element has it among its unknowns
    character(len=:), allocatable :: s

    s = 'pairs of sides in the matrix'
    if (pilot) s = '3 unknowns per die (its pilot)'
  end function unknowns_of

  !> Components of the history that a material needs.
  pure function state_of_law(law, material) result(n)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    integer :: n
    type(law_t) :: own

    own = law_of_material(law, material)
    n = total_components(own%history)
  end function state_of_law

  !> The points of a material hold phases, as a law of a steel has them.
  pure function follows_phases(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes
    type(law_t) :: own

    own = law_of_material(law, material)
    yes = law%of_steel .and. find_variable(own%history, 'austenite') > 0
  end function follows_phases

  !> Coulomb's law without coefficient and cohesion has no friction; another law always has it.
  pure function has_friction(law, values) result(yes)
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: values(:)   !! (nparameter) of the material [unit of each]
    logical :: yes
    integer :: phi, cohesion

    phi = find_parameter(law, 'PHI')
    cohesion = find_parameter(law, 'PBOUE')
    yes = phi == 0 .or. cohesion == 0
    if (yes) return
    yes = values(phi) > 0 .or. values(cohesion) > 0
  end function has_friction

  !> Field a group's card begins with: the name of the block or set without its sides.
  pure function before_slash(name) result(s)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: s

    s = name(:scan(name//'/', './') - 1)
  end function before_slash

end module scene_effects
