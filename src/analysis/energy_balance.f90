!> What the books of energy come to: what is missing in them, what damping took, and what to do about it.
module energy_balance
  use kinds, only: wp
  use solution, only: solution_t
  use work_books, only: work_t
  implicit none
  private
  public :: damped_share, damping_advice, energy_imbalance, imbalance_advice, is_drag_alone, missing_energy

  !> The run warns above this share of what passed.
  real(wp), parameter :: largest_imbalance = 0.01_wp
  !> And where viscous forces took more than this share of it.
  real(wp), parameter :: largest_damping = 0.01_wp
  !> Drag that took more than this share of it resisted alone.
  real(wp), parameter :: of_drag = 0.1_wp

contains

  !> What came in and is neither stored nor dissipated, per radian when axisymmetric [energy].
  pure function missing_energy(solution) result(missing)
    type(solution_t), intent(in) :: solution
    real(wp) :: missing

    associate (work => solution%work)
      missing = solution%external_work + work%heat + work%overlap + work%remeshing &
                - work%elastic - work%flow - solution%friction_work - work%contact - work%damping - work%drag
    end associate
  end function missing_energy

  !> The same over all that passed. A run through which less passed than round-off amounts to has none.
  pure function energy_imbalance(solution) result(share)
    type(solution_t), intent(in) :: solution
    real(wp) :: share

    share = 0
    associate (passed => max(solution%work%passed, solution%work%round_off))
      if (passed > 0) share = missing_energy(solution)/passed
    end associate
  end function energy_imbalance

  !> What to do about an imbalance above the bound; empty where there is none.
  pure function imbalance_advice(solution) result(advice)
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice

    advice = ''
    if (abs(energy_imbalance(solution)) > largest_imbalance) &
      advice = 'motion and forces are not straight within a step: take smaller steps (STRAT) and compare, half the step halves it'
    ! without inertia there is no kinetic energy that it could become
    if (energy_imbalance(solution) > largest_imbalance) &
      advice = advice//'; what stays was released suddenly, as by a part that snaps free: it would be kinetic energy'
  end function imbalance_advice

  !> What viscous forces of damped steps took, over all that passed.
  pure function damped_share(solution) result(share)
    type(solution_t), intent(in) :: solution
    real(wp) :: share

    share = 0
    if (solution%work%damping > 0) share = solution%work%damping/max(solution%work%passed, solution%work%damping)
  end function damped_share

  !> What to say of it; empty where there is nothing.
  pure function damping_advice(solution) result(advice)
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice

    advice = ''
    if (damped_share(solution) > largest_damping) &
      advice = 'what a die held was let go suddenly, and where it came to rest depends on the way there: compare with ' &
               //'smaller steps (STRAT), or let the die withdraw at once'
  end function damping_advice

  !> Bodies were pushed about against their drag, and hardly strained: it took more than a tenth of all that passed.
  elemental function is_drag_alone(work) result(yes)
    type(work_t), intent(in) :: work
    logical :: yes

    yes = work%drag > of_drag*work%passed
  end function is_drag_alone

end module energy_balance
