!> Members of the LAW family: a new law is one file and one line here.
submodule(law_registry) law_members
  use law_arbthmet, only: law_arbthmet_row
  use law_coul2d, only: law_coul2d_row
  use law_ela, only: law_ela_row, law_elath_row
  use law_epla, only: law_epla_row
  use law_glue2d, only: law_glue2d_row
  use law_heat, only: law_heat_row, law_heath_row
  use law_meta, only: law_meta_row, law_metamec_row
  use law_viscous, only: law_evpnh_row, law_gsell_row
  implicit none
contains

  module procedure list_laws
    allocate (laws(12))
    laws(1) = law_ela_row()
    laws(2) = law_epla_row()
    laws(3) = law_coul2d_row()
    laws(4) = law_glue2d_row()
    laws(5) = law_elath_row()
    laws(6) = law_evpnh_row()
    laws(7) = law_gsell_row()
    laws(8) = law_heat_row()
    laws(9) = law_heath_row()
    laws(10) = law_meta_row()
    laws(11) = law_arbthmet_row()
    laws(12) = law_metamec_row()
  end procedure list_laws

end submodule law_members
