!> The invariant of bodies with phases: at every point each fraction is in [0, 1], and they sum to 1.
module phase_books
  use errors, only: error_t, exit_bug, fail
  use kinds, only: wp
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: transfer_fraction
  use text, only: to_text
  implicit none
  private
  public :: book_fractions, fraction_slack, has_fractions

  !> By how much fractions may miss 0, 1 or their sum: round-off of a few terms.
  real(wp), parameter :: fraction_slack = 1.0e-12_wp

contains

  !> Some points of the scene have phases.
  pure function has_fractions(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      yes = yes .or. any(is_fraction(scene%groups(g)))
    end do
  end function has_fractions

  !> The largest error of the fractions of a step just found, kept if it is the largest so far. One that is no round-off is a bug.
  subroutine book_fractions(scene, solution, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(error_t), allocatable, intent(out) :: error
    logical, allocatable :: here(:)
    real(wp) :: worst
    integer :: g, first, last

    do g = 1, size(scene%groups)
      allocate (here, source=is_fraction(scene%groups(g)))
      if (any(here)) then
        first = scene%groups(g)%variables(findloc(here, .true., 1))%first
        last = scene%groups(g)%variables(findloc(here, .true., 1, back=.true.))%first
        worst = worst_of(solution%groups(g)%trial(first:last, :, :))
        solution%worst_fraction = max(solution%worst_fraction, worst)
        if (worst > fraction_slack) then
          call fail(error, exit_bug, 'step '//to_text(solution%step)//': fractions of phases of '//scene%groups(g)%name &
                    //' miss [0, 1] or their sum 1 by '//to_text(worst, 3))
          return
        end if
      end if
      deallocate (here)
    end do
  end subroutine book_fractions

  !> Which of the variables of a group are fractions of the phases of a steel: they stand together.
  pure function is_fraction(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes(size(group%variables))
    integer :: k

    do k = 1, size(yes)
      yes(k) = group%variables(k)%transfer == transfer_fraction
    end do
  end function is_fraction

  !> By how much fractions leave [0, 1], or their sum 1.
  pure function worst_of(z) result(worst)
    real(wp), intent(in) :: z(:, :, :)   !! (fraction, point, element) [-]
    real(wp) :: worst
    real(wp) :: off
    integer :: e, p

    worst = 0
    do e = 1, size(z, 3)
      do p = 1, size(z, 2)
        off = max(abs(sum(z(:, p, e)) - 1), -minval(z(:, p, e)), maxval(z(:, p, e)) - 1)
        ! a fraction that is no number is none
        if (.not. (all(z(:, p, e) <= huge(off)) .and. all(z(:, p, e) >= -huge(off)))) off = huge(off)
        worst = max(worst, off)
      end do
    end do
  end function worst_of

end module phase_books
