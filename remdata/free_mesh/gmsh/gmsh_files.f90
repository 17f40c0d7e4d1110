!> Input and output files of Gmsh: a script of points, lines and sizes, and a mesh.
!>
!> All points along the contours are given, one element per line: Gmsh adds none there. Coordinates are those of a body of unit
!> size at the origin, for Gmsh's tolerances are absolute numbers. Formats: Gmsh reference manual, scripting language and
!> MSH file format, version 2.
module gmsh_files
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use errors, only: error_t, exit_machine, fail
  use kinds, only: wp
  use quad_lists, only: quads_t, refuse_mesh
  use text, only: to_text
  implicit none
  private
  public :: cell_t, unit_frame_t, write_script, read_quads

  !> A square with requested element sizes.
  type :: cell_t
    real(wp) :: low(2) = 0.0_wp, width = 0.0_wp   !! [length]
    !> Sizes at the corners, counter-clockwise from `low` [length].
    real(wp) :: sizes(4) = 0.0_wp
    integer :: depth = 0
  end type cell_t

  !> Position and scale of the unit body.
  type :: unit_frame_t
    real(wp) :: low(2) = 0.0_wp, width = 1.0_wp   !! [length]
  end type unit_frame_t

  !> Frontal Delaunay triangles (J.-F. Remacle et al., Int. J. Num. Meth. Engng 94 (2013) 494-512) paired into quadrilaterals by
  !> Blossom (ibid. 89 (2012) 1102-1119). Options whose defaults depend on the version or the user's files are set.
  character(len=*), parameter :: options(14) = [character(len=40) :: &
    'Mesh.Algorithm = 6;', 'Mesh.RecombineAll = 1;', 'Mesh.RecombinationAlgorithm = 1;', 'Mesh.Smoothing = 10;', &
    'Mesh.ElementOrder = 1;', 'Mesh.MeshSizeExtendFromBoundary = 0;', 'Mesh.MeshSizeFromPoints = 0;', &
    'Mesh.MeshSizeFromCurvature = 0;', 'Mesh.RandomSeed = 1;', 'Mesh.RandomFactor = 1e-9;', 'Mesh.MaxNumThreads2D = 1;', &
    'Mesh.MshFileVersion = 2.2;', 'Mesh.Binary = 0;', 'Mesh.SaveAll = 1;']
  !> Element types of the file format; types 2 and 3 have 3 and 4 corners.
  integer, parameter :: triangle = 2, quadrilateral = 3, point = 15

contains

  !> The script. The outer contour comes first, then holes; each has the body on its left.
  subroutine write_script(path, frame, points, first, cells, factor, error)
    character(len=*), intent(in) :: path
    type(unit_frame_t), intent(in) :: frame
    real(wp), intent(in) :: points(:, :)   !! along the contours (2, n) [length]
    integer, intent(in) :: first(:)        !! (ncontour + 1) of each contour among the points, and one past the last
    type(cell_t), intent(in) :: cells(:)   !! (ncell)
    real(wp), intent(in) :: factor         !! ratio of the sizes to those of the cells
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: form = '(*(a,g0,:))'
    integer :: unit, status, k, c, next
    real(wp) :: x(2), far(2)

    open (newunit=unit, file=path, status='replace', action='write', iostat=status)
    if (status == 0) write (unit, '(a)', iostat=status) options
    do k = 1, size(points, 2)
      x = (points(:, k) - frame%low)/frame%width
      if (status == 0) write (unit, form, iostat=status) 'Point(', k, ') = {', x(1), ', ', x(2), ', 0};'
    end do
    do c = 1, size(first) - 1
      do k = first(c), first(c + 1) - 1
        next = merge(first(c), k + 1, k == first(c + 1) - 1)
        if (status == 0) write (unit, form, iostat=status) 'Line(', k, ') = {', k, ', ', next, '};'
      end do
      if (status == 0) write (unit, form, iostat=status) 'Curve Loop(', c, ') = {', first(c), ':', first(c + 1) - 1, '};'
    end do
    if (status == 0) write (unit, form, iostat=status) 'Transfinite Curve {1:', size(points, 2), '} = 2;'
    if (status == 0) write (unit, form, iostat=status) 'Plane Surface(1) = {1:', size(first) - 1, '};'
    if (status == 0) write (unit, '(a)', iostat=status) 'View "sizes" {'
    do k = 1, size(cells)
      x = (cells(k)%low - frame%low)/frame%width
      far = x + cells(k)%width/frame%width
      associate (h => factor*cells(k)%sizes/frame%width)
        if (status == 0) write (unit, form, iostat=status) 'SQ(', x(1), ', ', x(2), ', 0, ', far(1), ', ', x(2), ', 0, ', &
          far(1), ', ', far(2), ', 0, ', x(1), ', ', far(2), ', 0){', h(1), ', ', h(2), ', ', h(3), ', ', h(4), '};'
      end associate
    end do
    if (status == 0) write (unit, '(a)', iostat=status) '};'
    if (status == 0) write (unit, '(a)', iostat=status) 'Field[1] = PostView;'
    if (status == 0) write (unit, '(a)', iostat=status) 'Field[1].ViewIndex = 0;'
    if (status == 0) write (unit, '(a)', iostat=status) 'Background Field = 1;'
    if (status == 0) close (unit, iostat=status)
    if (status /= 0) call fail(error, exit_machine, "cannot write '"//path//"'")
  end subroutine write_script

  !> The mesh between n given points. Anything unexpected in the file is an error.
  subroutine read_quads(path, frame, n, quads, error)
    character(len=*), intent(in) :: path
    type(unit_frame_t), intent(in) :: frame
    integer, intent(in) :: n
    type(quads_t), intent(out) :: quads
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: x(:, :)
    integer :: unit, status

    allocate (x(2, 0), quads%corners(4, 0))
    open (newunit=unit, file=path, status='old', action='read', iostat=status)
    if (status /= 0) then
      call refuse_mesh('Gmsh', 'there is no mesh', error)
      return
    end if
    call read_nodes(unit, x, error)
    if (.not. allocated(error)) call read_elements(unit, n, x, quads, error)
    close (unit)
    if (allocated(error)) return
    quads%inside = spread(frame%low, 2, size(quads%inside, 2)) + frame%width*quads%inside
  end subroutine read_quads

  !> Read up to and including a line.
  subroutine find_line(unit, requested, status)
    integer, intent(in) :: unit
    character(len=*), intent(in) :: requested
    integer, intent(out) :: status
    character(len=32) :: line

    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0 .or. line == requested) return
    end do
  end subroutine find_line

  subroutine read_nodes(unit, x, error)
    integer, intent(in) :: unit
    real(wp), allocatable, intent(inout) :: x(:, :)   !! by number
    type(error_t), allocatable, intent(out) :: error
    integer :: status, n, k, number
    real(wp) :: coordinates(2)

    n = 0
    call find_line(unit, '$Nodes', status)
    if (status == 0) read (unit, *, iostat=status) n
    if (status /= 0 .or. n < 1) then
      call refuse_mesh('Gmsh', 'it has no nodes', error)
      return
    end if
    deallocate (x)
    allocate (x(2, n))
    do k = 1, n
      read (unit, *, iostat=status) number, coordinates
      if (status == 0 .and. .not. all(ieee_is_finite(coordinates))) status = 1
      if (status == 0 .and. (number < 1 .or. number > n)) status = 1
      if (status /= 0) then
        call refuse_mesh('Gmsh', 'row '//to_text(k)//' of its nodes is invalid', error)
        return
      end if
      x(:, number) = coordinates
    end do
  end subroutine read_nodes

  !> Elements, and the given point of each node number of the file.
  subroutine read_elements(unit, n, x, quads, error)
    integer, intent(in) :: unit, n
    real(wp), intent(in) :: x(:, :)
    type(quads_t), intent(inout) :: quads
    type(error_t), allocatable, intent(out) :: error
    character(len=256) :: line
    integer :: status, rows, k, head(3), row(32), ncell, length, known(size(x, 2))

    rows = 0
    call find_line(unit, '$Elements', status)
    if (status == 0) read (unit, *, iostat=status) rows
    if (status /= 0 .or. rows < 1) then
      call refuse_mesh('Gmsh', 'it has no elements', error)
      return
    end if
    deallocate (quads%corners)
    allocate (quads%corners(4, rows))
    known = 0
    ncell = 0
    do k = 1, rows
      head = 0
      read (unit, '(a)', iostat=status) line
      if (status == 0) read (line, *, iostat=status) head
      length = 0
      if (head(2) == point) length = 1
      if (head(2) == triangle) length = 3
      if (head(2) == quadrilateral) length = 4
      length = length + 3 + head(3)
      if (status == 0 .and. (head(3) < 2 .or. length > size(row))) status = 1
      if (status == 0) read (line, *, iostat=status) row(:length)
      if (status == 0) then
        if (any(row(4 + head(3):length) < 1 .or. row(4 + head(3):length) > size(known))) status = 1
        if (head(2) == point .and. (row(5) < 1 .or. row(5) > n)) status = 1
      end if
      if (status /= 0) then
        call refuse_mesh('Gmsh', 'row '//to_text(k)//' of its elements is invalid', error)
        return
      end if
      select case (head(2))
      case (point)
        known(row(length)) = row(5)
      case (quadrilateral, triangle)
        ncell = ncell + 1
        quads%corners(:, ncell) = 0
        quads%corners(:head(2) + 1, ncell) = row(length - head(2):length)
      end select
    end do
    if (ncell == 0) then
      call refuse_mesh('Gmsh', 'it has no quadrilaterals', error)
    else if (count(known > 0) /= n) then
      call refuse_mesh('Gmsh', 'the points of the contour are missing', error)
    else
      quads%corners = quads%corners(:, :ncell)
      call number_inside(n, x, known, quads)
    end if
  end subroutine read_elements

  !> Number the nodes of quadrilaterals: given points as they are, then the others.
  pure subroutine number_inside(n, x, known, quads)
    integer, intent(in) :: n
    real(wp), intent(in) :: x(:, :)
    integer, intent(inout) :: known(:)
    type(quads_t), intent(inout) :: quads
    integer :: e, k, last, list(size(known))

    last = 0
    do e = 1, size(quads%corners, 2)
      do k = 1, count(quads%corners(:, e) > 0)
        associate (node => quads%corners(k, e))
          if (known(node) == 0) then
            last = last + 1
            known(node) = n + last
            list(last) = node
          end if
          node = known(node)
        end associate
      end do
    end do
    quads%inside = x(:, list(:last))
  end subroutine number_inside

end module gmsh_files
