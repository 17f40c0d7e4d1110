!> MIXED: the factorisation of FRONT in single precision, by which solutions are refined in working precision (A. Buttari,
!> J. Dongarra, J. Langou, J. Langou, P. Luszczek, J. Kurzak, Int. J. High Perform. Comput. Appl. 21 (2007) 457-466): half the
!> bytes, and processors do twice the operations in a second.
module linear_mixed
  use front_factors_single, only: create_front
  use kinds, only: wp
  use linear_api, only: solver_row_t
  implicit none
  private
  public :: linear_mixed_row

contains

  function linear_mixed_row() result(row)
    type(solver_row_t) :: row

    row%name = 'MIXED'
    row%purpose = 'FRONT in single precision, refined, where matrices are large; FRONT where that is not accurate'
    row%fallback = 'FRONT'
    ! a correction of Newton's method needs no more; a second refinement often would not pay
    row%refine_above = 1.0e-11_wp
    ! fewer gain nothing (tests/bench, linear solvers)
    row%least_operations = 5.0e7_wp
    row%single = .true.
    row%inverts = .true.
    row%create => create_front
  end function linear_mixed_row

end module linear_mixed
