!> PROBE cards: one column of the history each.
module probes
  use kinds, only: wp
  implicit none
  private
  public :: probe_t, is_elsewhere
  public :: probe_node, probe_reaction, probe_point, probe_maximum, probe_minimum, probe_mean

  !> Kinds: coordinate or displacement of a node; sum of reactions of a set; state at a point; extremes and mean over a
  !> group.
  integer, parameter :: probe_node = 1
  integer, parameter :: probe_reaction = 2
  integer, parameter :: probe_point = 3
  integer, parameter :: probe_maximum = 4
  integer, parameter :: probe_minimum = 5
  integer, parameter :: probe_mean = 6

  type :: probe_t
    character(len=:), allocatable :: name, unit
    integer :: kind = 0
    !> Node kind: 1 = x, 2 = y, 3 = displacement x, 4 = displacement y. Reaction kind: 1 = x, 2 = y.
    integer :: quantity = 0
    !> Field of nodes that is not the displacement (position in the scene's list), 0 for this or for the state.
    integer :: field = 0
    !> Nodes asked for (one for the node kind).
    integer, allocatable :: nodes(:)
    !> From the node to the position asked for; 0 where that is a node of the deck's own mesh [length].
    real(wp) :: offset(2) = 0.0_wp
    !> Place of the node or of the point that is read, in the deck's own mesh, and its distance from the one asked for [length].
    real(wp) :: place(2) = 0.0_wp, apart = 0.0_wp
    !> Group, element and point, and component of the state, for the kinds that read the state.
    integer :: group = 0, element = 0, point = 0, component = 0
    !> Further groups of a mean, and the component of the state there.
    integer, allocatable :: more_groups(:), more_components(:)
    !> Measure of the stress whose first component that is (stress_measures), 0 for the component itself.
    integer :: measure = 0
    !> What it reads was cut off: it is nan.
    logical :: is_gone = .false.
    !> Factor, for instance 2 pi for forces of axisymmetric scenes.
    real(wp) :: factor = 1.0_wp
  end type probe_t

  !> Node and point are taken to be where they were asked for up to this share of the size of the mesh.
  real(wp), parameter :: same_place = 1.0e-6_wp

contains

  !> The node or point that is read is not where it was asked for: on other meshes it is another one. Not so before there is a mesh.
  pure function is_elsewhere(probe, coordinates) result(is)
    type(probe_t), intent(in) :: probe
    real(wp), intent(in) :: coordinates(:, :)   !! (2, nnode) of the deck's own mesh [length]
    logical :: is

    is = size(coordinates, 2) > 0
    if (is) is = probe%apart > same_place*maxval(maxval(coordinates, 2) - minval(coordinates, 2))
  end function is_elsewhere

end module probes
