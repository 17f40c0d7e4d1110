!> A mesh too coarse for the shape that fronts of temperature and phases leave: said at the end of a run.
module coarse_shape
  use kinds, only: wp
  use shape_record, only: has_errors, is_shown, shape_errors_t
  use solution, only: solution_t
  use text, only: add_text, percent, string_t, to_text
  implicit none
  private
  public :: warn_of_coarse_shape, words_of_shape

  !> Errors up to this share of what they are errors of are not warned of.
  real(wp), parameter :: expected_share = 0.1_wp

contains

  !> A line, added to the warnings of a run at its end, where the shape errs by more than a share of itself, or is not shown.
  subroutine warn_of_coarse_shape(solution, warnings)
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines

    associate (errors => solution%shape%errors)
      if (.not. has_errors(errors)) return
      if (is_shown(errors) .and. errors%displacement <= expected_share*errors%of_displacement &
          .and. errors%curvature <= expected_share*errors%of_curvature) return
      call add_text(warnings, 'the mesh is coarse for the shape that is left: fronts of temperature and phases are thin beside ' &
                    //'its elements; '//words_of_shape(errors)//'; use smaller elements across the fronts (half as large: a ' &
                    //'quarter of the error), and compare (lagastudy)')
    end associate
  end subroutine warn_of_coarse_shape

  !> The errors in words.
  pure function words_of_shape(errors) result(words)
    type(shape_errors_t), intent(in) :: errors
    character(len=:), allocatable :: words

    if (.not. is_shown(errors)) then
      words = 'shape: not known: an element holds '//percent(errors%share)//' of a front in the mean'
      return
    end if
    words = 'shape:'
    if (errors%displacement > 0) words = words//' up to '//to_text(errors%displacement, 2)//' of ' &
                                         //to_text(errors%of_displacement, 3)//' [length], growth '//to_text(errors%growth, 2) &
                                         //' of '//to_text(errors%of_growth, 3)
    if (errors%displacement > 0 .and. errors%curvature > 0) words = words//';'
    if (errors%curvature > 0) words = words//' curvature of the section '//to_text(errors%curvature, 2)//' of ' &
                                      //to_text(errors%of_curvature, 3)//' [1/length]'
  end function words_of_shape

end module coarse_shape
