!> The discrete equations of a scene, as data: unknowns, solves and their patterns, what elements and laws there are, buffers of the
!> element loop. They are set up in `equation_set_up`, evaluated in `evaluation`, and solved for a correction in `corrections`.
module equations
  use wall_contact, only: wall_contact_t
  use dofs, only: dofs_t
  use drivers, only: drivers_t
  use elem_api, only: elem_t, mode_advance
  use element_loop, only: element_buffers_t
  use fields, only: find_field
  use fine_mesh_data, only: fine_mesh_t
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use own_crossings, only: free_sides_t
  use pairs, only: pairs_t
  use patches, only: patch_map_t
  use scene, only: scene_t
  use solves, only: solve_t
  use threads, only: team_t
  use timers, only: ledger_t
  use torch_steps, only: torch_step_t
  implicit none
  private
  public :: remedy_none, remedy_euler, remedy_monotone, equations_t, stage_t, take_turn, solves_heat

  !> How a step is made again that has left its bounds (heat_stages): by implicit Euler, and with flows that keep to them (PL8TM).
  integer, parameter :: remedy_none = 0, remedy_euler = 1, remedy_monotone = 2

  !> A stage of a step that is made in several.
  type :: stage_t
    !> Length by which changes of the heat content are divided, over that of the stage; and share of the step after which the
    !> stage ends.
    real(wp) :: share = 1.0_wp, reach = 1.0_wp
    !> Heat taken up and released counts; otherwise flows alone.
    logical :: content = .true.
    !> Of flows alone: the length of the step over which stated heat is a mean; 0: it is that of the instant [time].
    real(wp) :: mean_over = 0.0_wp
  end type stage_t

  type :: equations_t
    type(elem_t), allocatable :: elems(:)
    type(law_t), allocatable :: laws(:)
    type(kinematics_t) :: kinematics
    type(dofs_t) :: dofs
    !> The solves in the order of a step, and the present one.
    type(solve_t), allocatable :: solves(:)
    integer :: now = 1
    !> Mode of the elements (elem_api).
    integer :: mode = mode_advance
    type(stage_t) :: stage
    !> Powers of torches in a step of several stages; not allocated in others, whose instants tell them (step_instants).
    type(torch_step_t), allocatable :: torches
    integer :: remedy = remedy_none
    type(element_buffers_t) :: buffers
    !> Sides that must not cross walls, and what holds them.
    type(wall_contact_t) :: wall
    !> Sides of bodies that may pass through one another.
    type(free_sides_t) :: free_sides
    !> Elements at most in a patch (nonlinear_elimination), 0 where none is eliminated; elements by their nodes where patches are.
    integer :: patch_size = 0
    type(patch_map_t) :: patches
    !> None is, in the attempts at a step that follow one which failed with a patch: it may have led past where a side snaps off.
    logical :: without_patches = .false.
    !> New contact comes in softly in the next attempt at the step, and with this share of its penalties now (soft_contact).
    logical :: softly = .false.
    real(wp) :: penalty_share = 1.0_wp
    !> Corrections lead downhill alone: the equilibrium found before was not stable (step_equilibrium). One that is not is taken.
    logical :: downhill = .false., takes_unstable = .false.
    !> With a load factor: shares of corrections are taken that keep the residual below a ceiling (line_search).
    logical :: below_ceiling = .false.
    !> Equilibrium is restored where the dies and supports of the operation before let the part go. A slender part bends far then:
    !> each correction stretches it by the square of its turn, and the next one takes that back, so that the residual rises and
    !> falls in turns. A search would stop where the stretch begins: corrections are taken whole, and most of the way is made at
    !> once. Not where the stress depends on the way (hypoelastic).
    logical :: let_go = .false.
    !> Bodies of nodes that supports do not hold, of no size where there is none (loose_bodies).
    integer, allocatable :: loose(:)
    !> Of these, in the present step, the number of the assembly that press on one another and that nothing else presses, 0 where
    !> something does (nnode; mark_acted_on).
    integer, allocatable :: assembly(:)
    !> Drag on these assemblies at the start of the present step (ndof): force over motion (resting_bodies).
    real(wp), allocatable :: drag(:)
    !> It is so many times the usual one in the next attempt at a step: grows while attempts fail.
    real(wp) :: more_drag = 1.0_wp
    !> Components of pilots that friction alone holds, and whose points all slide, in the last correction (3, ndie).
    logical, allocatable :: slides(:, :)
    !> Forces on dies that the present step started just in touch with the part, 0 for others (ndie; seating).
    real(wp), allocatable :: seated(:)
    !> Ways, along X and Y, that it took them over a gap (2, ndie) [length].
    real(wp), allocatable :: way_to_part(:, :)
    type(ledger_t) :: timers
    type(team_t) :: team
    !> Internal force (element forces summed) at the last evaluation, and the sum of their sizes (ndof).
    real(wp), allocatable :: force(:), magnitude(:)
    !> Norm of the sources within elements at the last evaluation (elem_api) [power].
    real(wp) :: source = 0.0_wp
    !> Heat taken up by all elements in the step, and released in them, at the last evaluation of their solve [energy].
    real(wp) :: heat_stored = 0.0_wp, heat_released = 0.0_wp
    !> Viscous force over velocity of the unknowns in a step that is damped (ndof); not allocated in others (damping).
    real(wp), allocatable :: damping(:)
    !> Motion in such a step that meets no viscous force (ndof).
    real(wp), allocatable :: carried(:)
    !> Weights of the quantities in norms over several of them (convergence).
    real(wp), allocatable :: weight(:)
    !> Nodes of the solid elements, and the pairs that unknowns and pattern are of.
    integer, allocatable :: solids(:, :)
    type(pairs_t), allocatable :: pairs(:)
    !> Nodes coupled by the pairs: a side and a piece, two nodes twice to make eight.
    integer, allocatable :: links(:, :)
    !> Nodes of the mesh.
    integer :: nnode = 0
    !> Groups that are loads: their forces come from outside.
    logical, allocatable :: is_load(:)
    !> Drivers of the laws at the points of the groups.
    type(drivers_t), allocatable :: drivers(:)
    !> The mesh twice as fine, where temperatures are followed there (space_error).
    type(fine_mesh_t) :: fine
    !> Diagonal of the box around the mesh [length].
    real(wp) :: size = 0.0_wp
  end type equations_t

contains

  !> The solve that a field belongs to is the present one.
  pure subroutine take_turn(equations, field)
    type(equations_t), intent(inout) :: equations
    integer, intent(in) :: field   !! position in the scene's list
    integer :: s

    do s = 1, size(equations%solves)
      if (equations%solves(s)%own(field)) equations%now = s
    end do
  end subroutine take_turn

  !> The temperature is among the fields of the solve under way.
  pure function solves_heat(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: f

    f = find_field(scene%fields, 'temperature')
    yes = f > 0
    if (yes) yes = equations%solves(equations%now)%own(f)
  end function solves_heat

end module equations
