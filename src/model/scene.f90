!> A scene: everything a deck says, fixed for the length of a run.
module scene
  use dies, only: die_t
  use accuracy_rules, only: accuracy_rules_t
  use effects, only: effect_t
  use fields, only: field_t
  use heat_contacts, only: die_heat_t, heat_contact_t
  use kinds, only: wp
  use loads, only: die_force_t, die_motion_t, exchange_t, field_history_t, fixation_t, load_factor_t, multiplier_at, multiplier_t, &
                   nodal_force_t, start_t
  use materials, only: material_t
  use mesh, only: mesh_t
  use probes, only: probe_t
  use quadrature, only: rule_t
  use remesher_options, only: has_contours, remesher_options_t
  use remeshing, only: remesh_rules_t
  use sections, only: section_drive_t
  use state_variables, only: state_variable_t
  use strategy, only: strategy_t
  use weld_sources, only: weld_source_t
  implicit none
  private
  public :: scene_t, group_t, wall_t, plane_state_names, host_of, is_later_operation, is_solid, lacks_mesh, operation_of, &
    pilot_at, solid_elements
  public :: role_body, role_second, role_contact, role_side_load, role_volume_load, role_spring, role_heat_contact, role_die_heat
  public :: role_load_factor
  public :: plane_strain, axisymmetric, plane_stress, generalised_plane_strain

  !> Plane states.
  integer, parameter :: plane_strain = 1
  integer, parameter :: axisymmetric = 2
  integer, parameter :: plane_stress = 3
  integer, parameter :: generalised_plane_strain = 4
  character(len=6), parameter :: plane_state_names(4) = ['PLSTN ', 'AXISYM', 'PLSTS ', 'GPLSTN']

  !> What a group is: a body with its first formulation, a further formulation on a body's elements and points, contact of sides,
  !> a load on sides or on the volume of a body, the spring of a die, heat between sides and a die, the heat capacity of a die,
  !> forces whose size is found.
  integer, parameter :: role_body = 1, role_second = 2, role_contact = 3, role_side_load = 4, role_volume_load = 5, &
                        role_spring = 6, role_heat_contact = 7, role_die_heat = 8, role_load_factor = 9

  !> Elements of one ELEM and one LAW with their state: the unit of the element loop.
  type :: group_t
    character(len=:), allocatable :: name
    integer :: role = 0
    !> Body whose elements these are (position in the scene's list), for further formulations and loads on the volume; contact whose
    !> sides these are, for heat between them and the die; 0 for others.
    integer :: host = 0
    !> Member of the ELEM family, by name and position in its list.
    character(len=:), allocatable :: elem
    integer :: elem_id = 0
    !> Material (position in the scene's list); 0 for elements without a law.
    integer :: material = 0
    !> What the element of a load states of itself: it brings heat; it is springs of a body.
    logical :: brings_heat = .false., is_spring = .false.
    !> Integration points of an element: of the square for bodies, of the line for sides.
    type(rule_t) :: rule
    !> Points on sides whose number is chosen by the lengths of sides, anew on every mesh.
    logical :: rule_is_chosen = .false.
    !> Option of the ELEM that the card asks for (position in the row's list), 0 for none.
    integer :: option = 0
    !> Nodes (nnode, nelem).
    integer, allocatable :: connectivity(:, :)
    !> Die faced by contact elements, or held by a spring; 0 for others.
    integer :: die = 0
    !> Place among the groups that face a deformable die, 0 for others.
    integer :: pairs = 0
    !> Young's modulus of the body behind the sides of a contact, or of that behind the die where it is softer [stress].
    real(wp) :: modulus = 0.0_wp
    !> Most that penalties of a contact which follow from an allowed penetration are raised to, over those of it [-].
    real(wp) :: most_share = 1.0_wp
    !> Tangential penalty over the normal one of a contact, where the card of its law does not give it [-].
    real(wp) :: tangential_share = 0.0_wp
    !> Component of the pilot that a spring holds, and its stiffness [force/length, or moment per radian].
    integer :: component = 0
    real(wp) :: stiffness = 0.0_wp
    !> Load on sides or on the volume: amplitude (of a pressure, of a force per volume, density times squared speed of rotation)
    !> times multiplier; heat capacity of a die.
    integer :: multiplier = 0
    real(wp) :: amplitude = 0.0_wp
    !> Heat that passes the sides; and that between sides and a die.
    type(exchange_t) :: exchange
    type(heat_contact_t) :: heat_contact
    !> Torch that heats the body (position in the scene's list), 0 for others.
    integer :: source = 0
    !> Direction of a force on the volume: 1 = x, 2 = y; 0 where unused.
    integer :: direction = 0
    !> Temperature given to the body: amplitude times multiplier; multiplier 0 where none is.
    integer :: temperature_multiplier = 0
    real(wp) :: temperature_amplitude = 0.0_wp
    !> Or the temperatures of another run, place in the scene's list of histories; 0 for none.
    integer :: temperature_history = 0
    !> Declared state of a point, with places in the state array.
    type(state_variable_t), allocatable :: variables(:)
  end type group_t

  !> A plane of symmetry, which is a wall for the body that a support holds in it (walls).
  type :: wall_t
    !> The support as the deck names it, and the direction across the line: 1 = x, 2 = y.
    character(len=:), allocatable :: label
    integer :: component = 0
    !> The body is where coordinates are larger (1) or smaller (-1) than on the line; and a node on the line.
    integer :: side = 0, node = 0
  end type wall_t

  type :: scene_t
    character(len=:), allocatable :: title
    integer :: plane_state = 0
    !> Section (sections) at the start, and in generalised plane strain what drives its three components.
    real(wp) :: section(3) = 0.0_wp
    type(section_drive_t) :: section_drives(3)
    !> Member of the kinematics family, by name and position in its list.
    character(len=:), allocatable :: kinematics
    integer :: kinematics_id = 0
    !> The geometry follows the displacements.
    logical :: finite = .true.
    !> Errors that come of the path within steps are estimated: a law flows, and the deck bounds them.
    logical :: follows_path = .false.
    type(mesh_t) :: mesh
    type(material_t), allocatable :: materials(:)
    type(group_t), allocatable :: groups(:)
    !> Unknowns that the elements of the groups declare, without values: those of mechanics first (fields).
    type(field_t), allocatable :: fields(:)
    !> Values of fields at the start on bodies where they are others than the field's own.
    type(start_t), allocatable :: starts(:)
    !> Values of given fields.
    type(field_history_t), allocatable :: histories(:)
    type(die_t), allocatable :: dies(:)
    type(multiplier_t), allocatable :: multipliers(:)
    type(fixation_t), allocatable :: fixations(:)
    type(wall_t), allocatable :: walls(:)
    type(die_motion_t), allocatable :: die_motions(:)
    type(die_force_t), allocatable :: die_forces(:)
    type(die_heat_t), allocatable :: die_heats(:)
    type(nodal_force_t), allocatable :: forces(:)
    type(load_factor_t) :: load_factor
    type(probe_t), allocatable :: probes(:)
    !> Heat of welding torches.
    type(weld_source_t), allocatable :: sources(:)
    type(strategy_t) :: strategy
    type(accuracy_rules_t) :: accuracy
    type(remesher_options_t) :: remesher
    type(remesh_rules_t) :: remesh
    type(effect_t), allocatable :: effects(:)
    !> Mesh generation, 1 for the deck's own mesh; an operation begins one, whose elements are those of the one before.
    integer :: generation = 1
    !> Place among the operations of the deck, how many there are, and its name; 0 and no name for a deck without any.
    integer :: operation = 0, operations = 0
    character(len=:), allocatable :: operation_name
  end type scene_t

contains

  !> Name of the operation; empty in a deck without any.
  pure function operation_of(scene) result(name)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: name

    name = ''
    if (allocated(scene%operation_name)) name = scene%operation_name
  end function operation_of

  !> A body: it has elements of its own, and counts once for contours, errors, results and remeshing.
  elemental function is_solid(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = group%role == role_body
  end function is_solid

  !> Elements of all bodies.
  pure function solid_elements(scene) result(n)
    type(scene_t), intent(in) :: scene
    integer :: n
    integer :: g

    n = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end function solid_elements

  !> The body whose elements a group has: its own, or those of its host.
  pure function host_of(scene, g) result(host)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    integer :: host

    host = scene%groups(g)%host
    if (host == 0) host = g
  end function host_of

  !> An operation that follows another. Its dies stand from its beginning where their multipliers begin, which may be how the one
  !> before has left them; at the beginning of a run they stand where the deck has them, and are moved there in the first step.
  pure function is_later_operation(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = scene%operation > 1
  end function is_later_operation

  !> Pilot of a die by its motions.
  pure function pilot_at(scene, die, time) result(pilot)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    real(wp), intent(in) :: time   !! [time]
    real(wp) :: pilot(3)           !! x, y, angle [length], [length], [rad]
    integer :: k

    pilot = scene%dies(die)%pilot
    do k = 1, size(scene%die_motions)
      associate (motion => scene%die_motions(k))
        if (motion%die /= die .or. motion%multiplier == 0) cycle
        pilot(motion%component) = scene%dies(die)%pilot(motion%component) &
                                  + motion%amplitude*multiplier_at(scene%multipliers(motion%multiplier), time)
      end associate
    end do
  end function pilot_at

  !> Bodies are given by their contours, and no mesh has been made of them yet.
  pure function lacks_mesh(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes

    yes = has_contours(scene%remesher) .and. allocated(scene%mesh%coordinates)
    if (yes) yes = size(scene%mesh%coordinates, 2) == 0
  end function lacks_mesh

end module scene
