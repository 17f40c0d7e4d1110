!> A material: a law with its numbers. What the numbers mean is declared by the law (src/law).
module materials
  use kinds, only: wp
  implicit none
  private
  public :: material_t

  type :: material_t
    character(len=:), allocatable :: name
    !> Name of the LAW it is made of, and its place in the list of laws.
    character(len=:), allocatable :: law
    integer :: law_id = 0
    !> Values of the law's parameters, in the order the law declares them.
    real(wp), allocatable :: values(:)
    !> Table of a curve, abscissa ascending (2, n); empty when the law's form has none.
    real(wp), allocatable :: curve(:, :)
    !> Where the deck defines it, for messages.
    character(len=:), allocatable :: where_defined
  end type material_t
end module materials
