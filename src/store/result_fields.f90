!> Fields of an instant among the results: at nodes, of elements, and the state at the points, each with its unit.
module result_fields
  use fields, only: field_t
  use hardness, only: has_hardness
  use hdf5_file, only: hdf5_file_t
  use heat_record, only: finer_share
  use kinds, only: wp
  use nodal_fields, only: error_prefix, list_nodal_fields, nodal_field
  use phase_state, only: at_hardness, state_names
  use quadrature, only: square_rule
  use scene, only: scene_t
  use shape_functions, only: quad8
  use solution, only: solution_t
  use state_variables, only: component_names, state_variable_t, total_components
  use steels, only: phase_count
  use text, only: add_text, string_t, to_text
  use xdmf_grid, only: xdmf_field_t, xdmf_grid_t
  implicit none
  private
  public :: put_field, put_vector, put_nodal_fields, put_cells, put_points

contains

  !> A field on nodes, and what acts on it.
  subroutine put_field(file, field, grid)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), intent(in) :: field
    type(xdmf_grid_t), intent(inout) :: grid

    if (field%ncomp == 2) then
      call put_vector(file, field%name, field%value, field%unit, grid)
      call put_vector(file, field%dual, field%applied, field%dual_unit, grid)
    else
      call put_scalar(file, field%name, field%value(1, :), field%unit, grid)
      if (.not. field%given) call put_scalar(file, field%dual, field%applied(1, :), field%dual_unit, grid)
    end if
  end subroutine put_field

  subroutine put_scalar(file, name, values, unit, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)   !! (nnode) [unit]
    character(len=*), intent(in) :: unit
    type(xdmf_grid_t), intent(inout) :: grid

    call file%write('node/'//name, values)
    call file%write_attribute('node/'//name, 'unit', unit)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Scalar', 'node/'//name)]
  end subroutine put_scalar

  !> A vector at the nodes, with the third component ParaView asks for.
  subroutine put_vector(file, name, vector, unit, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: vector(:, :)   !! (2, nnode) [unit]
    character(len=*), intent(in) :: unit
    type(xdmf_grid_t), intent(inout) :: grid
    real(wp) :: padded(3, size(vector, 2))

    padded(1:2, :) = vector
    padded(3, :) = 0
    call file%write('node/'//name, padded)
    call file%write_attribute('node/'//name, 'unit', unit)
    grid%fields = [grid%fields, xdmf_field_t(name, 'Node', 'Vector', 'node/'//name)]
  end subroutine put_vector

  !> Every component of the solid groups' states at the nodes, and von Mises' equivalent stress.
  subroutine put_nodal_fields(file, scene, solution, grid)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(xdmf_grid_t), intent(inout) :: grid
    type(string_t), allocatable :: names(:)
    real(wp), allocatable :: at(:)
    integer :: k

    call list_nodal_fields(scene, names)
    do k = 1, size(names)
      call nodal_field(scene, solution, names(k)%s, at)
      call put_scalar(file, names(k)%s, at, unit_of(scene, names(k)%s), grid)
    end do
    if (solution%heat%space_steps == 0) return
    at = finer_share*solution%heat%finer(:size(scene%mesh%coordinates, 2))
    call put_scalar(file, 'error_temperature', at, 'temperature', grid)
    call list_errors_of_phases(scene, solution, names)
    do k = 1, size(names)
      call nodal_field(scene, solution, error_prefix//names(k)%s, at)
      call put_scalar(file, error_prefix//names(k)%s, at, unit_of(scene, names(k)%s), grid)
    end do
  end subroutine put_nodal_fields

  !> Fractions of phases, and the hardness of steels that have one, whose errors by temperatures in space are followed.
  pure subroutine list_errors_of_phases(scene, solution, names)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(out) :: names(:)   !! (nname)
    logical :: followed, hard
    integer :: g, i

    followed = .false.
    hard = .false.
    do g = 1, size(scene%groups)
      if (size(solution%groups(g)%space_error) == 0) cycle
      followed = .true.
      hard = hard .or. has_hardness(scene%materials(scene%groups(g)%material)%steel)
    end do
    allocate (names(0))
    if (.not. followed) return
    do i = 1, phase_count
      call add_text(names, trim(state_names(i)))
    end do
    if (hard) call add_text(names, trim(state_names(at_hardness)))
  end subroutine list_errors_of_phases

  !> Unit of a component of the state of a body; that of von Mises' stress, which is none.
  pure function unit_of(scene, name) result(unit)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unit
    type(string_t), allocatable :: names(:), units(:)
    integer :: g, k

    unit = 'stress'
    do g = 1, size(scene%groups)
      call component_names(scene%groups(g)%variables, names)
      call component_units(scene%groups(g)%variables, units)
      do k = 1, size(names)
        if (names(k)%s == name) unit = units(k)%s
      end do
    end do
  end function unit_of

  !> Units of all components, as component_names has them.
  pure subroutine component_units(variables, units)
    type(state_variable_t), intent(in) :: variables(:)     !! (nvariable)
    type(string_t), allocatable, intent(out) :: units(:)   !! (ncomponent)
    integer :: i, c, n

    allocate (units(total_components(variables)))
    n = 0
    do i = 1, size(variables)
      do c = 1, variables(i)%ncomp
        n = n + 1
        units(n)%s = variables(i)%unit
      end do
    end do
  end subroutine component_units

  !> A number for each solid element.
  subroutine put_cells(file, name, values, grid)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)   !! (nelement) [-]
    type(xdmf_grid_t), intent(inout) :: grid

    call file%write('element/'//name, values)
    call file%write_attribute('element/'//name, 'unit', '-')
    grid%fields = [grid%fields, xdmf_field_t(name, 'Cell', 'Scalar', 'element/'//name)]
  end subroutine put_cells

  !> State of all points of all groups, as the solver holds it; of bodies also where the points are, and a grid of each for programs
  !> that draw them.
  subroutine put_points(file, scene, solution, x, instant, grids)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :)             !! (2, nnode) coordinates reached [length]
    type(xdmf_grid_t), intent(in) :: instant    !! its time and file
    type(xdmf_grid_t), allocatable, intent(out) :: grids(:)   !! (nbody)
    type(string_t), allocatable :: names(:), units(:)
    type(xdmf_grid_t) :: grid
    character(len=:), allocatable :: place
    integer :: g, c

    allocate (grids(0))
    do g = 1, size(scene%groups)
      if (size(scene%groups(g)%variables) == 0) cycle
      call component_names(scene%groups(g)%variables, names)
      call component_units(scene%groups(g)%variables, units)
      place = 'points/'//to_text(g)
      call file%write(place//'/state', solution%groups(g)%committed)
      call file%write(place//'/components', names)
      call file%write(place//'/units', units)
      if (size(scene%groups(g)%connectivity, 1) /= 8) cycle
      call file%write(place//'/coordinates', points_of(scene%groups(g)%connectivity, size(solution%groups(g)%committed, 2), x))
      call file%write_attribute(place//'/coordinates', 'unit', 'length')
      grid%label = scene%groups(g)%name
      grid%time = instant%time
      grid%file = instant%file
      grid%geometry = place//'/coordinates'
      grid%nnode = size(solution%groups(g)%committed(1, :, :))
      if (allocated(grid%fields)) deallocate (grid%fields)
      allocate (grid%fields(size(names)))
      do c = 1, size(names)
        grid%fields(c)%name = names(c)%s
        grid%fields(c)%center = 'Node'
        grid%fields(c)%kind = 'Scalar'
        grid%fields(c)%dataset = place//'/state'
        grid%fields(c)%component = c
        grid%fields(c)%extents = shape(solution%groups(g)%committed)
      end do
      grids = [grids, grid]
    end do
  end subroutine put_points

  !> Where the integration points of elements are, those of an element one after the other.
  pure function points_of(connectivity, npoint, x) result(places)
    integer, intent(in) :: connectivity(:, :)   !! (8, nelement)
    integer, intent(in) :: npoint
    real(wp), intent(in) :: x(:, :)             !! (2, nnode) [length]
    real(wp) :: places(2, npoint*size(connectivity, 2))   !! [length]
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8, npoint), dphi(2, 8)
    integer :: p, e

    call square_rule(npoint, xi, weight)
    do p = 1, npoint
      call quad8(xi(1, p), xi(2, p), phi(:, p), dphi)
    end do
    do e = 1, size(connectivity, 2)
      places(:, (e - 1)*npoint + 1:e*npoint) = matmul(x(:, connectivity(:, e)), phi)
    end do
  end function points_of

end module result_fields
