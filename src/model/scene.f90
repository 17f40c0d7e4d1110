!> A scene: everything a deck says, fixed for the length of a run.
module scene
  use dies, only: die_t
  use effects, only: effect_t
  use kinds, only: wp
  use loads, only: die_motion_t, fixation_t, multiplier_t, nodal_force_t
  use materials, only: material_t
  use mesh, only: mesh_t
  use probes, only: probe_t
  use state_variables, only: state_variable_t
  use strategy, only: strategy_t
  implicit none
  private
  public :: scene_t, group_t, plane_strain, axisymmetric, plane_state_names

  !> Plane states.
  integer, parameter :: plane_strain = 1
  integer, parameter :: axisymmetric = 2
  character(len=6), parameter :: plane_state_names(2) = ['PLSTN ', 'AXISYM']

  !> Elements of one ELEM and one LAW with their state: the unit of the element loop.
  type :: group_t
    character(len=:), allocatable :: name
    !> Member of the ELEM family, by name and place in its list.
    character(len=:), allocatable :: elem
    integer :: elem_id = 0
    !> Material (place in the scene's list); 0 for elements without a law.
    integer :: material = 0
    !> Integration points of an element (negative: at equal distances).
    integer :: npoint = 0
    !> Nodes (nnode, nelem).
    integer, allocatable :: connectivity(:, :)
    !> Die faced by contact elements, multiplier and amplitude of load elements; 0 where unused.
    integer :: die = 0
    integer :: multiplier = 0
    real(wp) :: amplitude = 0.0_wp
    !> Declared state of a point, with places in the state array.
    type(state_variable_t), allocatable :: variables(:)
  end type group_t

  type :: scene_t
    character(len=:), allocatable :: title
    integer :: plane_state = 0
    !> Member of the kinematics family, by name and place in its list.
    character(len=:), allocatable :: kinematics
    integer :: kinematics_id = 0
    !> The geometry follows the displacements.
    logical :: finite = .true.
    type(mesh_t) :: mesh
    type(material_t), allocatable :: materials(:)
    type(group_t), allocatable :: groups(:)
    type(die_t), allocatable :: dies(:)
    type(multiplier_t), allocatable :: multipliers(:)
    type(fixation_t), allocatable :: fixations(:)
    type(die_motion_t), allocatable :: die_motions(:)
    type(nodal_force_t), allocatable :: forces(:)
    type(probe_t), allocatable :: probes(:)
    type(strategy_t) :: strategy
    type(effect_t), allocatable :: effects(:)
    !> Mesh generation, 1 for the deck's own mesh.
    integer :: generation = 1
  end type scene_t
end module scene
