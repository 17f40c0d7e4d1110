!> Multipliers in time (.LIC), imposed displacements, motions of dies, nodal forces.
module loads
  use fields, only: displacement_field
  use kinds, only: wp
  implicit none
  private
  public :: load_factor_t, start_t, field_history_t, multiplier_t, fixation_t, die_motion_t, die_force_t, nodal_force_t, exchange_t
  public :: by_flux, by_convection, by_radiation
  public :: instants_around, multiplier_at, value_in_table

  !> Piecewise linear in time, constant outside its points.
  type :: multiplier_t
    character(len=:), allocatable :: name
    real(wp), allocatable :: time(:), value(:)
    !> It stands before the operations of the deck, and is of all of them.
    logical :: shared = .false.
  end type multiplier_t

  !> Value of a field on the nodes of a body at the start, or on all nodes.
  type :: start_t
    !> Name of the body, empty for all; and place in the scene's list of fields.
    character(len=:), allocatable :: body
    integer :: field = 0
    !> Values at the nodes of the mesh (nnode), used at those of the body [of the field].
    real(wp), allocatable :: values(:)
  end type start_t

  !> Values of a field on the nodes of a body that are known beforehand, at instants; linear in time between them.
  type :: field_history_t
    !> Place in the scene's list of fields, and name of the body.
    integer :: field = 0
    character(len=:), allocatable :: body
    !> Where they come from, as the deck says it.
    character(len=:), allocatable :: source
    !> Instant of the source that is 0 here [time].
    real(wp) :: begins = 0.0_wp
    integer, allocatable :: nodes(:)
    !> Instants here, ascending (n) [time], and the values then (node, n) [of the field].
    real(wp), allocatable :: time(:), values(:, :)
  end type field_history_t

  !> Imposed motion (or value) of one component of a field at some nodes: amplitude times multiplier (0 = held).
  type :: fixation_t
    integer, allocatable :: nodes(:)
    !> Of the displacement 1 = x, 2 = y.
    integer :: component = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
    !> Place in the scene's list of fields.
    integer :: field = displacement_field
    !> The line that it holds is no wall for its body (walls).
    logical :: may_pass = .false.
    !> As the deck names it, for listings.
    character(len=:), allocatable :: label
  end type fixation_t

  !> Displacement of a die's pilot: component 1 = x, 2 = y, 3 = angle.
  type :: die_motion_t
    integer :: die = 0
    integer :: component = 0
    real(wp) :: amplitude = 1.0_wp
    integer :: multiplier = 0
  end type die_motion_t

  !> A component of a die's pilot that is free, with the force (moment) on it: amplitude times multiplier, per radian
  !> when axisymmetric; multiplier 0 for none.
  type :: die_force_t
    integer :: die = 0
    integer :: component = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
  end type die_force_t

  !> Force (what acts on a field) on one node (per radian when axisymmetric): amplitude times multiplier.
  type :: nodal_force_t
    integer :: node = 0
    integer :: component = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
    !> Place in the scene's list of fields.
    integer :: field = displacement_field
  end type nodal_force_t

  !> A multiplier that is found, so that a measure of the motion follows another one.
  type :: load_factor_t
    !> The multiplier found, 0 for none, and the one that the measure follows, times the amplitude.
    integer :: multiplier = 0, curve = 0
    real(wp) :: amplitude = 1.0_wp
    !> The measure: displacement of a node in a direction; of node 0 the work of the loads over the multiplier.
    integer :: node = 0, component = 0
    !> Forces on nodes that it multiplies (places in the scene's list).
    integer, allocatable :: forces(:)
  end type load_factor_t

  !> Kinds of heat exchange: a given flow, convection, radiation.
  integer, parameter :: by_flux = 1, by_convection = 2, by_radiation = 3

  !> Heat that passes a side, comes from a volume, or passes the faces of a sheet (elem_heat_sides, elem_heat_source).
  type :: exchange_t
    integer :: kind = by_flux
    !> The faces of a sheet that heat passes; none where it passes sides, or comes from the volume.
    logical :: faces(2) = .false.
    !> Heat flow per area, coefficient of convection, or emissivity times the constant of radiation; times a multiplier, 0 for none.
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
    !> By what it is multiplied at a temperature of the surface (2, npoint); not allocated where it is the same at all.
    real(wp), allocatable :: table(:, :)
    !> Temperature of the surroundings, times a multiplier, 0 for none; what makes temperatures absolute.
    real(wp) :: surroundings = 0.0_wp
    integer :: surroundings_multiplier = 0
    real(wp) :: zero = 0.0_wp
  end type exchange_t

contains

  !> Value and slope of a function at an abscissa.
  pure subroutine value_in_table(points, x, value, slope)
    real(wp), intent(in) :: points(:, :)     !! (2, npoint) [-]
    real(wp), intent(in) :: x
    real(wp), intent(out) :: value, slope
    integer :: i, n

    n = size(points, 2)
    slope = 0
    if (x <= points(1, 1)) then
      value = points(2, 1)
    else if (x >= points(1, n)) then
      value = points(2, n)
    else
      do i = 2, n - 1
        if (x <= points(1, i)) exit
      end do
      slope = (points(2, i) - points(2, i - 1))/(points(1, i) - points(1, i - 1))
      value = points(2, i - 1) + slope*(x - points(1, i - 1))
    end if
  end subroutine value_in_table

  !> The instant before a time, and the share of the way from it to the next one, 0 to 1: linear in time. Outside of the instants
  !> the first or the last.
  pure subroutine instants_around(times, time, before, share)
    real(wp), intent(in) :: times(:)   !! (n) ascending [time]
    real(wp), intent(in) :: time       !! [time]
    integer, intent(out) :: before     !! 1 to n - 1, 1 where there is one instant
    real(wp), intent(out) :: share     !! [-]

    before = 1
    share = 0
    if (size(times) == 1) return
    before = max(1, min(size(times) - 1, count(times <= time)))
    share = max(0.0_wp, min(1.0_wp, (time - times(before))/(times(before + 1) - times(before))))
  end subroutine instants_around

  !> Value of a multiplier at a time.
  pure function multiplier_at(multiplier, time) result(value)
    type(multiplier_t), intent(in) :: multiplier
    real(wp), intent(in) :: time
    real(wp) :: value
    integer :: i, n

    n = size(multiplier%time)
    if (time <= multiplier%time(1)) then
      value = multiplier%value(1)
    else if (time >= multiplier%time(n)) then
      value = multiplier%value(n)
    else
      do i = 2, n
        if (time <= multiplier%time(i)) exit
      end do
      value = multiplier%value(i - 1) + (multiplier%value(i) - multiplier%value(i - 1)) &
              *(time - multiplier%time(i - 1))/(multiplier%time(i) - multiplier%time(i - 1))
    end if
  end function multiplier_at

end module loads
