!> Supervision of the mesh: its errors after every step, and whether a new one is due (cards ESTIM, REMSH).
module watch_mesh
  use estimator, only: estimate_errors
  use estimator_parts, only: estimator_t
  use fields, only: displacement_field
  use listing, only: list_lines, listing_t
  use narrow_contacts, only: measure_narrow, narrow_t
  use narrow_loads, only: note_narrow
  use remeshing, only: has_limit, never, trigger_t, trigger_words
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  use timers, only: ledger_t
  use triggers, only: distress_trigger, find_triggers, find_trims, was_good
  implicit none
  private
  public :: estimate, estimate_stress, note_first_narrow, look_at_mesh, ask_for_trims, answer_distress, mesh_is_due, remesh_reason

contains

  !> Errors of the accepted instant.
  subroutine estimate(scene, estimator, timers, solution)
    type(scene_t), intent(in) :: scene
    type(estimator_t), intent(in) :: estimator
    type(ledger_t), intent(inout) :: timers
    type(solution_t), intent(inout) :: solution
    integer :: timer

    if (.not. has_estimate(scene)) return
    call timers%add('error estimates', timer)
    call timers%start(timer)
    call estimate_errors(estimator, scene, solution)
    call note_narrow(scene, solution)
    call timers%stop(timer)
  end subroutine estimate

  !> Error of the stress restored on a new mesh; nothing has been added yet to the error of the strain.
  subroutine estimate_stress(scene, estimator, solution)
    type(scene_t), intent(in) :: scene
    type(estimator_t), intent(in) :: estimator
    type(solution_t), intent(inout) :: solution
    type(solution_t), allocatable :: tried

    if (.not. has_estimate(scene)) return
    allocate (tried, source=solution)
    call estimate_errors(estimator, scene, tried)
    solution%estimate%stress = tried%estimate%stress
    solution%estimate%stress_of = tried%estimate%stress_of
  end subroutine estimate_stress

  !> How narrow contact is beside the sides of a new mesh that has been made for it.
  subroutine note_first_narrow(scene, solution)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    type(narrow_t) :: narrow

    if (.not. scene%remesh%narrow < never) return
    narrow = measure_narrow(scene, solution)
    solution%estimate%first_narrow = narrow%ratio
  end subroutine note_first_narrow

  !> Errors are estimated of stresses and strains: where bodies move.
  pure function has_estimate(scene)
    type(scene_t), intent(in) :: scene
    logical :: has_estimate

    has_estimate = scene%remesh%estimate .and. scene%fields(displacement_field)%declared
  end function has_estimate

  !> Ask for a new mesh when the one just used has passed a limit.
  subroutine look_at_mesh(scene, timers, listing, solution)
    type(scene_t), intent(in) :: scene
    type(ledger_t), intent(inout) :: timers
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(inout) :: solution
    type(trigger_t), allocatable :: found(:)
    integer :: timer

    if (.not. scene%remesh%on) return
    call timers%add('remeshing', timer)
    call timers%start(timer)
    call find_triggers(scene, solution, found)
    call timers%stop(timer)
    if (size(found) > 0) call ask_for_mesh(scene, found, listing, solution)
  end subroutine look_at_mesh

  !> Ask for the mesh that is cut along lines, when an operation begins.
  subroutine ask_for_trims(scene, listing, solution)
    type(scene_t), intent(in) :: scene
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(inout) :: solution
    type(trigger_t), allocatable :: found(:)

    call find_trims(scene, solution, found)
    if (size(found) > 0) call ask_for_mesh(scene, found, listing, solution)
  end subroutine ask_for_trims

  !> Ask for a new mesh when a step has been cut back often on one that was good before (DISTRESS), or can be cut back no more: the
  !> run would end with it, by whatever limits meshes are replaced; but where a body has passed through itself, another mesh has the
  !> same sides.
  subroutine answer_distress(scene, cutbacks, give_up, passes_itself, listing, solution)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: cutbacks   !! one after the other
    logical, intent(in) :: give_up    !! the least step has failed
    logical, intent(in) :: passes_itself   !! a body has passed through itself in it
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(inout) :: solution

    if (.not. has_limit(scene%remesh) .or. .not. was_good(scene, solution)) return
    if (.not. give_up .and. cutbacks < scene%remesh%distress) return
    if (passes_itself .and. scene%remesh%distress == huge(0)) return
    call ask_for_mesh(scene, [distress_trigger(scene, cutbacks)], listing, solution)
    ! what comes next is another mesh, or one more try
    solution%next_step = max(solution%next_step, scene%strategy%least_step)
  end subroutine answer_distress

  subroutine ask_for_mesh(scene, found, listing, solution)
    type(scene_t), intent(in) :: scene
    type(trigger_t), intent(in) :: found(:)
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(inout) :: solution
    type(string_t) :: lines(size(found))
    integer :: k

    deallocate (solution%estimate%triggers)
    allocate (solution%estimate%triggers, source=found)
    solution%estimate%last_stop = solution%step
    solution%crossing%remeshed = .false.
    do k = 1, size(found)
      lines(k)%s = 'remesh: '//trigger_text(scene, found(k))
    end do
    call list_lines(listing, lines)
  end subroutine ask_for_mesh

  !> A new mesh has been asked for.
  pure function mesh_is_due(solution) result(due)
    type(solution_t), intent(in) :: solution
    logical :: due

    due = size(solution%estimate%triggers) > 0
  end function mesh_is_due

  !> Why the run stops for a new mesh, in one line.
  function remesh_reason(scene, solution) result(s)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: s
    integer :: k

    s = 'a new mesh is due at step '//to_text(solution%step)//':'
    do k = 1, size(solution%estimate%triggers)
      if (k > 1) s = s//';'
      s = s//' '//trigger_text(scene, solution%estimate%triggers(k))
    end do
  end function remesh_reason

  !> `aspect_ratio 12.3 (limit 10), element 7 of billet`.
  function trigger_text(scene, trigger) result(s)
    type(scene_t), intent(in) :: scene
    type(trigger_t), intent(in) :: trigger
    character(len=:), allocatable :: s

    s = trigger_words(trigger%name, trigger%value, trigger%limit)
    if (trigger%element > 0) s = s//', element '//to_text(trigger%element)
    if (trigger%group > 0) s = s//' of '//scene%groups(trigger%group)%name
  end function trigger_text

end module watch_mesh
