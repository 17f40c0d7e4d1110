!> The members of a scene that a checkpoint holds (visitors): what the remesher needs, which has neither elements nor laws, and what
!> a deck needs on another mesh. All else is read again from the cards.
module visit_scene
  use scene, only: plane_state_names, scene_t
  use visit_estimate, only: visit_remesh_rules
  use visit_field, only: visit_field_declaration
  use visit_group, only: visit_group_members
  use visit_material, only: visit_material_members
  use visit_parts, only: visit_die, visit_fixation, visit_mesh, visit_wall
  use visit_remesher, only: visit_remesher_options
  use visitors, only: kept, recomputed, visitor_t
  implicit none
  private
  public :: visit_scene_members

  !> Entries of a list at most: far above what cards give, far below all memory.
  integer, parameter :: most_parts = 100000
  character(len=*), parameter :: of_the_deck = 'the solver reads it from the deck'

contains

  subroutine visit_scene_members(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(scene_t), intent(inout) :: self

    call visitor%enter('scene')
    call visitor%member('plane_state', self%plane_state, kept, low=1, high=size(plane_state_names))
    call visitor%member('finite', self%finite, kept)
    call visitor%member('follows_path', self%follows_path, kept)
    call visitor%member('generation', self%generation, recomputed, low=1)
    call visitor%member('operation', self%operation, kept, low=0)
    call visitor%leave('scene')
    call visitor%enter('mesh')
    call visit_mesh(visitor, self%mesh)
    call visitor%leave('mesh')
    call visit_lists(visitor, self)
    call visitor%enter('remesher')
    call visit_remesher_options(visitor, self%remesher)
    call visitor%leave('remesher')
    call visitor%enter('remesh')
    call visit_remesh_rules(visitor, self%remesh)
    call visitor%leave('remesh')
    call visitor%derived('title', of_the_deck)
    call visitor%derived('operations', of_the_deck)
    call visitor%derived('operation_name', of_the_deck)
    call visitor%derived('section', of_the_deck)
    call visitor%derived('section_drives', of_the_deck)
    call visitor%derived('kinematics', of_the_deck)
    call visitor%derived('kinematics_id', of_the_deck)
    call visitor%derived('starts', of_the_deck)
    call visitor%derived('histories', of_the_deck)
    call visitor%derived('multipliers', of_the_deck)
    call visitor%derived('die_motions', of_the_deck)
    call visitor%derived('die_forces', of_the_deck)
    call visitor%derived('die_heats', of_the_deck)
    call visitor%derived('forces', of_the_deck)
    call visitor%derived('load_factor', of_the_deck)
    call visitor%derived('probes', of_the_deck)
    call visitor%derived('sources', of_the_deck)
    call visitor%derived('strategy', of_the_deck)
    call visitor%derived('accuracy', of_the_deck)
    call visitor%derived('effects', of_the_deck)
  end subroutine visit_scene_members

  subroutine visit_lists(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(scene_t), intent(inout) :: self
    integer :: k, n

    n = 0
    if (allocated(self%fields)) n = size(self%fields)
    call visitor%list('declared_fields', n, most_parts)
    if (.not. allocated(self%fields)) allocate (self%fields(n))
    do k = 1, n
      call visitor%enter_item('declared_fields', k)
      call visit_field_declaration(visitor, self%fields(k))
      call visitor%leave('declared_fields')
    end do
    n = 0
    if (allocated(self%dies)) n = size(self%dies)
    call visitor%list('dies', n, most_parts)
    if (.not. allocated(self%dies)) allocate (self%dies(n))
    do k = 1, n
      call visitor%enter_item('dies', k)
      call visit_die(visitor, self%dies(k))
      call visitor%leave('dies')
    end do
    n = 0
    if (allocated(self%materials)) n = size(self%materials)
    call visitor%list('materials', n, most_parts)
    if (.not. allocated(self%materials)) allocate (self%materials(n))
    do k = 1, n
      call visitor%enter_item('materials', k)
      call visit_material_members(visitor, self%materials(k))
      call visitor%leave('materials')
    end do
    n = 0
    if (allocated(self%groups)) n = size(self%groups)
    call visitor%list('groups', n, most_parts)
    if (.not. allocated(self%groups)) allocate (self%groups(n))
    do k = 1, n
      call visitor%enter_item('groups', k)
      call visit_group_members(visitor, self%groups(k))
      call visitor%leave('groups')
    end do
    n = 0
    if (allocated(self%fixations)) n = size(self%fixations)
    call visitor%list('fixations', n, most_parts)
    if (.not. allocated(self%fixations)) allocate (self%fixations(n))
    do k = 1, n
      call visitor%enter_item('fixations', k)
      call visit_fixation(visitor, self%fixations(k))
      call visitor%leave('fixations')
    end do
    n = 0
    if (allocated(self%walls)) n = size(self%walls)
    call visitor%list('walls', n, most_parts)
    if (.not. allocated(self%walls)) allocate (self%walls(n))
    do k = 1, n
      call visitor%enter_item('walls', k)
      call visit_wall(visitor, self%walls(k))
      call visitor%leave('walls')
    end do
  end subroutine visit_lists

end module visit_scene
