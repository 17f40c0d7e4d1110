!> The members of the ELEM family in this program: those of the library that know no temperature.
submodule(elem_registry) plain_elems
  use elem_body_forces, only: elem_bforc_row, elem_centr_row
  use elem_body_springs, only: elem_bsprg_row
  use elem_cnt2d, only: elem_cnt2d_row
  use elem_cntdf, only: elem_cntdf_row
  use elem_pl8ls, only: elem_pl8ls_row
  use elem_pres2d, only: elem_pres2d_row
  use elem_spring, only: elem_spring_row
  implicit none
contains

  module procedure list_elems
    allocate (elems(8))
    elems(1) = elem_pl8ls_row()
    elems(2) = elem_cnt2d_row()
    elems(3) = elem_cntdf_row()
    elems(4) = elem_pres2d_row()
    elems(5) = elem_bforc_row()
    elems(6) = elem_centr_row()
    elems(7) = elem_spring_row()
    elems(8) = elem_bsprg_row()
  end procedure list_elems

end submodule plain_elems
