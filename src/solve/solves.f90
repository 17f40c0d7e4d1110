!> Solves: which fields are solved for together. A step is a list of solves.
!>
!> One solve with all fields is the monolithic way; one for each quantity (motion, temperature), in turns, the staggered way. A
!> solve has equations for the free unknowns of its own fields, the pattern of its matrix, and a linear solver. Unknowns of other
!> fields are given: their motion in the step is what their own solve has found, or predicted.
!> Source of the split: C.A. Felippa, K.C. Park, Comput. Meth. Appl. Mech. Eng. 24 (1980) 61-111.
module solves
  use dofs, only: dofs_t
  use fields, only: field_t, solved_with
  use kinds, only: wp
  use linear_solver, only: linear_solver_t
  use sparsity, only: build_pattern, pattern_t
  use strategy, only: coupling_monolithic
  implicit none
  private
  public :: solve_t, list_solves, number_equations, quantities_of, set_up_pattern

  type :: solve_t
    !> Quantities solved for, for listings.
    character(len=:), allocatable :: name
    !> Fields of the scene that are solved for (nfield), and groups whose elements act on one of them (ngroup).
    logical, allocatable :: own(:), active(:)
    !> Number of equations; equation of each unknown (ndof), 0 where it is prescribed or given.
    integer :: neq = 0
    integer, allocatable :: equation(:)
    !> Unknowns of the own fields (ndof).
    logical, allocatable :: is_own(:)
    type(pattern_t) :: pattern
    real(wp), allocatable :: values(:)
    type(linear_solver_t) :: solver
    !> The solver knows the pattern.
    logical :: analysed = .false.
  end type solve_t

contains

  !> The solves of a scene: one for each quantity in the order of the fields from the last to the first (temperature before
  !> motion, which it drives), or a single one.
  subroutine list_solves(fields, coupling, solves)
    type(field_t), intent(in) :: fields(:)   !! (nfield)
    integer, intent(in) :: coupling
    type(solve_t), allocatable, intent(out) :: solves(:)   !! (nsolve)
    logical :: left(size(fields))
    integer :: f, n

    allocate (solves(0))
    ! fields whose values are given belong to no solve
    left = fields%declared .and. .not. fields%given
    if (coupling == coupling_monolithic .or. .not. any(left)) then
      deallocate (solves)
      allocate (solves(1))
      allocate (solves(1)%own(size(fields)), source=.true.)
      solves(1)%name = 'all fields'
      return
    end if
    deallocate (solves)
    allocate (solves(count_quantities(fields)))
    n = 0
    do f = size(fields), 1, -1
      if (.not. left(f)) cycle
      n = n + 1
      solves(n)%name = solved_with(fields(f))
      allocate (solves(n)%own(size(fields)), source=is_of(fields, solved_with(fields(f))) .and. .not. fields%given)
      left = left .and. .not. solves(n)%own
    end do
  end subroutine list_solves

  !> Fields that are solved for with a quantity.
  pure function is_of(fields, quantity) result(yes)
    type(field_t), intent(in) :: fields(:)
    character(len=*), intent(in) :: quantity
    logical :: yes(size(fields))
    integer :: f

    do f = 1, size(fields)
      yes(f) = solved_with(fields(f)) == quantity
    end do
  end function is_of

  !> Different quantities among the declared fields.
  pure function count_quantities(fields) result(n)
    type(field_t), intent(in) :: fields(:)
    integer :: n
    integer :: f

    n = 0
    do f = 1, size(fields)
      if (.not. fields(f)%declared .or. fields(f)%given) cycle
      if (any(is_of(fields(:f - 1), solved_with(fields(f))) .and. fields(:f - 1)%declared)) cycle
      n = n + 1
    end do
  end function count_quantities

  !> Number the equations of the free unknowns of a solve, and find the groups that act on its fields.
  pure subroutine number_equations(dofs, solve)
    type(dofs_t), intent(in) :: dofs
    type(solve_t), intent(inout) :: solve
    integer :: d, f, g, k

    allocate (solve%is_own(dofs%ndof), source=.false.)
    do f = 1, size(dofs%fields)
      if (.not. solve%own(f)) cycle
      associate (number => dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do d = 1, size(number, 1)
            if (number(d, k) > 0) solve%is_own(number(d, k)) = .true.
          end do
        end do
      end associate
    end do
    allocate (solve%equation(dofs%ndof), source=0)
    solve%neq = 0
    do d = 1, dofs%ndof
      if (.not. (dofs%is_free(d) .and. solve%is_own(d))) cycle
      solve%neq = solve%neq + 1
      solve%equation(d) = solve%neq
    end do
    allocate (solve%active(size(dofs%groups)), source=.false.)
    do g = 1, size(dofs%groups)
      associate (layout => dofs%groups(g)%layout)
        do k = 1, layout%nfield
          if (layout%acts(k)) solve%active(g) = solve%active(g) .or. solve%own(layout%field(k))
        end do
      end associate
    end do
  end subroutine number_equations

  !> How many quantities a solve has equations for.
  pure function quantities_of(dofs, solve) result(n)
    type(dofs_t), intent(in) :: dofs
    type(solve_t), intent(in) :: solve
    integer :: n
    integer :: q

    n = count([(any(solve%equation > 0 .and. dofs%quantity == q), q=1, size(dofs%quantities))])
  end function quantities_of

  !> Pattern of the matrix of a solve, and room for its nonzeros; the solver analyses it before the next factorisation.
  subroutine set_up_pattern(dofs, symmetric, solve)
    type(dofs_t), intent(in) :: dofs
    logical, intent(in) :: symmetric
    type(solve_t), intent(inout) :: solve

    call build_pattern(dofs, solve%neq, solve%equation, solve%active, symmetric, solve%pattern)
    if (allocated(solve%values)) deallocate (solve%values)
    allocate (solve%values(solve%pattern%nnz))
    solve%analysed = .false.
  end subroutine set_up_pattern

end module solves
