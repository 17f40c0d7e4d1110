!> What to do where the errors that come of the path within the steps (path_error) are large in sum.
module path_advice
  use kinds, only: wp
  use path_record, only: motion_error, path_record_t, stress_error
  use text, only: to_text
  implicit none
  private
  public :: motion_advice, stress_advice

  !> The run warns above this share: runs whose steps are bounded as by default have half of it or less.
  real(wp), parameter :: largest_path_error = 0.02_wp

contains

  !> Empty where the error of the motion is small in sum.
  pure function motion_advice(path) result(advice)
    type(path_record_t), intent(in) :: path
    character(len=:), allocatable :: advice

    advice = ''
    if (.not. motion_error(path) > largest_path_error) return
    advice = 'the motion bends within steps, or temperatures err in them; half the step halves it: take a smaller PATH (NORMS), ' &
             //'TOL (THETA) or step (STRAT) and compare' &
             //least_steps(path)
  end function motion_advice

  !> Empty where the error of the stress is small now.
  pure function stress_advice(path) result(advice)
    type(path_record_t), intent(in) :: path
    character(len=:), allocatable :: advice

    advice = ''
    if (.not. stress_error(path) > largest_path_error) return
    advice = 'rates change within steps, half the step halves it: take a smaller RATE (NORMS) or step (STRAT) and compare' &
             //least_steps(path)
  end function stress_advice

  pure function least_steps(path) result(words)
    type(path_record_t), intent(in) :: path
    character(len=:), allocatable :: words

    words = ''
    if (path%above > 0) words = '; '//to_text(path%above)// &
            ' steps are above what NORMS allows (of the least length, or shortened in vain)'
  end function least_steps

end module path_advice
