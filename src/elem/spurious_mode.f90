!> Motions that the points of an element do not see, or see in part.
!>
!> In the parent square u = xi (3 eta^2 - 1), v = -eta (3 xi^2 - 1), which 8 nodes can make, has no strain at xi, eta = +-1/sqrt(3):
!> nothing resists it in an element of 2 x 2 points that stands alone. (In other shapes there is one like it, 16 unknowns having 3
!> rigid motions and 12 strains.) Neighbours that share a side cannot both make it; an element lightly held can.
!> Measure: of the square of the strain of a motion, the share which 3 x 3 points see, and 2 x 2 points do not: 1 for the mode, 0
!> for strains that are linear over the element.
!> With the option MEAN the pressure does not see tr h - theta (mean_dilatation), change of volume that is not linear over the
!> element: v = xi (1 - eta^2), for one, which neighbours can make too. In large strain it may be free, where shear is small and
!> flow goes the same way. Measure: the square of that over half the square of the strain, 1 at most.
!> Where an element deforms less than the mean of the group that mean is its measure.
module spurious_mode
  use elem_api, only: elem_t, has_option
  use kinds, only: wp
  use mean_dilatation, only: dilatation_t, hidden_change, mean_word
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: axisymmetric, group_t, is_solid, scene_t
  use solid_terms, only: first_element
  implicit none
  private
  public :: has_mean_dilatation, has_spurious_mode, may_stand_alone, find_spurious_mode, spurious_limit

  !> A share above this is reported. The mode has 1; smooth motions have less than 0.05, corners that a body folds over up to 0.71.
  !> With MEAN necks have up to 0.25, folded corners 0.73; elements that saw in tension (mean_dilatation) 0.7 to 1.
  real(wp), parameter :: spurious_limit = 0.9_wp
  !> Points of the elements that have the mode.
  integer, parameter :: reduced_rule = 4
  !> A body of more elements has neighbours enough to stop the mode.
  integer, parameter :: few_elements = 16

contains

  !> Whether a group's elements have motions that their points do not see, or with MEAN, in large strain, their pressures.
  pure function has_spurious_mode(elem, group, finite) result(yes)
    type(elem_t), intent(in) :: elem     !! of the group
    type(group_t), intent(in) :: group
    logical, intent(in) :: finite
    logical :: yes

    yes = (is_solid(group) .and. group%rule%n == reduced_rule) .or. (has_mean_dilatation(elem, group) .and. finite)
  end function has_spurious_mode

  !> The elements of a group have the option MEAN.
  pure function has_mean_dilatation(elem, group) result(yes)
    type(elem_t), intent(in) :: elem     !! of the group
    type(group_t), intent(in) :: group
    logical :: yes

    yes = has_option(elem, group, mean_word)
  end function has_mean_dilatation

  !> Whether a motion of a group may go unresisted. With MEAN hardening and shear resist.
  elemental function may_stand_alone(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = is_solid(group) .and. group%rule%n == reduced_rule .and. size(group%connectivity, 2) <= few_elements
  end function may_stand_alone

  !> Largest share among the elements of a group, and where.
  pure subroutine find_spurious_mode(scene, elem, group, x, motion, share, element)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elem       !! of the group
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: x(:, :, :)     !! (2, 8, nelem) nodes at the end of the motion [length]
    real(wp), intent(in) :: motion(:, :)   !! (2, nnode) of all nodes [length]
    real(wp), intent(out) :: share
    integer, intent(out) :: element
    type(quad8_rule_t) :: seen, all
    real(wp), dimension(size(x, 3)) :: hidden, whole, volume
    real(wp) :: u(2, 8), unused, mean
    type(dilatation_t) :: own
    integer :: e

    call quad8_rule(group%rule%n, seen)
    call quad8_rule(9, all)
    do e = 1, size(x, 3)
      u = motion(:, group%connectivity(:, e))
      call square_of_strain(all, scene%plane_state == axisymmetric, x(:, :, e), u, whole(e), volume(e))
      if (has_mean_dilatation(elem, group)) then
        call first_element(scene, all, group%connectivity(:, e), own)
        hidden(e) = 2*square_of_hidden(all, scene%plane_state == axisymmetric, own, x(:, :, e), u)
      else
        call square_of_strain(seen, scene%plane_state == axisymmetric, x(:, :, e), u, hidden(e), unused)
        hidden(e) = whole(e) - hidden(e)
      end if
    end do
    share = 0
    element = 0
    if (.not. sum(whole) > 0) return
    mean = sum(whole)/sum(volume)
    element = maxloc(hidden/max(whole, mean*volume), 1)
    share = min(1.0_wp, max(0.0_wp, hidden(element)/max(whole(element), mean*volume(element))))
  end subroutine find_spurious_mode

  !> Integral of the square of the change of volume that the pressure does not see.
  pure function square_of_hidden(rule, hoop, own, x, u) result(square)
    type(quad8_rule_t), intent(in) :: rule
    logical, intent(in) :: hoop
    type(dilatation_t), intent(in) :: own
    real(wp), intent(in) :: x(2, 8), u(2, 8)   !! (2, node) [length]
    real(wp) :: square
    real(wp) :: nx(8), ny(8), detj, r, dv(rule%npoint), trace(rule%npoint)
    integer :: p

    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      dv(p) = detj*rule%weight(p)
      trace(p) = dot_product(nx, u(1, :)) + dot_product(ny, u(2, :))
      if (.not. hoop) cycle
      r = dot_product(rule%phi(:, p), x(1, :))
      trace(p) = trace(p) + dot_product(rule%phi(:, p), u(1, :))/r
      dv(p) = dv(p)*r
    end do
    square = sum(dv*hidden_change(own, dv, trace)**2)
  end function square_of_hidden

  !> Integral of the strain squared by a rule, and of 1.
  pure subroutine square_of_strain(rule, hoop, x, u, square, volume)
    type(quad8_rule_t), intent(in) :: rule
    logical, intent(in) :: hoop
    real(wp), intent(in) :: x(2, 8), u(2, 8)
    real(wp), intent(out) :: square, volume
    real(wp) :: nx(8), ny(8), detj, dv, r, strain(4)
    integer :: p

    square = 0
    volume = 0
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
      dv = detj*rule%weight(p)
      strain = [dot_product(nx, u(1, :)), dot_product(ny, u(2, :)), 0.5_wp*(dot_product(ny, u(1, :)) + dot_product(nx, u(2, :))), &
                0.0_wp]
      if (hoop) then
        r = dot_product(rule%phi(:, p), x(1, :))
        strain(4) = dot_product(rule%phi(:, p), u(1, :))/r
        dv = dv*r
      end if
      square = square + dv*(strain(1)**2 + strain(2)**2 + 2*strain(3)**2 + strain(4)**2)
      volume = volume + dv
    end do
  end subroutine square_of_strain

end module spurious_mode
