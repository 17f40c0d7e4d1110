!> Advice where the part is deeper in a die than its contact law allows (`PENETR`, a share of the side).
!>
!> At a point: the penalty made from PENETR gives a pressure p the depth PENETR side p/(E/100), so depth over allowed is 100 p/E,
!> whatever PENETR and the length of the side are. A multiplier takes that depth away (AUGMENT), or a larger penalty (AKP).
!> Between points: the side is as deep as its parabola differs from the die, which no pressure at its points corrects, but more
!> points and shorter sides do.
module penetration_advice
  use kinds, only: wp
  use quadrature, only: rule_gauss
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: advice_at_points, advice_between_points, states_penetration

  !> Numbers among the values of every contact law (contact_penalties).
  integer, parameter :: at_penetr = 1, at_akp = 2, at_augment = 4
  !> Penetrations are reported as too large beyond this share above the allowed.
  real(wp), parameter :: slack = 1.0e-6_wp
  !> Most integration points that a side may have.
  integer, parameter :: most_points = 17

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

  !> For sides between these points; empty where none was deeper than allowed, or than its points are.
  pure function advice_between_points(scene, solution) result(advice)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: advice
    integer :: g
    logical :: gauss, few
    character(len=*), parameter :: shorter = 'shorter sides where the die bends'

    advice = ''
    if (solution%worst_sample_ratio <= max(1.0_wp, solution%worst_penetration_ratio) + slack) return
    gauss = .false.
    few = .false.
    do g = 1, size(scene%groups)
      if (.not. is_contact(scene%groups(g))) cycle
      gauss = gauss .or. scene%groups(g)%rule%family == rule_gauss
      few = few .or. scene%groups(g)%rule%n < most_points
    end do
    if (gauss) then
      advice = 'CNT2D with -3 points, which are the nodes, or where the die bends within a side with -9 or -17; '
    else if (few) then
      advice = 'CNT2D with -9 or -17 points; '
    end if
    if (any_law(scene, at_augment, without=.true.)) advice = advice//'AUGMENT 20 in the contact law; '
    advice = advice//shorter
  end function advice_between_points

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
