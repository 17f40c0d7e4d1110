!> Changes of a few quadrilaterals: one less, as many, or one more (P. Kinney, CleanUp: improving quadrilateral finite element
!> meshes, 6th International Meshing Roundtable, 1997, 449-461).
!>
!> Each is tried when it saves more than the rule asks for, and stays when the rule accepts the shapes around it.
module quad_changes
  use kinds, only: wp
  use quad_charges, only: charge, charge_of, saved
  use quad_memory, only: change_rule_t, judge, memory_t, remember
  use quad_mesh, only: add_quad_point, fan_of, most_around, put_quad, quad_mesh_t, quads_across, remove_quad
  implicit none
  private
  public :: remove_doublet, collapse, change_hexagon, open_point

contains

  !> Two quadrilaterals that share two sides become one.
  pure subroutine remove_doublet(mesh, point, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: point
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: e, f, k, quad(4)
    type(memory_t) :: memory

    e = mesh%around(1, point)
    f = mesh%around(2, point)
    k = findloc(mesh%corner(:, f), point, 1)
    quad = mesh%corner(:, e)
    if (any(quad == mesh%corner(mod(k + 1, 4) + 1, f))) return
    ! the two points between the sides that go have one less
    associate (ends => mesh%corner([modulo(k - 2, 4) + 1, mod(k, 4) + 1], f))
      if (.not. charge(mesh, point, 0) + saved(mesh, ends, [-1, -1]) > rule%gain) return
    end associate
    call remember(mesh, [quad, mesh%corner(:, f)], memory)
    quad(findloc(quad, point, 1)) = mesh%corner(mod(k + 1, 4) + 1, f)
    call remove_quad(mesh, f)
    call put_quad(mesh, e, quad)
    call judge(mesh, memory, rule, changed)
  end subroutine remove_doublet

  !> Collapse a quadrilateral along the diagonal from its corner k.
  pure subroutine collapse(mesh, e, k, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: e, k
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: a, b, c, d, i, j, f, quad(4), list(most_around), n
    real(wp) :: gained, ideal
    type(memory_t) :: memory

    a = mesh%corner(k, e)
    b = mesh%corner(k + 1, e)
    c = mesh%corner(k + 2, e)
    d = mesh%corner(mod(k + 2, 4) + 1, e)
    if (mesh%fixed(a) .and. mesh%fixed(c)) return
    if (mesh%fixed(c)) then
      call swap(a, c)
      call swap(b, d)
    end if
    if (min(mesh%count(b), mesh%count(d)) < 2) return
    n = mesh%count(a) + mesh%count(c) - 2
    if (n > most_around) return
    ideal = merge(mesh%ideal(a), 4.0_wp, mesh%fixed(a))
    gained = saved(mesh, [b, d], [-1, -1]) + charge(mesh, a, 0) + charge(mesh, c, 0) - charge_of(n, ideal, mesh%fixed(a))
    if (.not. gained > rule%gain) return
    ! no other quadrilateral has both ends of the diagonal
    do i = 1, mesh%count(c)
      f = mesh%around(i, c)
      if (f /= e .and. any(mesh%corner(:, f) == a)) return
    end do
    call remember(mesh, [a, b, c, d], memory)
    if (memory%nquad == 0) return
    if (.not. mesh%fixed(a)) mesh%x(:, a) = 0.5_wp*(mesh%x(:, a) + mesh%x(:, c))
    call remove_quad(mesh, e)
    n = mesh%count(c)
    list(:n) = mesh%around(:n, c)
    do i = 1, n
      quad = mesh%corner(:, list(i))
      j = findloc(quad, c, 1)
      quad(j) = a
      call put_quad(mesh, list(i), quad)
    end do
    call judge(mesh, memory, rule, changed)
  end subroutine collapse

  pure subroutine swap(a, b)
    integer, intent(inout) :: a, b
    integer :: c

    c = a
    a = b
    b = c
  end subroutine swap

  !> Divide the hexagon of the two quadrilaterals with the side between p and q in another way: by one of its two other diagonals,
  !> or by a new point in three.
  pure subroutine change_hexagon(mesh, p, q, way, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: p, q
    integer, intent(in) :: way   !! 1, 2 for the diagonals, 3, 4 for three quadrilaterals with a side from q or from p
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: left, right, ring(6), k, new, e
    real(wp) :: gained
    type(memory_t) :: memory

    call quads_across(mesh, p, q, left, right)
    if (left == 0 .or. right == 0) return
    ! around: q, r, s, p, t, u; beginning with q or p, or the point after, the new side is from its first to its fourth point
    k = findloc(mesh%corner(:, left), q, 1)
    ring(1:3) = mesh%corner([k, mod(k, 4) + 1, mod(k + 1, 4) + 1], left)
    k = findloc(mesh%corner(:, right), p, 1)
    ring(4:6) = mesh%corner([k, mod(k, 4) + 1, mod(k + 1, 4) + 1], right)
    do k = 2, 6
      if (any(ring(:k - 1) == ring(k))) return
    end do
    if (way == 4) ring = cshift(ring, 3)
    if (way <= 2) then
      ring = cshift(ring, way)
      gained = saved(mesh, [p, q, ring(1), ring(4)], [-1, -1, 1, 1])
    else
      gained = saved(mesh, ring(3:5), [1, -1, 1]) - charge_of(3, 4.0_wp, .false.)
    end if
    if (.not. gained > rule%gain .or. any(mesh%count(ring) >= most_around)) return
    call remember(mesh, ring, memory)
    if (memory%nquad == 0) return
    if (way <= 2) then
      call remove_quad(mesh, left)
      call put_quad(mesh, right, ring(1:4))
      call put_quad(mesh, left, ring([4, 5, 6, 1]))
    else
      call add_quad_point(mesh, sum(mesh%x(:, ring), 2)/6, ring, new, e)
      if (new == 0) return
      call remove_quad(mesh, left)
      call put_quad(mesh, right, [ring(1:3), new])
      call put_quad(mesh, left, [ring(3:5), new])
      call put_quad(mesh, e, [ring([5, 6, 1]), new])
    end if
    call judge(mesh, memory, rule, changed)
  end subroutine change_hexagon

  !> Open an inner point along two of its sides.
  pure subroutine open_point(mesh, point, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: point
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: quads(most_around), ends(most_around), n, i, j, m, best(2), new, e, quad(4), k
    real(wp) :: gained, most, middle(2)
    type(memory_t) :: memory

    call fan_of(mesh, point, n, quads, ends)
    if (n < 5) return
    most = rule%gain
    best = 0
    do i = 1, n
      do m = 2, n - 2
        j = modulo(i + m - 1, n) + 1
        if (max(mesh%count(ends(i)), mesh%count(ends(j))) >= most_around) cycle
        gained = saved(mesh, [ends(i), ends(j)], [1, 1]) + charge(mesh, point, 0) - charge_of(n - m + 1, 4.0_wp, .false.) &
                 - charge_of(m + 1, 4.0_wp, .false.)
        if (.not. gained > most) cycle
        most = gained
        best = [i, m]
      end do
    end do
    if (best(1) == 0) return
    call remember(mesh, [point, ends(:n)], memory)
    if (memory%nquad == 0) return
    i = best(1)
    m = best(2)
    j = modulo(i + m - 1, n) + 1
    middle = mesh%x(:, point)
    do k = i, i + m - 1
      middle = middle + sum(mesh%x(:, mesh%corner(:, quads(modulo(k - 1, n) + 1))), 2)/(4*m)
    end do
    middle = 0.75_wp*mesh%x(:, point) + 0.25_wp*(middle - mesh%x(:, point))
    call add_quad_point(mesh, middle, [point], new, e)
    if (new == 0) return
    do k = i, i + m - 1
      associate (f => quads(modulo(k - 1, n) + 1))
        quad = mesh%corner(:, f)
        quad(findloc(quad, point, 1)) = new
        call put_quad(mesh, f, quad)
      end associate
    end do
    call put_quad(mesh, e, [ends(i), new, ends(j), point])
    call judge(mesh, memory, rule, changed)
  end subroutine open_point

end module quad_changes
