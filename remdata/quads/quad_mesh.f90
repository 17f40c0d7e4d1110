!> Quadrilaterals between points, with what is around each point, for changes of both.
module quad_mesh
  use kinds, only: pi, wp
  use plane_vectors, only: angle_between
  implicit none
  private
  public :: quad_mesh_t, set_up_quad_mesh, most_around, put_quad, remove_quad, add_quad_point, quads_across, fan_of

  !> Quadrilaterals around a point at most.
  integer, parameter :: most_around = 16

  type :: quad_mesh_t
    integer :: npoint = 0, nquad = 0
    real(wp), allocatable :: x(:, :)        !! (2, npoint) and space for more [length]
    integer, allocatable :: corner(:, :)    !! (4, nquad) counter-clockwise; 0 for one that was removed
    integer, allocatable :: count(:)        !! (npoint) quadrilaterals around it
    integer, allocatable :: around(:, :)    !! (most_around, npoint) these
    logical, allocatable :: fixed(:)        !! (npoint) on a contour or an inner curve
    real(wp), allocatable :: ideal(:)       !! (npoint) angle of the body there, in right angles
    !> By which quadrilaterals around each point are longer than wide (`directed_sizes`): 0 for squares (2, npoint) [-].
    real(wp), allocatable :: stretch(:, :)
  end type quad_mesh_t

contains

  !> From points, of which those on contours stay: where a side has a quadrilateral on its left only. `possible` is false where more
  !> quadrilaterals meet at a point than there is space for.
  pure subroutine set_up_quad_mesh(x, corners, mesh, possible)
    real(wp), intent(in) :: x(:, :)           !! (2, npoint) [length]
    integer, intent(in) :: corners(:, :)      !! (4, nquad)
    type(quad_mesh_t), intent(out) :: mesh
    logical, intent(out) :: possible
    integer :: np, nq, e, k, p, before(size(x, 2)), after(size(x, 2)), left, right
    real(wp) :: angle

    np = size(x, 2)
    nq = size(corners, 2)
    mesh%npoint = np
    mesh%nquad = nq
    allocate (mesh%x(2, 2*np), mesh%corner(4, 2*nq), mesh%count(2*np), mesh%around(most_around, 2*np), mesh%fixed(2*np), &
              mesh%ideal(2*np))
    allocate (mesh%stretch(2, 2*np), source=0.0_wp)
    mesh%x(:, :np) = x
    mesh%corner = 0
    mesh%count = 0
    mesh%fixed = .false.
    mesh%ideal = 4
    possible = .false.
    do e = 1, nq
      do k = 1, 4
        p = corners(k, e)
        if (mesh%count(p) == most_around) return
        mesh%count(p) = mesh%count(p) + 1
        mesh%around(mesh%count(p), p) = e
      end do
      mesh%corner(:, e) = corners(:, e)
    end do
    before = 0
    after = 0
    do e = 1, nq
      do k = 1, 4
        associate (a => corners(k, e), b => corners(mod(k, 4) + 1, e))
          call quads_across(mesh, a, b, left, right)
          if (right > 0) cycle
          after(a) = b
          before(b) = a
        end associate
      end do
    end do
    do p = 1, np
      mesh%fixed(p) = before(p) > 0
      if (.not. mesh%fixed(p)) cycle
      angle = angle_between(x(:, after(p)) - x(:, p), x(:, before(p)) - x(:, p))
      if (angle <= 0) angle = angle + 2*pi
      mesh%ideal(p) = angle/(pi/2)
    end do
    possible = .true.
  end subroutine set_up_quad_mesh

  !> Give quadrilateral e these corners, in place of those it had.
  pure subroutine put_quad(mesh, e, corners)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: e
    integer, intent(in) :: corners(:)   !! (4) counter-clockwise
    integer :: k

    if (mesh%corner(1, e) > 0) call remove_quad(mesh, e)
    mesh%corner(:, e) = corners
    do k = 1, 4
      associate (n => mesh%count(corners(k)))
        n = n + 1
        mesh%around(n, corners(k)) = e
      end associate
    end do
  end subroutine put_quad

  pure subroutine remove_quad(mesh, e)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: e
    integer :: k, i

    do k = 1, 4
      associate (point => mesh%corner(k, e))
        i = findloc(mesh%around(:mesh%count(point), point), e, 1)
        mesh%around(i, point) = mesh%around(mesh%count(point), point)
        mesh%count(point) = mesh%count(point) - 1
      end associate
    end do
    mesh%corner(:, e) = 0
  end subroutine remove_quad

  !> One more point that may move, and one more quadrilateral, both without anything; 0 where there is no space.
  pure subroutine add_quad_point(mesh, x, like, point, e)
    type(quad_mesh_t), intent(inout) :: mesh
    real(wp), intent(in) :: x(2)       !! [length]
    integer, intent(in) :: like(:)     !! points around, of which it has the mean stretch (n)
    integer, intent(out) :: point, e

    point = 0
    e = 0
    if (mesh%npoint == size(mesh%x, 2) .or. mesh%nquad == size(mesh%corner, 2)) return
    mesh%npoint = mesh%npoint + 1
    mesh%nquad = mesh%nquad + 1
    point = mesh%npoint
    e = mesh%nquad
    mesh%x(:, point) = x
    mesh%fixed(point) = .false.
    mesh%ideal(point) = 4
    mesh%stretch(:, point) = sum(mesh%stretch(:, like), 2)/size(like)
    mesh%count(point) = 0
  end subroutine add_quad_point

  !> The two quadrilaterals with the side between a and b: the one that has it from a to b, and the other; 0 where there is none.
  pure subroutine quads_across(mesh, a, b, left, right)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: a, b
    integer, intent(out) :: left, right
    integer :: i, k

    left = 0
    right = 0
    do i = 1, mesh%count(a)
      associate (corner => mesh%corner(:, mesh%around(i, a)))
        k = findloc(corner, a, 1)
        if (corner(mod(k, 4) + 1) == b) left = mesh%around(i, a)
        if (corner(mod(k + 2, 4) + 1) == b) right = mesh%around(i, a)
      end associate
    end do
  end subroutine quads_across

  !> The quadrilaterals around an inner point counter-clockwise, and the far end of the side where each begins; none where
  !> they do not close around it.
  pure subroutine fan_of(mesh, point, n, quads, ends)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: point
    integer, intent(out) :: n
    integer, intent(out) :: quads(:), ends(:)   !! (most_around)
    integer :: e, k, left, right

    n = 0
    e = mesh%around(1, point)
    do
      k = findloc(mesh%corner(:, e), point, 1)
      n = n + 1
      quads(n) = e
      ends(n) = mesh%corner(mod(k, 4) + 1, e)
      call quads_across(mesh, point, mesh%corner(mod(k + 2, 4) + 1, e), left, right)
      e = left
      if (e == quads(1) .and. n == mesh%count(point)) return
      if (e == 0 .or. n == mesh%count(point)) exit
    end do
    n = 0
  end subroutine fan_of

end module quad_mesh
