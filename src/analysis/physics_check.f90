!> What can be said of a deck before it runs: how parts and dies stand to each other, and what is seldom meant.
module physics_check
  use acting_causes, only: anything_acts, expands, is_warm, unloaded
  use closing_dies, only: judge_closing
  use contact_check, only: judge_contact, words_of
  use contact_outlook, only: look_at_contact, outlook_t
  use cut_multipliers, only: judge_cut_multipliers
  use fields, only: displacement_field
  use heat_check, only: check_exchanges, check_heat
  use kinds, only: wp
  use law_api, only: law_t
  use law_numbers_check, only: judge_alpha, judge_friction, judge_hardening, judge_strains, judge_yield
  use scene, only: axisymmetric, group_t, lacks_mesh, role_side_load, scene_t
  use pressed_supports, only: judge_pressed_supports
  use supports, only: free_motions
  use text, only: add => add_text, string_t, to_text
  use touching_bodies, only: judge_touching
  use uneven_mesh, only: judge_sizes
  implicit none
  private
  public :: check_operation, check_physics

  !> Ends and middle of a side of an element.
  integer, parameter :: nodes_of_side = 3
  !> Steps that no run makes.
  real(wp), parameter :: most_steps = 1.0e6_wp

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
    call judge_cut_multipliers(scene, warnings)
    call judge_steps(scene, warnings)
    call check_heat(scene, laws, table, warnings)
    do g = 1, size(scene%groups)
      call judge_axis(scene, scene%groups(g), warnings)
    end do
    if (.not. lacks_mesh(scene)) call judge_touching(scene, warnings)
    call judge_sizes(scene, warnings)
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
    call judge_pressed_supports(scene, warnings)
    if (.not. lacks_mesh(scene)) call free_motions(scene, outlook, warnings)
    do g = 1, size(scene%materials)
      call judge_yield(scene, laws, g, warnings)
      call judge_hardening(scene, laws, g, warnings)
      call judge_strains(scene, g, warnings)
      call judge_friction(scene, laws, g, warnings)
      call judge_alpha(scene, laws, g, warnings)
    end do
    call judge_expansion(scene, laws, warnings)
    if (.not. anything_acts(scene)) &
      call add(warnings, 'nothing moves and no load acts: no multiplier (LIC) is other than zero at any time')
  end subroutine check_physics

  !> Warnings of the cards of a later operation, whatever form the part has then.
  subroutine check_operation(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                        !! (nlaw)
    type(string_t), allocatable, intent(out) :: warnings(:)   !! (nwarning)
    integer :: g

    allocate (warnings(0))
    call judge_cut_multipliers(scene, warnings)
    call check_exchanges(scene, warnings)
    do g = 1, size(scene%groups)
      call judge_axis(scene, scene%groups(g), warnings)
    end do
    do g = 1, size(scene%materials)
      call judge_friction(scene, laws, g, warnings)
    end do
  end subroutine check_operation

  !> The longest step is so short beside the run that it does not end.
  subroutine judge_steps(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)

    associate (strategy => scene%strategy)
      if (strategy%end_time > most_steps*strategy%largest_step) &
        call add(warnings, 'the run has '//to_text(strategy%end_time/strategy%largest_step, 3)//' steps or more: its end is at ' &
                 //to_text(strategy%end_time, 5)//', steps are '//to_text(strategy%largest_step, 3)//' long at most (STRAT)')
    end associate
  end subroutine judge_steps

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

end module physics_check
