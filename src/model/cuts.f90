!> Cuts that part a body (cards TRIM and PIERC): what is cut, and what has been.
module cuts
  use kinds, only: wp
  implicit none
  private
  public :: cut_t, cut_record_t, is_trim, was_just_cut
  public :: stage_of_cuts, trim_trigger, web_trigger

  !> Why a new mesh is due (remeshing): a cut along a line, a web that parts.
  character(len=*), parameter :: trim_trigger = 'trim', web_trigger = 'web'

  !> Stage of a remesh that is responsible where a body cannot be cut as the deck says.
  character(len=*), parameter :: stage_of_cuts = 'cut'

  !> A cut that the deck asks for.
  type :: cut_t
    !> Body, by its place among the groups of the scene.
    integer :: group = 0
    !> Straight line from one point to another (x and y of both), cut when the operation begins [length].
    real(wp) :: line(4) = 0.0_wp
    !> Die under which a web parts, and the thickness at which it does [length]; 0 for a cut along a line.
    integer :: die = 0
    real(wp) :: thickness = 0.0_wp
    !> A point on the side that is kept; of a web that parts, in the piece that is kept, where one is given [length].
    logical :: names_kept = .false.
    real(wp) :: kept(2) = 0.0_wp
  end type cut_t

  !> What came of it. Volumes and forces are per radian when axisymmetric, otherwise of the thickness of the section.
  type :: cut_record_t
    !> Mesh that was made with the cut; 0 before.
    integer :: generation = 0
    real(wp) :: time = 0.0_wp
    !> Volume removed, thickness of the web, and size of the force on the die then.
    real(wp) :: volume = 0.0_wp, thickness = 0.0_wp, force = 0.0_wp
  end type cut_record_t

contains

  !> Along a line, at the beginning of an operation.
  elemental function is_trim(cut) result(yes)
    type(cut_t), intent(in) :: cut
    logical :: yes

    yes = cut%die == 0
  end function is_trim

  !> This mesh was made with a cut.
  pure function was_just_cut(records, generation) result(yes)
    type(cut_record_t), intent(in) :: records(:)   !! (ncut)
    integer, intent(in) :: generation              !! of the mesh
    logical :: yes

    yes = any(records%generation == generation)
  end function was_just_cut

end module cuts
