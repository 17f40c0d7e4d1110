!> The free mesher: quadrilaterals of requested sizes inside contours, of any shape.
!>
!> The contours are triangulated; directions along them are continued into the body; points are packed as corners of squares along
!> these directions; the triangles between all points are merged in pairs, and those left are brought
!> together; what is connected badly is changed, and all is smoothed.
!> Steps and their sources are those of the modules used here. Nothing is drawn at random and signs are exact: the same contours
!> give the same mesh, whatever the number of threads. All loops are bounded.
module quad_mesher
  use background, only: background_t, set_up_background
  use contour_triangles, only: triangulate_contours
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use point_packing, only: pack_points
  use quad_cleaning, only: clean_quads
  use quad_lists, only: quads_t
  use quad_mesh, only: quad_mesh_t, set_up_quad_mesh
  use quad_seams, only: separate_sides
  use quad_smoothing, only: smooth_all
  use size_field, only: size_field_t
  use stretched_sides, only: exchange_stretched, stretch_of_points
  use triangle_pairs, only: pair_triangles
  use triangle_moves, only: merge_triangles
  use triangulation, only: triangulation_t
  implicit none
  private
  public :: fill_with_quads

  !> Sweeps of smoothing at most: before cleaning, and after each round of it.
  integer, parameter :: first_sweeps = 10, sweeps = 30, rounds = 3

contains

  !> Quadrilaterals inside contours, with the given sides as theirs. Where triangles cannot all be merged, none is cleaned, and some
  !> remain.
  pure subroutine fill_with_quads(points, sides, ncontour, sizes, material, factor, quads, error)
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    !> Ends of each side: first those of the contours, the body on their left, then those of inner curves (2, nside).
    integer, intent(in) :: sides(:, :)
    integer, intent(in) :: ncontour        !! number of sides of contours
    type(size_field_t), intent(in) :: sizes
    integer, intent(in) :: material        !! as `directed_size_at` takes it
    real(wp), intent(in) :: factor         !! ratio of the sizes to those of the field
    type(quads_t), intent(out) :: quads
    type(error_t), allocatable, intent(out) :: error
    type(triangulation_t) :: triangles
    type(background_t) :: field
    type(quad_mesh_t) :: mesh
    real(wp), allocatable :: stretch(:, :)
    integer, allocatable :: corners(:, :), original(:)
    logical :: possible
    integer :: n, round, k

    call triangulate_contours(points, sides, ncontour, triangles, error)
    if (allocated(error)) return
    call set_up_background(triangles, sides + 4, sizes, material, factor, field)
    call pack_points(field, sides(:, :ncontour) + 4, triangles, error)
    if (allocated(error)) return
    call stretch_of_points(field, triangles, stretch)
    call exchange_stretched(stretch, triangles)
    call pair_triangles(triangles, stretch, corners)
    n = size(points, 2)
    ! the first four points are those of the square around
    corners = max(corners - 4, 0)
    quads%inside = triangles%x(:, n + 5:triangles%npoint)
    call move_alloc(corners, quads%corners)
    call merge_triangles(triangles%x(:, 5:triangles%npoint), sides(:, ncontour + 1:), quads%corners)
    if (any(quads%corners == 0)) return
    call separate_sides(triangles%npoint - 4, sides(:, ncontour + 1:), quads%corners, original)
    call set_up_quad_mesh(triangles%x(:, [(k, k=5, triangles%npoint), original + 4]), quads%corners, mesh, possible)
    if (.not. possible) then
      call fail(error, exit_no_convergence, 'remdata: too many elements meet at a point of the mesh', &
                'ask for elements of other sizes')
      return
    end if
    mesh%stretch(:, :mesh%npoint) = stretch(:, [(k, k=5, triangles%npoint), original + 4])
    call smooth_all(mesh, first_sweeps)
    do round = 1, rounds
      call clean_quads(mesh)
      call smooth_all(mesh, sweeps)
    end do
    call number_again(mesh, n, triangles%npoint - 4, original, quads)
  end subroutine fill_with_quads

  !> Without the points and quadrilaterals that were removed.
  pure subroutine number_again(mesh, n, npoint, original, quads)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: n             !! given points, which keep their numbers
    integer, intent(in) :: npoint        !! points before the copies of those on inner curves
    integer, intent(in) :: original(:)   !! what these are copies of
    type(quads_t), intent(out) :: quads
    integer :: number(mesh%npoint), k, e, last

    last = n
    number(:n) = [(k, k=1, n)]
    do k = n + 1, mesh%npoint
      number(k) = 0
      if (k > npoint .and. k <= npoint + size(original)) number(k) = original(k - npoint)
      if (mesh%count(k) == 0 .or. number(k) > 0) cycle
      last = last + 1
      number(k) = last
    end do
    allocate (quads%inside(2, last - n), quads%corners(4, count(mesh%corner(1, :mesh%nquad) > 0)))
    do k = n + 1, mesh%npoint
      if (number(k) > n) quads%inside(:, number(k) - n) = mesh%x(:, k)
    end do
    last = 0
    do e = 1, mesh%nquad
      if (mesh%corner(1, e) == 0) cycle
      last = last + 1
      quads%corners(:, last) = number(mesh%corner(:, e))
    end do
  end subroutine number_again

end module quad_mesher
