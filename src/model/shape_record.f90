!> What is known of the error in space of the shape that fronts of temperature and phases leave (strain_spans, shape_error).
module shape_record
  use kinds, only: wp
  implicit none
  private
  public :: has_errors, is_shown, shape_errors_t, shape_record_t

  !> Where an element holds more of a front than this, in the mean, nothing is known of what the front leaves.
  real(wp), parameter :: largest_share = 0.5_wp

  !> Errors at the end of a run, and what they are errors of: of a body its farthest displacement [length] from the shape that it
  !> had, moved, turned and grown evenly, and this growth [-]; of a section its curvatures, where they are free [1/length].
  type :: shape_errors_t
    logical :: known = .false.
    !> Share of a front that an element holds, in the mean over the bodies [-].
    real(wp) :: share = 0.0_wp
    real(wp) :: displacement = 0.0_wp, of_displacement = 0.0_wp
    real(wp) :: growth = 0.0_wp, of_growth = 0.0_wp
    real(wp) :: curvature = 0.0_wp, of_curvature = 0.0_wp
  end type shape_errors_t

  type :: shape_record_t
    !> States have been followed; least and largest temperature of their points.
    logical :: followed = .false.
    real(wp) :: coldest = 0.0_wp, hottest = 0.0_wp
    type(shape_errors_t) :: errors
  end type shape_record_t

contains

  !> The mesh shows the shape: the errors are some.
  pure function is_shown(errors) result(yes)
    type(shape_errors_t), intent(in) :: errors
    logical :: yes

    yes = errors%share <= largest_share
  end function is_shown

  !> Something is known of the shape: errors above round-off, or that the mesh does not show it.
  pure function has_errors(errors) result(yes)
    type(shape_errors_t), intent(in) :: errors
    logical :: yes

    yes = errors%known .and. (max(errors%displacement, errors%curvature) > 0 .or. .not. is_shown(errors))
  end function has_errors

end module shape_record
