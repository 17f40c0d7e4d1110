!> Loads that few sides of elements have borne, noted step by step and told at the end.
module narrow_loads
  use fields, only: pilot_field
  use kinds, only: wp
  use narrow_contacts, only: few_sides, measure_narrow, narrow_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: to_text
  use vectors, only: length_of
  implicit none
  private
  public :: narrow_words, note_narrow

  !> Told from this share of the largest force on; noted from this error of the stress on, at which new meshes are due by default.
  real(wp), parameter :: main_share = 0.5_wp, large_error = 0.05_wp

contains

  !> Keep of the steps in which few sides bore a die that with the largest force.
  pure subroutine note_narrow(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! at an accepted instant
    type(narrow_t) :: now
    real(wp) :: force

    if (.not. scene%remesh%on) return
    now = measure_narrow(scene, solution)
    if (.not. (now%across < few_sides .and. now%error > large_error)) return
    force = length_of(solution%fields(pilot_field)%applied(1:2, now%die))
    associate (record => solution%narrow)
      record%until = solution%time
      if (.not. force > record%force) return
      record%die = now%die
      record%force = force
      record%across = now%across
      record%error = now%error
    end associate
  end subroutine note_narrow

  !> What is known of it at the end; nothing where there was none, or with a small force.
  pure function narrow_words(scene, solution) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: words

    words = ''
    associate (record => solution%narrow)
      if (record%die == 0 .or. record%die > size(scene%dies)) return
      if (.not. record%force > main_share*solution%largest_force) return
      words = 'up to time '//to_text(record%until, 4)//' die '//scene%dies(record%die)%name &
              //' was borne by few sides of elements, '//to_text(record%across, 2)//' across its contact where it bore ' &
              //to_text(100*record%force/solution%largest_force, 3)//' % of the largest force: the width of that is known to ' &
              //'within half a side, '//to_text(50/record%across, 2)//' %, and the force with it (error of the stress behind ' &
              //'these sides: '//to_text(100*record%error, 2)//' %); smaller elements there (REMSH SIZE, WINDOW) show what it is'
    end associate
  end function narrow_words

end module narrow_loads
