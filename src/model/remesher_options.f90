!> How a scene is remeshed: options of REMSH cards for the remesher, and for the restart on a new mesh.
module remesher_options
  use acceptance, only: acceptance_t
  use cuts, only: cut_t
  use kinds, only: pi, wp
  use mesh_windows, only: mesh_window_t
  use zone_marks, only: contour_card_t, zone_card_t, zone_mark_t
  implicit none
  private
  public :: own_mesh_t, remesher_options_t, bodies_have_sizes, has_zones, has_contours, elements_allowed, number_of_cuts
  public :: smallest_anywhere
  public :: as_it_comes, by_zones, by_gmsh, by_free

  !> Mesher: zones, and where they fail the free mesher, then Gmsh; zones alone; Gmsh alone; the free mesher alone.
  integer, parameter :: as_it_comes = 0, by_zones = 1, by_gmsh = 2, by_free = 3

  !> Largest ratio of length to width where the deck does not say: as long as wide, as longer ones save little in the
  !> scenes (manual).
  real(wp), parameter :: default_stretch = 1.0_wp

  !> The mesh that the cards make, before any remesh took its place.
  type :: own_mesh_t
    integer :: elements = 0
    !> Sizes of the smallest and the largest element [length].
    real(wp) :: smallest = 0.0_wp, largest = 0.0_wp
    !> Thickness of each body that is slender, or of the part that it is joined to; 0 of others (nbody) [length].
    real(wp), allocatable :: thickness(:)
  end type own_mesh_t

  type :: remesher_options_t
    !> A REMSH card is there.
    logical :: wanted = .false.
    !> State transfer: number of the method, exponent of 1/R^N, points of moving least squares.
    integer :: transfer = 1
    real(wp) :: exponent = 2.0_wp
    integer :: neighbours = 16
    !> Sizes of elements, smallest and largest, and the smallest where dies bend and at their sharp corners [length].
    real(wp) :: smallest = 0.0_wp, largest = 0.0_wp, smallest_at_bends = 0.0_wp, smallest_at_corners = 0.0_wp
    !> Error of the strains an element is made for, elements at most.
    real(wp) :: strain_error = 0.05_wp
    integer :: most_elements = 0
    !> Largest ratio of length to width of elements that the remesher asks for.
    real(wp) :: stretch = default_stretch
    !> Sizes in windows; empty without any.
    type(mesh_window_t), allocatable :: windows(:)
    !> Elements across a contact interval (0: as they come), angle a side of an element may turn by, and at a bend of a die
    !> [radian].
    integer :: across_contact = 4
    real(wp) :: turn = pi/12, turn_at_dies = pi/12
    !> Elements across a slender body; 0: as they come.
    real(wp) :: across_slender = 0.0_wp
    !> Mesher.
    integer :: mesher = as_it_comes
    !> When a mesh is refused, and other ways tried then.
    type(acceptance_t) :: accept
    integer :: tries = 5
    !> Sizes of the deck's own mesh, for values that the deck does not give.
    type(own_mesh_t) :: own_mesh
    !> Zones that cards give, and the points they name; without them blocks are zones.
    type(zone_mark_t), allocatable :: marks(:)
    type(zone_card_t), allocatable :: zones(:)
    !> Contours of bodies of which the remesher makes the first mesh too.
    type(contour_card_t), allocatable :: contours(:)
    !> Bodies that are cut.
    type(cut_t), allocatable :: cuts(:)
  end type remesher_options_t

contains

  pure function has_zones(options) result(yes)
    type(remesher_options_t), intent(in) :: options
    logical :: yes

    yes = allocated(options%zones)
    if (yes) yes = size(options%zones) > 0
  end function has_zones

  !> Elements of a mesh whose sizes are divided by `finer`: where they are to be finer, the limit must not keep them from it.
  pure function elements_allowed(options, finer) result(most)
    type(remesher_options_t), intent(in) :: options
    real(wp), intent(in) :: finer
    integer :: most

    most = huge(most)
    if (options%most_elements > 0) most = int(min(options%most_elements*max(1.0_wp, finer)**2, real(huge(most), wp)))
  end function elements_allowed

  !> The smallest size that elements may have at any place [length].
  pure function smallest_anywhere(options) result(smallest)
    type(remesher_options_t), intent(in) :: options
    real(wp) :: smallest
    integer :: k

    smallest = options%smallest
    if (.not. allocated(options%windows)) return
    do k = 1, size(options%windows)
      smallest = min(smallest, options%windows(k)%smallest)
    end do
  end function smallest_anywhere

  pure function number_of_cuts(options) result(n)
    type(remesher_options_t), intent(in) :: options
    integer :: n

    n = 0
    if (allocated(options%cuts)) n = size(options%cuts)
  end function number_of_cuts

  !> Each of several bodies has sizes of its own.
  pure function bodies_have_sizes(options) result(yes)
    type(remesher_options_t), intent(in) :: options
    logical :: yes

    yes = has_contours(options)
    if (yes) yes = all(options%contours%largest > 0)
  end function bodies_have_sizes

  pure function has_contours(options) result(yes)
    type(remesher_options_t), intent(in) :: options
    logical :: yes

    yes = allocated(options%contours)
    if (yes) yes = size(options%contours) > 0
  end function has_contours

end module remesher_options
