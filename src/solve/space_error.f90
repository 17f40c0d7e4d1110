!> Error of temperatures in space: those of a mesh twice as fine less those of the mesh, followed through the run, without solving
!> on it.
!>
!> Temperatures on corners err with the square of the size of elements, so they err 4/3 of this difference (L.F. Richardson, Phil.
!> Trans. R. Soc. A 210 (1911) 307-357). The difference d obeys the balance of heat of the fine mesh with what the temperatures of
!> the mesh leave unbalanced there as its source, r (hierarchical error estimate: R.E. Bank, R.K. Smith, SIAM J. Numer. Anal. 30
!> (1993) 921-935; of parabolic equations S. Adjerid, J.E. Flaherty, Comput. Meth. Appl. Mech. Engng 55 (1986) 3-26), so that what
!> came in the first instants of a quench, in a layer thinner than an element, is conducted and dies away as temperatures do. By
!> implicit Euler, with C the capacity, K the flows of the fine mesh,
!>   (C/dt + K) d1 = C d0/dt + r;
!> in a step of TR-BDF2 in two stages of the length D dt (SDIRK2: R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006-1021), which
!> have the matrix of the step. Each is solved by cycles of two grids (W. Hackbusch, Multi-Grid Methods and Applications, 1985):
!> relaxation on the fine one (A.H. Baker et al., SIAM J. Sci. Comput. 33 (2011) 2864-2887: by the sizes of the rows, which
!> converges at any step), correction by the factors at hand of the mesh itself, relaxation. It begins with the difference of the
!> stage before: in short steps one cycle is enough.
module space_error
  use equations, only: equations_t, take_turn
  use errors, only: error_t
  use fields, only: find_field, has_corners_only
  use fine_bodies, only: add_bodies, chord_capacities, contents_of
  use fine_loads, only: add_loads, by_tables
  use fine_mesh, only: make_fine_mesh, place_fine_mesh
  use fine_mesh_data, only: fine_mesh_t
  use fine_system, only: fine_system_t, flow_of, row_sums_of_flow, start_system, to_corners, to_nodes
  use heat_error, only: diagonal
  use heat_stages, only: in_two_stages
  use heat_record, only: finer_share
  use kinds, only: wp
  use linear_solver, only: solve_unrefined
  use scene, only: scene_t
  use solution, only: solution_t
  use space_phases, only: follow_space_phases
  use step_outcome, only: outcome_t
  implicit none
  private
  public :: follow_space_error

  !> Relaxations before and after the correction.
  integer, parameter :: relaxations = 2
  !> Cycles end where this share of the right side is left in the norm of the rows, or are so many: in long steps, in which latent
  !> heat comes and goes, one leaves half of what it should find.
  real(wp), parameter :: left_share = 0.05_wp
  integer, parameter :: most_cycles = 4

contains

  !> Follow the error through a step that has been found, before it is committed. Nothing where no temperature is solved for, or
  !> temperatures stand on middles of sides too.
  subroutine follow_space_error(scene, equations, solution, dt, outcome, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(outcome_t), intent(in) :: outcome
    type(error_t), allocatable, intent(out) :: error
    type(fine_system_t) :: system
    real(wp), allocatable :: finer(:)
    real(wp), dimension(size(scene%mesh%coordinates, 2)) :: at_start, at_end
    integer :: field, now, timer

    field = find_field(scene%fields, 'temperature')
    if (field == 0) return
    if (.not. (scene%fields(field)%declared .and. has_corners_only(scene%fields(field))) .or. scene%fields(field)%given) return
    call equations%timers%add('heat error in space', timer)
    call equations%timers%start(timer)
    now = equations%now
    call take_turn(equations, field)
    if (equations%fine%nelement == 0) then
      call make_fine_mesh(scene, equations, solution, equations%fine)
    else
      call place_fine_mesh(scene, solution, equations%fine)
    end if
    if (equations%fine%nelement > 0) then
      call make_system(scene, equations, solution, field, dt, outcome, at_start, at_end, system)
      finer = solution%heat%finer
      call advance(scene, equations, solution, field, dt, in_two_stages(scene, solution, outcome), outcome%iterations > 0, &
                   at_start, system, error)
      if (.not. allocated(error)) &
        call follow_space_phases(scene, equations, equations%fine, at_start, at_end, finer, solution%heat%finer, dt, solution)
    end if
    equations%now = now
    call equations%timers%stop(timer)
  end subroutine follow_space_error

  !> The balance of the step on the fine mesh, and the temperatures of the mesh at both ends of it.
  subroutine make_system(scene, equations, solution, field, dt, outcome, before, now, system)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: field
    real(wp), intent(in) :: dt
    type(outcome_t), intent(in) :: outcome
    real(wp), intent(out) :: before(:), now(:)   !! (nnode of the mesh) [temperature]
    type(fine_system_t), intent(out) :: system
    real(wp) :: mean(size(scene%mesh%coordinates, 2))
    logical :: two_stages
    integer :: n, d

    two_stages = in_two_stages(scene, solution, outcome)
    before = solution%fields(field)%value(1, :)
    now = before
    mean = before
    do n = 1, size(now)
      d = equations%dofs%fields(field)%number(1, n)
      if (d == 0) cycle
      now(n) = before(n) + outcome%du(d)
      if (allocated(outcome%heat%mean) .and. two_stages) then
        mean(n) = before(n) + outcome%heat%mean(d)
      else
        mean(n) = before(n) + scene%strategy%theta*outcome%du(d)
      end if
    end do
    call start_system(equations%fine, system)
    call add_bodies(scene, equations, solution, equations%fine, before, now, mean, dt, &
                    merge(diagonal, 1.0_wp, two_stages)*dt, system)
    call add_loads(scene, equations, equations%fine, field, solution%time + dt, solution%heat%finer, system)
  end subroutine make_system

  !> The difference at the end of the step, and what is told of it.
  subroutine advance(scene, equations, solution, field, dt, two_stages, at_hand, before, system, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    integer, intent(in) :: field
    real(wp), intent(in) :: dt
    logical, intent(in) :: two_stages
    logical, intent(in) :: at_hand   !! factors of a matrix of this step are: those of an earlier one are not, in a run that goes on
    real(wp), intent(in) :: before(:)   !! (nnode of the mesh) at the start of the step [temperature]
    type(fine_system_t), intent(inout) :: system
    type(error_t), allocatable, intent(out) :: error
    real(wp), dimension(equations%fine%nnode) :: source, content, d
    logical :: fixed(equations%fine%nnode)
    real(wp) :: length
    integer :: stage, trial, trials

    call find_fixed(equations, field, fixed)
    ! what comes to corners is what their functions see less what comes to the nodes beside them
    source = 2*system%unbalanced - to_corners_all(equations%fine, system%unbalanced)
    d = solution%heat%finer
    content = solution%heat%finer_content
    ! at the start, on a new mesh, and where a body was laid: temperatures alone are known
    if (.not. any(abs(content) > 0)) call contents_of(scene, equations, equations%fine, before, d, content)
    where (fixed)
      d = 0
      content = 0
    end where
    call chord_capacities(scene, equations, equations%fine, content + dt*source, system)
    length = merge(diagonal, 1.0_wp, two_stages)*dt
    ! by tables, heat at sides may go with the temperature otherwise at the end of a stage than at its start
    trials = merge(2, 1, by_tables(scene))
    do stage = merge(1, 2, two_stages), 2
      do trial = 1, trials
        if (stage + trial > 2) &
          call add_loads(scene, equations, equations%fine, field, solution%time + dt, d, system, slopes_alone=.true.)
        call solve_stage(equations, field, system, fixed, at_hand, length, content/length + source, d, error)
        if (allocated(error)) return
      end do
      if (stage == 1) content = content + (1 - diagonal)*dt*(source - flow_of(equations%fine, system, d))
    end do
    solution%heat%finer = d
    solution%heat%finer_content = content + length*(source - flow_of(equations%fine, system, d))
    call note(equations%fine, system%temperature, finer_share*d, solution%time + dt, solution)
  end subroutine advance

  !> At corners the sum of what their functions see, at other nodes what is there.
  pure function to_corners_all(fine, at_nodes) result(all)
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: at_nodes(:)
    real(wp) :: all(size(at_nodes))

    all = to_corners(fine, at_nodes)
    where (.not. is_corner(fine)) all = at_nodes
  end function to_corners_all

  pure function is_corner(fine) result(yes)
    type(fine_mesh_t), intent(in) :: fine
    logical :: yes(fine%nnode)
    integer :: e

    yes = .false.
    do e = 1, fine%nelement
      yes(fine%nodes(:4, e)) = .true.
    end do
  end function is_corner

  !> Nodes whose temperature is imposed, and middles of outer sides between two of them.
  pure subroutine find_fixed(equations, field, fixed)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field
    logical, intent(out) :: fixed(:)   !! (nnode)
    integer :: n, d

    fixed = .true.
    associate (fine => equations%fine, number => equations%dofs%fields(field)%number)
      do n = 1, fine%nelement
        fixed(fine%nodes(:, n)) = .false.
      end do
      do n = 1, size(number, 2)
        d = number(1, n)
        if (d > 0) fixed(n) = equations%solves(equations%now)%equation(d) == 0
      end do
      do n = 1, size(fine%outside)
        fixed(fine%outside(n)) = all(fixed(fine%ends(:, fine%outside(n))))
      end do
    end associate
  end subroutine find_fixed

  !> Cycles for (C/length + K) d = rhs.
  subroutine solve_stage(equations, field, system, fixed, at_hand, length, rhs, d, error)
    type(equations_t), intent(inout) :: equations
    integer, intent(in) :: field
    type(fine_system_t), intent(in) :: system
    logical, intent(in) :: fixed(:)         !! (nnode)
    logical, intent(in) :: at_hand          !! factors of a matrix of the step are
    real(wp), intent(in) :: length          !! [time]
    real(wp), intent(in) :: rhs(:)          !! (nnode) [power]
    real(wp), intent(inout) :: d(:)         !! (nnode) [temperature]
    type(error_t), allocatable, intent(out) :: error
    real(wp), dimension(size(d)) :: rows, free, residual, correction, change
    real(wp) :: energy, enough
    integer :: k, cycle_number
    logical :: found

    rows = system%capacity/length + row_sums_of_flow(equations%fine, system)
    where (fixed .or. .not. rows > 0) rows = huge(1.0_wp)
    free = rhs
    where (fixed) free = 0
    residual = free - of_difference_in_step(d)
    enough = left_share*norm2(free/sqrt(rows))
    do cycle_number = 1, merge(most_cycles, 1, at_hand)
      if (cycle_number > 1 .and. norm2(residual/sqrt(rows)) <= enough) exit
      call relax()
      if (at_hand) then
        call correct_by_mesh(equations, field, to_corners(equations%fine, residual)/system%stiffened, correction, found, error)
        if (allocated(error)) return
        if (found) call take_correction()
      end if
      call relax()
    end do

  contains

    subroutine relax()
      do k = 1, relaxations
        d = d + residual/rows
        residual = free - of_difference_in_step(d)
      end do
    end subroutine relax

    !> As far as the energy of what is left falls.
    subroutine take_correction()
      correction = to_nodes(equations%fine, correction/system%stiffened)
      where (fixed) correction = 0
      change = of_difference_in_step(correction)
      energy = dot_product(correction, change)
      if (.not. energy > 0) return
      energy = dot_product(correction, residual)/energy
      d = d + energy*correction
      residual = residual - energy*change
    end subroutine take_correction

    !> (C/length + K) t, 0 where temperatures are imposed.
    function of_difference_in_step(t) result(power)
      real(wp), intent(in) :: t(:)    !! (nnode) [temperature]
      real(wp) :: power(size(t))      !! [power]

      power = system%capacity/length*t + flow_of(equations%fine, system, t)
      where (fixed) power = 0
    end function of_difference_in_step

  end subroutine solve_stage

  !> Temperatures of the corners by the factors at hand of the mesh itself, which stay as they are, as all that is kept of its
  !> solves. `found` is false where there are none: nothing has been solved for yet, or they failed.
  subroutine correct_by_mesh(equations, field, residual, correction, found, error)
    type(equations_t), intent(inout) :: equations
    integer, intent(in) :: field
    real(wp), intent(in) :: residual(:)      !! (nnode) [power]
    real(wp), intent(out) :: correction(:)   !! (nnode), 0 where nothing is solved for [temperature]
    logical, intent(out) :: found
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: x(equations%solves(equations%now)%neq)
    integer :: n

    correction = 0
    found = .false.
    associate (number => equations%dofs%fields(field)%number, solve => equations%solves(equations%now))
      if (.not. solve%analysed) return
      x = 0
      do n = 1, size(number, 2)
        if (number(1, n) == 0) cycle
        if (solve%equation(number(1, n)) > 0) x(solve%equation(number(1, n))) = residual(n)
      end do
      call solve_unrefined(solve%solver, x, found, error)
      if (allocated(error) .or. .not. found) return
      do n = 1, size(number, 2)
        if (number(1, n) == 0) cycle
        if (solve%equation(number(1, n)) > 0) correction(n) = x(solve%equation(number(1, n)))
      end do
    end associate
  end subroutine correct_by_mesh

  !> The largest error now and so far, and that in the mean square of the volume.
  pure subroutine note(fine, temperatures, errors, time, solution)
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: temperatures(:), errors(:)   !! (nnode) [temperature]
    real(wp), intent(in) :: time                         !! end of the step
    type(solution_t), intent(inout) :: solution
    real(wp) :: square
    integer :: e

    square = 0
    do e = 1, fine%nelement
      square = square + dot_product(fine%volume(:, e), errors(fine%nodes(:, e))**2)
    end do
    associate (heat => solution%heat)
      do e = 1, fine%nelement
        associate (t => temperatures(fine%nodes(:4, e)))
          if (heat%space_steps == 0 .and. e == 1) heat%coldest = t(1)
          if (heat%space_steps == 0 .and. e == 1) heat%hottest = t(1)
          heat%coldest = min(heat%coldest, minval(t))
          heat%hottest = max(heat%hottest, maxval(t))
        end associate
      end do
      heat%space_steps = heat%space_steps + 1
      heat%space_now = maxval(abs(errors))
      heat%space_largest = max(heat%space_largest, heat%space_now)
      heat%space_mean = sqrt(square/sum(fine%volume))
      if (heat%space_mean > heat%space_mean_largest) heat%space_time = time
      heat%space_mean_largest = max(heat%space_mean_largest, heat%space_mean)
    end associate
  end subroutine note

end module space_error
