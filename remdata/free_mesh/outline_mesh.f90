!> A mesh of 8-node quadrilaterals from contours and requested sizes, without zones.
!>
!> Ends of elements are placed along the contours as for zones; the free mesher, or Gmsh, makes quadrilaterals of four nodes
!> between them, which get middle nodes on their sides (middle_nodes); then bad elements are untangled.
module outline_mesh
  use block_mesh, only: polygon_area
  use body_outlines, only: outline_t
  use body_seams, only: seams_t
  use boundary_curves, only: boundary_curve_t
  use corner_mesh, only: corner_mesh_t, loops_around, loops_t, put_points
  use errors, only: error_t
  use flat_quads, only: open_flat_corners
  use gmsh_call, only: gmsh_t, mesh_outline
  use gmsh_files, only: cell_t
  use kinds, only: wp
  use middle_nodes, only: add_middle_nodes
  use outline_sides, only: divide_outlines, lay_out_outlines
  use quad_lists, only: quads_t, refuse_mesh
  use quad_mesher, only: fill_with_quads
  use side_curves, only: curve_t
  use size_cells, only: cover
  use size_field, only: size_field_t
  use split_cells, only: split_into_quads
  use text, only: to_text
  use untangle_elements, only: untangle
  use zone_mesh, only: mesh_settings_t, new_mesh_t
  use zones, only: zone_layout_t
  implicit none
  private
  public :: mesh_outlines, mesher_t

  !> Who makes quadrilaterals inside contours: Gmsh, or the free mesher.
  type :: mesher_t
    logical :: is_gmsh = .false.
    type(gmsh_t) :: gmsh
  end type mesher_t

  !> The limit on the number of elements is met by increasing the sizes, by more than the square root, in several attempts: each
  !> time by a little more, as a limit that is just missed would be missed again.
  real(wp), parameter :: growth = 1.02_wp
  integer, parameter :: attempts = 8

contains

  !> The mesh, or the reason of the failure. `division%factor` of the mesh is the effect of a limited number of elements.
  subroutine mesh_outlines(boundaries, outlines, field, settings, split, mesher, mesh, error, seams)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(outline_t), intent(in) :: outlines(:)            !! (nbody)
    type(size_field_t), intent(in) :: field
    type(mesh_settings_t), intent(in) :: settings
    logical, intent(in) :: split   !! elements are made twice as large, and split
    type(mesher_t), intent(inout) :: mesher
    type(new_mesh_t), intent(out) :: mesh
    type(error_t), allocatable, intent(out) :: error
    type(seams_t), optional, intent(in) :: seams   !! of the outlines that have some
    type(curve_t), allocatable :: curves(:)
    integer, allocatable :: first(:)
    real(wp), allocatable :: ends(:)
    type(corner_mesh_t) :: draft
    real(wp) :: factor
    integer :: attempt, k

    call lay_out_outlines(boundaries, outlines, mesh%layout, seams)
    factor = 1/settings%division%refine
    do attempt = 1, attempts
      call divide_outlines(boundaries, outlines, mesh%layout, field, factor, split, curves, mesh%division, first, ends)
      call make_corners(boundaries, outlines, field, mesh%layout, curves, factor, split, first, ends, mesher, draft, error)
      if (allocated(error)) return
      if (size(draft%zone) <= settings%division%most_elements) exit
      factor = growth**attempt*factor*sqrt(real(size(draft%zone), wp)/settings%division%most_elements)
    end do
    mesh%division%nelem = size(draft%zone)
    call add_middle_nodes(boundaries, curves, first, ends, name_of(mesher), draft, mesh, error)
    if (allocated(error) .or. .not. settings%least_sine > 0) return
    associate (nend => size(draft%x, 2), n => draft%nfixed)
      call untangle(mesh%connectivity, [(k > n, k=1, nend)], settings%least_sine, mesh%coordinates)
    end associate
  end subroutine mesh_outlines

  !> Corners of all elements: along the contours, and by the mesher body by body.
  subroutine make_corners(boundaries, outlines, field, layout, curves, factor, split, first, ends, mesher, draft, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(outline_t), intent(in) :: outlines(:)
    type(size_field_t), intent(in) :: field
    type(zone_layout_t), intent(in) :: layout
    type(curve_t), intent(in) :: curves(:)
    real(wp), intent(in) :: factor, ends(:)
    logical, intent(in) :: split
    integer, intent(in) :: first(:)
    type(mesher_t), intent(inout) :: mesher
    type(corner_mesh_t), intent(out) :: draft
    type(error_t), allocatable, intent(out) :: error
    type(loops_t) :: loops
    type(quads_t) :: quads
    integer :: b

    call put_points(boundaries, layout, curves, first, ends, draft)
    allocate (draft%corners(4, 0), draft%zone(0))
    do b = 1, size(outlines)
      call loops_around(layout, draft, b, loops, error)
      if (allocated(error)) return
      associate (x => draft%x(:, loops%points))
        if (split) then
          call fill_contours(mesher, x(:, ::2), loops%first/2 + 1, field, outlines(b)%material, 2*factor, quads, error)
          if (.not. allocated(error)) call split_into_quads(x(:, ::2), loops%next(loops%next(::2))/2 + 1, quads)
        else
          call fill_contours(mesher, x, loops%first, field, outlines(b)%material, factor, quads, error)
          if (.not. allocated(error)) call refuse_triangles(mesher, quads, error)
        end if
      end associate
      if (allocated(error)) return
      if (any(outlines%has_seams)) call open_corners_of_part(loops, draft%x(:, loops%points), quads)
      call add_quads(quads, b, loops%points, draft)
    end do
    ! not across seams
    if (.not. any(outlines%has_seams)) call open_flat_corners(draft%next, draft%smooth, draft%x, draft%corners, draft%zone)
  end subroutine make_corners

  !> Flat corners along contours and seams of a part, before it is one of several.
  pure subroutine open_corners_of_part(loops, points, quads)
    type(loops_t), intent(in) :: loops
    real(wp), intent(in) :: points(:, :)   !! of the loops (2, n) [length]
    type(quads_t), intent(inout) :: quads
    real(wp), allocatable :: x(:, :)
    integer, allocatable :: zone(:)
    integer :: e, n

    n = size(points, 2)
    allocate (x(2, n + size(quads%inside, 2)), zone(size(quads%corners, 2)))
    x(:, :n) = points
    x(:, n + 1:) = quads%inside
    zone = 0
    do e = 1, size(zone)
      if (polygon_area(x(:, quads%corners(:, e))) < 0) quads%corners(:, e) = quads%corners([1, 4, 3, 2], e)
    end do
    call open_flat_corners(loops%next, loops%smooth, x, quads%corners, zone)
    quads%inside = x(:, n + 1:)
  end subroutine open_corners_of_part

  !> Quadrilaterals, and perhaps triangles, between the points along the contours of a body.
  subroutine fill_contours(mesher, points, first, field, material, factor, quads, error)
    type(mesher_t), intent(inout) :: mesher
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    integer, intent(in) :: first(:)        !! (ncontour + 1) of each contour among the points, and one past the last
    type(size_field_t), intent(in) :: field
    integer, intent(in) :: material
    real(wp), intent(in) :: factor         !! ratio of the sizes to those of the field
    type(quads_t), intent(out) :: quads
    type(error_t), allocatable, intent(out) :: error
    type(cell_t), allocatable :: cells(:)
    integer :: sides(2, size(points, 2)), c, k

    if (mesher%is_gmsh) then
      call cover(field, material, minval(points, 2), maxval(points, 2), cells)
      call mesh_outline(mesher%gmsh, points, first, cells, factor, quads, error)
      return
    end if
    do c = 1, size(first) - 1
      do k = first(c), first(c + 1) - 1
        sides(:, k) = [k, merge(first(c), k + 1, k + 1 == first(c + 1))]
      end do
    end do
    call fill_with_quads(points, sides, size(sides, 2), field, material, factor, quads, error)
  end subroutine fill_contours

  pure subroutine refuse_triangles(mesher, quads, error)
    type(mesher_t), intent(in) :: mesher
    type(quads_t), intent(in) :: quads
    type(error_t), allocatable, intent(out) :: error

    if (any(quads%corners == 0)) &
      call refuse_mesh(name_of(mesher), 'it has '//to_text(count(quads%corners == 0))//' triangles', error)
  end subroutine refuse_triangles

  pure function name_of(mesher) result(name)
    type(mesher_t), intent(in) :: mesher
    character(len=:), allocatable :: name

    name = 'the free mesher'
    if (mesher%is_gmsh) name = 'Gmsh'
  end function name_of

  !> Quadrilaterals between the points of loops and new ones, counter-clockwise.
  pure subroutine add_quads(quads, outline, points, draft)
    type(quads_t), intent(in) :: quads
    integer, intent(in) :: outline, points(:)   !! (n) of the loops
    type(corner_mesh_t), intent(inout) :: draft
    real(wp), allocatable :: x(:, :)
    integer, allocatable :: corners(:, :)
    integer :: e, k, n, old

    n = size(draft%x, 2)
    allocate (x(2, n + size(quads%inside, 2)))
    x(:, :n) = draft%x
    x(:, n + 1:) = quads%inside
    old = size(draft%corners, 2)
    allocate (corners(4, old + size(quads%corners, 2)))
    corners(:, :old) = draft%corners
    do e = 1, size(quads%corners, 2)
      do k = 1, 4
        associate (corner => quads%corners(k, e))
          corners(k, old + e) = n + corner - size(points)
          if (corner <= size(points)) corners(k, old + e) = points(corner)
        end associate
      end do
    end do
    do e = old + 1, size(corners, 2)
      if (polygon_area(x(:, corners(:, e))) < 0) corners(:, e) = corners([1, 4, 3, 2], e)
    end do
    draft%zone = [draft%zone, spread(outline, 1, size(quads%corners, 2))]
    call move_alloc(x, draft%x)
    call move_alloc(corners, draft%corners)
  end subroutine add_quads

end module outline_mesh
