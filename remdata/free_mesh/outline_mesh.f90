!> A mesh of 8-node quadrilaterals from contours and requested sizes, without zones.
!>
!> Ends of elements are placed along the contours as for zones; the free mesher, or Gmsh, makes quadrilaterals of four nodes
!> between them. The middle nodes of their sides are placed here: on the contour by its parabolas, halfway inside; then bad
!> elements are untangled.
module outline_mesh
  use block_mesh, only: polygon_area
  use body_outlines, only: outline_t
  use body_seams, only: seams_t
  use boundary_curves, only: boundary_curve_t, position_t
  use corner_mesh, only: corner_mesh_t, loops_around, loops_t, put_points
  use errors, only: error_t
  use flat_quads, only: open_flat_corners
  use gmsh_call, only: gmsh_t, mesh_outline
  use gmsh_files, only: cell_t
  use kinds, only: wp
  use outline_sides, only: divide_outlines, lay_out_outlines
  use quad_lists, only: quads_t, refuse_mesh
  use quad_mesher, only: fill_with_quads
  use side_curves, only: curve_t
  use side_middles, only: place_middle
  use size_cells, only: cover
  use size_field, only: size_field_t
  use split_cells, only: split_into_quads
  use text, only: to_text
  use untangle_elements, only: untangle
  use zone_mesh, only: mesh_settings_t, new_mesh_t, seam_side_t
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
    call complete(boundaries, curves, first, ends, name_of(mesher), draft, mesh, error)
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

  !> Middle nodes, positions on the contour, sides along it; and whether the elements fill the contour.
  pure subroutine complete(boundaries, curves, first, ends, name, draft, mesh, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: first(:)
    real(wp), intent(in) :: ends(:)
    character(len=*), intent(in) :: name   !! of the mesher
    type(corner_mesh_t), intent(in) :: draft
    type(new_mesh_t), intent(inout) :: mesh
    type(error_t), allocatable, intent(out) :: error
    integer :: nend, n, nnode, s, k, i, middle
    logical :: fills

    nend = size(draft%x, 2)
    n = size(draft%next)
    allocate (mesh%zone, source=draft%zone)
    allocate (mesh%connectivity(8, size(draft%zone)), mesh%sides(n))
    mesh%connectivity(1:4, :) = draft%corners
    call number_middles(draft%next, nend, mesh%connectivity, mesh%sides%element, nnode, fills)
    if (.not. fills) then
      call refuse_mesh(name, 'its elements do not fill the contour', error)
      return
    end if
    allocate (mesh%coordinates(2, nnode), mesh%boundary(nnode), mesh%position(nnode))
    mesh%coordinates(:, :nend) = draft%x
    do i = 1, size(mesh%zone)
      do k = 1, 4
        mesh%coordinates(:, mesh%connectivity(4 + k, i)) = &
          0.5_wp*(draft%x(:, mesh%connectivity(k, i)) + draft%x(:, mesh%connectivity(mod(k, 4) + 1, i)))
      end do
    end do
    mesh%boundary = 0
    mesh%position(:n) = draft%position
    do s = 1, size(draft%start) - 1
      do i = draft%start(s), draft%start(s + 1) - 1
        k = first(s) + i - draft%start(s)
        middle = nend + i
        call place_middle(boundaries, curves(s), ends(k:k + 1), draft%x(:, [i, draft%next(i)]), mesh%coordinates(:, middle), &
                          mesh%position(middle))
        mesh%boundary([i, middle]) = curves(s)%boundary
        mesh%sides(i)%nodes = [i, middle, draft%next(i)]
        mesh%sides(i)%boundary = curves(s)%boundary
        mesh%sides(i)%from = draft%position(i)
        mesh%sides(i)%to = draft%position(draft%next(i))
      end do
    end do
    call complete_seams(boundaries, curves, first, ends, draft, mesh, fills)
    if (.not. fills) call refuse_mesh(name, 'its elements do not follow the sides between bodies', error)
  end subroutine complete

  !> Sides along seams, with their middle nodes on them.
  pure subroutine complete_seams(boundaries, curves, first, ends, draft, mesh, follows)
    type(boundary_curve_t), intent(in) :: boundaries(:)
    type(curve_t), intent(in) :: curves(:)
    integer, intent(in) :: first(:)
    real(wp), intent(in) :: ends(:)
    type(corner_mesh_t), intent(in) :: draft
    type(new_mesh_t), intent(inout) :: mesh
    logical, intent(out) :: follows   !! all of them are sides of elements
    type(position_t) :: ignored
    integer :: s, k, n

    n = 0
    do s = size(draft%start), size(curves)
      n = n + ubound(draft%seams(s)%points, 1)
    end do
    allocate (mesh%seams(n))
    follows = .true.
    n = 0
    do s = size(draft%start), size(curves)
      associate (points => draft%seams(s)%points)
        do k = 1, ubound(points, 1)
          n = n + 1
          mesh%seams(n) = seam_side_t([points(k - 1), middle_between(mesh%connectivity, points(k - 1), points(k)), points(k)], &
                                      mesh%layout%sides(s)%path)
          follows = follows .and. mesh%seams(n)%nodes(2) > 0
          if (.not. follows) return
          call place_middle(boundaries, curves(s), ends(first(s) + k - 1:first(s) + k), draft%x(:, points(k - 1:k)), &
                            mesh%coordinates(:, mesh%seams(n)%nodes(2)), ignored)
        end do
      end associate
    end do
  end subroutine complete_seams

  !> Middle node of the side of an element from one node to another; 0 where there is none.
  pure function middle_between(connectivity, from, to) result(middle)
    integer, intent(in) :: connectivity(:, :), from, to
    integer :: middle
    integer :: e, k

    do e = 1, size(connectivity, 2)
      do k = 1, 4
        if (connectivity(k, e) /= from .or. connectivity(mod(k, 4) + 1, e) /= to) cycle
        middle = connectivity(4 + k, e)
        return
      end do
    end do
    middle = 0
  end function middle_between

  !> Middle nodes: first those along the contour, in the order of its points, then the others as elements have them. The
  !> elements fill the contour when each of its sides belongs to one element, and every other side to two, one on each side.
  pure subroutine number_middles(next, nend, connectivity, element, nnode, fills)
    integer, intent(in) :: next(:), nend
    integer, intent(inout) :: connectivity(:, :)   !! (8, nelem) corners in, middles out
    integer, intent(out) :: element(:)             !! (nside) element of each side of the contour
    integer, intent(out) :: nnode
    logical, intent(out) :: fills
    ! sides that begin at one node form a linked list
    integer :: latest(nend), before(4*size(connectivity, 2)), far(4*size(connectivity, 2)), number(4*size(connectivity, 2))
    integer :: e, k, i, a, b, side, open_sides

    element = 0
    latest = 0
    nnode = nend + size(next)
    open_sides = 0
    fills = .true.
    do e = 1, size(connectivity, 2)
      do k = 1, 4
        a = connectivity(k, e)
        b = connectivity(mod(k, 4) + 1, e)
        if (a <= size(next)) then
          if (next(a) == b) then
            fills = fills .and. element(a) == 0
            element(a) = e
            connectivity(4 + k, e) = nend + a
            cycle
          end if
        end if
        side = 4*(e - 1) + k
        far(side) = b
        before(side) = latest(a)
        latest(a) = side
        i = latest(b)
        do while (i > 0)
          if (far(i) == a) exit
          i = before(i)
        end do
        if (i == 0) then
          nnode = nnode + 1
          number(side) = nnode
          open_sides = open_sides + 1
        else
          number(side) = number(i)
          ! no third element has it
          far(i) = 0
          far(side) = 0
          open_sides = open_sides - 1
        end if
        connectivity(4 + k, e) = number(side)
      end do
    end do
    fills = fills .and. all(element > 0) .and. open_sides == 0
  end subroutine number_middles

end module outline_mesh
