!> Results of a remesh, the stage it reached and the time each task took: for the report.
module remesh_facts
  use corrected_contours, only: contour_report_t
  use cuts, only: cut_record_t
  use kinds, only: wp
  use material_volumes, only: materials_kept_t
  use mesh_prediction, only: prediction_t
  use new_mesh_check, only: mesh_check_t
  use timers, only: ledger_t
  use transfer_report, only: carried_quantity_t, transfer_report_t
  implicit none
  private
  public :: remesh_facts_t, begin_task, end_task

  type :: remesh_facts_t
    !> Stage responsible for a failure that follows: checkpoint, contour, mesh, transfer, contact.
    character(len=:), allocatable :: stage
    integer :: generation = 0, step = 0
    real(wp) :: time = 0.0_wp
    integer :: old_elements = 0, new_elements = 0
    type(contour_report_t) :: contour
    type(mesh_check_t) :: mesh
    !> Materials that share sides.
    type(materials_kept_t) :: materials
    !> Mesher that made the mesh.
    character(len=:), allocatable :: mesher
    type(transfer_report_t) :: transfer
    !> Integrals of contact variables over the contact intervals.
    type(carried_quantity_t), allocatable :: contacts(:)
    !> Largest displacement of a node to fit a die made of sides, divided by the length of its side.
    real(wp) :: fit = 0.0_wp
    !> Ratio of the element sizes used to the requested ones, to respect the limit on the number of elements.
    real(wp) :: coarser = 1.0_wp
    !> Errors expected of the new mesh, divided by those its sizes were computed for.
    type(prediction_t) :: expected
    !> Seconds of the tasks, in their order.
    type(ledger_t) :: timers
    !> What came of the cuts of the scene, where some were made; the volume removed, of the full circumference when axisymmetric.
    type(cut_record_t), allocatable :: cuts(:)
    real(wp) :: removed = 0.0_wp
    !> The current task; 0: none.
    integer :: task = 0
  end type remesh_facts_t

contains

  !> Start the timer of a task, after that of the previous one was stopped.
  subroutine begin_task(facts, stage, task)
    type(remesh_facts_t), intent(inout) :: facts
    character(len=*), intent(in) :: stage   !! responsible for a failure
    character(len=*), intent(in) :: task

    call end_task(facts)
    facts%stage = stage
    call facts%timers%add(task, facts%task)
    call facts%timers%start(facts%task)
  end subroutine begin_task

  subroutine end_task(facts)
    type(remesh_facts_t), intent(inout) :: facts

    if (facts%task > 0) call facts%timers%stop(facts%task)
    facts%task = 0
  end subroutine end_task

end module remesh_facts
