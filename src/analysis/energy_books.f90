!> Books of energy: what the work from outside and that of temperatures became.
!>
!> Work from outside is taken by the trapezoidal rule, from the forces at both ends of the step and its motion. Forces at the
!> end of the step alone would err in first order even where all is elastic, and make work of a rigid rotation R of a body under
!> stress, sum f(n+1).du = (1 - cos) sum f.x; the mean of both ends leaves sum f.(R - R^T)x/2, the moment of forces in balance:
!> none.
!>
!> What is stored and dissipated is counted at the points, where the flow is, so that the difference of both is the error of the
!> path: motion and forces are not straight within a step. It falls with the step.
module energy_books
  use contact_contour, only: sample_depth
  use dies, only: present_die
  use elem_api, only: totals_t
  use elem_body_springs, only: springs_of_body
  use element_loop, only: group_geometry
  use energy_round_off, only: operations, stiffest
  use equations, only: equations_t
  use fields, only: displacement_field, field_t, on_nodes, on_pilots, pilot_field, section_field
  use gap_work, only: work_across_gaps
  use kinds, only: eps, wp
  use scene, only: role_spring, scene_t
  use solution, only: present_coordinates, solution_t
  use thermal_work, only: book_heat_work, heat_work_t
  use work_books, only: work_t
  implicit none
  private
  public :: book_stored, book_work, external_on_unknowns, spring_energy, start_stored

contains

  !> External work by the trapezoidal rule: forces from outside on nodes and pilots times their motion; without the way that a force
  !> takes a die over a gap, on which nothing takes work of it: its press keeps or loses that.
  subroutine book_work(equations, du, solution)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)   !! (ndof) motion of the step [unknown]
    type(solution_t), intent(inout) :: solution
    type(work_t) :: before
    real(wp) :: applied(equations%dofs%ndof), done, sizes
    integer :: f, k, c

    applied = external_on_unknowns(equations)
    before = solution%work
    sizes = 0
    do f = 1, size(solution%fields)
      do k = 1, size(solution%fields(f)%applied, 2)
        done = 0
        do c = 1, solution%fields(f)%ncomp
          call book(equations%dofs%fields(f)%number(c, k), solution%fields(f), free_way(f, c, k), solution%fields(f)%applied(c, k))
        end do
        if (solution%fields(f)%place == on_pilots) sizes = sizes + abs(done)
      end do
    end do
    associate (work => solution%work)
      work%from_outside = sizes + abs(work%supports - before%supports) + abs(work%loads - before%loads) &
                          + abs(work%section - before%section)
    end associate

  contains

    pure function free_way(f, c, k) result(way)
      integer, intent(in) :: f, c, k   !! field, component, node or die
      real(wp) :: way                  !! [length]

      way = 0
      if (f == pilot_field .and. c <= 2) way = equations%way_to_part(c, k)
    end function free_way

    subroutine book(dof, field, way, force)
      integer, intent(in) :: dof
      type(field_t), intent(in) :: field
      real(wp), intent(in) :: way   !! over a gap [length]
      real(wp), intent(inout) :: force
      real(wp) :: part

      if (dof == 0) return
      if (field%quantity == 'motion') then
        part = 0.5_wp*(force + applied(dof))*(du(dof) - way)
        done = done + part
        solution%external_work = solution%external_work + part
        associate (work => solution%work)
          if (field%place == on_pilots) then
            work%dies = work%dies + part
          else if (field%place /= on_nodes) then
            work%section = work%section + part
          else if (equations%dofs%is_free(dof)) then
            work%loads = work%loads + part
          else
            work%supports = work%supports + part
          end if
        end associate
      end if
      force = applied(dof)
    end subroutine book

  end subroutine book_work

  !> The external force on each unknown: the internal force there, without the elements that are loads.
  pure function external_on_unknowns(equations) result(applied)
    type(equations_t), intent(in) :: equations
    real(wp) :: applied(equations%dofs%ndof)   !! [residual]
    integer :: g, k, c, d, m

    applied = equations%force
    do g = 1, size(equations%dofs%groups)
      if (.not. equations%is_load(g)) cycle
      m = equations%solves(1)%pattern%force_start(g)
      do k = 1, size(equations%dofs%groups(g)%dof, 2)
        do c = 1, size(equations%dofs%groups(g)%dof, 1)
          m = m + 1
          d = equations%dofs%groups(g)%dof(c, k)
          applied(d) = applied(d) - equations%buffers%force(m)
        end do
      end do
    end do
  end function external_on_unknowns

  !> What the step stored and dissipated, after it was measured and before its state is committed.
  subroutine book_stored(scene, equations, du, totals, friction_before, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)             !! (ndof) motion of the step [unknown]
    type(totals_t), intent(in) :: totals
    real(wp), intent(in) :: friction_before   !! work of friction up to the step, per radian when axisymmetric [energy]
    type(solution_t), intent(inout) :: solution
    type(heat_work_t) :: heat
    real(wp) :: friction, overlap, taken, of_dies, of_supports

    if (.not. scene%fields(displacement_field)%declared) return
    call work_across_gaps(scene, equations, solution, of_dies, of_supports)
    solution%external_work = solution%external_work + (of_dies + of_supports)
    call book_heat_work(scene, equations, solution, heat)
    friction = solution%friction_work - friction_before
    overlap = 0
    if (solution%step == 1) overlap = work_of_overlap(scene, equations, du, solution)
    associate (work => solution%work, u => solution%fields(displacement_field))
      work%dies = work%dies + of_dies
      work%supports = work%supports + of_supports
      work%heat = work%heat + heat%work
      work%grown = work%grown + heat%grown
      work%flow = work%flow + totals%dissipated
      work%contact = work%contact + totals%contact_work
      work%overlap = work%overlap + overlap
      ! what came in, or what was stored and dissipated: where one is small, as in relaxation, the other is not
      taken = abs(totals%elastic_energy - work%elastic) + totals%dissipated + friction + abs(totals%contact_work)
      work%passed = work%passed + max(work%from_outside + abs(overlap), taken) + heat%passed
      work%elastic = totals%elastic_energy
      work%round_off = work%round_off + operations*eps*stiffest(scene, equations)*totals%volume &
                       *maxval(abs(u%last_increment))/equations%size
    end associate
  end subroutine book_stored

  !> Energy that a first step finds in parts that lie in a die at the start (a ring shrunk on another): contact pushes them apart,
  !> and its points take more than the motion gives them, sum f(1).du/2, with the overlap applied in proportion.
  function work_of_overlap(scene, equations, du, solution) result(work)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: du(:)   !! (ndof) [unknown]
    type(solution_t), intent(in) :: solution
    real(wp) :: work
    type(totals_t) :: part
    real(wp), allocatable :: x(:, :), sides(:, :, :)
    real(wp) :: depth, ratio
    integer :: g, e, c, m

    work = 0
    allocate (x, source=present_coordinates(scene, solution) - solution%fields(displacement_field)%last_increment)
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), dof => equations%dofs%groups(g)%dof, row => equations%elems(scene%groups(g)%elem_id))
        if (group%die == 0 .or. group%material == 0) cycle
        call sample_depth(group, present_die(scene%dies(group%die), x), scene%dies(group%die)%pilot, scene%mesh%coordinates, x, &
                          0.0_wp, depth, ratio)
        if (.not. depth > operations*eps*equations%size) cycle
        call group_geometry(scene, group, row, solution%fields(displacement_field)%value, sides)
        call row%measure(scene, group, equations%laws(scene%materials(group%material)%law_id), &
                         solution%fields(section_field)%value(:, 1), solution%penalty_share, sides, &
                         solution%groups(g)%trial, solution%groups(g)%committed, part)
        work = work + part%contact_work + part%friction_work
        m = equations%solves(1)%pattern%force_start(g)
        do e = 1, size(dof, 2)
          do c = 1, size(dof, 1)
            m = m + 1
            work = work - 0.5_wp*equations%buffers%force(m)*du(dof(c, e))
          end do
        end do
      end associate
    end do
  end function work_of_overlap

  !> Elastic energy where a run begins or goes on: what a new mesh changed is kept apart.
  pure subroutine start_stored(totals, solution)
    type(totals_t), intent(in) :: totals
    type(solution_t), intent(inout) :: solution

    associate (work => solution%work)
      work%remeshing = work%remeshing + (totals%elastic_energy - work%elastic)
      work%elastic = totals%elastic_energy
    end associate
  end subroutine start_stored

  !> Energy that springs of dies and of bodies hold [energy]. They stand outside: what dies do to the part is the work of dies, what
  !> springs of a body do that of loads.
  pure function spring_energy(scene, solution) result(energy)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: energy
    real(wp) :: force, of_body
    integer :: g

    energy = 0
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%is_spring) then
          call springs_of_body(scene, group, solution%fields(displacement_field)%value, force, of_body)
          energy = energy + of_body
        end if
        if (group%role /= role_spring) cycle
        associate (c => group%component)
          energy = energy + 0.5_wp*group%stiffness*(solution%fields(pilot_field)%value(c, group%die) &
                                                    - scene%dies(group%die)%pilot(c))**2
        end associate
      end associate
    end do
  end function spring_energy

end module energy_books
