!> Which points flow: as with points of contact, Newton's method searches for their set while it changes.
!>
!> A point that turns from flow to unloading takes the matrix of a state which may be a hundred times stiffer, and the residual need
!> not fall until the set is found. Where loads turn back, all that flowed unloads; near their limit the set and the residual grow
!> with the step alike, so that a shorter step has the same set to find.
module flow_changes
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: flow_set, note_flow

contains

  !> The set as it is now, and whether it is another than before.
  pure subroutine note_flow(scene, solution, set, changed)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(inout) :: set(:)   !! (n) of flow_set
    logical, intent(out) :: changed
    logical :: now(size(set))

    now = flow_set(scene, solution)
    changed = any(now .neqv. set)
    set = now
  end subroutine note_flow

  !> Points of all bodies with a plastic strain that are plastic in the trial state, one after the other.
  pure function flow_set(scene, solution) result(set)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, allocatable :: set(:)   !! (n)
    integer :: g, n, plastic, first

    n = 0
    do g = 1, size(scene%groups)
      if (place_of_plastic(g) > 0) n = n + size(solution%groups(g)%trial(1, :, :))
    end do
    allocate (set(n))
    first = 1
    do g = 1, size(scene%groups)
      plastic = place_of_plastic(g)
      if (plastic == 0) cycle
      associate (trial => solution%groups(g)%trial(plastic, :, :), committed => solution%groups(g)%committed(plastic, :, :))
        set(first:first + size(trial) - 1) = reshape(trial > committed, [size(trial)])
        first = first + size(trial)
      end associate
    end do

  contains

    !> Where a point of the group has its plastic strain, 0 for none.
    pure integer function place_of_plastic(g)
      integer, intent(in) :: g
      integer :: variable

      place_of_plastic = 0
      variable = find_variable(scene%groups(g)%variables, 'plastic_strain')
      if (variable > 0) place_of_plastic = scene%groups(g)%variables(variable)%first
    end function place_of_plastic

  end function flow_set

end module flow_changes
