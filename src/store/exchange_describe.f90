!> The description of the checkpoint, for users who read one with other tools.
module exchange_describe
  use contact_ends, only: contact_end_t
  use exchange_schema, only: deck_source_t, schema_name, schema_version, visit_deck_source
  use member_schema, only: member_schema_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  use visit_remesher, only: visit_contact_ends
  use visit_scene, only: visit_scene_members
  use visit_solution, only: visit_solution_members
  implicit none
  private
  public :: describe_checkpoint

contains

  !> A line for each member, in the order in which they are visited.
  subroutine describe_checkpoint(lines)
    type(string_t), allocatable, intent(out) :: lines(:)   !! (n)
    type(member_schema_t) :: schema
    type(deck_source_t) :: deck
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(contact_end_t), allocatable :: ends(:)

    allocate (schema%lines(4))
    schema%lines(1)%s = schema_name//', schema '//to_text(schema_version)// &
                        ': HDF5 after a user block of 512 bytes with length and SHA-256'
    schema%lines(2)%s = 'Numbers and texts are attributes of the group they stand in, arrays and long texts are datasets.'
    schema%lines(3)%s = 'A line each: path, type, extents (in the order of Fortran), unit, what a remesh does with it, range.'
    schema%lines(4)%s = ''
    call visit_deck_source(schema, deck)
    call visit_scene_members(schema, scene)
    ! a solution has its lists before it is visited: one entry of each
    allocate (solution%fields(1), solution%groups(1), solution%pairs(1), solution%cuts(1), solution%estimate%triggers(0))
    solution%fields(1)%name = '<name>'
    solution%fields(1)%unit = 'its unit'
    solution%fields(1)%dual_unit = 'of its dual'
    call visit_solution_members(schema, solution)
    call visit_contact_ends(schema, ends)
    call move_alloc(schema%lines, lines)
  end subroutine describe_checkpoint

end module exchange_describe
