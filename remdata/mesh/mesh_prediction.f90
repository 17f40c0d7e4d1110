!> The error expected of a mesh, from its sizes relative to the requested ones.
!>
!> An element of the requested size has an error equal to the limit; the error varies with the size to the power p. Zones cannot
!> follow every size, and the number of elements may be limited: the prediction shows the effect of both.
module mesh_prediction
  use block_mesh, only: polygon_area
  use directed_sizes, only: ratio_of
  use kinds, only: wp
  use size_field, only: directed_size_at, is_in_window, size_field_t
  use zone_mesh, only: new_mesh_t
  implicit none
  private
  public :: prediction_t, predict

  type :: prediction_t
    !> Error over its limit: square mean over the area, and of the worst element.
    real(wp) :: mean = 0.0_wp, worst = 0.0_wp
    !> Square mean over the area of the windows; 0 without any.
    real(wp) :: in_windows = 0.0_wp
    !> Elements divided by the number that the requested sizes would need: above 1 where zones need more.
    real(wp) :: elements = 0.0_wp
  end type prediction_t

contains

  pure function predict(mesh, field, order) result(prediction)
    type(new_mesh_t), intent(in) :: mesh
    type(size_field_t), intent(in) :: field
    real(wp), intent(in) :: order
    type(prediction_t) :: prediction
    real(wp) :: x(2, 4), middle(2), area, total, within, across, stretch(2), ratio
    integer :: e

    total = 0
    within = 0
    do e = 1, size(mesh%zone)
      x = mesh%coordinates(:, mesh%connectivity(1:4, e))
      area = polygon_area(x)
      middle = 0.25_wp*sum(x, 2)
      call directed_size_at(field, mesh%layout%zones(mesh%zone(e))%material, middle, across, stretch)
      ratio = sqrt(max(area, 0.0_wp)/ratio_of(stretch))/across
      prediction%mean = prediction%mean + area*ratio**(2*order)
      prediction%worst = max(prediction%worst, ratio**order)
      prediction%elements = prediction%elements + ratio**2
      total = total + area
      if (.not. is_in_window(field, mesh%layout%zones(mesh%zone(e))%material, middle)) cycle
      prediction%in_windows = prediction%in_windows + area*ratio**(2*order)
      within = within + area
    end do
    prediction%mean = sqrt(prediction%mean/total)
    if (within > 0) prediction%in_windows = sqrt(prediction%in_windows/within)
    prediction%elements = size(mesh%zone)/prediction%elements
  end function predict

end module mesh_prediction
