!> The constrained Delaunay triangulation of a body: of the points along its contours, whose sides are all kept.
!>
!> A side that the points' triangulation lacks is made by exchanging the sides that cross it, one after another as soon as their two
!> triangles are convex (S. W. Sloan, A fast algorithm for generating constrained Delaunay triangulations, Computers & Structures 47
!> (1993) 441-450). Contours that touch or cross themselves or each other are refused, with the place.
module contour_triangles
  use errors, only: error_t, exit_no_convergence, fail
  use exact_signs, only: in_circle, orientation
  use kinds, only: wp
  use text, only: to_text
  use triangulation, only: add_point, after, before, exchange_side, place_of, start_triangulation, triangulation_t
  implicit none
  private
  public :: triangulate_contours

  !> Rounds of exchanges per crossing side, before giving up.
  integer, parameter :: rounds = 100

contains

  !> Point k of the contours is point k + 4 of the triangulation.
  pure subroutine triangulate_contours(points, sides, ncontour, mesh, error)
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    !> Ends of each side: first those of the contours, the body on their left, then those of inner curves (2, nside).
    integer, intent(in) :: sides(:, :)
    integer, intent(in) :: ncontour        !! number of sides of contours
    type(triangulation_t), intent(out) :: mesh
    type(error_t), allocatable, intent(out) :: error
    integer :: k, point

    call start_triangulation(points, mesh)
    do k = 1, size(points, 2)
      call add_point(mesh, points(:, k), mesh%triangle_at(mesh%npoint), point)
      if (point /= k + 4) then
        call refuse('two points of the contours coincide', points(:, k), error)
        return
      end if
    end do
    do k = 1, size(sides, 2)
      call make_side(mesh, sides(1, k) + 4, sides(2, k) + 4, error)
      if (allocated(error)) return
    end do
    call restore_all(mesh)
    call mark_inside(mesh, sides(:, :ncontour) + 4, error)
  end subroutine triangulate_contours

  pure subroutine refuse(why, x, error)
    character(len=*), intent(in) :: why
    real(wp), intent(in) :: x(2)
    type(error_t), allocatable, intent(out) :: error

    call fail(error, exit_no_convergence, 'remdata: '//why//' at x = '//to_text(x(1))//', y = '//to_text(x(2)), &
              'remesh earlier, or with other sizes of elements')
  end subroutine refuse

  !> Keep the side from a to b; make it where it is not there.
  pure subroutine make_side(mesh, a, b, error)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: a, b
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: crossing(:, :)
    integer :: t, k, round, n, left, c, d

    call list_crossing(mesh, a, b, crossing, error)
    if (allocated(error)) return
    n = size(crossing, 2)
    do round = 1, rounds + n
      left = 0
      do n = 1, size(crossing, 2)
        call find_side(mesh, crossing(1, n), crossing(2, n), t, k)
        c = mesh%node(k, t)
        d = mesh%node(place_of(mesh, t, mesh%across(k, t)), mesh%across(k, t))
        if (turn(mesh, c, crossing(1, n), d) > 0 .and. turn(mesh, d, crossing(2, n), c) > 0) then
          call exchange_side(mesh, t, k)
          if (any([c, d] == a) .or. any([c, d] == b) .or. turn(mesh, a, b, c)*turn(mesh, a, b, d) >= 0) cycle
          left = left + 1
          crossing(:, left) = merge([c, d], [d, c], turn(mesh, a, b, c) < 0)
        else
          left = left + 1
          crossing(:, left) = crossing(:, n)
        end if
      end do
      crossing = crossing(:, :left)
      if (left == 0) exit
    end do
    call find_side(mesh, a, b, t, k)
    if (t == 0) then
      call refuse('a side of the contours cannot be kept', mesh%x(:, a), error)
      return
    end if
    mesh%kept(k, t) = .true.
    mesh%kept(place_of(mesh, t, mesh%across(k, t)), mesh%across(k, t)) = .true.
  end subroutine make_side

  pure function turn(mesh, a, b, c) result(sign)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: a, b, c
    integer :: sign

    sign = orientation(mesh%p(:, a), mesh%p(:, b), mesh%p(:, c))
  end function turn

  !> Sides that cross the line from a to b, each with its first end on the right of the line.
  pure subroutine list_crossing(mesh, a, b, crossing, error)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: a, b
    integer, allocatable, intent(out) :: crossing(:, :)   !! (2, n)
    type(error_t), allocatable, intent(out) :: error
    integer :: t, k, start, far, next

    allocate (crossing(2, 0))
    start = mesh%triangle_at(a)
    t = start
    do
      k = findloc(mesh%node(:, t), a, 1)
      if (any(mesh%node(:, t) == b)) return
      associate (c => mesh%node(after(k), t), d => mesh%node(before(k), t))
        if (turn(mesh, a, b, c) == 0 .and. sum((mesh%p(:, c) - mesh%p(:, a))*(mesh%p(:, b) - mesh%p(:, a))) > 0) then
          call refuse('a point of the contours lies on a side', mesh%x(:, c), error)
          return
        end if
        if (turn(mesh, a, b, c) < 0 .and. turn(mesh, a, b, d) > 0) exit
      end associate
      t = mesh%across(after(k), t)
      if (t == start .or. t == 0) exit
    end do
    do
      associate (c => mesh%node(after(k), t), d => mesh%node(before(k), t))
        if (mesh%kept(k, t)) then
          call refuse('contours cross', 0.5_wp*(mesh%x(:, c) + mesh%x(:, d)), error)
          return
        end if
        crossing = reshape([crossing, c, d], [2, size(crossing, 2) + 1])
      end associate
      next = mesh%across(k, t)
      far = mesh%node(place_of(mesh, t, next), next)
      t = next
      if (far == b) return
      select case (turn(mesh, a, b, far))
      case (0)
        call refuse('a point of the contours lies on a side', mesh%x(:, far), error)
        return
      case (1)
        ! the next side is from the end on the right to `far`
        k = findloc(mesh%node(:, t), crossing(2, size(crossing, 2)), 1)
      case default
        k = findloc(mesh%node(:, t), crossing(1, size(crossing, 2)), 1)
      end select
    end do
  end subroutine list_crossing

  !> The triangle with the side from a to b in its sequence of nodes; 0 where there is none.
  pure subroutine find_side(mesh, a, b, t, k)
    type(triangulation_t), intent(in) :: mesh
    integer, intent(in) :: a, b
    integer, intent(out) :: t, k
    integer :: start, i

    start = mesh%triangle_at(a)
    t = start
    do
      i = findloc(mesh%node(:, t), a, 1)
      k = before(i)
      if (mesh%node(after(i), t) == b) return
      t = mesh%across(after(i), t)
      if (t == start .or. t == 0) exit
    end do
    t = 0
  end subroutine find_side

  !> Exchange sides that are not kept until all satisfy the circle test: each exchange lowers the lifted surface, so this ends.
  pure subroutine restore_all(mesh)
    type(triangulation_t), intent(inout) :: mesh
    integer :: t, k, u
    logical :: changed

    do
      changed = .false.
      do t = 1, mesh%ntriangle
        do k = 1, 3
          u = mesh%across(k, t)
          if (u == 0 .or. mesh%kept(k, t)) cycle
          if (in_circle(mesh%p(:, mesh%node(1, t)), mesh%p(:, mesh%node(2, t)), mesh%p(:, mesh%node(3, t)), &
                        mesh%p(:, mesh%node(place_of(mesh, t, u), u))) <= 0) cycle
          call exchange_side(mesh, t, k)
          changed = .true.
        end do
      end do
      if (.not. changed) exit
    end do
  end subroutine restore_all

  !> The triangles on the left of the contours, and all that are reached from them without crossing a contour.
  pure subroutine mark_inside(mesh, contours, error)
    type(triangulation_t), intent(inout) :: mesh
    integer, intent(in) :: contours(:, :)   !! (2, nside)
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: stack(:)
    logical :: border(3, mesh%ntriangle), open_body
    integer :: n, s, t, k, u

    border = .false.
    allocate (stack(3*mesh%ntriangle + size(contours, 2)))
    n = 0
    do s = 1, size(contours, 2)
      call find_side(mesh, contours(1, s), contours(2, s), t, k)
      border(k, t) = .true.
      n = n + 1
      stack(n) = t
    end do
    do while (n > 0)
      t = stack(n)
      n = n - 1
      if (mesh%inside(t)) cycle
      mesh%inside(t) = .true.
      do k = 1, 3
        u = mesh%across(k, t)
        if (border(k, t) .or. u == 0) cycle
        if (mesh%inside(u)) cycle
        n = n + 1
        stack(n) = u
      end do
    end do
    do s = 1, size(contours, 2)
      call find_side(mesh, contours(1, s), contours(2, s), t, k)
      if (mesh%inside(mesh%across(k, t))) exit
    end do
    ! the square around has the first four points
    open_body = any(mesh%inside(mesh%triangle_at(:4)))
    if (s <= size(contours, 2) .or. open_body) &
      call refuse('the contours enclose no body', mesh%x(:, contours(1, min(s, size(contours, 2)))), error)
  end subroutine mark_inside

end module contour_triangles
