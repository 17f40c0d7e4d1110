!> Errors of phases that come of those of temperatures in space (space_error), followed through the run.
!>
!> Kinetics of points are made once more in every step along the temperatures without their error,
!>   T + 4/3 d,
!> with d the difference of a mesh twice as fine, bilinear in its elements, and T and d linear in time within the step, as kinetics
!> take them (phase_step); from the states that were found so before. What they have more at the end than the states of the points
!> is the error of these: propagation of errors by experimental perturbation (G. Dahlquist, A. Bjorck, Numerical Methods, 1974,
!> sec. 2.2). Temperatures stay within those that the run has had: d has swings beyond them where heat enters suddenly, which
!> phases would remember. A hardness is none before 700 degC is passed (hardness): where one of both has none there is no error.
!> The heat of transformation that they release more is not in d: released a step later, where martensite forms by a
!> small change of the temperature, it makes d swing.
module space_phases
  use equations, only: equations_t
  use fine_mesh, only: quarter_nodes
  use fine_mesh_data, only: fine_mesh_t
  use heat_record, only: finer_share
  use kinds, only: wp
  use law_api, only: driver_temperature, heat_law
  use phase_state, only: at_hardness, state_names
  use quadrature, only: square_rule
  use scene, only: scene_t
  use shape_functions, only: quad4, quad8_corner
  use solution, only: solution_t
  use state_variables, only: find_variable
  implicit none
  private
  public :: follow_space_phases

contains

  !> Errors of the phases at the end of a step that has been found, before it is committed.
  pure subroutine follow_space_phases(scene, equations, fine, before, now, finer_before, finer_now, dt, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: before(:), now(:)               !! (nnode) at both ends of the step, of the mesh [temperature]
    real(wp), intent(in) :: finer_before(:), finer_now(:)   !! (nfiner) d at both ends of the step [temperature]
    real(wp), intent(in) :: dt                              !! [time]
    type(solution_t), intent(inout) :: solution             !! trial states are those of the end of the step
    real(wp) :: of_mesh(4, 9), of_finer(9, 9), temperatures(2, 9)
    logical :: follows(size(scene%groups))
    integer :: e, g, npoint, of_functions

    do g = 1, size(follows)
      follows(g) = size(solution%groups(g)%space_error) > 0
      if (.not. follows(g)) cycle
      associate (law => equations%laws(scene%materials(scene%groups(g)%material)%law_id))
        follows(g) = law%kind == heat_law .and. law%of_steel
      end associate
    end do
    if (.not. any(follows)) return
    of_functions = 0
    do e = 1, fine%nelement
      g = fine%group(e)
      if (.not. follows(g)) cycle
      npoint = scene%groups(g)%rule%n
      if (npoint /= of_functions) call functions_at_points(npoint, of_mesh, of_finer)
      of_functions = npoint
      associate (corners => fine%nodes(:4, e), nodes => fine%nodes(:, e))
        temperatures(1, :npoint) = matmul(before(corners), of_mesh(:, :npoint)) &
                                   + finer_share*matmul(finer_before(nodes), of_finer(:, :npoint))
        temperatures(2, :npoint) = matmul(now(corners), of_mesh(:, :npoint)) &
                                   + finer_share*matmul(finer_now(nodes), of_finer(:, :npoint))
      end associate
      temperatures(:, :npoint) = min(max(temperatures(:, :npoint), solution%heat%coldest), solution%heat%hottest)
      call follow_element(scene, equations, g, fine%element(e), temperatures(:, :npoint), dt, solution)
    end do
  end subroutine follow_space_phases

  !> Points of an element.
  pure subroutine follow_element(scene, equations, g, e, temperatures, dt, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g, e                    !! group and its element
    real(wp), intent(in) :: temperatures(:, :)     !! (2, npoint) without error, at both ends of the step [temperature]
    real(wp), intent(in) :: dt                     !! [time]
    type(solution_t), intent(inout) :: solution
    real(wp) :: given(max(1, size(equations%drivers(g)%value, 1)), 2), released, of_work, slope
    real(wp), dimension(size(solution%groups(g)%committed, 1)) :: start, end
    integer :: p, hard

    hard = scene%groups(g)%variables(find_variable(scene%groups(g)%variables, trim(state_names(at_hardness))))%first
    associate (material => scene%materials(scene%groups(g)%material), own => equations%drivers(g), state => solution%groups(g))
      associate (law => equations%laws(material%law_id))
        do p = 1, size(temperatures, 2)
          given = 0
          if (size(own%value, 1) > 0) given = own%value(:, :2, p, e)
          given(driver_temperature, :) = temperatures(:, p)
          start = state%committed(:, p, e) + state%space_error(:, p, e)
          call law%release(material, dt, given, start, released, of_work, slope, end)
          if (.not. (end(hard) > 0 .and. state%trial(hard, p, e) > 0)) end(hard) = state%trial(hard, p, e)
          state%space_error(:, p, e) = end - state%trial(:, p, e)
        end do
      end associate
    end associate
  end subroutine follow_element

  !> Functions of the temperatures of an element and of its quarters at the points of a rule.
  pure subroutine functions_at_points(npoint, of_mesh, of_finer)
    integer, intent(in) :: npoint
    real(wp), intent(out) :: of_mesh(4, 9)     !! (corner, point) [-]
    real(wp), intent(out) :: of_finer(9, 9)    !! (node, point) [-]
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: at(2), of_quarter(4)
    integer :: p, q

    call square_rule(npoint, xi, weight)
    of_mesh = 0
    of_finer = 0
    do p = 1, npoint
      call quad4(xi(1, p), xi(2, p), of_mesh(:, p))
      do q = 1, 4
        at = 2*xi(:, p) - quad8_corner(:, q)
        if (all(abs(at) <= 1)) exit
      end do
      call quad4(at(1), at(2), of_quarter)
      of_finer(quarter_nodes(:, q), p) = of_quarter
    end do
  end subroutine functions_at_points

end module space_phases
