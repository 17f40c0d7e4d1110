!> Errors of temperatures in time in the states of bodies that flow, and those of the phases that follow them (path_stress).
!>
!> Temperatures have errors of their own (heat_error), found before those of the stress: e0 at the start of a step and e1 at its
!> end, and so have phases that another formulation on the body holds. A better run is at temperatures and phases that are so much
!> others. A body that has its kinetics itself needs nothing of this but the temperatures.
module path_heat
  use drivers, only: drivers_t, from_state
  use equations, only: equations_t
  use fields, only: find_field
  use kinds, only: wp
  use law_api, only: heat_law
  use path_record, only: state_error_t
  use scene, only: host_of, scene_t
  use solution, only: solution_t
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: follow_heat, warmth_t

  !> What errors of temperatures are in a step.
  type :: warmth_t
    !> They are some.
    logical :: any = .false.
    !> At the start of the step, and how they change in it (ndof) [temperature].
    real(wp), allocatable :: before(:), change(:)
    !> Errors of the phases at its end (ngroup).
    type(state_error_t), allocatable :: phases(:)
    !> Drivers of the step with the share of these errors; they hold as they are.
    type(drivers_t), allocatable :: drivers(:)
  end type warmth_t

contains

  !> Errors of temperatures and phases in a step that has converged.
  subroutine follow_heat(scene, equations, solution, active, share, outcome, warmth)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution    !! its trial state is that of the step
    logical, intent(in) :: active(:)            !! (ngroup) bodies that flow
    real(wp), intent(in) :: share               !! of the errors, so small that all is linear
    type(outcome_t), intent(in) :: outcome
    type(warmth_t), intent(out) :: warmth
    integer :: f

    allocate (warmth%drivers, source=equations%drivers)
    warmth%drivers%vary = .false.
    allocate (warmth%before(size(outcome%du)), warmth%change(size(outcome%du)), source=0.0_wp)
    allocate (warmth%phases(size(active)))
    f = find_field(scene%fields, 'temperature')
    if (f == 0 .or. .not. outcome%heat%estimated) return
    warmth%before = of_unknowns(equations%dofs%fields(f)%number(1, :), solution%heat%temperature_error, size(outcome%du))
    warmth%change = of_unknowns(equations%dofs%fields(f)%number(1, :), outcome%heat%temperature_error, size(outcome%du)) &
                    - warmth%before
    warmth%any = any(abs(warmth%before) > 0) .or. any(abs(warmth%change) > 0)
    if (warmth%any) call follow_phases(scene, equations, solution, active, share, outcome, warmth)
  end subroutine follow_heat

  !> Values at nodes as those of the unknowns there.
  pure function of_unknowns(number, at_nodes, ndof) result(values)
    integer, intent(in) :: number(:)        !! (nnode) of the unknown, 0 where there is none
    real(wp), intent(in) :: at_nodes(:)     !! (nnode)
    integer, intent(in) :: ndof
    real(wp) :: values(ndof)
    integer :: n

    values = 0
    do n = 1, size(number)
      if (number(n) > 0) values(number(n)) = at_nodes(n)
    end do
  end function of_unknowns

  !> The phases that drive bodies which flow, with their errors.
  subroutine follow_phases(scene, equations, solution, active, share, outcome, warmth)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: active(:)   !! (ngroup) bodies that flow
    real(wp), intent(in) :: share      !! of the errors
    type(outcome_t), intent(in) :: outcome
    type(warmth_t), intent(inout) :: warmth
    logical :: holds(size(active))
    integer :: g

    if (.not. allocated(outcome%heat%phases)) return
    holds = has_phases(scene, equations, active)
    do g = 1, size(holds)
      if (holds(g) .and. allocated(outcome%heat%phases(g)%value)) warmth%phases(g)%value = outcome%heat%phases(g)%value
    end do
    do g = 1, size(active)
      if (active(g)) call drive(scene, solution, g, share, warmth)
    end do
  end subroutine follow_phases

  !> Groups of heat whose states are phases that drive bodies which flow (ngroup).
  pure function has_phases(scene, equations, active) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical, intent(in) :: active(:)   !! (ngroup) bodies that flow
    logical :: yes(size(active))
    integer :: g, k, s

    yes = .false.
    do g = 1, size(active)
      if (.not. (active(g) .and. allocated(equations%drivers(g)%source))) cycle
      do k = 1, size(equations%drivers(g)%source)
        associate (source => equations%drivers(g)%source(k))
          if (source%kind /= from_state) cycle
          s = source%group(host_of(scene, g))
          associate (law => equations%laws(scene%materials(scene%groups(s)%material)%law_id))
            yes(s) = law%kind == heat_law .and. law%of_steel
          end associate
        end associate
      end do
    end do
  end function has_phases

  !> The errors of the phases at both ends of the step are among the drivers of a body on the same points.
  pure subroutine drive(scene, solution, g, share, warmth)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g           !! group of the body
    real(wp), intent(in) :: share      !! of the errors
    type(warmth_t), intent(inout) :: warmth
    integer :: k, s

    associate (own => warmth%drivers(g), body => host_of(scene, g))
      if (.not. allocated(own%source)) return
      do k = 1, size(own%source)
        if (own%source(k)%kind /= from_state) cycle
        s = own%source(k)%group(body)
        if (.not. allocated(warmth%phases(s)%value)) cycle
        associate (row => own%source(k)%row(body))
          own%value(k, 1, :, :) = own%value(k, 1, :, :) + share*solution%groups(s)%error(row, :, :)
          own%value(k, 2, :, :) = own%value(k, 2, :, :) + share*warmth%phases(s)%value(row, :, :)
        end associate
      end do
    end associate
  end subroutine drive

end module path_heat
