!> What a remesh has made, how far it came, and where its time went: for the report.
module remesh_facts
  use kinds, only: wp
  use material_volumes, only: materials_kept_t
  use mesh_prediction, only: prediction_t
  use new_mesh_check, only: mesh_check_t
  use part_contour, only: contour_report_t
  use timers, only: ledger_t
  use transfer_report, only: balance_t, transfer_report_t
  implicit none
  private
  public :: remesh_facts_t, begin_task, end_task

  type :: remesh_facts_t
    !> What is to blame if this is the end: checkpoint, contour, mesh, transfer, contact.
    character(len=:), allocatable :: stage
    integer :: generation = 0, step = 0
    real(wp) :: time = 0.0_wp
    integer :: old_elements = 0, new_elements = 0
    type(contour_report_t) :: contour
    type(mesh_check_t) :: mesh
    !> Materials that share sides.
    type(materials_kept_t) :: materials
    !> Who made the mesh.
    character(len=:), allocatable :: mesher
    type(transfer_report_t) :: transfer
    !> Integrals of contact along its runs.
    type(balance_t), allocatable :: contacts(:)
    !> Largest way of a node to fit a die made of sides, over its side.
    real(wp) :: fit = 0.0_wp
    !> Sizes are so many times the wanted ones, for the limit on the number of elements.
    real(wp) :: coarser = 1.0_wp
    !> The errors expected of the new mesh, over those its sizes were wanted for.
    type(prediction_t) :: expected
    !> Seconds of the tasks, in their order.
    type(ledger_t) :: timers
    !> The task at hand; 0: none.
    integer :: task = 0
  end type remesh_facts_t

contains

  !> The time from now on is that of a task; the one before has ended.
  subroutine begin_task(facts, stage, task)
    type(remesh_facts_t), intent(inout) :: facts
    character(len=*), intent(in) :: stage   !! to blame for a failure
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
