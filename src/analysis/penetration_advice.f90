!> Advice where the part is deeper in a die than its contact law allows (`PENETR`, a share of the side).
!>
!> At a point: the penalty made from PENETR gives a pressure p the depth PENETR side p/(E/100), so depth over allowed is 100 p/E,
!> whatever PENETR and the length of the side are. A multiplier takes that depth away (AUGMENT), or a larger penalty (AKP).
!> Between points: the side is as deep as its parabola differs from the die, which no pressure at its points corrects, but more
!> points and shorter sides do. A side that is seen along its whole length spans the bend instead: a new mesh is due.
module penetration_advice
  use contact_quality, only: measure_misfit, misfit_t
  use dies, only: is_deformable
  use kinds, only: wp
  use quadrature, only: rule_along, rule_control, rule_gauss
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: advice_at_points, advice_between_points, allowed_between, sides_that_span, states_penetration

  !> Numbers among the values of every contact law (contact_penalties).
  integer, parameter :: at_penetr = 1, at_akp = 2, at_augment = 4
  !> Penetrations are reported as too large beyond this share above the allowed.
  real(wp), parameter :: slack = 1.0e-6_wp
  !> Most integration points that a side may have.
  integer, parameter :: most_points = 17
  !> And the number that is advised first.
  integer, parameter :: many_points = 9
  !> Between points that see the whole side it may be so much deeper than allowed; and a side that is farther from its die between
  !> two places in contact, over the depth allowed, does not follow the die.
  real(wp), parameter :: between_along = 2.0_wp, far_apart = 10.0_wp

contains

  !> For the integration points of contact; empty where none was deeper than allowed.
  pure function advice_at_points(scene, solution) result(advice)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice

    advice = ''
    if (solution%worst_penetration_ratio <= 1 + slack) return
    if (any_law(scene, at_augment, without=.true.)) then
      advice = 'AUGMENT 20 in the contact law'
    else
      advice = 'a larger AUGMENT in the contact law, and shorter steps (STRAT)'
    end if
    if (any_law(scene, at_akp, without=.false.)) then
      advice = advice//'; or a larger AKP'
    else
      advice = advice//'; PENETR changes the depth and the allowed one alike'
    end if
  end function advice_at_points

  !> How deep sides may be in their dies between points, over what is allowed.
  pure function allowed_between(scene) result(bound)
    type(scene_t), intent(in) :: scene
    real(wp) :: bound
    integer :: g

    bound = between_along
    do g = 1, size(scene%groups)
      if (is_contact(scene%groups(g)) .and. scene%groups(g)%rule%family /= rule_along) bound = 1
    end do
  end function allowed_between

  !> For sides between these points; empty where none was deeper than allowed, or than its points are.
  pure function advice_between_points(scene, solution) result(advice)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice
    integer :: g, fewest
    logical :: gauss, few, bezier, along, rigid
    character(len=*), parameter :: shorter = 'shorter sides where the die bends'

    advice = ''
    gauss = .false.
    few = .false.
    bezier = .false.
    along = .false.
    fewest = most_points
    do g = 1, size(scene%groups)
      if (.not. is_contact(scene%groups(g))) cycle
      associate (rule => scene%groups(g)%rule)
        gauss = gauss .or. rule%family == rule_gauss
        few = few .or. (rule%n < most_points .and. rule%family /= rule_along)
        if (rule%family /= rule_along) fewest = min(fewest, rule%n)
        rigid = .not. is_deformable(scene%dies(scene%groups(g)%die))
        along = along .or. (rigid .and. rule%family /= rule_along)
        bezier = bezier .or. (rigid .and. all(rule%family /= [rule_along, rule_control]))
      end associate
    end do
    if (solution%worst_sample_ratio <= max(allowed_between(scene), solution%worst_penetration_ratio) + slack) return
    if (gauss .or. few) then
      advice = 'CNT2D with '
      if (bezier) then
        advice = advice//'BEZIER or ALONG, or with '
      else if (along) then
        advice = advice//'ALONG, or with '
      end if
      if (gauss) advice = advice//'-3 points, which are the nodes; '
      if (.not. gauss .and. fewest < many_points) advice = advice//'-9 or '
      if (.not. gauss) advice = advice//'-17 points; '
    end if
    if (any_law(scene, at_augment, without=.true.)) advice = advice//'AUGMENT 20 in the contact law; '
    advice = advice//shorter
  end function advice_between_points

  !> What is reported of a side that spans a bend of its die at the end of a run; empty where none does.
  function sides_that_span(scene, solution) result(words)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: words
    type(misfit_t) :: misfit, one
    integer :: g, worst

    words = ''
    worst = 0
    misfit%between = far_apart
    do g = 1, size(scene%groups)
      if (.not. is_contact(scene%groups(g)) .or. scene%groups(g)%rule%family /= rule_along) cycle
      one = measure_misfit(scene, g, solution)
      if (.not. one%between > misfit%between) cycle
      misfit = one
      worst = g
    end do
    if (worst == 0) return
    words = 'side '//to_text(misfit%between_side)//' of '//scene%groups(worst)%name//' spans a bend of its die, ' &
            //to_text(misfit%between, 3)//' times the allowed penetration away from it between two places in contact: a new mesh ' &
            //'is due, with shorter sides there'
  end function sides_that_span

  !> A contact law of the scene limits the depth of the part.
  pure function states_penetration(scene) result(states)
    type(scene_t), intent(in) :: scene
    logical :: states

    states = any_law(scene, at_penetr, without=.false.)
  end function states_penetration

  !> Is there a contact whose law has, or is without, a value above 0 at this number? Laws that allow no depth do not count.
  pure function any_law(scene, place, without) result(there)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: place
    logical, intent(in) :: without
    logical :: there
    integer :: g

    there = .false.
    do g = 1, size(scene%groups)
      if (.not. is_contact(scene%groups(g))) cycle
      associate (values => scene%materials(scene%groups(g)%material)%values)
        if (values(at_penetr) > 0) there = there .or. (values(place) > 0 .neqv. without)
      end associate
    end do
  end function any_law

  pure function is_contact(group) result(is)
    type(group_t), intent(in) :: group
    logical :: is

    is = group%die > 0 .and. group%material > 0
  end function is_contact

end module penetration_advice
