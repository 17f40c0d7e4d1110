!> The pressure that the geometric part of PL8LS's matrix counts with while Newton's method is under way.
!>
!> Where volume can hardly change (nu near 1/2, plastic flow) the pressure of an iterate, kappa ln J, is wrong by kappa times what
!> of ln J is of second order in the last correction. That is far more than the pressures of equilibrium, and a matrix with it
!> is the matrix of another state: the next corrections are wrong, and steps short. With pressures as unknowns of their own the
!> iteration does not have this trouble, for they follow the linear equations: p + kappa tr(grad du). Eliminated at
!> each point, these unknowns leave forces and matrix as they are, but for the geometric part, which has that pressure. Where
!> Newton's method converges both are the same to second order. A prediction solves no equations: the pressure is that of the start
!> of the step.
!> Source: D. Magisano, L. Leonetti, G. Garcea, CMAME 313 (2017) 986-1005, for all stresses of beams and shells; of solids
!> pressures alone matter (the deviators made no difference on billet, ring, rib and bars of nu = .3 to .499999).
module linear_pressure
  use elem_api, only: instant_t
  use kinds, only: wp
  use mean_dilatation, only: dilatation_t, hidden_change, mean_volumes
  use quad8_geometry, only: derivatives, quad8_rule_t
  use sections, only: thickness_at
  implicit none
  private
  public :: has_linear_pressure, replace_pressure

contains

  !> The instant is that of a prediction or of a correction.
  pure function has_linear_pressure(instant) result(yes)
    type(instant_t), intent(in) :: instant
    logical :: yes

    yes = instant%predicted .or. allocated(instant%corrected_from)
  end function has_linear_pressure

  !> Give the stresses of an element the pressures of the start of the step, or those that the last correction makes.
  pure subroutine replace_pressure(instant, rule, nodes, section, x, du, dv, committed, tangent, stress, own)
    type(instant_t), intent(in) :: instant
    type(quad8_rule_t), intent(in) :: rule
    integer, intent(in) :: nodes(8)
    real(wp), intent(in) :: section(3, 2)         !! thickness [length] and slopes [-]: now, and their motion in the step
    real(wp), intent(in) :: x(2, 8)               !! nodes at the start of the step [length]
    real(wp), intent(in) :: du(:)                 !! (ndof) motion of the local unknowns, x then y of the nodes first [unknown]
    real(wp), intent(in) :: dv(:)                 !! (npoint) now [volume]
    real(wp), intent(in) :: committed(:, :)       !! (4, npoint) at the start of the step [stress]
    real(wp), intent(in) :: tangent(:, :, :)      !! (4, 5, npoint) [stress]
    real(wp), intent(inout) :: stress(:, :)       !! (4, npoint) [stress]
    type(dilatation_t), intent(in), optional :: own   !! with mean dilatation
    real(wp), dimension(size(dv)) :: linear, exact, before
    real(wp) :: y(2, 8), part(2, 8), from(3), nx(8), ny(8), detj, here(2), thickness
    integer :: p

    if (instant%predicted) then
      stress([1, 2, 4], :) = stress([1, 2, 4], :) + spread(sum(committed([1, 2, 4], :) - stress([1, 2, 4], :), 1)/3, 1, 3)
      return
    end if
    y = x + instant%corrected_from(:, nodes)
    part(1, :) = x(1, :) + du(1:8) - y(1, :)
    part(2, :) = x(2, :) + du(9:16) - y(2, :)
    from = section(:, 1) - section(:, 2) + instant%section_from
    do p = 1, size(dv)
      call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      here = matmul(y, rule%phi(:, p))
      thickness = thickness_at(from, here)
      before(p) = detj*rule%weight(p)*thickness
      linear(p) = dot_product(nx, part(1, :)) + dot_product(ny, part(2, :)) &
                  + (thickness_at(section(:, 1) - from, here) + dot_product(from(2:3), matmul(part, rule%phi(:, p))))/thickness
    end do
    if (present(own)) then
      linear = linear - hidden_change(own, before, linear)
      exact = log(mean_volumes(own, dv)/mean_volumes(own, before))
    else
      exact = log(dv/before)
    end if
    do p = 1, size(dv)
      stress([1, 2, 4], p) = stress([1, 2, 4], p) + sum(tangent([1, 2, 4], [1, 4, 5], p))/9*(linear(p) - exact(p))
    end do
  end subroutine replace_pressure

end module linear_pressure
