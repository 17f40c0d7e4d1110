!> What many transfers there and back between two unlike meshes do to a field, for every method.
module transfer_study
  use errors, only: error_t
  use kinds, only: pi, wp
  use state_pieces, only: mesh_of, state_pieces_t
  use state_variables, only: state_variable, transfer_scalar
  use transfer_api, only: transfer_options_t
  use transfer_cases, only: carry_pieces, square_grid
  use transfer_mesh, only: transfer_mesh_t
  use transfer_report, only: transfer_report_t
  implicit none
  private
  public :: loss_t, there_and_back, study_pieces, field_hill, field_band, field_edge

  !> Fields on the unit square: a round hill, a band with steep flanks, and a layer below the side y = 1.
  integer, parameter :: field_hill = 1, field_band = 2, field_edge = 3

  !> What is lost after so many transfers, over the largest value at the points of the first mesh or over its integral.
  type :: loss_t
    real(wp) :: peak = 0.0_wp
    real(wp) :: integral = 0.0_wp
    !> Mean square of the change over that of the field, as a root.
    real(wp) :: change = 0.0_wp
    !> Least value reached, over the largest of the first mesh.
    real(wp) :: least = 0.0_wp
  end type loss_t

contains

  !> The square in n x m bent elements with one scalar, `plastic_strain`.
  subroutine study_pieces(n, m, bend, pieces)
    integer, intent(in) :: n, m
    real(wp), intent(in) :: bend
    type(state_pieces_t), intent(out) :: pieces

    allocate (pieces%groups(1))
    associate (group => pieces%groups(1))
      call square_grid(n, m, bend, pieces%nodes, group%connectivity)
      group%material = 1
      group%npoint = 4
      allocate (group%variables(1))
      group%variables(1) = state_variable('plastic_strain', '-', transfer_scalar)
      group%variables(1)%first = 1
      allocate (group%values(1, 4, size(group%connectivity, 2)), source=0.0_wp)
    end associate
  end subroutine study_pieces

  pure elemental function field(kind_of, x, y) result(value)
    integer, intent(in) :: kind_of
    real(wp), intent(in) :: x, y
    real(wp) :: value

    value = 0
    select case (kind_of)
    case (field_hill)
      value = exp(-((x - 0.45_wp)**2 + (y - 0.55_wp)**2)/0.15_wp**2)
    case (field_band)
      value = 0.5_wp*(1 + tanh((0.12_wp - abs(x + y - 1.1_wp)/sqrt(2.0_wp))/0.03_wp))
    case (field_edge)
      value = exp((y - 1)/0.1_wp)*(1 + 0.3_wp*sin(2*pi*x))
    end select
  end function field

  !> Carry the field from one mesh to the other and back, `transfers` times in all (even); the losses after each return.
  subroutine there_and_back(kind_of, n, transfers, options, losses, error)
    integer, intent(in) :: kind_of, n, transfers
    type(transfer_options_t), intent(in) :: options
    type(loss_t), intent(out) :: losses(:)      !! (transfers/2)
    type(error_t), allocatable, intent(out) :: error
    type(state_pieces_t) :: one, other
    type(transfer_mesh_t) :: mesh
    type(transfer_report_t) :: report
    real(wp), allocatable :: first(:), now(:)
    integer :: k

    call study_pieces(n, n, 0.12_wp, one)
    call study_pieces(n + n/7 + 1, n - n/9, 0.15_wp, other)
    call mesh_of(one, mesh)
    allocate (first, source=field(kind_of, mesh%points(1, :), mesh%points(2, :)))
    allocate (now(size(first)))
    one%groups(1)%values(1, :, :) = reshape(first, shape(one%groups(1)%values(1, :, :)))
    do k = 1, transfers/2
      call carry_pieces(one, other, options, report, error)
      if (allocated(error)) return
      call carry_pieces(other, one, options, report, error)
      if (allocated(error)) return
      now = reshape(one%groups(1)%values(1, :, :), shape(now))
      losses(k)%peak = 1 - maxval(now)/maxval(first)
      losses(k)%integral = sum(now*mesh%volumes)/sum(first*mesh%volumes) - 1
      losses(k)%change = sqrt(sum((now - first)**2*mesh%volumes)/sum(first**2*mesh%volumes))
      losses(k)%least = minval(now)/maxval(first)
    end do
  end subroutine there_and_back

end module transfer_study
