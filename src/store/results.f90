!> Fields for people: one HDF5 file per mesh generation, one XDMF over all of them.
!>
!> `NAME.gNN.h5`: mesh/ (coordinates, topology from 0, groups), dies/, steps/NNNNNN/ with the
!> coordinates reached, nodal fields (node/NAME), numbers of elements (element/NAME) and the raw state of the points (points/GROUP).
module results
  use dies, only: is_deformable
  use errors, only: error_t
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use nodal_average, only: add_to_nodes
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use state_variables, only: component_names
  use system, only: base_name, file_exists, rename_file
  use text, only: string_t, to_text
  use xdmf_writer, only: xdmf_field_t, xdmf_grid_t, xdmf_t
  implicit none
  private
  public :: results_t, open_results, save_fields, save_failure

  type :: results_t
    !> Path of the run's files without endings, of the present generation's HDF5 file, and the XDMF.
    character(len=:), allocatable :: stem, path
    !> Step saved last, -1 before the first.
    integer :: saved_step = -1
    !> What the user should know of the files; may be unallocated.
    character(len=:), allocatable :: note
    type(xdmf_t) :: xdmf
  end type results_t

contains

  !> Begin the files of this generation, or take them up again after the step of a checkpoint.
  subroutine open_results(scene, solution, stem, resume, results, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem
    logical, intent(in) :: resume
    type(results_t), intent(out) :: results
    type(error_t), allocatable, intent(out) :: error
    logical :: there

    results%stem = stem
    results%path = stem//'.g'//two_digits(scene%generation)//'.h5'
    if (resume) then
      call results%xdmf%resume(stem//'.xdmf', solution%time, error)
      if (allocated(error)) return
    end if
    there = file_exists(results%path)
    if (resume .and. there) then
      call forget_later_steps(results%path, solution%step, results%saved_step, error)
      if (allocated(error)) call begin_again(scene, results, error)
    else
      call write_mesh(results%path, scene, error)
    end if
  end subroutine open_results

  !> A fields file that was damaged (a full disk, a kill in the middle of a save) does not keep a run from
  !> going on: it is put aside under another name, and a new one begins.
  subroutine begin_again(scene, results, error)
    type(scene_t), intent(in) :: scene
    type(results_t), intent(inout) :: results
    type(error_t), allocatable, intent(inout) :: error
    type(xdmf_t) :: empty

    results%note = 'note: '//error%message//'; put aside as '//results%path//'.damaged, fields begin anew'
    call rename_file(results%path, results%path//'.damaged', error)
    if (allocated(error)) return
    results%xdmf = empty
    results%saved_step = -1
    call write_mesh(results%path, scene, error)
  end subroutine begin_again

  !> Steps saved after the checkpoint are made again: take them out. `saved` is the checkpoint's own step if it is there.
  subroutine forget_later_steps(path, step, saved, error)
    character(len=*), intent(in) :: path
    integer, intent(in) :: step
    integer, intent(out) :: saved
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(string_t), allocatable :: names(:)
    integer :: k, number, status

    saved = -1
    call file%open_append(path, error)
    if (allocated(error)) return
    if (file%has('steps')) then
      call file%list('steps', names)
      do k = 1, size(names)
        read (names(k)%s, *, iostat=status) number
        if (status /= 0) cycle
        if (number > step) call file%remove('steps/'//names(k)%s)
        if (number == step) saved = step
      end do
    end if
    call file%close(error)
  end subroutine forget_later_steps

  subroutine write_mesh(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer, allocatable :: topology(:, :)
    character(len=:), allocatable :: place
    integer :: g, n

    call file%create(path, error)
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
      call file%write_attribute(place, 'npoint', scene%groups(g)%npoint)
    end do
    ! deformable dies are drawn with their bodies
    n = 0
    do g = 1, size(scene%dies)
      if (is_deformable(scene%dies(g))) cycle
      n = n + 1
      call file%write('dies/'//scene%dies(g)%name, scene%dies(g)%pieces)
      call file%write_attribute('dies/'//scene%dies(g)%name, 'number', n)
    end do
    call file%close(error)
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
    real(wp), intent(in), optional :: residual(:, :)  !! residual force of a step that failed (2, nnode)
    type(hdf5_file_t) :: file
    type(xdmf_grid_t) :: grid
    character(len=:), allocatable :: place
    character(len=6) :: number
    integer, allocatable :: rigid(:)
    integer :: nnode, g

    if (results%saved_step == solution%step) return
    nnode = size(scene%mesh%coordinates, 2)
    write (number, '(i6.6)') solution%step
    place = 'steps/'//number
    call file%open_append(results%path, error)
    if (allocated(error)) return
    call file%write(place//'/coordinates', scene%mesh%coordinates + solution%displacement)
    call file%write_attribute(place, 'time', solution%time)
    call file%write_attribute(place, 'step', solution%step)
    rigid = pack([(g, g=1, size(scene%dies))],.not. is_deformable(scene%dies))
    if (size(rigid) > 0) call file%write(place//'/pilots', solution%pilots(:, rigid))
    grid%time = solution%time
    grid%file = base_name(results%path)
    grid%geometry = place//'/coordinates'
    grid%nnode = nnode
    grid%topology = 'mesh/topology'
    allocate (grid%fields(0))
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) grid%nelement = grid%nelement + size(scene%groups(g)%connectivity, 2)
    end do
    call put_vector(file, place, 'displacement', solution%displacement, grid)
    call put_vector(file, place, 'applied_force', solution%applied, grid)
    if (present(residual)) call put_vector(file, place, 'residual_force', residual, grid)
    call put_nodal_fields(file, place, scene, solution, grid)
    if (scene%remesh%estimate) then
      call put_cells(file, place, 'error_stress', solution%estimate%stress_of, grid)
      call put_cells(file, place, 'error_strain', solution%estimate%strain_of, grid)
    end if
    call put_points(file, place, scene, solution)
    call file%close(error)
    if (.not. allocated(error)) call results%xdmf%add(grid, error)
    if (.not. allocated(error)) call results%xdmf%write_file(results%stem//'.xdmf', error)
    if (.not. allocated(error)) results%saved_step = solution%step
  end subroutine save_fields

  !> A picture of the step that failed, in files of its own (NAME.failed.*): the last good state with the residual force.
  subroutine save_failure(scene, solution, stem, residual, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: stem
    real(wp), intent(in) :: residual(:, :)
    type(error_t), allocatable, intent(out) :: error
    type(results_t) :: failed

    call open_results(scene, solution, stem//'.failed', .false., failed, error)
    if (.not. allocated(error)) call save_fields(scene, solution, failed, error, residual)
  end subroutine save_failure

  !> A vector at the nodes, with the third component ParaView asks for.
  subroutine put_vector(file, place, name, vector, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place, name
    real(wp), intent(in) :: vector(:, :)
    type(xdmf_grid_t), intent(inout) :: grid
    real(wp) :: padded(3, size(vector, 2))

    padded(1:2, :) = vector
    padded(3, :) = 0
    call file%write(place//'/node/'//name, padded)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Vector', place//'/node/'//name)]
  end subroutine put_vector

  !> Every component of the solid groups' states at the nodes, and von Mises' equivalent stress.
  subroutine put_nodal_fields(file, place, scene, solution, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(xdmf_grid_t), intent(inout) :: grid
    type(string_t), allocatable :: names(:), done(:)
    integer :: g, c

    allocate (done(0))
    call put_field('mises', 0)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      call component_names(scene%groups(g)%variables, names)
      do c = 1, size(names)
        if (any_is(done, names(c)%s)) cycle
        call put_field(names(c)%s, 1)
        done = [done, names(c)]
      end do
    end do

  contains

    subroutine put_field(name, kind)
      character(len=*), intent(in) :: name
      integer, intent(in) :: kind
      real(wp) :: at(size(scene%mesh%coordinates, 2)), count_at(size(scene%mesh%coordinates, 2))
      type(string_t), allocatable :: own(:)
      integer :: h, k

      at = 0
      count_at = 0
      do h = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(h))) cycle
        associate (state => solution%groups(h)%committed, nodes => scene%groups(h)%connectivity)
          if (kind == 0) then
            call add_to_nodes(nodes, mises(state(1:4, :, :)), at, count_at)
          else
            call component_names(scene%groups(h)%variables, own)
            do k = 1, size(own)
              if (own(k)%s == name) call add_to_nodes(nodes, state(k, :, :), at, count_at)
            end do
          end if
        end associate
      end do
      where (count_at > 0) at = at/count_at
      call file%write(place//'/node/'//name, at)
      grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Scalar', place//'/node/'//name)]
    end subroutine put_field

  end subroutine put_nodal_fields

  !> A number for each solid element.
  subroutine put_cells(file, place, name, values, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place, name
    real(wp), intent(in) :: values(:)
    type(xdmf_grid_t), intent(inout) :: grid

    call file%write(place//'/element/'//name, values)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Cell', 'Scalar', place//'/element/'//name)]
  end subroutine put_cells

  !> State of all points of all groups, as the solver holds it.
  subroutine put_points(file, place, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable :: names(:)
    integer :: g

    do g = 1, size(scene%groups)
      if (size(scene%groups(g)%variables) == 0) cycle
      call component_names(scene%groups(g)%variables, names)
      call file%write(place//'/points/'//to_text(g)//'/state', solution%groups(g)%committed)
      call file%write(place//'/points/'//to_text(g)//'/components', names)
    end do
  end subroutine put_points

  !> von Mises' equivalent stress of stresses (4, npoint, nelem).
  pure function mises(stress) result(q)
    real(wp), intent(in) :: stress(:, :, :)
    real(wp) :: q(size(stress, 2), size(stress, 3))

    q = sqrt(0.5_wp*((stress(1, :, :) - stress(2, :, :))**2 + (stress(2, :, :) - stress(4, :, :))**2 &
                     + (stress(4, :, :) - stress(1, :, :))**2) + 3*stress(3, :, :)**2)
  end function mises

  pure function any_is(words, word) result(found)
    type(string_t), intent(in) :: words(:)
    character(len=*), intent(in) :: word
    logical :: found
    integer :: k

    found = .false.
    do k = 1, size(words)
      found = found .or. words(k)%s == word
    end do
  end function any_is

  pure function two_digits(n) result(s)
    integer, intent(in) :: n
    character(len=2) :: s

    write (s, '(i2.2)') n
  end function two_digits

end module results
