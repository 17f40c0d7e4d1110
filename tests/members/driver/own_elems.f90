!> The members of the ELEM family in this program, in place of the library's list: PL8HY diffuses hydrogen as PL8TM does heat.
submodule(elem_registry) own_elems
  use elem_cnt2d, only: elem_cnt2d_row
  use elem_cntdf, only: elem_cntdf_row
  use elem_pl8ls, only: elem_pl8ls_row
  use elem_pl8tm, only: elem_pl8tm_row
  use elem_pres2d, only: elem_pres2d_row
  implicit none
contains

  module procedure list_elems
    integer :: u

    allocate (elems(5))
    elems(1) = elem_pl8ls_row()
    elems(2) = elem_cnt2d_row()
    elems(3) = elem_cntdf_row()
    elems(4) = elem_pres2d_row()
    elems(5) = elem_pl8tm_row()
    elems(5)%name = 'PL8HY'
    elems(5)%purpose = 'diffusion of hydrogen, 8-node quadrilateral'
    do u = 1, 2
      elems(5)%unknowns(u)%field%name = 'hydrogen'
      elems(5)%unknowns(u)%field%unit = 'hydrogen'
      elems(5)%unknowns(u)%field%dual = 'hydrogen_flow'
      elems(5)%unknowns(u)%field%dual_unit = 'hydrogen/time'
      elems(5)%unknowns(u)%field%word = 'H'
      elems(5)%unknowns(u)%field%quantity = 'hydrogen'
    end do
  end procedure list_elems

end submodule own_elems
