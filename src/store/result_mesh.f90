!> The file of a mesh among the results: mesh, groups, dies. Its layout is described in decks/RESULTS.md.
module result_mesh
  use dies, only: is_deformable
  use atomic, only: copy_to_temporary, temporary_name
  use errors, only: error_t
  use hdf5_file, only: hdf5_file_t
  use instant_files, only: begin_file, put_in_place
  use quadrature, only: rule_name, rule_number
  use result_dies, only: write_die_topology
  use scene, only: group_t, is_solid, scene_t
  use text, only: to_text
  implicit none
  private
  public :: complete_mesh, write_mesh, mark_format

  !> Raised when a program that reads these files must know.
  character(len=*), parameter :: format_name = 'lagamine results'
  integer, parameter :: format_version = 1

contains

  !> What the file is.
  subroutine mark_format(file)
    type(hdf5_file_t), intent(inout) :: file

    call file%write_attribute('/', 'format', format_name)
    call file%write_attribute('/', 'format_version', format_version)
  end subroutine mark_format

  !> Write the file of the scene's mesh.
  subroutine write_mesh(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer, allocatable :: topology(:, :)
    integer :: g, n

    call begin_file(file, path, error)
    if (allocated(error)) return
    call solid_topology(scene, topology)
    call mark_format(file)
    call file%write('mesh/coordinates', scene%mesh%coordinates)
    call file%write_attribute('mesh/coordinates', 'unit', 'length')
    call file%write('mesh/topology', topology)
    call file%write_attribute('/', 'title', scene%title)
    call file%write_attribute('/', 'plane_state', scene%plane_state)
    call file%write_attribute('/', 'generation', scene%generation)
    do g = 1, size(scene%groups)
      call write_group(file, g, scene%groups(g))
    end do
    ! deformable dies are drawn with their bodies
    n = 0
    do g = 1, size(scene%dies)
      if (is_deformable(scene%dies(g))) cycle
      n = n + 1
      call file%write('dies/'//scene%dies(g)%name, scene%dies(g)%pieces)
      call file%write_attribute('dies/'//scene%dies(g)%name, 'number', n)
      call file%write_attribute('dies/'//scene%dies(g)%name, 'unit', 'length')
    end do
    call write_die_topology(file, scene%dies)
    call file%group('steps')
    call put_in_place(file, path, error)
  end subroutine write_mesh

  !> Add to the file of a mesh what groups the scene has since it was written.
  subroutine complete_mesh(path, scene, error)
    character(len=*), intent(in) :: path
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    integer :: g, known

    call file%open(path, error)
    if (allocated(error)) return
    do known = size(scene%groups), 1, -1
      if (file%has(place_of(known))) exit
    end do
    call file%close(error)
    if (allocated(error) .or. known == size(scene%groups)) return
    call copy_to_temporary(path, error)
    if (.not. allocated(error)) call file%open_append(temporary_name(path), error)
    if (allocated(error)) return
    do g = known + 1, size(scene%groups)
      call write_group(file, g, scene%groups(g))
    end do
    call put_in_place(file, path, error)
  end subroutine complete_mesh

  subroutine write_group(file, g, group)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: g
    type(group_t), intent(in) :: group

    call file%write(place_of(g)//'/connectivity', group%connectivity - 1)
    call file%write_attribute(place_of(g), 'name', group%name)
    call file%write_attribute(place_of(g), 'elem', group%elem)
    call file%write_attribute(place_of(g), 'npoint', rule_number(group%rule))
    call file%write_attribute(place_of(g), 'rule', rule_name(group%rule))
  end subroutine write_group

  pure function place_of(g)
    integer, intent(in) :: g   !! number of the group
    character(len=:), allocatable :: place_of

    place_of = 'mesh/groups/'//to_text(g)
  end function place_of

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

end module result_mesh
