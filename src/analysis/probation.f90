!> The first steps on a new mesh, compared with those before it: a mesh that reached equilibrium but then allows only very short
!> steps, or none, is refused after all. Nothing is saved then: the run stands at its last save, and its caller goes back to the old
!> mesh.
module probation
  use acceptance, only: end_probation, probation_steps, step_ratio
  use equations, only: equations_t
  use errors, only: error_t, exit_no_convergence, fail
  use json_writer, only: json_t
  use judge_remesh, only: advice_after_refusal
  use kinds, only: wp
  use listing, only: list_lines, listing_t
  use residual_place, only: bad_shape, least_shape, place_residual, residual_place_t
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use step_outcome, only: outcome_t
  use text, only: string_t, to_text, two_digits
  implicit none
  private
  public :: is_too_short, pass_probation, refuse_after_all

  !> Contact is responsible for a residual of which more than this share is at its sides.
  real(wp), parameter :: most_of_it = 0.5_wp

contains

  !> Steps have become shorter than is allowed on probation.
  pure function is_too_short(scene, solution) result(short)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical :: short

    short = step_ratio(solution%probation) < scene%remesher%accept%step_ratio
  end function is_too_short

  !> The mesh has made its steps on probation, or the run ends before: it is accepted.
  subroutine pass_probation(scene, stem, listing, solution, error)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: stem
    type(listing_t), intent(in) :: listing
    type(solution_t), intent(inout) :: solution
    type(error_t), allocatable, intent(out) :: error
    type(string_t) :: line(1)

    line(1)%s = 'mesh '//to_text(scene%generation)//' is off probation: least step '//to_text(step_ratio(solution%probation), 3) &
                //' of the least of '//to_text(probation_steps)//' before it (limit ' &
                //to_text(scene%remesher%accept%step_ratio, 3)//')'
    call list_lines(listing, line)
    call write_verdict(scene, solution, stem, '', error)
    call end_probation(solution%probation)
  end subroutine pass_probation

  !> The mesh is refused: its steps are too short, or (error is allocated) the run cannot go on.
  subroutine refuse_after_all(scene, equations, solution, outcome, stem, error)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    character(len=*), intent(in) :: stem
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: late
    character(len=:), allocatable :: what, stage

    if (allocated(error)) then
      what = error%message
      deallocate (error)
    else
      what = 'its steps fall to '//to_text(step_ratio(solution%probation), 3)//' of the least before it, at least ' &
             //to_text(scene%remesher%accept%step_ratio, 3)
      if (allocated(outcome%reason)) what = what//' ('//outcome%reason//')'
    end if
    stage = stage_of(scene, equations, solution, outcome)
    call fail(error, exit_no_convergence, 'mesh '//to_text(scene%generation)//' refused on probation after step ' &
              //to_text(solution%step)//': '//what//'; responsible stage: '//stage, advice_after_refusal)
    call write_verdict(scene, solution, stem, stage, late)
    if (allocated(late)) call move_alloc(late, error)
  end subroutine refuse_after_all

  !> By the step that failed: the mesh where an element is distorted, contact where the residual is at its sides, else the transfer.
  pure function stage_of(scene, equations, solution, outcome) result(stage)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(outcome_t), intent(in) :: outcome
    character(len=:), allocatable :: stage
    type(residual_place_t) :: place
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), residual(equations%dofs%ndof), shape
    integer :: node

    residual = 0
    if (allocated(outcome%residual)) residual = merge(outcome%residual, 0.0_wp, equations%dofs%is_free)
    call place_residual(scene, equations%dofs, 0*residual, equations%magnitude, residual, place)
    x = present_coordinates(scene, solution)
    shape = least_shape(scene, x, place%node)
    if (outcome%group > 0 .and. outcome%element > 0) then
      associate (group => scene%groups(outcome%group))
        if (is_solid(group)) then
          do node = 1, 4
            shape = min(shape, least_shape(scene, x, group%connectivity(node, outcome%element)))
          end do
        end if
      end associate
    end if
    if (shape < bad_shape) then
      stage = 'mesh'
    else if (place%at_contact > most_of_it) then
      stage = 'contact'
    else
      stage = 'transfer'
    end if
  end function stage_of

  !> `NAME.gNN.probation.json`: written before any checkpoint states that the probation is over.
  subroutine write_verdict(scene, solution, stem, stage, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem, stage   !! empty: the mesh is not refused
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json

    call json%begin_object()
    call json%add('generation', scene%generation)
    call json%add('remesh_refused', len(stage) > 0)
    if (len(stage) > 0) call json%add('stage', stage)
    call json%add('steps', probation_steps - solution%probation%left)
    call json%add('least_step_ratio', step_ratio(solution%probation))
    call json%add('least_step_ratio_limit', scene%remesher%accept%step_ratio)
    call json%end_object()
    call json%write_file(stem//'.g'//two_digits(scene%generation)//'.probation.json', error)
  end subroutine write_verdict

end module probation
