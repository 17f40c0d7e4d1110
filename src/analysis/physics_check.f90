!> What can be said of a deck before it runs: how parts and dies stand to each other, and what is seldom meant.
module physics_check
  use closing_dies, only: judge_closing
  use contact_outlook, only: lies_on, look_at_contact, moves, outlook_t
  use dies, only: is_deformable
  use fields, only: displacement_field
  use heat_check, only: check_exchanges, check_heat
  use kinds, only: wp
  use law_api, only: driver_count, find_parameter, law_t, solid_law
  use resting_dies, only: has_spring
  use scene, only: axisymmetric, group_t, lacks_mesh, role_side_load, scene_t
  use supports, only: free_motions, is_mechanical_load
  use text, only: add => add_text, string_t, to_text
  use touching_bodies, only: judge_touching
  implicit none
  private
  public :: check_operation, check_physics, largest_overlap, words_of

  !> A part that begins deeper in a rigid die than this share of its side was not meant to.
  real(wp), parameter :: largest_overlap = 0.01_wp
  !> Metals yield at less than this share of Young's modulus: the strongest steels and glassy metals at 0.01 to 0.02.
  real(wp), parameter :: largest_yield = 0.03_wp
  !> Dry metals rub at less, hot ones that stick at their shear flow stress (M).
  real(wp), parameter :: largest_friction = 1.0_wp
  !> Metals expand by 1e-5 to 3e-5 of their length for a degree, polymers by 3e-4.
  real(wp), parameter :: largest_alpha = 0.01_wp
  !> Laws for solids in which temperatures make no strain.
  character(len=6), parameter :: without_expansion(*) = [character(len=6) :: 'ELA', 'EPLA', 'EVP-NH', 'GSELL']
  !> Ends and middle of a side of an element.
  integer, parameter :: nodes_of_side = 3

contains

  !> Lines of the table of places and dies; and warnings, one line each. Of bodies that have contours alone neither supports nor
  !> torches are looked at.
  subroutine check_physics(scene, laws, table, warnings)
    type(scene_t), intent(in) :: scene                        !! as the deck gives it, before any new mesh
    type(law_t), intent(in) :: laws(:)                        !! (nlaw)
    type(string_t), allocatable, intent(out) :: table(:)      !! (nline)
    type(string_t), allocatable, intent(out) :: warnings(:)   !! (nwarning)
    type(outlook_t) :: outlook(size(scene%groups))
    logical :: met
    integer :: g

    allocate (table(0), warnings(0))
    call check_heat(scene, laws, table, warnings)
    do g = 1, size(scene%groups)
      call judge_axis(scene, scene%groups(g), warnings)
    end do
    if (.not. lacks_mesh(scene)) call judge_touching(scene, warnings)
    if (.not. scene%fields(displacement_field)%declared) return
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        call look_at_contact(scene, group, outlook(g))
        call add(table, 'contact    '//group%name//': '//words_of(scene, group, outlook(g)))
      end associate
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%die == 0 .or. group%material == 0) cycle
        ! a die that slides along one side presses on another
        met = any(scene%groups%die == group%die .and. outlook%first >= 0)
        call judge_contact(scene, laws, group, outlook(g), met, warnings)
      end associate
    end do
    call judge_closing(scene, warnings)
    if (.not. lacks_mesh(scene)) call free_motions(scene, outlook, warnings)
    do g = 1, size(scene%materials)
      call judge_yield(scene, laws, g, warnings)
      call judge_friction(scene, laws, g, warnings)
      call judge_alpha(scene, laws, g, warnings)
    end do
    call judge_expansion(scene, laws, warnings)
    if (.not. anything_acts(scene)) &
      call add(warnings, 'nothing moves and no load acts: all multipliers (LIC) are zero at all times')
  end subroutine check_physics

  !> Warnings of the cards of a later operation, whatever form the part has then.
  subroutine check_operation(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                        !! (nlaw)
    type(string_t), allocatable, intent(out) :: warnings(:)   !! (nwarning)
    integer :: g

    allocate (warnings(0))
    call check_exchanges(scene, warnings)
    do g = 1, size(scene%groups)
      call judge_axis(scene, scene%groups(g), warnings)
    end do
    do g = 1, size(scene%materials)
      call judge_friction(scene, laws, g, warnings)
    end do
  end subroutine check_operation

  !> Loads and exchanges of heat on sides of the axis of rotation, where there is no area: they do nothing.
  subroutine judge_axis(scene, group, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(string_t), allocatable, intent(inout) :: warnings(:)
    logical :: on_axis(size(group%connectivity, 2))
    integer :: e

    if (scene%plane_state /= axisymmetric .or. lacks_mesh(scene) .or. size(on_axis) == 0) return
    if (group%role /= role_side_load) return
    do e = 1, size(on_axis)
      on_axis(e) = .not. maxval(abs(scene%mesh%coordinates(1, group%connectivity(:nodes_of_side, e)))) > 0
    end do
    if (all(on_axis)) call add(warnings, group%name//': its sides lie on the axis, where there is no area: it does nothing')
  end subroutine judge_axis

  !> How a group stands to its die.
  function words_of(scene, group, outlook) result(words)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(outlook_t), intent(in) :: outlook
    character(len=:), allocatable :: words

    if (is_deformable(scene%dies(group%die))) then
      words = 'between two bodies'
      return
    else if (.not. outlook%faces) then
      words = 'no side faces the die at the start'
    else if (abs(outlook%over_side) < lies_on) then
      words = 'touches at the start'
    else if (outlook%depth > 0) then
      words = to_text(outlook%depth, 4)//' deep at the start'
    else
      words = 'gap '//to_text(-outlook%depth, 4)//' at the start'
    end if
    if (outlook%faces .and. outlook%depth < 0 .and. is_pushed(scene, group%die, outlook)) words = words//', which its FORCE closes'
    if (.not. moves(scene, group%die) .or. abs(outlook%first) <= 0) return
    if (outlook%first > 0) then
      words = words//', met at about time '//to_text(outlook%first, 3)//' by the die''s motion'
    else
      words = words//', not met by the die''s motion'
    end if
  end function words_of

  !> A force pushes what is free of a die along X or Y to the sides that face it, and no spring holds it there (seating).
  pure function is_pushed(scene, die, outlook) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    type(outlook_t), intent(in) :: outlook
    logical :: yes
    real(wp) :: force
    integer :: k

    yes = .false.
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        if (load%die /= die .or. load%component > 2 .or. load%multiplier == 0) cycle
        if (has_spring(scene, die, load%component)) cycle
        associate (value => scene%multipliers(load%multiplier)%value)
          force = load%amplitude*value(maxloc(abs(value), 1))
        end associate
        yes = yes .or. force*outlook%least_push(load%component) > 0 .or. force*outlook%largest_push(load%component) > 0
      end associate
    end do
  end function is_pushed

  !> Parts in dies, dies walked the wrong way, dies that miss.
  subroutine judge_contact(scene, laws, group, outlook, met, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(group_t), intent(in) :: group
    type(outlook_t), intent(in) :: outlook
    logical, intent(in) :: met   !! its die meets some sides
    type(string_t), allocatable, intent(inout) :: warnings(:)

    associate (die => scene%dies(group%die))
      if (is_deformable(die)) return
      if (2*outlook%inside > outlook%seen) then
        call add(warnings, group%name//': the part begins within the body of die '//die%name &
                 //': a die is walked with the part on the left (DIE)')
      else if (outlook%faces .and. outlook%over_side > largest_overlap) then
        call add(warnings, group%name//': the part begins '//to_text(outlook%depth, 3)//' deep in die '//die%name &
                 //', '//to_text(100*outlook%over_side, 3)//' % of a side, all of it in the first step, however short: let ' &
                 //'the die come from that far off (MOVE), or round what sticks in it')
      else if (moves(scene, group%die) .and. outlook%first < 0) then
        if (.not. met .and. unloaded(scene, group%die) .and. .not. expands(scene, laws)) &
          call add(warnings, group%name//': die '//die%name//' does not meet the part on all its way: moved the other way, ' &
                   //'or the stroke is too short')
      else if (moves(scene, group%die) .and. outlook%faces .and. .not. outlook%faces_at_end) then
        call add(warnings, group%name//': at the end of its motion die '//die%name//' no longer faces the part: the stroke ' &
                 //'leaves it')
      end if
    end associate
  end subroutine judge_contact

  !> Temperatures change, and a body answers to them with a strain.
  pure function expands(scene, laws) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical :: yes
    integer :: k

    yes = .false.
    if (.not. is_warm(scene)) return
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%material == 0 .or. group%die > 0) cycle
        associate (law => laws(scene%materials(group%material)%law_id))
          if (law%kind == solid_law) yes = yes .or. .not. any(without_expansion == law%name)
        end associate
      end associate
    end do
  end function expands

  !> Temperatures act on bodies: a field, or given ones.
  pure function is_warm(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = has_temperature(scene)
    do k = 1, size(scene%groups)
      yes = yes .or. max(scene%groups(k)%temperature_multiplier, scene%groups(k)%temperature_history) > 0
    end do
  end function is_warm

  !> A field beside the motion.
  pure function has_temperature(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = any([(scene%fields(k)%declared .and. scene%fields(k)%quantity /= 'motion', k=1, size(scene%fields))])
  end function has_temperature

  !> Nothing but this die moves by what the deck gives, and no load acts; heat that passes is none.
  pure function unloaded(scene, die) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die   !! 0 for none
    logical :: yes
    integer :: k

    yes = size(scene%die_forces) == 0 .and. size(scene%forces) == 0 &
          .and. all(scene%section_drives%multiplier == 0) .and. scene%load_factor%multiplier == 0
    do k = 1, size(scene%groups)
      yes = yes .and. .not. is_mechanical_load(scene%groups(k))
    end do
    do k = 1, size(scene%dies)
      if (k /= die) yes = yes .and. .not. moves(scene, k)
    end do
    do k = 1, size(scene%fixations)
      yes = yes .and. (scene%fixations(k)%multiplier == 0 .or. scene%fixations(k)%field /= displacement_field)
    end do
  end function unloaded

  !> A yield stress that no metal has beside its modulus: units mixed.
  subroutine judge_yield(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: m
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: young, poisson, yield

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      if (law%name /= 'EPLA') return
      block
        real(wp) :: drivers(driver_count(law)), history(size(law%history)*4)

        drivers = 0
        if (allocated(material%temperatures)) drivers(1) = material%temperatures(1)
        history = 0
        call law%elastic(material, drivers(1), young, poisson)
        yield = law%flow_stress(material, drivers, history)
      end block
      if (yield > largest_yield*young) call add(warnings, 'law '//material%name//': it yields at '//to_text(yield/young, 3) &
        //' of E, metals below '//to_text(largest_yield)//': are E and stresses in one unit?')
    end associate
  end subroutine judge_yield

  !> A coefficient of friction that no pair of metals has, and nothing beside it that bounds friction: a percentage.
  subroutine judge_friction(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: m
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: phi

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      if (find_parameter(law, 'PHI') == 0) return
      phi = material%values(find_parameter(law, 'PHI'))
      if (.not. (phi > largest_friction .and. phi < huge(phi))) return
      if (min(material%values(find_parameter(law, 'M')), material%values(find_parameter(law, 'TAUMAX'))) < huge(phi)) return
      call add(warnings, 'law '//material%name//': its coefficient of friction is '//to_text(phi, 3)//', of metals below ' &
               //to_text(largest_friction)//': is it in percent? Above 1 an equilibrium need not exist (what sticks: GLUE2D)')
    end associate
  end subroutine judge_friction

  !> A coefficient of expansion that no solid has: given in millionths.
  subroutine judge_alpha(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: m
    type(string_t), allocatable, intent(inout) :: warnings(:)
    integer :: k

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      k = find_parameter(law, 'ALPHA')
      if (k == 0) return
      if (material%values(k) > largest_alpha) call add(warnings, 'law '//material%name//': it expands by ' &
        //to_text(material%values(k), 3)//' of its length for each degree, solids by less than '//to_text(largest_alpha) &
        //': is ALPHA in 1e-6?')
    end associate
  end subroutine judge_alpha

  !> Bodies that temperatures alone should strain, and no law of which expands.
  subroutine judge_expansion(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    type(string_t), allocatable, intent(inout) :: warnings(:)

    if (any(scene%groups%material > 0 .and. scene%groups%die > 0)) return
    if (is_warm(scene) .and. unloaded(scene, 0) .and. .not. expands(scene, laws)) &
      call add(warnings, 'nothing but temperatures acts on the bodies, and none of their laws expands (ELATH and ARBTHMET do): ' &
               //'no stress, no motion')
  end subroutine judge_expansion

  !> A multiplier is not zero at some time, or the scene needs none: heat acts by itself, and one without multipliers has none to be
  !> zero.
  pure function anything_acts(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: k

    yes = size(scene%multipliers) == 0 .or. has_temperature(scene)
    do k = 1, size(scene%multipliers)
      yes = yes .or. maxval(abs(scene%multipliers(k)%value)) > 0
    end do
  end function anything_acts

end module physics_check
