!> FRONT: the multifrontal factorisation of this program, without pivoting, by all threads.
module linear_front
  use front_factors, only: create_front
  use linear_api, only: solver_row_t
  implicit none
  private
  public :: linear_front_row

contains

  function linear_front_row() result(row)
    type(solver_row_t) :: row

    row%name = 'FRONT'
    row%purpose = 'multifrontal, all threads, without pivoting; MUMPS where that is not accurate'
    row%fallback = 'MUMPS'
    row%inverts = .true.
    row%create => create_front
  end function linear_front_row

end module linear_front
