!> The members of the LAW family in this program, in place of the library's list.
submodule(law_registry) own_laws
  use law_ela, only: law_ela_row, law_elath_row
  use law_heat, only: law_heat_row
  use law_steel5, only: law_steel5_row
  use law_worn, only: law_worn_row
  implicit none
contains

  module procedure list_laws
    allocate (laws(5))
    laws(1) = law_ela_row()
    laws(2) = law_elath_row()
    laws(3) = law_heat_row()
    laws(4) = law_steel5_row()
    laws(5) = law_worn_row()
  end procedure list_laws

end submodule own_laws
