!> What elements answer: how a block of them was computed, and the sums over a group at an accepted instant.
module element_report
  use kinds, only: wp
  implicit none
  private
  public :: report_t, totals_t, add_totals
  public :: block_done, block_inverted, block_law_failed, block_without_source

  !> Answers of a block.
  integer, parameter :: block_done = 0
  integer, parameter :: block_inverted = 1     !! an element has turned inside out
  integer, parameter :: block_law_failed = 2   !! a law gave up
  integer, parameter :: block_without_source = 3   !! the ellipsoid of a torch is outside its bodies

  !> Report of a block: its status, the element that failed, the largest strain increment.
  type :: report_t
    integer :: status = block_done
    integer :: element = 0
    !> Filled in by the element loop.
    integer :: group = 0
    real(wp) :: strain = 0.0_wp
    !> Share of the step after which contact begins somewhere, with little overlap; 1 when it need not be shortened.
    real(wp) :: event = 1.0_wp
    !> Share of the step after which a side begins to go through a die unseen; 1 when none does.
    real(wp) :: passed = 1.0_wp
    !> A point meets a piece of a deformable die that it is not paired with: its contact is missing.
    logical :: unpaired = .false.
    !> Largest change of penetration at a point already in contact, over the side.
    real(wp) :: jump = 0.0_wp
    !> Points in contact as the step began, and those of them that no longer are.
    integer :: bearing = 0, lost = 0
    !> A side is in contact between its points.
    logical :: between = .false.
    !> Square of the norm of the sources within the elements, which the other terms of the elements balance [power^2].
    real(wp) :: source = 0.0_wp
    !> Heat that the elements took up in the step, and that sources released in them [energy].
    real(wp) :: heat_stored = 0.0_wp, heat_released = 0.0_wp
    !> In mode_error: integrals of the squares of the error of the heat content, over the least capacity, and of the temperature,
    !> and the volume [temperature^2 volume], [volume].
    real(wp) :: error_square = 0.0_wp, temperature_square = 0.0_wp, error_volume = 0.0_wp
  end type report_t

  !> Sums over a group at an accepted instant (per radian when axisymmetric), and extremes.
  type :: totals_t
    real(wp) :: volume = 0.0_wp
    !> What the volume would be without elastic strain.
    real(wp) :: unloaded_volume = 0.0_wp
    real(wp) :: elastic_energy = 0.0_wp
    !> What points carry of plastic work, over their volumes of now: of one instant, to compare the state of two meshes.
    real(wp) :: plastic_work = 0.0_wp
    real(wp) :: friction_work = 0.0_wp
    !> Since the instant before: what flow dissipated, what penalties and multipliers of contact took, and the sum over the points
    !> of the sizes of changes of elastic energy.
    real(wp) :: dissipated = 0.0_wp, contact_work = 0.0_wp, passed = 0.0_wp
    !> Least increment of dissipated work at any point since the instant before.
    real(wp) :: least_dissipation = 0.0_wp
    !> Largest penetration, and the largest over what its side allows.
    real(wp) :: max_penetration = 0.0_wp
    real(wp) :: penetration_ratio = 0.0_wp
    integer :: open = 0, stick = 0, slip = 0
  end type totals_t

contains

  !> Add the measures of one group to the totals of the scene.
  pure subroutine add_totals(sum, part)
    type(totals_t), intent(inout) :: sum
    type(totals_t), intent(in) :: part

    sum%volume = sum%volume + part%volume
    sum%unloaded_volume = sum%unloaded_volume + part%unloaded_volume
    sum%elastic_energy = sum%elastic_energy + part%elastic_energy
    sum%plastic_work = sum%plastic_work + part%plastic_work
    sum%friction_work = sum%friction_work + part%friction_work
    sum%dissipated = sum%dissipated + part%dissipated
    sum%contact_work = sum%contact_work + part%contact_work
    sum%passed = sum%passed + part%passed
    sum%least_dissipation = min(sum%least_dissipation, part%least_dissipation)
    sum%max_penetration = max(sum%max_penetration, part%max_penetration)
    sum%penetration_ratio = max(sum%penetration_ratio, part%penetration_ratio)
    sum%open = sum%open + part%open
    sum%stick = sum%stick + part%stick
    sum%slip = sum%slip + part%slip
  end subroutine add_totals

end module element_report
