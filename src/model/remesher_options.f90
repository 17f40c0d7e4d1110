!> How a scene is remeshed: what REMSH cards ask of the remesher, and of the restart on a new mesh.
module remesher_options
  use kinds, only: pi, wp
  implicit none
  private
  public :: remesher_options_t

  type :: remesher_options_t
    !> A REMSH card is there.
    logical :: wanted = .false.
    !> State transfer: number of the method, exponent of 1/R^N, points of moving least squares.
    integer :: transfer = 2
    real(wp) :: exponent = 2.0_wp
    integer :: neighbours = 20
    !> Sizes of elements, smallest and largest [length].
    real(wp) :: smallest = 0.0_wp, largest = 0.0_wp
    !> Error of the strains an element is made for, elements at most.
    real(wp) :: strain_error = 0.05_wp
    integer :: most_elements = 0
    !> Elements across a stretch of contact (0: as they come), angle a side of an element may turn by [radian].
    integer :: across_contact = 4
    real(wp) :: turn = pi/12
    !> Limits of the restart: iterations, and change of the force of a die (share of the largest).
    integer :: most_iterations = 40
    real(wp) :: force_change = 0.1_wp
  end type remesher_options_t
end module remesher_options
