!> The element loop: forces, matrices and trial state of all groups at a trial motion.
!>
!> Blocks of elements are spread over threads; each writes its own slices of flat arrays, which are
!> then gathered in a fixed order, so results are the same bits for any number of threads.
module element_loop
  use dofs, only: dofs_t
  use driver_values, only: advance_drivers
  use drivers, only: drivers_t, with_slopes
  use elem_api, only: block_done, elem_t, instant_t, layout_t, report_t
  use fields, only: displacement_field
  use kinds, only: wp
  use kinematics_api, only: kinematics_t
  use law_api, only: law_t
  use driver_slopes, only: fill_slopes
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use sparsity, only: pattern_t
  use timers, only: ledger_t
  implicit none
  private
  public :: element_buffers_t, run_elements, run_few, gather_forces, gather_geometry, gather_matrix, add_prescribed, group_geometry

  !> Elements per block: their arrays stay in the first-level caches.
  integer, parameter :: block_size = 16
  !> Fewer blocks, or nonzeros, are faster on one thread.
  integer, parameter :: worth_threads = 8, worth_gathering = 50000

  type :: element_buffers_t
    !> Element forces and matrices of all groups, one after the other.
    real(wp), allocatable :: force(:), matrix(:)
  end type element_buffers_t

contains

  !> Compute all active groups at the motion `du` of the step. `report` holds the first failure met, in
  !> the order of groups and elements.
  subroutine run_elements(scene, elems, kinematics, laws, dofs, active, pattern, instant, du, now, solution, drivers, buffers, &
                          timers, report)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(dofs_t), intent(in) :: dofs
    logical, intent(in) :: active(:)   !! (ngroup) groups to compute
    type(pattern_t), intent(in) :: pattern
    type(instant_t), intent(in) :: instant
    real(wp), intent(in) :: du(:)       !! (ndof) motion of every unknown [unknown]
    real(wp), intent(in) :: now(:, :)   !! (nnode, nfield) trial values of the fields that drive points [unit of each field]
    type(solution_t), intent(inout) :: solution
    type(drivers_t), intent(inout) :: drivers(:)   !! (ngroup) of the points of the groups
    type(element_buffers_t), intent(inout) :: buffers
    type(ledger_t), intent(inout) :: timers
    type(report_t), intent(out) :: report
    type(report_t), allocatable :: reports(:)
    integer :: g, k, b, nelem, ndof, first, last, f, m, timer

    ! groups that are driven by what others find in this iteration come after them
    do k = 1, 2*size(scene%groups)
      g = 1 + mod(k - 1, size(scene%groups))
      if (.not. active(g) .or. (with_slopes(drivers(g)) .neqv. k > size(scene%groups))) cycle
      associate (group => scene%groups(g), row => elems(scene%groups(g)%elem_id), state => solution%groups(g))
        call timers%add(row%effect, timer)
        call timers%start(timer)
        call advance_drivers(scene, laws, solution, now, instant%time, instant%reach, g, drivers)
        if (instant%tangent) call fill_slopes(scene, laws, solution, now, instant, g, drivers)
        nelem = size(group%connectivity, 2)
        ndof = size(dofs%groups(g)%dof, 1)
        allocate (reports((nelem + block_size - 1)/block_size))
        !$omp parallel do schedule(dynamic) private(first, last, f, m) if (size(reports) >= worth_threads)
        do b = 1, size(reports)
          first = (b - 1)*block_size + 1
          last = min(b*block_size, nelem)
          f = pattern%force_start(g) + (first - 1)*ndof
          m = pattern%matrix_start(g) + (first - 1)*ndof*ndof
          call run_block(scene, group, row, kinematics, laws, instant, dofs%groups(g)%nodes(:, first:last), &
                         dofs%groups(g)%dof(:, first:last), dofs%groups(g)%layout, first, du, &
                         solution%fields(displacement_field)%value, drivers(g)%value(:, :, :, first:last), &
                         state%committed(:, :, first:last), &
                         state%trial(:, :, first:last), buffers%force(f + 1), buffers%matrix(m + 1), reports(b))
        end do
        !$omp end parallel do
        do b = 1, size(reports)
          report%strain = max(report%strain, reports(b)%strain)
          report%jump = max(report%jump, reports(b)%jump)
          report%bearing = report%bearing + reports(b)%bearing
          report%lost = report%lost + reports(b)%lost
          report%between = report%between .or. reports(b)%between
          report%event = min(report%event, reports(b)%event)
          report%passed = min(report%passed, reports(b)%passed)
          report%source = report%source + reports(b)%source
          report%heat_stored = report%heat_stored + reports(b)%heat_stored
          report%heat_released = report%heat_released + reports(b)%heat_released
          report%error_square = report%error_square + reports(b)%error_square
          report%temperature_square = report%temperature_square + reports(b)%temperature_square
          report%error_volume = report%error_volume + reports(b)%error_volume
          report%unpaired = report%unpaired .or. reports(b)%unpaired
          if (report%status /= block_done .or. reports(b)%status == block_done) cycle
          report%status = reports(b)%status
          report%element = reports(b)%element
          report%group = g
        end do
        deallocate (reports)
        call timers%stop(timer)
      end associate
      if (report%status /= block_done) return
    end do
  end subroutine run_elements

  !> Some elements of a group, at a motion of the step, apart from the state of the step: drivers are as they were found last.
  subroutine run_few(scene, row, kinematics, laws, dofs, instant, g, first, last, du, solution, drivers, force, matrix, report)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: row
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(dofs_t), intent(in) :: dofs
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: g, first, last   !! group, and elements of it
    real(wp), intent(in) :: du(:)           !! (ndof) motion of every unknown [unknown]
    type(solution_t), intent(in) :: solution
    type(drivers_t), intent(in) :: drivers   !! of the points of the group
    real(wp), intent(out) :: force(:, :)     !! (ndof of the element, nelem) [residual]
    real(wp), intent(out) :: matrix(:, :, :) !! (ndof, ndof, nelem) [residual/unknown]
    type(report_t), intent(out) :: report
    real(wp), allocatable :: trial(:, :, :)

    allocate (trial, source=solution%groups(g)%trial(:, :, first:last))
    call run_block(scene, scene%groups(g), row, kinematics, laws, instant, dofs%groups(g)%nodes(:, first:last), &
                   dofs%groups(g)%dof(:, first:last), dofs%groups(g)%layout, first, du, &
                   solution%fields(displacement_field)%value, drivers%value(:, :, :, first:last), &
                   solution%groups(g)%committed(:, :, first:last), trial, force, matrix, report)
  end subroutine run_few

  !> One block: gather its geometry and motion, then call the element.
  subroutine run_block(scene, group, row, kinematics, laws, instant, nodes, dof, layout, first, du, displacement, drivers, &
                       committed, trial, force, matrix, report)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(elem_t), intent(in) :: row
    type(kinematics_t), intent(in) :: kinematics
    type(law_t), intent(in) :: laws(:)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: nodes(:, :), dof(:, :), first
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: du(:), displacement(:, :), drivers(:, :, :, :)
    real(wp), intent(in), contiguous :: committed(:, :, :)
    real(wp), intent(inout), contiguous :: trial(:, :, :)
    real(wp), intent(inout) :: force(size(dof, 1), size(dof, 2)), matrix(size(dof, 1), size(dof, 1), size(dof, 2))
    type(report_t), intent(out) :: report
    real(wp) :: x(2, size(nodes, 1), size(nodes, 2)), motion(size(dof, 1), size(dof, 2))
    real(wp) :: start(merge(size(dof, 1), 0, allocated(instant%values)), size(dof, 2))
    integer :: e, law

    law = 1
    if (group%material > 0) law = scene%materials(group%material)%law_id
    call gather_geometry(scene, row, kinematics%finite, nodes, displacement, x)
    do e = 1, size(dof, 2)
      motion(:, e) = du(dof(:, e))
      if (allocated(instant%values)) start(:, e) = instant%values(dof(:, e))
    end do
    call row%compute(scene, group, kinematics, laws(law), instant, layout, first, x, motion, start, drivers, committed, trial, &
                     force, matrix, report)
  end subroutine run_block

  !> Coordinates the elements work on: moved with the displacements, unless kinematics are SMALL and the element does not follow.
  pure subroutine gather_geometry(scene, row, finite, connectivity, displacement, x)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: row
    logical, intent(in) :: finite
    integer, intent(in) :: connectivity(:, :)    !! (nnode of the element, nelem)
    real(wp), intent(in) :: displacement(:, :)   !! (2, nnode), or none [length]
    real(wp), intent(out) :: x(:, :, :)          !! (2, nnode of the element, nelem) [length]
    integer :: e

    do e = 1, size(connectivity, 2)
      x(:, :, e) = scene%mesh%coordinates(:, connectivity(:, e))
      if ((finite .or. row%follows) .and. size(displacement) > 0) x(:, :, e) = x(:, :, e) + displacement(:, connectivity(:, e))
    end do
  end subroutine gather_geometry

  !> Geometry of a whole group.
  pure subroutine group_geometry(scene, group, row, displacement, x)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(elem_t), intent(in) :: row
    real(wp), intent(in) :: displacement(:, :)         !! (2, nnode) [length]
    real(wp), allocatable, intent(out) :: x(:, :, :)   !! (2, row%nnode, nelem) [length]

    allocate (x(2, row%nnode, size(group%connectivity, 2)))
    call gather_geometry(scene, row, scene%finite, group%connectivity, displacement, x)
  end subroutine group_geometry

  !> Internal force on every unknown of a solve, and the sum of the sizes of what is added there; others keep theirs.
  subroutine gather_forces(pattern, buffers, is_own, force, magnitude)
    type(pattern_t), intent(in) :: pattern
    type(element_buffers_t), intent(in) :: buffers
    logical, intent(in) :: is_own(:)                    !! (ndof)
    real(wp), intent(inout) :: force(:), magnitude(:)   !! (ndof) [force]
    integer :: d, k

    !$omp parallel do private(k) schedule(static) if (pattern%nnz > worth_gathering)
    do d = 1, size(force)
      if (.not. is_own(d)) cycle
      force(d) = 0
      magnitude(d) = 0
      do k = pattern%force_first(d), pattern%force_first(d + 1) - 1
        force(d) = force(d) + buffers%force(pattern%force_entry(k))
        magnitude(d) = magnitude(d) + abs(buffers%force(pattern%force_entry(k)))
      end do
    end do
    !$omp end parallel do
  end subroutine gather_forces

  !> Nonzeros of the assembled matrix.
  subroutine gather_matrix(pattern, buffers, values)
    type(pattern_t), intent(in) :: pattern
    type(element_buffers_t), intent(in) :: buffers
    real(wp), intent(out) :: values(:)   !! (nnz) [residual/unknown]
    real(wp) :: total
    integer :: n, k

    !$omp parallel do private(k, total) schedule(static) if (pattern%nnz > worth_gathering)
    do n = 1, pattern%nnz
      ! most nonzeros have one entry; none has less
      total = buffers%matrix(pattern%entry(pattern%first(n)))
      do k = pattern%first(n) + 1, pattern%first(n + 1) - 1
        total = total + buffers%matrix(pattern%entry(k))
      end do
      values(n) = total
    end do
    !$omp end parallel do
  end subroutine gather_matrix

  !> Add K du to the internal force for a motion of prescribed unknowns not yet in `du` (the rest of `motion` is zero).
  subroutine add_prescribed(dofs, active, pattern, buffers, motion, force)
    type(dofs_t), intent(in) :: dofs
    logical, intent(in) :: active(:)   !! (ngroup) groups that act in the solve
    type(pattern_t), intent(in) :: pattern
    type(element_buffers_t), intent(in) :: buffers
    real(wp), intent(in) :: motion(:)     !! (ndof) [unknown]
    real(wp), intent(inout) :: force(:)   !! (ndof) [residual]
    integer :: g, e, i, j, m, ndof

    do g = 1, size(dofs%groups)
      if (.not. active(g)) cycle
      associate (dof => dofs%groups(g)%dof)
        ndof = size(dof, 1)
        do e = 1, size(dof, 2)
          do j = 1, ndof
            if (.not. abs(motion(dof(j, e))) > 0) cycle
            m = pattern%matrix_start(g) + ((e - 1)*ndof + j - 1)*ndof
            ! one by one: an unknown may stand several times in an element
            do i = 1, ndof
              force(dof(i, e)) = force(dof(i, e)) + buffers%matrix(m + i)*motion(dof(j, e))
            end do
          end do
        end do
      end associate
    end do
  end subroutine add_prescribed

end module element_loop
