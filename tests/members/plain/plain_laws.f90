!> The members of the LAW family in this program: those of the library that need no temperature.
submodule(law_registry) plain_laws
  use law_coul2d, only: law_coul2d_row
  use law_ela, only: law_ela_row, law_elath_row
  use law_epla, only: law_epla_row
  use law_glue2d, only: law_glue2d_row
  use law_viscous, only: law_evpnh_row, law_gsell_row
  implicit none
contains

  module procedure list_laws
    allocate (laws(7))
    laws(1) = law_ela_row()
    laws(2) = law_epla_row()
    laws(3) = law_coul2d_row()
    laws(4) = law_glue2d_row()
    laws(5) = law_elath_row()
    laws(6) = law_evpnh_row()
    laws(7) = law_gsell_row()
  end procedure list_laws

end submodule plain_laws
