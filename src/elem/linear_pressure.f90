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
  use quad8_geometry, only: max_points, places, quad8_rule_t, slopes
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
    real(wp) :: y1(8), y2(8), part1(8), part2(8), from(3), detj, thickness
    real(wp), dimension(max_points, 4) :: jacobian, parent
    real(wp), dimension(max_points, 2) :: here, away
    integer :: p

    if (instant%predicted) then
      stress([1, 2, 4], :) = stress([1, 2, 4], :) + spread(sum(committed([1, 2, 4], :) - stress([1, 2, 4], :), 1)/3, 1, 3)
      return
    end if
    y1 = x(1, :) + instant%corrected_from(1, nodes)
    y2 = x(2, :) + instant%corrected_from(2, nodes)
    part1 = x(1, :) + du(1:8) - y1
    part2 = x(2, :) + du(9:16) - y2
    from = section(:, 1) - section(:, 2) + instant%section_from
    call slopes(rule, y1, y2, jacobian)
    call slopes(rule, part1, part2, parent)
    call places(rule, y1, y2, here)
    call places(rule, part1, part2, away)
    do p = 1, size(dv)
      detj = jacobian(p, 1)*jacobian(p, 4) - jacobian(p, 2)*jacobian(p, 3)
      thickness = thickness_at(from, here(p, :))
      before(p) = detj*rule%weight(p)*thickness
      ! trace of the gradient of the correction
      linear(p) = (jacobian(p, 4)*parent(p, 1) - jacobian(p, 2)*parent(p, 3) + jacobian(p, 1)*parent(p, 4) &
                   - jacobian(p, 3)*parent(p, 2))/detj &
                  + (thickness_at(section(:, 1) - from, here(p, :)) + dot_product(from(2:3), away(p, :)))/thickness
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
