!> The checkpoint: exchange between solver and REMDATA, and restart file.
!>
!> The modules exchange_* own the schema; nothing else names a dataset of it.
module exchange
  use exchange_read, only: read_contact_ends, read_deck_of_checkpoint, read_state
  use exchange_scene, only: checkpoint_facts_t, read_bare_scene, read_facts, read_remesh
  use exchange_schema, only: open_checkpoint, schema_version
  use exchange_write, only: write_checkpoint
  implicit none
  private
  public :: checkpoint_facts_t, open_checkpoint, read_bare_scene, read_contact_ends, read_deck_of_checkpoint, read_facts, &
            read_remesh, read_state, schema_version, write_checkpoint
end module exchange
