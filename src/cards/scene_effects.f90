!> Effects of a scene: each on because a card needs it, and off otherwise.
module scene_effects
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use elem_api, only: elem_t, has_unknown
  use law_api, only: asks_for, find_parameter, law_of_material, law_t
  use materials, only: material_t
  use scene, only: generalised_plane_strain, scene_t
  use scene_draft, only: head_location
  use state_variables, only: find_variable, total_components
  use text, only: to_text
  implicit none
  private
  public :: list_effects

contains

  !> All effects in a fixed order. The scene is without mistakes.
  subroutine list_effects(deck, laws, elems, diagnostics, scene)
    type(deck_t), intent(in) :: deck
    type(law_t), intent(in) :: laws(:)     !! (nlaw)
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(diagnostics_t), intent(in) :: diagnostics
    type(scene_t), intent(inout) :: scene
    integer :: g, k

    allocate (scene%effects(13))
    call set(1, 'displacement', 'no body')
    call set(2, 'large strain', 'KINEM '//scene%kinematics, 'displacement')
    call set(3, 'plasticity', 'no LAW with a yield stress is used', 'displacement')
    call set(4, 'contact', 'no CNT2D card')
    call set(5, 'friction', 'no contact law with friction is used', 'contact')
    call set(6, 'pressure', 'no PRES2D card')
    call set(7, 'body force', 'no BFORC, CENTR or SPRNG of a body')
    call set(8, 'heat', 'no card asks for it')
    call set(9, 'phases', 'no LAW META, no ARBTHMET with TIME')
    call set(10, 'temperature', 'no TEMPE card', 'displacement')
    call set(11, 'error estimates', 'no ESTIM or REMSH card')
    call set(12, 'remeshing', 'no REMSH card')
    call set(13, 'load factor', 'no LOADF card')

    call switch_on(2, scene%finite, 'KINEM', scene%kinematics, 'geometry that follows, geometric matrix')
    call switch_on(11, scene%remesh%estimate, trim(merge('REMSH', 'ESTIM', scene%remesh%on)), '', &
                   '2 sums per element, an estimate per step')
    call switch_on(12, scene%remesh%on, 'REMSH', '', 'a look at the mesh after every step')
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        select case (elems(group%elem_id)%effect)
        case ('displacement')
          call switch_on(1, .true., group%elem, group%name, &
                         to_text(2*size(scene%mesh%labels) + merge(3, 0, scene%plane_state == generalised_plane_strain)) &
                         //' unknowns, 8 state per point (stress, elastic strain)')
        case ('contact')
          call switch_on(4, .true., 'CNT2D', before_slash(group%name), unknowns_of(has_unknown(elems(group%elem_id), 'pilot')) &
                         //', '//to_text(total_components(group%variables))//' state per point')
        case ('body force')
          call switch_on(7, .true., group%elem, before_slash(group%name), 'forces and matrix of the loaded elements')
        case ('heat')
          call switch_on(8, .true., merge('ADDEL', 'BLOCK', group%host > 0), before_slash(group%name), &
                         'a temperature on every node or corner, a solve of its own')
        case ('load factor')
          call switch_on(13, .true., group%elem, before_slash(group%name), 'an unknown, a row and a column of the matrix')
        case ('pressure')
          call switch_on(6, .true., group%elem, before_slash(group%name), 'forces and matrix of the loaded sides')
        end select
        if (max(group%temperature_multiplier, group%temperature_history) > 0) &
          call switch_on(10, .true., 'TEMPE', group%name, 'numbers of laws at the temperature given')
        if (group%material == 0) cycle
        associate (material => scene%materials(group%material))
          if (asks_for(laws(material%law_id), 'plasticity')) &
            call switch_on(3, .true., 'LAW', material%name, &
                           to_text(state_of_law(laws(material%law_id), material))//' state per point')
          if (follows_phases(laws(material%law_id), material)) &
            call switch_on(9, .true., 'LAW', material%name, &
                           to_text(state_of_law(laws(material%law_id), material))//' state per point')
          if (asks_for(laws(material%law_id), 'friction')) then
            if (.not. scene%effects(5)%on) scene%effects(5)%why = 'PHI and PBOUE of every contact law are 0'
            call switch_on(5, has_friction(laws(material%law_id), g), 'LAW', material%name, 'unsymmetric matrix, friction work')
          end if
        end associate
      end associate
    end do
    scene%follows_path = scene%effects(3)%on .and. (scene%strategy%path_bound > 0 .or. scene%strategy%rate_bound > 0)
    do k = 1, size(scene%effects)
      if (.not. scene%effects(k)%on) scene%effects(k)%adds = 'nothing'
    end do

  contains

    subroutine set(k, name, why, within)
      integer, intent(in) :: k
      character(len=*), intent(in) :: name, why
      character(len=*), intent(in), optional :: within

      scene%effects(k)%name = name
      scene%effects(k)%why = why
      scene%effects(k)%adds = ''
      scene%effects(k)%within = ''
      if (present(within)) scene%effects(k)%within = within
    end subroutine set

    !> The first card that needs an effect is the one named.
    subroutine switch_on(k, condition, keyword, first_field, adds)
      integer, intent(in) :: k
      logical, intent(in) :: condition
      character(len=*), intent(in) :: keyword, first_field, adds

      if (scene%effects(k)%on .or. .not. condition) return
      scene%effects(k)%on = .true.
      scene%effects(k)%why = card_text(keyword, first_field)
      scene%effects(k)%adds = adds
    end subroutine switch_on

    !> A card in messages: keyword, first field, file and line. A body may come from a BLOCK or a BODY.
    function card_text(keyword, first_field) result(s)
      character(len=*), intent(in) :: keyword, first_field
      character(len=:), allocatable :: s, body
      integer :: i

      body = scene%groups(1)%elem
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
      logical, intent(in) :: pilot
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
    pure function has_friction(law, g) result(yes)
      type(law_t), intent(in) :: law
      integer, intent(in) :: g
      logical :: yes
      integer :: phi, cohesion

      phi = find_parameter(law, 'PHI')
      cohesion = find_parameter(law, 'PBOUE')
      yes = phi == 0 .or. cohesion == 0
      if (yes) return
      associate (values => scene%materials(scene%groups(g)%material)%values)
        yes = values(phi) > 0 .or. values(cohesion) > 0
      end associate
    end function has_friction

    !> Field a group's card begins with: the name of the block or set without its sides.
    pure function before_slash(name) result(s)
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: s

      s = name(:scan(name//'/', './') - 1)
    end function before_slash

  end subroutine list_effects

end module scene_effects
