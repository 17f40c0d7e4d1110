!> The file of a mesh among the results: mesh, groups, dies. Its layout is described in decks/RESULTS.md.
module result_mesh
  use dies, only: is_deformable
  use errors, only: error_t
  use hdf5_file, only: hdf5_file_t
  use instant_files, only: begin_file, put_in_place
  use quadrature, only: rule_name, rule_number
  use result_dies, only: write_die_topology
  use scene, only: is_solid, scene_t
  use text, only: to_text
  implicit none
  private
  public :: write_mesh, mark_format

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
    character(len=:), allocatable :: place
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
      place = 'mesh/groups/'//to_text(g)
      call file%write(place//'/connectivity', scene%groups(g)%connectivity - 1)
      call file%write_attribute(place, 'name', scene%groups(g)%name)
      call file%write_attribute(place, 'elem', scene%groups(g)%elem)
      call file%write_attribute(place, 'npoint', rule_number(scene%groups(g)%rule))
      call file%write_attribute(place, 'rule', rule_name(scene%groups(g)%rule))
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
