!> The checkpoint: exchange between solver and REMDATA, and restart file.
!>
!> What is in it is named by the routines that visit the members of scene and solution (src/model, visit_*), and nowhere else;
!> `remdata --schema` prints it.
module exchange
  use exchange_describe, only: describe_checkpoint
  use exchange_facts, only: checkpoint_facts_t, read_facts, read_facts_alone
  use exchange_read, only: read_bare_scene, read_contact_ends, read_deck_of_checkpoint, read_remesh, read_state
  use exchange_schema, only: open_checkpoint, schema_version
  use exchange_write, only: write_checkpoint
  implicit none
  private
  public :: checkpoint_facts_t, describe_checkpoint, open_checkpoint, read_bare_scene, read_contact_ends, &
            read_deck_of_checkpoint, read_facts, read_facts_alone, read_remesh, read_state, schema_version, write_checkpoint
end module exchange
