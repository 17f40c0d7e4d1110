!> Members of the ELEM family: a new element is one file and one line here.
submodule(elem_registry) elem_members
  use elem_body_forces, only: elem_bforc_row, elem_centr_row
  use elem_body_springs, only: elem_bsprg_row
  use elem_cnt2d, only: elem_cnt2d_row
  use elem_cntdf, only: elem_cntdf_row
  use elem_die_heat, only: elem_dietm_row
  use elem_heat_contact, only: elem_cndtm_row, elem_cnttm_row
  use elem_heat_source, only: elem_faces_row, elem_heats_row
  use elem_heat_sides, only: elem_conve_row, elem_flux_row, elem_radia_row
  use elem_load_factor, only: elem_loadf_row
  use elem_pl8ls, only: elem_pl8ls_row
  use elem_pl8tm, only: elem_pl8tm_row
  use elem_pres2d, only: elem_pres2d_row
  use elem_spring, only: elem_spring_row
  use elem_weld_source, only: elem_goldak_row
  implicit none
contains

  module procedure list_elems
    allocate (elems(19))
    elems(1) = elem_pl8ls_row()
    elems(2) = elem_cnt2d_row()
    elems(3) = elem_cntdf_row()
    elems(4) = elem_pres2d_row()
    elems(5) = elem_bforc_row()
    elems(6) = elem_centr_row()
    elems(7) = elem_spring_row()
    elems(8) = elem_pl8tm_row()
    elems(9) = elem_flux_row()
    elems(10) = elem_conve_row()
    elems(11) = elem_radia_row()
    elems(12) = elem_heats_row()
    elems(13) = elem_goldak_row()
    elems(14) = elem_cnttm_row()
    elems(15) = elem_cndtm_row()
    elems(16) = elem_dietm_row()
    elems(17) = elem_bsprg_row()
    elems(18) = elem_loadf_row()
    elems(19) = elem_faces_row()
  end procedure list_elems

end submodule elem_members
