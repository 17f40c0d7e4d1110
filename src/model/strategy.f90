!> How a run marches: steps, iterations, norms, savings (cards STRAT, NORMS, SOLVR, SAVE, STOP).
module strategy
  use kinds, only: wp
  implicit none
  private
  public :: strategy_t, order_in_time
  public :: coupling_once, coupling_converged, coupling_monolithic, coupling_names
  public :: scheme_theta, scheme_tr_bdf2

  !> How fields of several quantities (motion, temperature) are coupled in a step: solved in turns, once or until nothing
  !> changes any more, or all in one Newton iteration.
  integer, parameter :: coupling_once = 1, coupling_converged = 2, coupling_monolithic = 3
  character(len=10), parameter :: coupling_names(3) = ['ONCE      ', 'CONVERGE  ', 'MONOLITHIC']

  !> How the balance of heat is met in time: at one instant of the step or in the mean of its ends, or by TR-BDF2.
  integer, parameter :: scheme_theta = 1, scheme_tr_bdf2 = 2

  !> Patches are eliminated where matrices are large enough to be worth it.
  integer, parameter, public :: patch_by_matrix = -1

  type :: strategy_t
    !> First, least and largest step [time].
    real(wp) :: first_step = 0.0_wp, least_step = 0.0_wp, largest_step = 0.0_wp
    !> Beginning and end of the scene; it begins at 0 but for a later operation [time].
    real(wp) :: begins = 0.0_wp, end_time = 0.0_wp
    !> After n iterations the step is multiplied by (nopti/n)**(1/nalpha), within [dminmu, dmaxmu].
    integer :: nopti = 5
    real(wp) :: nalpha = 3.0_wp
    real(wp) :: dminmu = 0.25_wp, dmaxmu = 1.5_wp
    !> Iterations after which a step is cut back.
    integer :: max_iterations = 20
    !> Residual force over reference force, correction over the step's displacement.
    real(wp) :: force_norm = 1.0e-6_wp, displacement_norm = 1.0e-5_wp
    !> Largest strain increment of a step at any point (norm of the logarithmic strain).
    real(wp) :: strain_bound = 0.4_wp
    !> Longest way of a rigid die that is driven in a step [length]; 0: not bounded.
    real(wp) :: travel_bound = 0.0_wp
    !> Largest errors that come of the path within steps: of the motion of a step over the motion, and of the stress over the
    !> stress; 0: not bounded, and where both are, none is estimated (path_error).
    real(wp) :: path_bound = 0.04_wp, rate_bound = 0.008_wp
    !> Elements at most in a patch whose unknowns are eliminated before a correction; 0: none is (nonlinear_elimination).
    integer :: patch = patch_by_matrix
    !> Place of the linear solver in their list; the first is the default.
    integer :: linear_solver = 1
    !> Of no account where a scene has fields of one quantity.
    integer :: coupling = coupling_once
    !> Balance of heat: at the share theta of the step, or in the mean of its ends with theta for the later one.
    real(wp) :: theta = 1.0_wp
    logical :: theta_mean = .false.
    integer :: scheme = scheme_theta
    !> Largest error in time of a step, of the heat content over the heat capacity in the mean square of the volume; 0: steps are
    !> not chosen by it [temperature].
    real(wp) :: time_tolerance = 0.0_wp
    !> Fields are saved every so many steps, and at these times.
    integer :: save_every = 0
    real(wp), allocatable :: save_times(:)
    !> A checkpoint is written every so many steps (0 = with the fields and at the end only).
    integer :: checkpoint_every = 0
    !> Runs of other fineness are compared at these times, which are hit exactly; not allocated without ACCURACY [time].
    real(wp), allocatable :: watch_times(:)
  end type strategy_t

contains

  !> Order of the scheme of heat in the length of the step.
  elemental function order_in_time(strategy) result(order)
    type(strategy_t), intent(in) :: strategy
    integer :: order

    order = 1
    if (strategy%scheme == scheme_tr_bdf2 .or. abs(strategy%theta - 0.5_wp) < epsilon(1.0_wp)) order = 2
  end function order_in_time

end module strategy
