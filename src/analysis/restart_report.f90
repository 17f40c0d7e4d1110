!> What a restart on a new mesh tells of the remesh, for scripts: `NAME.gNN.restart.json`, and `restart` in `summary.json`.
module restart_report
  use errors, only: error_t
  use history, only: circumference
  use json_writer, only: json_t
  use restore_balance, only: balance_t, force_change
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: add_restart, write_restart

contains

  !> The file, written as soon as the mesh is judged: a run that is killed later leaves it.
  subroutine write_restart(path, scene, solution, balance, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(balance_t), intent(in) :: balance
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json

    call json%begin_object()
    call add_facts(json, scene, solution, balance)
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_restart

  !> The object `restart`, in an object.
  subroutine add_restart(json, scene, solution, balance)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(balance_t), intent(in) :: balance

    call json%begin_object('restart')
    call add_facts(json, scene, solution, balance)
    call json%end_object()
  end subroutine add_restart

  !> Energies are those of the full circumference when the scene is axisymmetric.
  subroutine add_facts(json, scene, solution, balance)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(balance_t), intent(in) :: balance

    call json%add('generation', scene%generation)
    call json%add('remesh_refused', balance%refused)
    if (allocated(balance%stage)) call json%add('stage', balance%stage)
    call json%add('first_residual', balance%first_residual)
    call json%add('iterations', balance%iterations)
    call json%add('parts', balance%parts)
    call json%add('motion_over_size', balance%motion)
    call json%add('force_change', force_change(balance))
    call json%add('volume_before', circumference(scene)*balance%before%volume)
    call json%add('volume_after', circumference(scene)*balance%after%volume)
    call json%add('elastic_energy_before', circumference(scene)*balance%before%elastic_energy)
    call json%add('elastic_energy_after', circumference(scene)*balance%after%elastic_energy)
    call json%add('plastic_work_before', circumference(scene)*balance%before%plastic_work)
    call json%add('plastic_work_after', circumference(scene)*balance%after%plastic_work)
    if (scene%remesh%estimate) call json%add('error_stress_pct', 100*solution%estimate%stress)
    call json%add('wall_s', balance%wall)
  end subroutine add_facts

end module restart_report
