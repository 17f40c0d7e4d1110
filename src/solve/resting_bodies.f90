!> Bodies that nothing holds and nothing loads rest, and move against a little drag.
!>
!> A part that has lost all contact is in equilibrium wherever it is, and so also where the motion of its last step would take it.
!> One that dies touch with no pressure at all is such a part too. Without inertia it has no reason to go on: the prediction of a
!> step leaves such a body where it is.
!>
!> Nor is it known where dies that come to it would push it. Between two that lean towards each other by less than friction bears,
!> it is held and upset; but it slips out just as well, with no pressure and hence no friction, and Newton's method finds the one or
!> the other by round-off. So a force acts against the motion of such a body in the step,
!>
!>     f = drag E V/L**2 du
!>
!> with the volume V around a node, the modulus E of its body and the extent L, as long as no pressure is above a few times what
!> that makes: what is pushed resists a little, friction acts, and of all ways that dies leave it one of the shortest is gone, for
!> any round-off and in any axes. The force is far below those of a body that is strained. It also makes the matrix regular.
!> Attempts at a step that failed are followed by ones with more of it.
!>
!> Bodies that press on one another and on nothing else, as a rivet and its plates that the tools have left, are such a body
!> together.
module resting_bodies
  use equations, only: equations_t
  use fields, only: displacement_field
  use kinds, only: wp
  use loose_bodies, only: mark_acted_on
  use scene, only: axisymmetric, is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use volumes_of_unknowns, only: volumes_of_nodes
  implicit none
  private
  public :: leave_at_rest, light, strengthen_drag, remove_rigid_motion, work_of_drag

  !> Force that moves a body by its extent, over its modulus and section: above round-off of forces, below what strains it.
  real(wp), parameter :: drag = 1.0e-7_wp
  !> A pressure below this share of the modulus is light: some times what drag makes.
  real(wp), parameter :: light = 3.0e-7_wp
  !> After an attempt that failed there is so many times more of it, up to the largest.
  real(wp), parameter :: stronger = 10.0_wp, strongest = 1.0e4_wp

contains

  !> Take back the predicted motion of bodies that neither a contact nor a load acts on; and the drag on those that none presses.
  subroutine leave_at_rest(scene, equations, solution, time, du)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(inout) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: time         !! at the end of the step
    real(wp), intent(inout) :: du(:)     !! (ndof) motion of the step [unknown]
    logical :: acted_on(0:size(equations%loose)), pressed(0:size(equations%loose))
    integer :: assembly(0:size(equations%loose))
    real(wp) :: x(2, size(equations%loose)), factor
    integer :: b, k, c

    equations%drag = 0
    if (size(equations%loose) == 0) return
    associate (loose => equations%loose, number => equations%dofs%fields(displacement_field)%number)
      call mark_acted_on(scene, equations%laws, solution, loose, time, light, pressed, assembly)
      equations%assembly = assembly(loose)
      if (all(equations%assembly == 0)) return
      call mark_acted_on(scene, equations%laws, solution, loose, time, 0.0_wp, acted_on)
      equations%drag = volumes_of_nodes(scene, equations, solution)
      x = present_coordinates(scene, solution)
      do b = 0, maxval(loose)
        factor = 0
        if (assembly(b) > 0) factor = equations%more_drag*drag*modulus_of(scene, equations, b)/square_of_extent(x, loose == b)
        do k = 1, size(loose)
          if (loose(k) /= b) cycle
          do c = 1, 2
            if (number(c, k) == 0) cycle
            equations%drag(number(c, k)) = factor*equations%drag(number(c, k))
            if (factor > 0 .and. .not. acted_on(b)) du(number(c, k)) = 0
          end do
        end do
      end do
    end associate
  end subroutine leave_at_rest

  !> An attempt at a step has ended: after one that failed there is more drag, and the usual one after one that did not.
  elemental subroutine strengthen_drag(failed, equations)
    logical, intent(in) :: failed
    type(equations_t), intent(inout) :: equations

    equations%more_drag = merge(min(stronger*equations%more_drag, strongest), 1.0_wp, failed)
  end subroutine strengthen_drag

  !> Take the rigid motions of bodies that only their drag resists, together where they press on one another, out of a motion that
  !> answers forces which balance each other: but for round-off these forces move no body as a whole, and against the drag round-off
  !> is a large motion. The strain stays. Rigid motions are those that no support bars: translations and, in the plane, the turn.
  subroutine remove_rigid_motion(scene, equations, solution, motion, bodies)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(inout) :: motion(:)          !! (ndof) [unknown]
    logical, intent(in), optional :: bodies(0:)   !! (0:nnode) those it is taken out of, by their numbers; all if not given
    integer :: part_of(size(equations%loose))
    real(wp) :: x(2, size(equations%loose)), rigid(size(motion))
    logical :: barred(2)
    integer :: b, c
    integer, parameter :: turn = 0

    if (size(equations%loose) == 0) return
    if (.not. any(equations%drag > 0)) return
    x = present_coordinates(scene, solution)
    part_of = equations%assembly
    if (present(bodies)) part_of = equations%loose
    do b = 1, maxval(part_of)
      if (present(bodies)) then
        if (.not. bodies(b)) cycle
      end if
      do c = 1, 2
        call find_rigid(c, barred(c))
        if (.not. barred(c)) call take_out()
      end do
      if (any(barred) .or. scene%plane_state == axisymmetric) cycle
      call find_rigid(turn, barred(1))
      call take_out()
    end do

  contains

    !> The translation of the body along an axis, or its turn about the middle of its drag: in the mean that moves none of it.
    subroutine find_rigid(axis, barred)
      integer, intent(in) :: axis
      logical, intent(out) :: barred     !! by a support
      real(wp) :: middle(2), weight(size(equations%loose))
      integer :: k, c

      rigid = 0
      barred = .false.
      associate (number => equations%dofs%fields(displacement_field)%number)
        weight = 0
        do k = 1, size(weight)
          if (part_of(k) == b .and. number(1, k) > 0) weight(k) = equations%drag(number(1, k))
        end do
        middle = 0
        if (sum(weight) > 0) middle = matmul(x, weight)/sum(weight)
        do k = 1, size(equations%loose)
          if (part_of(k) /= b) cycle
          do c = 1, 2
            if (number(c, k) == 0 .or. axis == 3 - c) cycle
            rigid(number(c, k)) = 1
            if (axis == turn) rigid(number(c, k)) = merge(middle(2) - x(2, k), x(1, k) - middle(1), c == 1)
            barred = barred .or. .not. equations%dofs%is_free(number(c, k))
          end do
        end do
      end associate
      if (axis == 1 .and. scene%plane_state == axisymmetric) barred = .true.
    end subroutine find_rigid

    !> Take the share of the rigid motion out, weighed by the drag.
    subroutine take_out()
      real(wp) :: weight

      weight = sum(equations%drag*rigid**2)
      if (weight > 0) motion = motion - sum(equations%drag*rigid*motion)/weight*rigid
    end subroutine take_out
  end subroutine remove_rigid_motion

  !> Work that the drag took in a step [energy].
  pure function work_of_drag(equations, du) result(work)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    real(wp) :: work

    work = sum(equations%drag*du**2)
  end function work_of_drag

  !> Largest Young's modulus of a body, at the first temperature of its cards.
  pure function modulus_of(scene, equations, body) result(modulus)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: body
    real(wp) :: modulus   !! [stress]
    real(wp) :: temperature, young, poisson
    integer :: g

    modulus = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (.not. is_solid(group) .or. group%material == 0) cycle
        if (equations%loose(group%connectivity(1, 1)) /= body) cycle
        associate (material => scene%materials(group%material))
          if (.not. associated(equations%laws(material%law_id)%elastic)) cycle
          temperature = 0
          if (allocated(material%temperatures)) temperature = material%temperatures(1)
          call equations%laws(material%law_id)%elastic(material, temperature, young, poisson)
        end associate
        modulus = max(modulus, young)
      end associate
    end do
  end function modulus_of

  !> Square of the diagonal of the box around some nodes [length^2].
  pure function square_of_extent(x, of_body) result(square)
    real(wp), intent(in) :: x(:, :)        !! (2, nnode) [length]
    logical, intent(in) :: of_body(:)      !! (nnode)
    real(wp) :: square

    square = sum((maxval(x, 2, spread(of_body, 1, 2)) - minval(x, 2, spread(of_body, 1, 2)))**2)
  end function square_of_extent

end module resting_bodies
