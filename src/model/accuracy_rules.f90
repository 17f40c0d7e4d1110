!> The accuracy a deck asks for (card ACCURACY), and how fine a run of the deck is.
module accuracy_rules
  use kinds, only: wp
  use text, only: string_t
  implicit none
  private
  public :: accuracy_rules_t, coarsest_mesh, fineness_t, stress_name

  !> Among the names of ACCURACY: the error of the stress in the norm of elastic energy, which is no column of the history.
  character(len=*), parameter :: stress_name = 'STRESS'
  !> The one mesh that is coarser than that of the deck: every second line of its blocks.
  real(wp), parameter :: coarsest_mesh = 0.5_wp

  !> What is asked for.
  type :: accuracy_rules_t
    !> Largest error, over the range of each quantity; 0 where the deck has no such card.
    real(wp) :: asked = 0.0_wp
    !> Columns of the history that are judged; none: those of accuracy_columns.
    type(string_t), allocatable :: columns(:)
    logical :: stress = .false.
    !> All bodies are blocks, which can have finer elements; all their divisions are even, so that every second line may go.
    logical :: divisible = .false., halvable = .false.
    !> Penetrations are allowed as shares of the sides of elements, by all laws of contact: none gives a penalty.
    logical :: of_sides = .false.
  end type accuracy_rules_t

  !> Factors over what the deck says: elements along a line of the mesh (1/2 or whole), length of the steps, penetration.
  type :: fineness_t
    real(wp) :: mesh = 1.0_wp, steps = 1.0_wp, depth = 1.0_wp
  end type fineness_t

end module accuracy_rules
