!> What a restart on a new mesh reports about the remesh, for scripts: `NAME.gNN.restart.json`, and `restart` in `summary.json`.
module restart_report
  use errors, only: error_t
  use history, only: circumference
  use dies, only: is_deformable
  use json_writer, only: json_t
  use judge_remesh, only: force_alone
  use remesh_limits, only: carried_change, energy_change, energy_limit, force_along, force_change, force_limit, residual_limit
  use residual_place, only: bad_shape
  use restore_balance, only: balance_t
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
    call json%add('iterations_in_all', balance%iterations_in_all)
    call json%add('restored', balance%restored)
    ! what restoring it changes is known when it is restored
    if (balance%restored) then
      call json%add('force_change', force_change(balance))
      call json%add('energy_change', energy_change(balance))
    end if
    ! tries are compared by this: whether they agree on the force
    if (force_alone(scene%remesher%accept, balance)) &
      call json%add('force_over_limit', force_along(balance)/scene%remesher%accept%force_change)
    call json%add('depth_change', balance%depth_change)
    call json%add('least_scaled_jacobian', balance%shape)
    associate (accept => scene%remesher%accept)
      call json%add('first_residual_limit', residual_limit(accept, balance))
      call json%add('iterations_limit', accept%iterations)
      call json%add('force_change_limit', force_limit(accept, balance))
      call json%add('energy_change_limit', energy_limit(accept, balance))
      call json%add('depth_change_limit', accept%depth_change)
      call json%add('least_scaled_jacobian_limit', bad_shape)
    end associate
    call json%add('first_residual_over_forces', balance%place%relative)
    call json%add('residual_at_contact', balance%place%at_contact)
    if (balance%place%node > 0) call json%add('residual_node', scene%mesh%labels(balance%place%node))
    call json%add('carried_force_change', carried_change(balance))
    call json%add('parts', balance%parts)
    call json%add('motion_over_size', balance%motion)
    call add_forces(json, scene, balance)
    call json%add('initial_volume', circumference(scene)*solution%initial_volume)
    call json%add('volume_before', circumference(scene)*balance%before%volume)
    call json%add('volume_after', circumference(scene)*balance%after%volume)
    call json%add('elastic_energy_before', circumference(scene)*balance%before%elastic_energy)
    call json%add('elastic_energy_after', circumference(scene)*balance%after%elastic_energy)
    call json%add('plastic_work_before', circumference(scene)*balance%before%plastic_work)
    call json%add('plastic_work_after', circumference(scene)*balance%after%plastic_work)
    if (scene%remesh%estimate) call json%add('error_stress_pct', 100*solution%estimate%stress)
    call json%add('wall_s', balance%wall)
  end subroutine add_facts

  !> Force on each rigid die: as the old mesh had it, by the pressures that were carried, in the equilibrium restored.
  subroutine add_forces(json, scene, balance)
    type(json_t), intent(inout) :: json
    type(scene_t), intent(in) :: scene
    type(balance_t), intent(in) :: balance
    integer :: k

    call json%begin_array('forces')
    do k = 1, size(scene%dies)
      if (is_deformable(scene%dies(k))) cycle
      call json%begin_object()
      call json%add('die', scene%dies(k)%name)
      call json%add('before', circumference(scene)*balance%pilot_before(1:2, k))
      call json%add('carried', circumference(scene)*balance%pilot_carried(1:2, k))
      call json%add('after', circumference(scene)*balance%pilot_after(1:2, k))
      call json%end_object()
    end do
    call json%end_array()
  end subroutine add_forces

end module restart_report
