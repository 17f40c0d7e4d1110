!> Middle nodes of a mesh without zones, whose quadrilaterals have four nodes so far: along contours and seams on their parabolas,
!> inside halfway.
module middle_nodes
  use boundary_curves, only: boundary_curve_t, position_t
  use corner_mesh, only: corner_mesh_t
  use errors, only: error_t
  use kinds, only: wp
  use quad_lists, only: refuse_mesh
  use side_curves, only: curve_t
  use side_middles, only: place_middle
  use zone_mesh, only: new_mesh_t, seam_side_t
  implicit none
  private
  public :: add_middle_nodes

contains

  !> Middle nodes, positions on the contour, sides along it; and whether the elements fill the contour.
  pure subroutine add_middle_nodes(boundaries, curves, first, ends, name, draft, mesh, error)
    type(boundary_curve_t), intent(in) :: boundaries(:)   !! (nboundary)
    type(curve_t), intent(in) :: curves(:)                !! (nside) of the sides of the layout
    integer, intent(in) :: first(:)                       !! (nside + 1) of each curve among `ends`
    real(wp), intent(in) :: ends(:)                       !! (first(nside + 1) - 1) arc lengths at ends of elements [length]
    character(len=*), intent(in) :: name                  !! of the mesher
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
  end subroutine add_middle_nodes

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

end module middle_nodes
