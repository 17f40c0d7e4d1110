!> Facts about a checkpoint for scripts, once it was found whole and of this schema.
module exchange_facts
  use errors, only: error_t
  use exchange_read, only: read_bare_scene, read_state
  use exchange_schema, only: open_checkpoint
  use facts_reader, only: facts_reader_t
  use kinds, only: wp
  use member_reader, only: member_reader_t
  use remesher_options, only: as_it_comes, has_zones
  use scene, only: is_solid, scene_t
  use solution, only: solution_t, start_solution
  use text, only: string_t
  use visit_scene, only: visit_scene_members
  use visit_solution, only: visit_solution_members
  implicit none
  private
  public :: checkpoint_facts_t, read_facts, read_facts_alone

  !> A checkpoint in short: where the run stands, on which mesh, and why a new one is due (no triggers: it is not).
  type :: checkpoint_facts_t
    integer :: generation = 1, step = 0, elements = 0
    !> Operation, 0 in a deck without any; and new meshes so far: a generation that only begins an operation is none.
    integer :: operation = 0, remeshings = 0
    real(wp) :: time = 0.0_wp
    !> State carried over to a new mesh, not yet in equilibrium.
    logical :: unbalanced = .false.
    integer :: transfer = 0
    !> Steps the mesh is still on probation for, and other ways tried where it is refused.
    integer :: probation = 0, tries = 0
    !> Cards give zones, and another mesher is not forbidden.
    logical :: has_zones = .false.
    !> Estimated errors of stress and strain, negative where they were not asked for [-].
    real(wp) :: error_stress = -1.0_wp, error_strain = -1.0_wp
    type(string_t), allocatable :: triggers(:)
    real(wp), allocatable :: values(:), limits(:)
  end type checkpoint_facts_t

contains

  !> Facts about a checkpoint whose contents are checked as a whole.
  subroutine read_facts(path, facts, error)
    character(len=*), intent(in) :: path
    type(checkpoint_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(member_reader_t) :: reader
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(error_t), allocatable :: ignored

    call open_checkpoint(path, reader, error)
    if (allocated(error)) return
    call read_bare_scene(reader, scene, error)
    if (.not. allocated(error)) then
      call start_solution(scene, solution)
      call read_state(reader, scene, solution, error)
    end if
    call reader%file%close(ignored)
    if (.not. allocated(error)) call take_facts(scene, solution, facts)
  end subroutine read_facts

  !> The same of one that a program of ours has just written: its hash is compared, and no more is read than the facts are made of.
  subroutine read_facts_alone(path, facts, error)
    character(len=*), intent(in) :: path
    type(checkpoint_facts_t), intent(out) :: facts
    type(error_t), allocatable, intent(out) :: error
    type(facts_reader_t) :: reader
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(error_t), allocatable :: ignored

    call open_checkpoint(path, reader, error, is_ours=.true.)
    if (allocated(error)) return
    call visit_scene_members(reader, scene)
    allocate (solution%fields(0), solution%groups(0), solution%pairs(0), solution%cuts(0), solution%estimate%triggers(0))
    call visit_solution_members(reader, solution)
    call reader%file%status(error)
    call reader%file%close(ignored)
    if (.not. allocated(error)) call take_facts(scene, solution, facts)
  end subroutine read_facts_alone

  subroutine take_facts(scene, solution, facts)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(checkpoint_facts_t), intent(inout) :: facts
    integer :: g, k

    facts%generation = scene%generation
    facts%operation = scene%operation
    facts%remeshings = scene%generation - max(scene%operation, 1)
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) facts%elements = facts%elements + size(scene%groups(g)%connectivity, 2)
    end do
    facts%time = solution%time
    facts%step = solution%step
    facts%unbalanced = solution%unbalanced
    facts%transfer = scene%remesher%transfer
    facts%tries = scene%remesher%tries
    facts%has_zones = has_zones(scene%remesher) .and. scene%remesher%mesher == as_it_comes
    facts%probation = solution%probation%left
    if (scene%remesh%estimate) then
      facts%error_stress = solution%estimate%stress
      facts%error_strain = solution%estimate%strain
    end if
    associate (triggers => solution%estimate%triggers)
      allocate (facts%triggers(size(triggers)))
      do k = 1, size(triggers)
        facts%triggers(k)%s = triggers(k)%name
      end do
      facts%values = triggers%value
      facts%limits = triggers%limit
    end associate
  end subroutine take_facts

end module exchange_facts
