!> A grid saved at one step as XDMF has it: its geometry, its topology and its fields, whose arrays stay in HDF5 files.
!>
!> Arrays have the natural Fortran order, which XDMF sees reversed:
!> coordinates (2, nodes), topology (8, elements) with nodes counted from 0, corners first, then the
!> mid-side nodes as in `shape_functions`; fields (components, nodes) or (components, elements).
!> ParaView wants 3 components of a vector (the third 0) and of a symmetric tensor
!> (xx, xy, xz, yy, yz, zz).
module xdmf_grid
  use errors, only: error_t, exit_bug, fail
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: xdmf_field_t, xdmf_grid_t, escaped, grid_text, nl

  !> A field on a grid.
  type :: xdmf_field_t
    character(len=:), allocatable :: name     !! shown to the user
    character(len=:), allocatable :: center   !! Node or Cell
    character(len=:), allocatable :: kind     !! Scalar, Vector (3), Tensor6 (6) or Tensor (9 components)
    character(len=:), allocatable :: dataset  !! path in the HDF5 file
    logical :: is_integer = .false.           !! 32-bit integers rather than doubles
    logical :: of_mesh = .false.              !! the dataset is in the file of the topology
    !> Of a scalar that is a component of an array of these extents, as Fortran has them: which one; 0 where it is all of the array.
    integer :: component = 0
    integer :: extents(3) = 0
  end type xdmf_field_t

  !> The grid saved at one step; points alone where there is no topology.
  type :: xdmf_grid_t
    real(wp) :: time = 0
    character(len=:), allocatable :: label     !! shown to the user; unallocated = mesh
    character(len=:), allocatable :: file      !! HDF5 file, relative to the directory of the XDMF file
    character(len=:), allocatable :: mesh_file !! that of the topology; unallocated = the same
    character(len=:), allocatable :: geometry  !! dataset of coordinates
    integer :: nnode = 0
    integer :: ndim = 2                        !! coordinates per node: 2 or 3
    character(len=:), allocatable :: topology  !! dataset of nodes per element
    integer :: nelement = 0
    character(len=:), allocatable :: shape     !! XDMF's name; unallocated = Quadrilateral_8
    integer :: nodes_per_element = 8
    type(xdmf_field_t), allocatable :: fields(:)
  end type xdmf_grid_t

  character(len=*), parameter :: nl = new_line('a')

contains

  !> A grid with its fields, from the column of `indent` on.
  pure subroutine grid_text(grid, indent, time, s, error)
    type(xdmf_grid_t), intent(in) :: grid
    character(len=*), intent(in) :: indent, time   !! the line of the time may be empty
    character(len=:), allocatable, intent(out) :: s
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: shape, mesh_file, label
    integer :: i

    label = 'mesh'
    if (allocated(grid%label)) label = grid%label
    shape = 'Quadrilateral_8'
    if (allocated(grid%shape)) shape = grid%shape
    mesh_file = grid%file
    if (allocated(grid%mesh_file)) mesh_file = grid%mesh_file
    s = indent//'<Grid Name="'//escaped(label)//'" GridType="Uniform">'//nl//time// &
      '    <Geometry GeometryType="'//trim(merge('XY ', 'XYZ', grid%ndim == 2))//'">'//nl// &
      data_item(grid%file, grid%geometry, grid%nnode, grid%ndim, .false.)//'    </Geometry>'//nl
    if (allocated(grid%topology)) then
      s = s//'    <Topology TopologyType="'//shape//'" NumberOfElements="'//to_text(grid%nelement)//'">'//nl// &
        data_item(mesh_file, grid%topology, grid%nelement, grid%nodes_per_element, .true.)//'    </Topology>'//nl
    else
      s = s//'    <Topology TopologyType="Polyvertex" NumberOfElements="'//to_text(grid%nnode)//'"/>'//nl
    end if
    if (allocated(grid%fields)) then
      do i = 1, size(grid%fields)
        call check_field(grid%fields(i), error)
        if (allocated(error)) return
        s = s//field_text(grid, grid%fields(i), mesh_file)
      end do
    end if
    s = s//indent//'</Grid>'//nl
  end subroutine grid_text

  !> One field as XDMF has it.
  pure function field_text(grid, field, mesh_file) result(s)
    type(xdmf_grid_t), intent(in) :: grid
    type(xdmf_field_t), intent(in) :: field
    character(len=*), intent(in) :: mesh_file
    character(len=:), allocatable :: s, file
    integer :: n

    n = grid%nnode
    if (field%center == 'Cell') n = grid%nelement
    file = grid%file
    if (field%of_mesh) file = mesh_file
    s = '    <Attribute Name="'//escaped(field%name)//'" AttributeType="'//field%kind//'" Center="'//field%center//'">'//nl
    if (field%component > 0) then
      s = s//component_item(file, field)
    else
      s = s//data_item(file, field%dataset, n, components(field%kind), field%is_integer)
    end if
    s = s//'    </Attribute>'//nl
  end function field_text

  !> One component of an array of three extents: start, stride and count of XDMF's hyperslab, slowest first.
  pure function component_item(file, field) result(s)
    character(len=*), intent(in) :: file
    type(xdmf_field_t), intent(in) :: field
    character(len=:), allocatable :: s, rows

    associate (n => field%extents)
      rows = to_text(n(3))//' '//to_text(n(2))
      s = '     <DataItem ItemType="HyperSlab" Dimensions="'//rows//' 1">'//nl// &
        '      <DataItem Format="XML" Dimensions="3 3">0 0 '//to_text(field%component - 1)//' 1 1 1 '//rows//' 1</DataItem>'//nl// &
        '      <DataItem Format="HDF" Dimensions="'//rows//' '//to_text(n(1))//'" NumberType="Float" Precision="8">'// &
        escaped(file)//':/'//escaped(field%dataset)//'</DataItem>'//nl//'     </DataItem>'//nl
    end associate
  end function component_item

  !> Where an array lies and how large it is: `n` rows, of several columns unless `ncomponent` is 1.
  pure function data_item(file, dataset, n, ncomponent, is_integer) result(s)
    character(len=*), intent(in) :: file, dataset
    integer, intent(in) :: n, ncomponent
    logical, intent(in) :: is_integer
    character(len=:), allocatable :: s

    s = to_text(n)
    if (ncomponent > 1) s = s//' '//to_text(ncomponent)
    s = '     <DataItem Format="HDF" Dimensions="'//s//'" '
    if (is_integer) then
      s = s//'NumberType="Int" Precision="4">'
    else
      s = s//'NumberType="Float" Precision="8">'
    end if
    s = s//escaped(file)//':'
    if (index(dataset, '/') /= 1) s = s//'/'
    s = s//escaped(dataset)//'</DataItem>'//nl
  end function data_item

  !> Components of a kind of field, 0 when it is unknown.
  pure function components(kind) result(n)
    character(len=*), intent(in) :: kind
    integer :: n

    select case (kind)
    case ('Scalar')
      n = 1
    case ('Vector')
      n = 3
    case ('Tensor6')
      n = 6
    case ('Tensor')
      n = 9
    case default
      n = 0
    end select
  end function components

  !> Refuse what ParaView would not understand.
  pure subroutine check_field(field, error)
    type(xdmf_field_t), intent(in) :: field
    type(error_t), allocatable, intent(out) :: error

    if (components(field%kind) == 0) then
      call fail(error, exit_bug, "XDMF field '"//field%name//"': kind '"//field%kind//"' is not Scalar, Vector, Tensor6 or Tensor")
    else if (field%center /= 'Node' .and. field%center /= 'Cell') then
      call fail(error, exit_bug, "XDMF field '"//field%name//"': center '"//field%center//"' is neither Node nor Cell")
    end if
  end subroutine check_field

  !> Text with XML's own characters escaped.
  pure function escaped(text) result(s)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: s
    integer :: i

    s = ''
    do i = 1, len(text)
      select case (text(i:i))
      case ('&')
        s = s//'&amp;'
      case ('<')
        s = s//'&lt;'
      case ('>')
        s = s//'&gt;'
      case ('"')
        s = s//'&quot;'
      case default
        s = s//text(i:i)
      end select
    end do
  end function escaped

end module xdmf_grid
