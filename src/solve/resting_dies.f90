!> Dies that are free, and that nothing acts on, rest; and what is free of a die where no force answers its motion.
!>
!> A pilot that FORCE or FREE releases has nothing to hold it but contact and springs. Where it has neither, and no force is on it
!> at the end of a step, it is in equilibrium wherever it is: it is not predicted to go on with its last motion, and until a contact
!> closes its equation, which is empty, has a diagonal. Where all points that touch it slide, friction does not answer its motion
!> across them: its equation has a diagonal too. None of this changes a force. Where a force is on it that nothing answers the
!> equation stays empty, and the matrix is singular.
!>
!> A die that a force has taken over a gap starts just in touch (seating): contact has hardly any pressure there, so that friction,
!> and the normals of a bend, hardly answer what else is free of it. A correction by such a matrix would throw it off the part.
!> Until contact has taken half of the force a share of its stiffness is added to the diagonals of the pilot: in the matrix alone.
module resting_dies
  use contact_changes, only: touching_dies
  use dofs, only: dofs_t
  use fields, only: pilot_field
  use kinds, only: wp
  use matrix_pattern, only: add_to_diagonal, matrix_pattern_t
  use scene, only: role_spring, scene_t
  use solution, only: solution_t
  use solves, only: solve_t
  implicit none
  private
  public :: has_spring, hold_free_dies, idle_dies, leave_dies_at_rest, unresisted_pilots

  !> Entries of the matrix below this share of the largest one are round-off.
  real(wp), parameter :: nothing = 1.0e-14_wp
  !> Share of its force that a die just in touch still has to give to contact, and what holds it over the contact's stiffness.
  real(wp), parameter :: not_taken = 0.5_wp, held_until_taken = 1.0e-3_wp

contains

  !> Dies that touch nothing as a step begins, or touch without a force.
  pure function idle_dies(scene, solution) result(idle)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: idle(size(scene%dies))   !! (ndie)
    integer :: k

    idle = touching_dies(scene, solution, at_start=.true.) == 0
    associate (applied => solution%fields(pilot_field)%applied)
      do k = 1, size(idle)
        idle(k) = idle(k) .or. .not. any(abs(applied(:, k)) > 0)
      end do
    end associate
  end function idle_dies

  !> Take back the predicted motion of what is free of idle dies that no force acts on at the end of the step.
  pure subroutine leave_dies_at_rest(scene, dofs, solution, external, du)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: external(:)   !! (ndof) forces at the end of the step [residual]
    real(wp), intent(inout) :: du(:)      !! (ndof) motion of the step [unknown]
    logical :: idle(size(scene%dies))
    integer :: k

    if (size(scene%die_forces) == 0) return
    idle = idle_dies(scene, solution)
    do k = 1, size(scene%die_forces)
      associate (load => scene%die_forces(k))
        if (.not. idle(load%die) .or. has_spring(scene, load%die, load%component)) cycle
        associate (d => dofs%fields(pilot_field)%number(load%component, load%die))
          if (d == 0) cycle
          if (.not. abs(external(d)) > 0) du(d) = 0
        end associate
      end associate
    end do
  end subroutine leave_dies_at_rest

  !> A diagonal for the equations of pilots that have no column: for those that are empty and without a residual, and for those of
  !> dies whose points all slide, as large as what their pressures make of friction. A die that friction alone holds comes so to
  !> where one of its points sticks.
  pure subroutine hold_free_dies(dofs, residual, seated, lever, solve, slides)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: residual(:)     !! (ndof) [residual]
    real(wp), intent(in) :: seated(:)       !! (ndie) forces on dies that the step started just in touch, 0 for others [force]
    real(wp), intent(in) :: lever           !! size of the scene [length]
    type(solve_t), intent(inout) :: solve   !! its matrix
    logical, intent(out) :: slides(:, :)    !! (3, ndie) components of pilots held in the latter way
    real(wp) :: column(0:solve%neq), row(solve%neq), diagonal(0:solve%neq)
    real(wp) :: across
    logical :: touching
    integer :: c, k

    slides = .false.
    associate (pilot => dofs%fields(pilot_field)%number)
      if (.not. any(solve%equation(pack(pilot, pilot > 0)) > 0)) return
      call largest_of_columns(solve%pattern, solve%values, column)
      row = 0
      do k = 1, solve%pattern%nnz
        row(solve%pattern%row(k)) = row(solve%pattern%row(k)) + abs(solve%values(k))
      end do
      diagonal = 0
      do k = 1, size(pilot, 2)
        touching = seated(k) > 0
        if (touching) touching = norm2(pack(residual(max(1, pilot(:2, k))), pilot(:2, k) > 0)) > not_taken*seated(k)
        if (touching) across = stiffness_across(pilot(:2, k))
        do c = 1, size(pilot, 1)
          if (pilot(c, k) == 0) cycle
          associate (equation => solve%equation(pilot(c, k)))
            if (equation == 0) cycle
            if (touching) then
              diagonal(equation) = held_until_taken*across*merge(lever**2, 1.0_wp, c == 3)
              cycle
            end if
            if (column(equation) > nothing*column(0)) cycle
            slides(c, k) = row(equation) > nothing*column(0)
            if (slides(c, k)) diagonal(equation) = row(equation)
            if (.not. (slides(c, k) .or. abs(residual(pilot(c, k))) > 0)) diagonal(equation) = column(0)
          end associate
        end do
      end do
    end associate
    if (any(diagonal > 0)) call add_to_diagonal(solve%pattern, diagonal, solve%values)

  contains

    !> Largest diagonal of the equations of a pilot along X and Y.
    pure function stiffness_across(number) result(stiffness)
      integer, intent(in) :: number(2)   !! its unknowns, 0 for none
      real(wp) :: stiffness              !! [force/length]
      real(wp) :: own(2)
      integer :: i, n

      own = 0
      do n = 1, solve%pattern%nnz
        if (solve%pattern%row(n) /= solve%pattern%column(n)) cycle
        do i = 1, 2
          if (number(i) == 0) cycle
          if (solve%equation(number(i)) == solve%pattern%row(n)) own(i) = own(i) + solve%values(n)
        end do
      end do
      stiffness = maxval(own)
    end function stiffness_across
  end subroutine hold_free_dies

  !> Components of pilots that have an equation, and whose motion changes no force of the last matrix of the solve.
  pure function unresisted_pilots(dofs, solve) result(unresisted)
    type(dofs_t), intent(in) :: dofs
    type(solve_t), intent(in) :: solve
    logical :: unresisted(size(dofs%fields(pilot_field)%number, 1), size(dofs%fields(pilot_field)%number, 2))   !! (3, ndie)
    real(wp) :: largest(0:solve%neq)
    integer :: c, k

    unresisted = .false.
    if (.not. allocated(solve%values)) return
    call largest_of_columns(solve%pattern, solve%values, largest)
    associate (pilot => dofs%fields(pilot_field)%number)
      do k = 1, size(pilot, 2)
        do c = 1, size(pilot, 1)
          if (pilot(c, k) == 0) cycle
          associate (equation => solve%equation(pilot(c, k)))
            unresisted(c, k) = equation > 0 .and. largest(equation) <= nothing*largest(0)
          end associate
        end do
      end do
    end associate
  end function unresisted_pilots

  !> Largest entry of every column of a matrix by its size, and in all of it.
  pure subroutine largest_of_columns(pattern, values, largest)
    class(matrix_pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: values(:)      !! (nnz) [residual/unknown]
    real(wp), intent(out) :: largest(0:)   !! (0:neq); that of 0 is of all columns
    integer :: k

    largest = 0
    do k = 1, pattern%nnz
      associate (i => pattern%row(k), j => pattern%column(k))
        largest(j) = max(largest(j), abs(values(k)))
        if (pattern%symmetric) largest(i) = max(largest(i), abs(values(k)))
        largest(0) = max(largest(0), abs(values(k)))
      end associate
    end do
  end subroutine largest_of_columns

  !> A spring ties a component of a pilot.
  pure function has_spring(scene, die, component) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die, component
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        yes = yes .or. (group%role == role_spring .and. group%die == die .and. group%component == component)
      end associate
    end do
  end function has_spring

end module resting_dies
