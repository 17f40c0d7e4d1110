!> The state of all solid elements as one table (component, point): of which variables, into it, and back to the groups.
module state_table
  use errors, only: error_t, exit_bug, fail
  use kinds, only: wp
  use state_pieces, only: state_group_t
  use state_variables, only: find_variable, state_variable_t
  use text, only: to_text
  implicit none
  private
  public :: list_variables, gather_states, hand_out_states

contains

  !> Variables of all groups of some kinds, each name once, with its first row in a table of them all.
  pure subroutine list_variables(groups, kinds_taken, variables, error)
    type(state_group_t), intent(in) :: groups(:)                       !! (ngroup)
    character(len=*), intent(in) :: kinds_taken(:)                     !! (nkind)
    type(state_variable_t), allocatable, intent(out) :: variables(:)   !! (nvariable)
    type(error_t), allocatable, intent(out) :: error
    type(state_variable_t), allocatable :: list(:)
    integer :: g, v, k, n, most

    most = 0
    do g = 1, size(groups)
      most = most + size(groups(g)%variables)
    end do
    allocate (list(most))
    n = 0
    do g = 1, size(groups)
      do v = 1, size(groups(g)%variables)
        associate (variable => groups(g)%variables(v))
          if (.not. any(kinds_taken == variable%transfer)) cycle
          k = find_variable(list(:n), variable%name)
          if (k == 0) then
            n = n + 1
            list(n) = variable
            list(n)%first = 1
            if (n > 1) list(n)%first = list(n - 1)%first + list(n - 1)%ncomp
          else if (list(k)%ncomp /= variable%ncomp .or. list(k)%transfer /= variable%transfer) then
            call fail(error, exit_bug, 'state transfer: '//variable%name//' is declared as '//list(k)%transfer//' of ' &
                      //to_text(list(k)%ncomp)//' and as '//variable%transfer//' of '//to_text(variable%ncomp)//' components')
            return
          end if
        end associate
      end do
    end do
    allocate (variables, source=list(:n))
  end subroutine list_variables

  !> Put the groups' values of the listed variables into one table (component, point); zero where a group has no such variable.
  pure subroutine gather_states(groups, variables, table)
    type(state_group_t), intent(in) :: groups(:)         !! (ngroup)
    type(state_variable_t), intent(in) :: variables(:)   !! (nvariable)
    real(wp), intent(out) :: table(:, :)                 !! (component, point) [unit of each component]
    integer :: g, v, k, e, from, last, offset

    table = 0
    offset = 0
    do g = 1, size(groups)
      do v = 1, size(variables)
        k = find_variable(groups(g)%variables, variables(v)%name)
        if (k == 0) cycle
        from = groups(g)%variables(k)%first
        last = variables(v)%ncomp - 1
        do e = 1, size(groups(g)%values, 3)
          associate (points => table(:, offset + (e - 1)*groups(g)%npoint + 1:offset + e*groups(g)%npoint))
            points(variables(v)%first:variables(v)%first + last, :) = groups(g)%values(from:from + last, :, e)
          end associate
        end do
      end do
      offset = offset + groups(g)%npoint*size(groups(g)%connectivity, 2)
    end do
  end subroutine gather_states

  !> States of the groups from the table; a variable that is not in the list, or in no old group of the number, gets its declared
  !> initial value.
  pure subroutine hand_out_states(old, variables, table, groups)
    type(state_group_t), intent(in) :: old(:)            !! (ngroup)
    type(state_variable_t), intent(in) :: variables(:)   !! (nvariable)
    real(wp), intent(in) :: table(:, :)                  !! (component, point) [unit of each component]
    type(state_group_t), intent(inout) :: groups(:)      !! (ngroup)
    integer :: g, v, k, e, from, last, offset, n

    offset = 0
    do g = 1, size(groups)
      n = size(groups(g)%connectivity, 2)
      if (allocated(groups(g)%values)) deallocate (groups(g)%values)
      allocate (groups(g)%values(sum(groups(g)%variables%ncomp), groups(g)%npoint, n))
      do v = 1, size(groups(g)%variables)
        associate (variable => groups(g)%variables(v), npoint => groups(g)%npoint)
          from = variable%first
          last = variable%ncomp - 1
          k = 0
          if (is_known(old, groups(g)%material, variable%name)) k = find_variable(variables, variable%name)
          if (k == 0) then
            groups(g)%values(from:from + last, :, :) = variable%initial
            cycle
          end if
          do e = 1, n
            groups(g)%values(from:from + last, :, e) = table(variables(k)%first:variables(k)%first + last, &
                                                             offset + (e - 1)*npoint + 1:offset + e*npoint)
          end do
        end associate
      end do
      offset = offset + groups(g)%npoint*n
    end do
  end subroutine hand_out_states

  !> Every old group of the number has the variable.
  pure function is_known(groups, material, name) result(yes)
    type(state_group_t), intent(in) :: groups(:)
    integer, intent(in) :: material
    character(len=*), intent(in) :: name
    logical :: yes
    integer :: g

    yes = .true.
    do g = 1, size(groups)
      if (groups(g)%material == material) yes = yes .and. find_variable(groups(g)%variables, name) > 0
    end do
  end function is_known

end module state_table
