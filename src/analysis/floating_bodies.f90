!> Bodies that nothing holds when a run ends: let go by their dies, they float; or dies have pushed them ahead without strain.
!>
!> Such a body rests where it was let go (resting_bodies): no force says where it would be. One that still lies against a die, as a
!> forging on its anvil when the punch has gone up, is where it would be anyway, and is not reported.
module floating_bodies
  use contact_outlook, only: gaps_at_rest
  use dies, only: is_deformable
  use energy_balance, only: is_drag_alone
  use energy_round_off, only: energy_without_strain
  use equations, only: equations_t
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use law_api, only: law_t
  use loose_bodies, only: mark_acted_on
  use resting_bodies, only: light
  use scene, only: group_t, is_solid, role_contact, scene_t
  use scene_as_it_stands, only: present_scene
  use solution, only: solution_t
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: warn_of_floating_bodies, warn_of_idle_dies

  !> A side lies on a die where the gap is below this share of its length.
  real(wp), parameter :: lies_on = 1.0e-3_wp
  !> A body that is carried along rigidly has strains of round-off over the lengths of its way and of its sides: far below this one,
  !> as is that of no load worth the name (the weight of 1 mm of steel: 4e-10).
  real(wp), parameter :: unstrained = 1.0e-10_wp

contains

  !> A line for each assembly of bodies that neither a support, a spring, a load nor a contact with others acts on, added to the
  !> warnings of a run at its end.
  subroutine warn_of_floating_bodies(scene, laws, loose, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: loose(:)   !! (nnode) the body of every node that supports do not hold, 0 for others; or of no size
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    logical :: acted_on(0:size(loose)), told(0:size(loose))
    integer :: assembly(0:size(loose)), part_of(size(loose))
    character(len=:), allocatable :: names, words
    real(wp) :: gap, over_side
    integer :: g, number
    logical :: several

    if (size(loose) == 0) return
    call mark_acted_on(scene, laws, solution, loose, solution%time, light, acted_on, assembly)
    part_of = assembly(loose)
    told = .false.
    told(0) = .true.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%is_spring) told(part_of(group%connectivity(1, 1))) = .true.
      end associate
    end do
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (.not. is_solid(group)) cycle
        number = part_of(group%connectivity(1, 1))
        if (told(number)) cycle
        told(number) = .true.
        call nearest_die(scene, solution, part_of, number, gap, over_side)
        if (over_side < lies_on) cycle
        call name_bodies(number, names, several)
        words = ': at the end nothing'
        if (acted_on(loose(group%connectivity(1, 1)))) words = words//' else'
        words = words//' holds '//trim(merge('them', 'it  ', several))//', no support and no contact'//beside(gap)
        if (several) then
          words = words//': they rest where they were let go, and no force says that they would'
        else
          words = words//': it rests where it was let go, and no force says that it would'
        end if
        call add_text(warnings, names//words)
      end associate
    end do

  contains

    !> The bodies of an assembly, each by the first of its groups.
    pure subroutine name_bodies(number, names, several)
      integer, intent(in) :: number
      character(len=:), allocatable, intent(out) :: names
      logical, intent(out) :: several
      logical :: named(0:size(loose))
      integer :: k

      names = ''
      named = .false.
      do k = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(k))) cycle
        associate (node => scene%groups(k)%connectivity(1, 1))
          if (part_of(node) /= number .or. named(loose(node))) cycle
          if (any(named)) names = names//', '
          names = names//scene%groups(k)%name
          named(loose(node)) = .true.
        end associate
      end do
      several = count(named) > 1
    end subroutine name_bodies

    !> How far away the nearest die is, where it faces any.
    pure function beside(gap) result(words)
      real(wp), intent(in) :: gap
      character(len=:), allocatable :: words

      words = ''
      if (gap < huge(gap)) words = ' (the nearest die is '//to_text(gap, 3)//' away)'
    end function beside
  end subroutine warn_of_floating_bodies

  !> Rigid dies have moved, and no more energy has passed than round-off makes: nothing resisted them. Or supports carried bodies
  !> along rigidly, against the round-off of their stresses, and no die was touched. Told where nothing else is.
  subroutine warn_of_idle_dies(scene, equations, solution, volume, warnings)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: volume   !! of the bodies, per radian when axisymmetric [volume]
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    real(wp) :: nothing
    integer :: k

    if (size(warnings) > 0 .or. .not. scene%fields(displacement_field)%declared) return
    nothing = energy_without_strain(scene, equations, volume, unstrained)
    associate (work => solution%work)
      if (work%passed > energy_without_strain(scene, equations, volume) .and. .not. is_drag_alone(work) &
          .and. (solution%worst_penetration > 0 .or. work%elastic > nothing .or. work%flow > nothing)) return
    end associate
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) cycle
      if (.not. any(abs(solution%fields(pilot_field)%value(:, k) - scene%dies(k)%pilot) > 0)) cycle
      call add_text(warnings, 'die '//scene%dies(k)%name//' has moved against no resistance, and no body is strained: it met ' &
                    //'none, or pushed ahead of it what no support holds')
      return
    end do
  end subroutine warn_of_idle_dies

  !> Least gap between an assembly of bodies and the dies that its contacts name, or others that face it; huge where there is none.
  subroutine nearest_die(scene, solution, part_of, number, gap, over_side)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: part_of(:), number   !! (nnode) assemblies of the nodes; the number of one
    real(wp), intent(out) :: gap            !! [length]
    real(wp), intent(out) :: over_side      !! over the length of the side
    type(scene_t) :: now
    real(wp), allocatable :: gaps(:, :), over_sides(:, :)
    integer :: g

    now = present_scene(scene, solution)
    gap = huge(gap)
    over_side = huge(over_side)
    do g = 1, size(now%groups)
      if (now%groups(g)%role /= role_contact) cycle
      if (.not. is_of(now%groups(g))) cycle
      call gaps_at_rest(now, now%groups(g), gaps, over_sides)
      if (size(gaps) == 0) cycle
      gap = min(gap, minval(gaps))
      over_side = min(over_side, minval(over_sides))
    end do

  contains

    !> A contact of the assembly with others.
    pure function is_of(group) result(yes)
      type(group_t), intent(in) :: group
      logical :: yes

      yes = part_of(group%connectivity(1, 1)) == number
      if (.not. is_deformable(scene%dies(group%die))) return
      yes = yes .neqv. part_of(scene%dies(group%die)%nodes(1, 1)) == number
    end function is_of
  end subroutine nearest_die

end module floating_bodies
