!> Fields for pictures: one HDF5 file per mesh generation, one per saved instant, one XDMF over all of them.
!>
!> `NAME.gNN.h5`: mesh/ (coordinates, topology from 0, groups), dies/, and steps/NNNNNN, links to the instants: files
!> `NAME.gNN/NNNNNN.h5` with the coordinates reached, nodal fields (node/NAME), numbers of elements (element/NAME) and the raw state
!> of the points (points/GROUP). Readers of HDF5 follow the links by themselves.
module results
  use dies, only: is_deformable
  use errors, only: error_t
  use fields, only: field_t, on_nodes, pilot_field
  use hdf5_file, only: hdf5_file_t
  use instant_files, only: begin_file, forget_later_steps, instant_path, instants_folder, link_instant, mesh_path, put_in_place
  use kinds, only: wp
  use nodal_fields, only: list_nodal_fields, nodal_field
  use quadrature, only: rule_number
  use scene, only: is_solid, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: component_names
  use system, only: base_name, file_exists, make_directory, remove_file, rename_file
  use text, only: string_t, to_text
  use xdmf_writer, only: xdmf_field_t, xdmf_grid_t, xdmf_t
  implicit none
  private
  public :: results_t, open_results, save_fields, save_failure

  type :: results_t
    !> Path of the run's files without endings, of the present generation's HDF5 file, and folder of its instants.
    character(len=:), allocatable :: stem, path, folder
    !> Step saved last, -1 before the first.
    integer :: saved_step = -1
    !> Note on the files for the user; may be unallocated.
    character(len=:), allocatable :: note
    type(xdmf_t) :: xdmf
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
    integer :: first_new, saved, g
    logical :: there

    results%stem = stem
    results%path = mesh_path(stem, scene%generation)
    results%folder = instants_folder(stem, scene%generation)
    first_new = scene%generation + merge(0, 1, new_mesh)
    if (after < 0) first_new = 1
    ! the XDMF first: at no time does it name a file that was removed
    if (after >= 0) call results%xdmf%resume(stem//'.xdmf', solution%time, base_name(mesh_path(stem, first_new)), error)
    if (allocated(error)) return
    if (results%xdmf%size() > 0) then
      call results%xdmf%write_file(stem//'.xdmf', error)
    else
      call remove_file(stem//'.xdmf', error)
    end if
    if (allocated(error)) return
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
    if (.not. file_exists(results%path)) call write_mesh(results%path, scene, error)
  end subroutine open_results

  !> A damaged file does not keep a run from going on: it is renamed.
  subroutine put_aside(path, results, error)
    character(len=*), intent(in) :: path
    type(results_t), intent(inout) :: results
    type(error_t), allocatable, intent(inout) :: error
    type(xdmf_t) :: empty

    results%note = 'note: '//error%message//'; put aside as '//path//'.damaged, its fields begin anew'
    call rename_file(path, path//'.damaged', error)
    if (.not. allocated(error)) call remove_file(results%stem//'.xdmf', error)
    results%xdmf = empty
    results%saved_step = -1
  end subroutine put_aside

  subroutine write_mesh(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer, allocatable :: topology(:, :)
    character(len=:), allocatable :: place
    integer :: g, n

    call begin_file(file, path, error)
    if (allocated(error)) return
    call solid_topology(scene, topology)
    call file%write('mesh/coordinates', scene%mesh%coordinates)
    call file%write('mesh/topology', topology)
    call file%write_attribute('/', 'title', scene%title)
    call file%write_attribute('/', 'plane_state', scene%plane_state)
    call file%write_attribute('/', 'generation', scene%generation)
    do g = 1, size(scene%groups)
      place = 'mesh/groups/'//to_text(g)
      call file%write(place//'/connectivity', scene%groups(g)%connectivity - 1)
      call file%write_attribute(place, 'name', scene%groups(g)%name)
      call file%write_attribute(place, 'elem', scene%groups(g)%elem)
      call file%write_attribute(place, 'npoint', rule_number(scene%groups(g)%rule))
    end do
    ! deformable dies are drawn with their bodies
    n = 0
    do g = 1, size(scene%dies)
      if (is_deformable(scene%dies(g))) cycle
      n = n + 1
      call file%write('dies/'//scene%dies(g)%name, scene%dies(g)%pieces)
      call file%write_attribute('dies/'//scene%dies(g)%name, 'number', n)
    end do
    call file%group('steps')
    call put_in_place(file, path, error)
  end subroutine write_mesh

  !> Nodes of all 8-node elements, counted from 0.
  pure subroutine solid_topology(scene, topology)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: topology(:, :)
    integer :: g

    allocate (topology(8, 0))
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      topology = reshape([topology, scene%groups(g)%connectivity - 1], [8, size(topology, 2) + &
                                                                        size(scene%groups(g)%connectivity, 2)])
    end do
  end subroutine solid_topology

  !> Save the accepted instant, once.
  subroutine save_fields(scene, solution, results, error, residual)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(results_t), intent(inout) :: results
    type(error_t), allocatable, intent(out) :: error
    real(wp), intent(in), optional :: residual(:, :)   !! (2, nnode) residual force of a step that failed [force]
    type(hdf5_file_t) :: file
    type(xdmf_grid_t) :: grid
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
    call file%write('coordinates', present_coordinates(scene, solution))
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
    if (present(residual)) call put_vector(file, 'residual_force', residual, grid)
    call put_nodal_fields(file, scene, solution, grid)
    if (scene%remesh%estimate) then
      call put_cells(file, 'error_stress', solution%estimate%stress_of, grid)
      call put_cells(file, 'error_strain', solution%estimate%strain_of, grid)
    end if
    call put_points(file, scene, solution)
    call put_in_place(file, path, error)
    if (.not. allocated(error)) call link_instant(results%path, results%folder, number, error)
    if (.not. allocated(error)) call results%xdmf%add(grid, error)
    if (.not. allocated(error)) call results%xdmf%write_file(results%stem//'.xdmf', error)
    if (.not. allocated(error)) results%saved_step = solution%step
  end subroutine save_fields

  !> A picture of the step that failed, in files of its own (NAME.failed.*): the last good state with the residual force.
  subroutine save_failure(scene, solution, stem, residual, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem
    real(wp), intent(in) :: residual(:, :)   !! (2, nnode) [force]
    type(error_t), allocatable, intent(out) :: error
    type(results_t) :: failed

    call open_results(scene, solution, stem//'.failed', -1, .false., failed, error)
    if (.not. allocated(error)) call save_fields(scene, solution, failed, error, residual)
  end subroutine save_failure

  !> A field on nodes, and what acts on it.
  subroutine put_field(file, field, grid)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), intent(in) :: field
    type(xdmf_grid_t), intent(inout) :: grid

    if (field%ncomp == 2) then
      call put_vector(file, field%name, field%value, grid)
      call put_vector(file, field%dual, field%applied, grid)
    else
      call put_scalar(file, field%name, field%value(1, :), grid)
      if (.not. field%given) call put_scalar(file, field%dual, field%applied(1, :), grid)
    end if
  end subroutine put_field

  subroutine put_scalar(file, name, values, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)   !! (nnode)
    type(xdmf_grid_t), intent(inout) :: grid

    call file%write('node/'//name, values)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Scalar', 'node/'//name)]
  end subroutine put_scalar

  !> A vector at the nodes, with the third component ParaView asks for.
  subroutine put_vector(file, name, vector, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: vector(:, :)
    type(xdmf_grid_t), intent(inout) :: grid
    real(wp) :: padded(3, size(vector, 2))

    padded(1:2, :) = vector
    padded(3, :) = 0
    call file%write('node/'//name, padded)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Vector', 'node/'//name)]
  end subroutine put_vector

  !> Every component of the solid groups' states at the nodes, and von Mises' equivalent stress.
  subroutine put_nodal_fields(file, scene, solution, grid)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(xdmf_grid_t), intent(inout) :: grid
    type(string_t), allocatable :: names(:)
    integer :: k

    call list_nodal_fields(scene, names)
    do k = 1, size(names)
      call put_field(names(k)%s)
    end do

  contains

    subroutine put_field(name)
      character(len=*), intent(in) :: name
      real(wp), allocatable :: at(:)

      call nodal_field(scene, solution, name, at)
      call file%write('node/'//name, at)
      grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Scalar', 'node/'//name)]
    end subroutine put_field

  end subroutine put_nodal_fields

  !> A number for each solid element.
  subroutine put_cells(file, name, values, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)
    type(xdmf_grid_t), intent(inout) :: grid

    call file%write('element/'//name, values)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Cell', 'Scalar', 'element/'//name)]
  end subroutine put_cells

  !> State of all points of all groups, as the solver holds it.
  subroutine put_points(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable :: names(:)
    integer :: g

    do g = 1, size(scene%groups)
      if (size(scene%groups(g)%variables) == 0) cycle
      call component_names(scene%groups(g)%variables, names)
      call file%write('points/'//to_text(g)//'/state', solution%groups(g)%committed)
      call file%write('points/'//to_text(g)//'/components', names)
    end do
  end subroutine put_points

end module results
