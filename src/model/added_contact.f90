!> What a run takes over as contacts are added to its scene: all of its state. Groups and dies that are new stand behind the others
!> (folding_bodies).
module added_contact
  use fields, only: on_pilots
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t, start_solution
  implicit none
  private
  public :: take_over_state

contains

  !> The state in a scene that has more contacts and dies than the one it is of, and is the same otherwise.
  pure subroutine take_over_state(before, scene, after)
    type(solution_t), intent(in) :: before
    type(scene_t), intent(in) :: scene           !! the new one
    type(solution_t), intent(out) :: after
    type(solution_t) :: fresh
    integer :: f, n

    call start_solution(scene, fresh, before%time)
    after = before
    n = size(before%groups)
    after%groups = [before%groups, fresh%groups(n + 1:)]
    n = size(before%pairs)
    after%pairs = [before%pairs, fresh%pairs(n + 1:)]
    do f = 1, size(fresh%fields)
      if (fresh%fields(f)%place /= on_pilots) cycle
      associate (old => before%fields(f), new => fresh%fields(f), now => after%fields(f))
        now%value = extended(old%value, new%value)
        now%last_increment = extended(old%last_increment, new%last_increment)
        now%older_increment = extended(old%older_increment, new%older_increment)
        now%applied = extended(old%applied, new%applied)
        now%reaction = extended(old%reaction, new%reaction)
      end associate
    end do
    n = size(before%heat%die_error)
    if (n > 0) after%heat%die_error = [before%heat%die_error, fresh%heat%die_error(n + 1:)]
  end subroutine take_over_state

  !> Values of before, and behind them those of new places.
  pure function extended(before, new) result(values)
    real(wp), intent(in) :: before(:, :), new(:, :)   !! (component, place) [unit of the field]
    real(wp) :: values(size(new, 1), size(new, 2))

    values = new
    values(:, :size(before, 2)) = before
  end function extended

end module added_contact
