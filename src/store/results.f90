!> Fields for pictures: one HDF5 file per mesh generation, one per saved instant, and over all of them the XDMF files of the bodies,
!> of the rigid dies and of the integration points.
!>
!> `NAME.gNN.h5`: mesh/ (coordinates, topology from 0, groups), dies/, and steps/NNNNNN, links to the instants: files
!> `NAME.gNN/NNNNNN.h5` with the coordinates reached, nodal fields (node/NAME), numbers of elements (element/NAME) and the raw state
!> of the points (points/GROUP). Readers of HDF5 follow the links by themselves. decks/RESULTS.md describes all that is in them.
module results
  use dies, only: is_deformable
  use errors, only: error_t
  use fields, only: on_nodes, pilot_field
  use hdf5_file, only: hdf5_file_t
  use instant_files, only: begin_file, forget_later_steps, instant_path, instants_folder, link_instant, mesh_path, put_in_place
  use kinds, only: wp
  use result_dies, only: put_dies
  use result_fields, only: put_cells, put_field, put_nodal_fields, put_points, put_vector
  use result_mesh, only: complete_mesh, mark_format, write_mesh
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use system, only: base_name, file_exists, make_directory, remove_file, rename_file
  use xdmf_grid, only: xdmf_grid_t
  use xdmf_writer, only: xdmf_t
  implicit none
  private
  public :: results_t, forget_failure, open_results, save_fields, save_failure

  !> Behind the stem in names of files of a step that failed.
  character(len=*), parameter :: failure = '.failed'
  !> What XDMF files are called behind the stem.
  character(len=12), parameter :: xdmf_endings(3) = ['.xdmf       ', '.dies.xdmf  ', '.points.xdmf']
  integer, parameter :: of_bodies = 1, of_dies = 2, of_points = 3

  type :: results_t
    !> Path of the run's files without endings, of the present generation's HDF5 file, and folder of its instants.
    character(len=:), allocatable :: stem, path, folder
    !> Step saved last, -1 before the first.
    integer :: saved_step = -1
    !> Note on the files for the user; may be unallocated.
    character(len=:), allocatable :: note
    !> Of bodies, dies and points.
    type(xdmf_t) :: xdmf(size(xdmf_endings))
  end type results_t

contains

  !> Begin the files of this generation, or take them up again. Instants after the step `after` are made again: they are taken out,
  !> of all generations, and so is all of a later generation, and of this one when its mesh is new.
  subroutine open_results(scene, solution, stem, after, new_mesh, results, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem
    integer, intent(in) :: after   !! -1: nothing stays
    logical, intent(in) :: new_mesh
    type(results_t), intent(out) :: results
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: path
    integer :: first_new, saved, g
    logical :: there

    results%stem = stem
    results%path = mesh_path(stem, scene%generation)
    results%folder = instants_folder(stem, scene%generation)
    first_new = scene%generation + merge(0, 1, new_mesh)
    if (after < 0) first_new = 1
    ! the XDMF first: at no time does it name a file that was removed
    do g = 1, size(xdmf_endings)
      path = stem//trim(xdmf_endings(g))
      if (after >= 0) call results%xdmf(g)%resume(path, solution%time, base_name(mesh_path(stem, first_new)), error)
      if (allocated(error)) return
      if (results%xdmf(g)%size() > 0) then
        call results%xdmf(g)%write_file(path, error)
      else
        call remove_file(path, error)
      end if
      if (allocated(error)) return
    end do
    g = 0
    do
      g = g + 1
      there = file_exists(mesh_path(stem, g))
      if (.not. there .and. g > scene%generation) exit
      if (.not. there) cycle
      call forget_later_steps(mesh_path(stem, g), instants_folder(stem, g), merge(after, -1, g < first_new), saved, error)
      if (allocated(error) .and. after >= 0) then
        call put_aside(mesh_path(stem, g), results, error)
      else if (g >= first_new) then
        call remove_file(mesh_path(stem, g), error)
      else if (g == scene%generation .and. saved == solution%step) then
        results%saved_step = saved
      end if
      if (allocated(error)) return
    end do
    call make_directory(results%folder, error)
    if (allocated(error)) return
    if (file_exists(results%path)) then
      call complete_mesh(results%path, scene, error)
    else
      call write_mesh(results%path, scene, error)
    end if
  end subroutine open_results

  !> A damaged file does not keep a run from going on: it is renamed.
  subroutine put_aside(path, results, error)
    character(len=*), intent(in) :: path
    type(results_t), intent(inout) :: results
    type(error_t), allocatable, intent(inout) :: error
    type(xdmf_t) :: empty
    integer :: k

    results%note = 'note: '//error%message//'; put aside as '//path//'.damaged, its fields begin anew'
    call rename_file(path, path//'.damaged', error)
    do k = 1, size(xdmf_endings)
      if (.not. allocated(error)) call remove_file(results%stem//trim(xdmf_endings(k)), error)
      results%xdmf(k) = empty
    end do
    results%saved_step = -1
  end subroutine put_aside

  !> Save the accepted instant, once.
  subroutine save_fields(scene, solution, results, error, residual)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(results_t), intent(inout) :: results
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in), optional :: residual(:, :)   !! (2, nnode) residual force of a step that failed [force]
    type(hdf5_file_t) :: file
    type(xdmf_grid_t) :: grid, dies
    type(xdmf_grid_t), allocatable :: points(:)
    real(wp), allocatable :: x(:, :)
    character(len=:), allocatable :: path
    character(len=6) :: number
    integer, allocatable :: rigid(:)
    integer :: nnode, g

    if (results%saved_step == solution%step) return
    nnode = size(scene%mesh%coordinates, 2)
    write (number, '(i6.6)') solution%step
    path = instant_path(results%folder, number)
    call begin_file(file, path, error)
    if (allocated(error)) return
    call mark_format(file)
    allocate (x, source=present_coordinates(scene, solution))
    call file%write('coordinates', x)
    call file%write_attribute('coordinates', 'unit', 'length')
    call file%write_attribute('/', 'time', solution%time)
    call file%write_attribute('/', 'step', solution%step)
    rigid = pack([(g, g=1, size(scene%dies))],.not. is_deformable(scene%dies))
    if (size(rigid) > 0) call file%write('pilots', solution%fields(pilot_field)%value(:, rigid))
    grid%time = solution%time
    grid%file = base_name(results%folder)//'/'//base_name(path)
    grid%mesh_file = base_name(results%path)
    grid%geometry = 'coordinates'
    grid%nnode = nnode
    grid%topology = 'mesh/topology'
    allocate (grid%fields(0))
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) grid%nelement = grid%nelement + size(scene%groups(g)%connectivity, 2)
    end do
    do g = 1, size(solution%fields)
      if (solution%fields(g)%declared .and. solution%fields(g)%place == on_nodes) call put_field(file, solution%fields(g), grid)
    end do
    if (present(residual)) call put_vector(file, 'residual_force', residual, 'force', grid)
    call put_nodal_fields(file, scene, solution, grid)
    if (scene%remesh%estimate) then
      call put_cells(file, 'error_stress', solution%estimate%stress_of, grid)
      call put_cells(file, 'error_strain', solution%estimate%strain_of, grid)
    end if
    call put_dies(file, scene%dies, solution%fields(pilot_field)%value, grid, dies)
    call put_points(file, scene, solution, x, grid, points)
    call put_in_place(file, path, error)
    if (.not. allocated(error)) call link_instant(results%path, results%folder, number, error)
    if (.not. allocated(error)) call results%xdmf(of_bodies)%add(grid, error)
    if (.not. allocated(error) .and. dies%nnode > 0) call results%xdmf(of_dies)%add(dies, error)
    if (.not. allocated(error) .and. size(points) > 0) call results%xdmf(of_points)%add_together('points', points, error)
    do g = 1, size(xdmf_endings)
      if (allocated(error) .or. results%xdmf(g)%size() == 0) cycle
      call results%xdmf(g)%write_file(results%stem//trim(xdmf_endings(g)), error)
    end do
    if (.not. allocated(error)) results%saved_step = solution%step
  end subroutine save_fields

  !> The picture of a step that failed in an earlier call is not of this one: its files go.
  subroutine forget_failure(stem, generation, error)
    character(len=*), intent(in) :: stem
    integer, intent(in) :: generation   !! of the present mesh
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: damaged
    integer :: g, saved
    logical :: there

    do g = 1, size(xdmf_endings)
      call remove_file(stem//failure//trim(xdmf_endings(g)), error)
      if (allocated(error)) return
    end do
    g = 0
    do
      g = g + 1
      there = file_exists(mesh_path(stem//failure, g))
      if (.not. there .and. g > generation) exit
      if (.not. there) cycle
      ! instants that a damaged file does not name stay
      call forget_later_steps(mesh_path(stem//failure, g), instants_folder(stem//failure, g), -1, saved, damaged)
      call remove_file(mesh_path(stem//failure, g), error)
      if (allocated(error)) return
    end do
  end subroutine forget_failure

  !> A picture of the step that failed, in files of its own (NAME.failed.*): the last good state with the residual force.
  subroutine save_failure(scene, solution, stem, residual, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem
    real(wp), intent(in) :: residual(:, :)   !! (2, nnode) [force]
    type(error_t), allocatable, intent(out) :: error
    type(results_t) :: failed

    call open_results(scene, solution, stem//failure, -1, .false., failed, error)
    if (.not. allocated(error)) call save_fields(scene, solution, failed, error, residual)
  end subroutine save_failure

end module results
