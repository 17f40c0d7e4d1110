!> Untangling of elements that smoothing left too skewed, by moving their corners.
!>
!> The quality of an element is the smallest sine between its lines at its eight nodes (the Jacobian over the lengths of its
!> columns); where it is inverted, the Jacobian itself divided by its previous area, since beyond a right angle the sine grows
!> again. A corner of a bad element is moved to the best of trial positions in eight directions, judged by the worst adjacent
!> element; its sides keep their shape. Good elements are not touched, and none becomes worse than the worst one around.
module untangle_elements
  use graded_sizes, only: list_elements
  use kinds, only: wp
  use plane_vectors, only: cross
  use shape_functions, only: quad8, quad8_corner
  implicit none
  private
  public :: untangle, least_sine, slopes_at_nodes

  !> Trial steps, as shares of the mean adjacent side, and number of passes.
  real(wp), parameter :: steps(4) = [0.4_wp, 0.15_wp, 0.05_wp, 0.015_wp]
  integer, parameter :: passes = 20
  real(wp), parameter :: half_root = 0.70710678118654752440_wp
  real(wp), parameter :: directions(2, 8) = reshape([1.0_wp, 0.0_wp, half_root, half_root, 0.0_wp, 1.0_wp, -half_root, half_root, &
                                                     -1.0_wp, 0.0_wp, -half_root, -half_root, 0.0_wp, -1.0_wp, &
                                                     half_root, -half_root], [2, 8])
  !> A smaller improvement is rejected.
  real(wp), parameter :: gain = 1.0e-3_wp

contains

  !> Move corners of elements below `least` that may move.
  pure subroutine untangle(connectivity, may_move, least, x)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelem)
    logical, intent(in) :: may_move(:)          !! (nend) corners, which are the first nodes
    real(wp), intent(in) :: least
    real(wp), intent(inout) :: x(:, :)   !! (2, nnode) [length]
    integer, allocatable :: first(:), around(:)
    real(wp), allocatable :: sine(:), unit(:)
    real(wp) :: dphi(2, 8, 8)
    integer :: pass, e, k, node
    logical :: moved, changed

    allocate (sine(size(connectivity, 2)), unit(size(connectivity, 2)))
    call slopes_at_nodes(dphi)
    do e = 1, size(sine)
      unit(e) = mean_square(x(:, connectivity(1:4, e)))
      sine(e) = least_sine(x(:, connectivity(:, e)), dphi, unit(e))
    end do
    if (.not. minval(sine) < least) return
    allocate (first(size(may_move) + 1), around(4*size(sine)))
    call list_elements(connectivity, first, around)
    do pass = 1, passes
      changed = .false.
      do e = 1, size(sine)
        if (.not. sine(e) < least) cycle
        do k = 1, 4
          node = connectivity(k, e)
          if (.not. may_move(node)) cycle
          call improve(connectivity, around(first(node):first(node + 1) - 1), node, dphi, unit, sine, x, moved)
          changed = changed .or. moved
        end do
      end do
      if (.not. changed) exit
    end do
  end subroutine untangle

  !> The best of the trial positions of one corner.
  pure subroutine improve(connectivity, elements, node, dphi, unit, sine, x, moved)
    integer, intent(in) :: connectivity(:, :), elements(:), node
    real(wp), intent(in) :: dphi(:, :, :), unit(:)
    real(wp), intent(inout) :: sine(:), x(:, :)
    logical, intent(out) :: moved
    real(wp) :: cell(2, 8, size(elements)), trial(2, 8), best, worst, mean, step(2), best_step(2)
    integer :: e, s, d, corner(size(elements))

    do e = 1, size(elements)
      cell(:, :, e) = x(:, connectivity(:, elements(e)))
      corner(e) = findloc(connectivity(1:4, elements(e)), node, 1)
    end do
    mean = sqrt(sum(unit(elements))/size(elements))
    best = minval(sine(elements)) + gain
    moved = .false.
    do s = 1, size(steps)
      do d = 1, size(directions, 2)
        step = steps(s)*mean*directions(:, d)
        worst = huge(worst)
        do e = 1, size(elements)
          trial = cell(:, :, e)
          call shift(corner(e), step, trial)
          worst = min(worst, least_sine(trial, dphi, unit(elements(e))))
          if (.not. worst > best) exit
        end do
        if (.not. worst > best) cycle
        best = worst
        best_step = step
        moved = .true.
      end do
    end do
    if (.not. moved) return
    do e = 1, size(elements)
      call shift(corner(e), best_step, cell(:, :, e))
      x(:, connectivity(:, elements(e))) = cell(:, :, e)
      sine(elements(e)) = least_sine(cell(:, :, e), dphi, unit(elements(e)))
    end do
  end subroutine improve

  !> Move a corner of an element; the adjacent sides keep their shape, so that no middle node moves along the chord.
  pure subroutine shift(corner, step, cell)
    integer, intent(in) :: corner
    real(wp), intent(in) :: step(2)
    real(wp), intent(inout) :: cell(:, :)
    real(wp) :: start(2), now(2), chord(2), bulge(2), share(2)
    integer :: k

    start = cell(:, corner)
    now = start + step
    do k = 0, 1
      associate (middle => cell(:, 5 + mod(corner + 3 - k, 4)), end => cell(:, mod(corner + 2*k, 4) + 1))
        chord = end - start
        bulge = middle - 0.5_wp*(start + end)
        ! along the chord and to its left, as shares of its length
        share = [dot_product(bulge, chord), cross(chord, bulge)]/dot_product(chord, chord)
        chord = end - now
        middle = 0.5_wp*(now + end) + share(1)*chord + share(2)*[-chord(2), chord(1)]
      end associate
    end do
    cell(:, corner) = now
  end subroutine shift

  !> Smallest sine between the lines of an element at its nodes; below zero the Jacobian over a quarter of a unit of area.
  pure function least_sine(x, dphi, unit) result(least)
    real(wp), intent(in) :: x(:, :)         !! (2, 8) [length]
    real(wp), intent(in) :: dphi(:, :, :)   !! (2, 8, 8) of `slopes_at_nodes` [-]
    real(wp), intent(in) :: unit            !! [length^2]
    real(wp) :: least
    real(wp) :: a(2), b(2), det
    integer :: k

    least = huge(least)
    do k = 1, 8
      a = matmul(x, dphi(1, :, k))
      b = matmul(x, dphi(2, :, k))
      det = cross(a, b)
      if (det > 0) then
        least = min(least, det/sqrt(dot_product(a, a)*dot_product(b, b)))
      else
        least = min(least, 4*det/unit)
      end if
    end do
  end function least_sine

  !> Mean square of the sides between corners [length^2].
  pure function mean_square(corners) result(mean)
    real(wp), intent(in) :: corners(:, :)   !! (2, 4) [length]
    real(wp) :: mean

    mean = 0.25_wp*sum((corners(:, [2, 3, 4, 1]) - corners)**2)
  end function mean_square

  !> Derivatives of the shape functions at the corners and middles.
  pure subroutine slopes_at_nodes(dphi)
    real(wp), intent(out) :: dphi(2, 8, 8)   !! (direction, function, node) [-]
    real(wp) :: phi(8), xi(2)
    integer :: k

    do k = 1, 4
      call quad8(quad8_corner(1, k), quad8_corner(2, k), phi, dphi(:, :, k))
      xi = 0.5_wp*(quad8_corner(:, k) + quad8_corner(:, mod(k, 4) + 1))
      call quad8(xi(1), xi(2), phi, dphi(:, :, 4 + k))
    end do
  end subroutine slopes_at_nodes

end module untangle_elements
