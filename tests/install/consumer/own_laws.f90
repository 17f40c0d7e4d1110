!> The members of the LAW family in this program, in place of the library's list.
submodule(law_registry) own_laws
  use law_ela, only: law_ela_row
  use law_fluid, only: law_fluid_row
  implicit none
contains

  module procedure list_laws
    allocate (laws(2))
    laws(1) = law_ela_row()
    laws(2) = law_fluid_row()
  end procedure list_laws

end submodule own_laws
