!> Damping of steps that lead away from an equilibrium that is lost.
!>
!> Where a die withdraws, what is thin under it loses its contact before what is thick: a flash springs back by a tenth of what
!> the part inside a closed die does. Held by friction no more, it is pushed out by the part inside, and friction holds it the
!> less, the further it has gone. Elastic energy is set free however little the die moves: there is no equilibrium near the last
!> one, and no step is short enough. In a press the flash would move within microseconds. Here viscous forces take the energy,
!> c w du/dt on a node with the volume w around it, until an equilibrium is found that needs none of them: the pseudo-transient
!> way to a steady state (C.T. Kelley, D.E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508-523), in steps that are accepted, so that
!> flow and friction follow it.
!>
!> A die that goes on needs the same where the part has reached a limit point: a strip that is bent freely bears on a node or two of
!> its dies, and snaps on to the next node where the bend becomes steep. So does a part whose supports move it along dies or other
!> parts, as a hook that is pushed over a ledge: the same scene as with the ledge moved. The velocity is that beside the motion of
!> a body's supports where these all move alike, so that what is carried along is not dragged.
!>
!> c begins so that the force of the die would move the part by the side of an element within the step that failed. A step that
!> fails again, or goes further than the path can be followed, makes it larger; others make it smaller. It ends where the forces
!> are within the tolerance of equilibrium. Their work is booked, and told at the end. No release takes more than the elastic energy
!> that was there, and what dies and supports give that carry the part on meanwhile: where they take more it is loads that drive it,
!> and nothing holds it (lost_equilibrium).
module damping
  use bodies, only: bodies_of_nodes
  use contact_changes, only: touching_dies
  use convergence, only: relative_residual
  use elem_api, only: block_done, report_t
  use elem_body_springs, only: volume_of_body
  use equations, only: equations_t, take_turn
  use evaluation, only: evaluate
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use prescribed_unknowns, only: prescribed_motion
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use vectors, only: length_of
  use volumes_of_unknowns, only: volumes_of_nodes
  implicit none
  private
  public :: begin_damping, ease_damping, prepare_damping, strengthen_damping, work_of_damping

  !> Supports move alike within round-off of their places.
  real(wp), parameter :: alike = 1.0e-9_wp
  !> Factors of the coefficient after a step that failed, and after one that was accepted.
  real(wp), parameter :: stronger = 4.0_wp, weaker = 0.3_wp

contains

  !> Viscous force over velocity of the unknowns in the step to come of length dt, and the motion that meets none; nothing where
  !> nothing is damped.
  subroutine prepare_damping(scene, solution, dt, equations)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    type(equations_t), intent(inout) :: equations

    if (allocated(equations%damping)) deallocate (equations%damping)
    if (.not. solution%damping > 0) return
    allocate (equations%damping, source=solution%damping*volumes_of_nodes(scene, equations, solution))
    equations%carried = motion_of_carried(scene, equations, solution, dt)
  end subroutine prepare_damping

  !> Motion in a step of bodies whose supports all move alike along X or Y (ndof); 0 for others.
  function motion_of_carried(scene, equations, solution, dt) result(carried)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    real(wp) :: carried(equations%dofs%ndof)   !! [unknown]
    real(wp) :: motion(equations%dofs%ndof), least, most
    integer :: body(size(scene%mesh%coordinates, 2)), b, c, k
    logical :: of_body(size(body))

    carried = 0
    motion = motion_given(scene, equations, solution, dt)
    if (.not. any(abs(motion) > 0)) return
    body = bodies_of_nodes(scene)
    associate (number => equations%dofs%fields(displacement_field)%number, free => equations%dofs%is_free)
      do b = 1, size(body)
        if (body(b) /= b) cycle
        of_body = body == b
        do c = 1, 2
          least = huge(least)
          most = -huge(most)
          do k = 1, size(body)
            if (.not. of_body(k) .or. number(c, k) == 0) cycle
            if (free(number(c, k))) cycle
            least = min(least, motion(number(c, k)))
            most = max(most, motion(number(c, k)))
          end do
          ! without a support there, or with several that move apart
          if (most < least) cycle
          if (.not. most - least <= alike*max(abs(least), abs(most))) cycle
          do k = 1, size(body)
            if (of_body(k) .and. number(c, k) > 0) carried(number(c, k)) = most
          end do
        end do
      end do
    end associate
  end function motion_of_carried

  !> Motion that the deck gives in a step from now (ndof); 0 for what is free.
  function motion_given(scene, equations, solution, dt) result(motion)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt   !! [time]
    real(wp) :: motion(equations%dofs%ndof)   !! [unknown]
    real(wp) :: driven(size(equations%dofs%prescribed))

    call prescribed_motion(scene, equations%dofs, solution%fields,.not. solution%last_step > 0, solution%time, &
                           solution%time + dt, driven)
    motion = 0
    motion(equations%dofs%prescribed%dof) = driven
  end function motion_given

  !> The coefficient with which a step of length dt that failed is tried again where a die withdraws, or past a limit point
  !> where a die moves, or the supports of a body that touches one do; 0 where none does.
  subroutine begin_damping(scene, equations, solution, dt, past_limit, die, withdraws, name)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(inout) :: solution
    real(wp), intent(in) :: dt     !! of the step that failed [time]
    logical, intent(in) :: past_limit   !! the step that failed has been past a limit point
    integer, intent(out) :: die         !! the one that withdraws, or moves, with the largest force, 0 where none does
    logical, intent(out) :: withdraws   !! it does the former
    character(len=:), allocatable, intent(out) :: name   !! of the die, or of the body whose supports move; '' where nothing does
    real(wp), dimension(equations%dofs%ndof) :: rest, motion
    real(wp) :: force, largest
    type(report_t) :: report
    logical :: back
    integer :: k

    die = 0
    withdraws = .false.
    name = ''
    if (.not. scene%fields(displacement_field)%declared .or. scene%load_factor%multiplier > 0) return
    motion = motion_given(scene, equations, solution, dt)
    rest = 0
    call take_turn(equations, displacement_field)
    call evaluate(scene, equations, solution, dt, rest, .false., report)
    if (report%status /= block_done) return
    largest = 0
    associate (pilot => equations%dofs%fields(pilot_field)%number)
      do k = 1, size(pilot, 2)
        if (any(pilot(1:2, k) == 0)) cycle
        if (.not. any(abs(motion(pilot(1:2, k))) > 0)) cycle
        ! one that turns a part over does not let it go
        back = dot_product(equations%force(pilot(1:2, k)), motion(pilot(1:2, k))) < 0
        if (.not. (past_limit .or. back)) cycle
        force = length_of(equations%force(pilot(1:2, k)))
        if (.not. force > largest) cycle
        largest = force
        die = k
        withdraws = back
      end do
    end associate
    if (die > 0) name = scene%dies(die)%name
    if (die == 0 .and. past_limit .and. any(touching_dies(scene, solution, at_start=.true.) > 0)) &
      call find_moved_body(scene, equations, motion, largest, name)
    if (name == '') return
    solution%damping = largest*dt/size_of_part(scene, solution)
    solution%damping_bound = solution%work%damping + solution%work%elastic
  end subroutine begin_damping

  !> The body whose moved supports bear the largest force as they drive it on, and that; '' and 0 where none does. One that is taken
  !> back lets go without a snap.
  subroutine find_moved_body(scene, equations, motion, largest, name)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations   !! with the forces of now
    real(wp), intent(in) :: motion(:)            !! (ndof) of supports [unknown]
    real(wp), intent(out) :: largest             !! [force]
    character(len=:), allocatable, intent(out) :: name
    real(wp) :: force(2), power
    integer :: g, c
    logical :: node(size(scene%mesh%coordinates, 2))

    largest = 0
    name = ''
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      node = .false.
      node(reshape(scene%groups(g)%connectivity, [size(scene%groups(g)%connectivity)])) = .true.
      associate (number => equations%dofs%fields(displacement_field)%number)
        power = 0
        do c = 1, 2
          associate (d => pack(number(c, :), moved(number(c, :))))
            force(c) = sum(equations%force(d))
            power = power + dot_product(equations%force(d), motion(d))
          end associate
        end do
      end associate
      if (.not. power > 0) cycle
      if (.not. length_of(force) > largest) cycle
      largest = length_of(force)
      name = scene%groups(g)%name
    end do

  contains

    !> Unknowns of the body's supports that move.
    pure function moved(d) result(yes)
      integer, intent(in) :: d(:)   !! (nnode) 0 for none
      logical :: yes(size(d))

      yes = node .and. d > 0
      where (yes) yes = abs(motion(max(d, 1))) > 0
    end function moved
  end subroutine find_moved_body

  !> Volume of the bodies times the side of the smallest element [length^4, per radian when axisymmetric].
  pure function size_of_part(scene, solution) result(s)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: s
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), one(2), other(2), area, volume
    integer :: g, e

    x = present_coordinates(scene, solution)
    volume = 0
    area = huge(area)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      associate (nodes => scene%groups(g)%connectivity)
        volume = volume + volume_of_body(scene, nodes)
        do e = 1, size(nodes, 2)
          one = x(:, nodes(3, e)) - x(:, nodes(1, e))
          other = x(:, nodes(4, e)) - x(:, nodes(2, e))
          area = min(area, 0.5_wp*abs(one(1)*other(2) - one(2)*other(1)))
        end do
      end associate
    end do
    s = volume*sqrt(area)
  end function size_of_part

  !> A damped step failed, or goes too far.
  elemental subroutine strengthen_damping(solution)
    type(solution_t), intent(inout) :: solution

    solution%damping = stronger*solution%damping
  end subroutine strengthen_damping

  !> A damped step was accepted, and the length of the next is chosen: damping eases unless that is shorter. It ends where its
  !> forces are within the tolerance of equilibrium. Dies and supports that carry the part on give it energy of their own.
  subroutine ease_damping(scene, equations, dt, du, given, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    real(wp), intent(in) :: given   !! work of dies and supports in the step, per radian when axisymmetric [energy]
    type(solution_t), intent(inout) :: solution
    real(wp) :: forces(size(du))
    integer :: turn

    if (.not. allocated(equations%damping)) return
    forces = equations%damping*(du - equations%carried)/dt
    if (.not. solution%next_step < dt) solution%damping = weaker*solution%damping
    solution%damping_bound = solution%damping_bound + max(given, 0.0_wp)
    ! heat may have been solved for after the motion
    turn = equations%now
    call take_turn(equations, displacement_field)
    if (relative_residual(equations, solution%fields, 0*du, forces, du) <= scene%strategy%force_norm) solution%damping = 0
    equations%now = turn
  end subroutine ease_damping

  !> Work that viscous forces took in a step [energy].
  pure function work_of_damping(equations, dt, du) result(work)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: dt      !! [time]
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    real(wp) :: work

    work = 0
    if (allocated(equations%damping)) work = sum(equations%damping*(du - equations%carried)*du)/dt
  end function work_of_damping

end module damping
