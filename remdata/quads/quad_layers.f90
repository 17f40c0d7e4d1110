!> A new layer of quadrilaterals between a flat corner on a contour and what is opposite.
module quad_layers
  use kinds, only: wp
  use quad_charges, only: charge_of, saved
  use quad_memory, only: change_rule_t, judge, memory_t, remember, restore
  use quad_mesh, only: add_quad_point, most_around, put_quad, quad_mesh_t, quads_across
  implicit none
  private
  public :: insert_layer

contains

  !> Insert a layer of three points between a flat corner k on a contour and the opposite corner d; where d is on a contour too, or
  !> that cannot be, a ring of four points in the quadrilateral.
  !> ```
  !>     v --- d --- w        v --- d --- w        d -------- c
  !>     |     |     |        | 1 --2-- 3 |        | \ 4--3 / |
  !>     |     |     |   ->   | |   |   | |   or   |  |    |  |
  !>     r --- a b c s        r a   b   c s        | / 1--2 \ |
  !>                                               a -------- b
  !> ```
  pure subroutine insert_layer(mesh, e, k, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    integer, intent(in) :: e, k
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: quad(4), before, after, none, v, w, new(4), more(4), i, other(4), last
    real(wp) :: gained
    type(memory_t) :: memory

    quad = mesh%corner(mod([k + 2, k - 1, k, k + 1], 4) + 1, e)
    associate (a => quad(1), b => quad(2), c => quad(3), d => quad(4))
      call quads_across(mesh, a, d, before, none)
      call quads_across(mesh, d, c, after, none)
      last = 4
      if (before > 0 .and. after > 0 .and. .not. mesh%fixed(d)) then
        i = findloc(mesh%corner(:, before), d, 1)
        v = mesh%corner(mod(i, 4) + 1, before)
        i = findloc(mesh%corner(:, after), d, 1)
        w = mesh%corner(mod(i + 2, 4) + 1, after)
        gained = saved(mesh, [b, d, v, w], [1, -1, 1, 1]) - 2*charge_of(3, 4.0_wp, .false.)
        if (gained > rule%gain .and. v /= w) last = 3
      end if
      if (last == 4) gained = saved(mesh, quad, [1, 1, 1, 1]) - 4*charge_of(3, 4.0_wp, .false.)
      if (.not. gained > rule%gain .or. any(mesh%count(quad) >= most_around)) return
      call remember(mesh, quad, memory)
      if (memory%nquad == 0) return
      do i = 1, last
        call add_quad_point(mesh, 0.5_wp*mesh%x(:, quad(i)) + 0.125_wp*sum(mesh%x(:, quad), 2), quad, new(i), more(i))
        if (new(i) > 0) cycle
        call restore(mesh, memory)
        return
      end do
      if (last == 3) then
        mesh%x(:, new(2)) = 0.5_wp*(mesh%x(:, b) + mesh%x(:, d))
        other = mesh%corner(:, before)
        where (other == d) other = new(1)
        call put_quad(mesh, before, other)
        other = mesh%corner(:, after)
        where (other == d) other = new(3)
        call put_quad(mesh, after, other)
        call put_quad(mesh, e, [a, b, new(2), new(1)])
        call put_quad(mesh, more(1), [b, c, new(3), new(2)])
        call put_quad(mesh, more(2), [new(1), new(2), d, v])
        call put_quad(mesh, more(3), [new(2), new(3), w, d])
      else
        call put_quad(mesh, e, new)
        do i = 1, 4
          call put_quad(mesh, more(i), [quad(i), quad(mod(i, 4) + 1), new(mod(i, 4) + 1), new(i)])
        end do
      end if
    end associate
    call judge(mesh, memory, rule, changed)
  end subroutine insert_layer

end module quad_layers
