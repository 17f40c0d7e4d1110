!> Changes of quadrilaterals on trial: what was around them, and whether they stay.
module quad_memory
  use kinds, only: wp
  use quad_mesh, only: most_around, quad_mesh_t
  use quad_smoothing, only: smooth_point, worst_sine
  implicit none
  private
  public :: change_rule_t, memory_t, remember, judge, restore

  !> Sweeps over the surroundings of a change, and quadrilaterals there at most.
  integer, parameter :: sweeps = 10, most_touched = 6*most_around

  !> Which changes are made: each lowers the charges by more than `gain`, and leaves around it no worse corner than was there, or a
  !> good one; or one that is better by `better`.
  type :: change_rule_t
    real(wp) :: gain = 1.0e-6_wp, good = 0.5_wp, better = 0.0_wp
    !> Only quadrilaterals with a worse corner are changed.
    real(wp) :: below = 2.0_wp
  end type change_rule_t

  !> The quadrilaterals and points around a change, as they were; `nquad` is 0 where there are too many.
  type :: memory_t
    integer :: nquad, npoint, quads, points
    integer :: quad(most_touched), corner(4, most_touched), point(4*most_touched)
    integer :: count(4*most_touched), around(most_around, 4*most_touched)
    real(wp) :: x(2, 4*most_touched), worst
  end type memory_t

contains

  !> All quadrilaterals at these points, and the points of those.
  pure subroutine remember(mesh, points, memory)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: points(:)   !! (n)
    type(memory_t), intent(out) :: memory
    integer :: i, j, k

    memory%nquad = 0
    memory%npoint = 0
    do i = 1, size(points)
      do j = 1, mesh%count(points(i))
        associate (e => mesh%around(j, points(i)))
          if (any(memory%quad(:memory%nquad) == e)) cycle
          if (memory%nquad == most_touched) then
            memory%nquad = 0
            return
          end if
          memory%nquad = memory%nquad + 1
          memory%quad(memory%nquad) = e
          memory%corner(:, memory%nquad) = mesh%corner(:, e)
          do k = 1, 4
            if (any(memory%point(:memory%npoint) == mesh%corner(k, e))) cycle
            memory%npoint = memory%npoint + 1
            memory%point(memory%npoint) = mesh%corner(k, e)
          end do
        end associate
      end do
    end do
    associate (n => memory%npoint)
      memory%x(:, :n) = mesh%x(:, memory%point(:n))
      memory%count(:n) = mesh%count(memory%point(:n))
      memory%around(:, :n) = mesh%around(:, memory%point(:n))
    end associate
    memory%points = mesh%npoint
    memory%quads = mesh%nquad
    memory%worst = worst_around(mesh, memory%point(:memory%npoint))
  end subroutine remember

  !> Smooth around a change; undo it where the worst corner is then neither good nor as good as before.
  pure subroutine judge(mesh, memory, rule, changed)
    type(quad_mesh_t), intent(inout) :: mesh
    type(memory_t), intent(in) :: memory
    type(change_rule_t), intent(in) :: rule
    logical, intent(inout) :: changed(:)   !! set at the points around a change that stays (npoint)
    integer :: sweep, k
    real(wp) :: moved

    do sweep = 1, sweeps
      do k = 1, memory%npoint
        if (mesh%fixed(memory%point(k)) .or. mesh%count(memory%point(k)) == 0) cycle
        call smooth_point(mesh, memory%point(k), moved)
      end do
      do k = memory%points + 1, mesh%npoint
        call smooth_point(mesh, k, moved)
      end do
    end do
    if (worst_around(mesh, memory%point(:memory%npoint)) >= min(rule%good, memory%worst + rule%better)) then
      changed(memory%point(:memory%npoint)) = .true.
      changed(memory%points + 1:mesh%npoint) = .true.
      return
    end if
    call restore(mesh, memory)
  end subroutine judge

  !> All as it was before a change.
  pure subroutine restore(mesh, memory)
    type(quad_mesh_t), intent(inout) :: mesh
    type(memory_t), intent(in) :: memory
    integer :: k

    do k = 1, memory%nquad
      mesh%corner(:, memory%quad(k)) = memory%corner(:, k)
    end do
    do k = 1, memory%npoint
      mesh%x(:, memory%point(k)) = memory%x(:, k)
      mesh%count(memory%point(k)) = memory%count(k)
      mesh%around(:, memory%point(k)) = memory%around(:, k)
    end do
    if (mesh%nquad > memory%quads) mesh%corner(:, memory%quads + 1:mesh%nquad) = 0
    mesh%npoint = memory%points
    mesh%nquad = memory%quads
  end subroutine restore

  !> Smallest sine at the corners of all quadrilaterals at points: those at the border of a change move too.
  pure function worst_around(mesh, points) result(worst)
    type(quad_mesh_t), intent(in) :: mesh
    integer, intent(in) :: points(:)   !! (n)
    real(wp) :: worst
    integer :: k

    worst = 1
    do k = 1, size(points)
      worst = min(worst, worst_sine(mesh, mesh%around(:mesh%count(points(k)), points(k))))
    end do
  end function worst_around

end module quad_memory
