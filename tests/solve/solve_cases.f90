!> A small scene and matrices on it, for the tests of the solver's parts.
module solve_cases
  use block_mesh, only: block_t, mesh_block
  use dies, only: finish_die
  use dofs, only: dofs_t
  use elem_api, only: elem_t
  use elem_registry, only: list_elems
  use element_loop, only: element_buffers_t
  use fields, only: mechanical_fields
  use kinds, only: wp
  use kinematics_api, only: solid_variables
  use law_cases, only: contact_material, elastic_material, law_row
  use sample_numbers, only: sample_t
  use scene, only: axisymmetric, group_t, plane_strain, role_body, role_contact, scene_t
  use solves, only: number_equations, solve_t
  use sparsity, only: pattern_t
  implicit none
  private
  public :: bar, whole_solve, two_elements, elements_of, random_buffers, dense_matrix, matrix_of_pattern

contains

  !> All fields in one solve, its equations numbered.
  subroutine whole_solve(dofs, solve)
    type(dofs_t), intent(in) :: dofs
    type(solve_t), intent(out) :: solve

    allocate (solve%own(size(dofs%fields)), source=.true.)
    call number_equations(dofs, solve)
  end subroutine whole_solve

  !> Two elements side by side (nodes 1-13), a node of no element (14), a die under both, which has its
  !> pilot at (1, -1). Held: x of the left side; driven: y of the top by multiplier 1 (0 to -0.3 in time 0
  !> to 2), the pilot's y by it too, twice as much.
  !>
  !>     9 10 11 12 13
  !>     6     7     8
  !>     1  2  3  4  5
  subroutine two_elements(scene)
    type(scene_t), intent(out) :: scene
    type(block_t) :: block
    integer :: side_first(5)
    integer, allocatable :: side_nodes(:, :), connectivity(:, :)
    real(wp), allocatable :: coordinates(:, :)

    block%corners = reshape([0.0_wp, 0.0_wp, 2.0_wp, 0.0_wp, 2.0_wp, 1.0_wp, 0.0_wp, 1.0_wp], [2, 4])
    block%divisions = [2, 1]
    call mesh_block(block, coordinates, connectivity, side_first, side_nodes)
    scene%plane_state = plane_strain
    scene%fields = mechanical_fields()
    scene%section = [1.0_wp, 0.0_wp, 0.0_wp]
    scene%kinematics_id = 1
    scene%mesh%coordinates = reshape([coordinates, 9.0_wp, 9.0_wp], [2, 14])
    allocate (scene%materials(2))
    scene%materials(1) = elastic_material()
    scene%materials(2) = contact_material(1000.0_wp, 1000.0_wp, 0.3_wp)
    scene%materials(1)%law_id = 1
    scene%materials(2)%law_id = 3

    allocate (scene%groups(2))
    scene%groups(1)%elem = 'PL8LS'
    scene%groups(1)%elem_id = 1
    scene%groups(1)%role = role_body
    scene%groups(1)%material = 1
    scene%groups(1)%rule%n = 4
    scene%groups(1)%connectivity = connectivity
    scene%groups(2)%elem = 'CNT2D'
    scene%groups(2)%elem_id = 2
    scene%groups(2)%role = role_contact
    scene%groups(2)%material = 2
    scene%groups(2)%rule%n = 2
    scene%groups(2)%die = 2
    scene%groups(2)%connectivity = side_nodes(:, side_first(1):side_first(2) - 1)

    ! two dies: nothing faces the first
    allocate (scene%dies(2))
    scene%dies(1)%name = 'idle'
    scene%dies(2)%name = 'tool'
    scene%dies(1)%pieces = reshape([-9.0_wp, -8.0_wp, 0.0_wp, -8.0_wp, 9.0_wp, -8.0_wp], [2, 3, 1])
    scene%dies(2)%pieces = reshape([-9.0_wp, -0.1_wp, 0.0_wp, -0.1_wp, 9.0_wp, -0.1_wp], [2, 3, 1])
    scene%dies(2)%pilot = [1.0_wp, -1.0_wp, 0.0_wp]
    call finish_die(scene%dies(1))
    call finish_die(scene%dies(2))

    allocate (scene%multipliers(1), scene%fixations(2), scene%die_motions(2), scene%die_forces(0), scene%forces(1), scene%probes(0))
    scene%multipliers(1)%name = 'press'
    scene%multipliers(1)%time = [0.0_wp, 1.0_wp, 2.0_wp]
    scene%multipliers(1)%value = [0.0_wp, -0.1_wp, -0.3_wp]
    scene%fixations(1)%nodes = [1, 6, 9]
    scene%fixations(1)%component = 1
    scene%fixations(2)%nodes = [9, 10, 11, 12, 13]
    scene%fixations(2)%component = 2
    scene%fixations(2)%amplitude = 1
    scene%fixations(2)%multiplier = 1
    scene%die_motions(1)%die = 1
    scene%die_motions(1)%component = 1
    scene%die_motions(1)%multiplier = 1
    scene%die_motions(2)%die = 2
    scene%die_motions(2)%component = 2
    scene%die_motions(2)%amplitude = 2
    scene%die_motions(2)%multiplier = 1
    scene%forces(1)%node = 5
    scene%forces(1)%component = 1
    scene%forces(1)%amplitude = 40
    scene%forces(1)%multiplier = 1
    scene%strategy%end_time = 2
  end subroutine two_elements

  !> The two elements alone, a bar along y about the axis; multiplier 1 stretches it: top nodes go up by -1 times it.
  subroutine bar(scene)
    type(scene_t), intent(out) :: scene
    type(group_t) :: group

    call two_elements(scene)
    scene%plane_state = axisymmetric
    scene%section = [0.0_wp, 1.0_wp, 0.0_wp]
    group = scene%groups(1)
    call solid_variables(law_row('ELA'), group%variables)
    deallocate (scene%groups)
    allocate (scene%groups(1), source=[group])
    scene%mesh%coordinates = scene%mesh%coordinates(:, :13)
    scene%fixations(2)%amplitude = -1
    scene%fixations = [scene%fixations, scene%fixations(1)]
    scene%fixations(3)%nodes = [1, 2, 3, 4, 5]
    scene%fixations(3)%component = 2
    deallocate (scene%die_motions, scene%forces)
    allocate (scene%die_motions(0), scene%forces(0))
    scene%strategy%least_step = 1.0e-3_wp
    scene%strategy%strain_bound = 1
    scene%strategy%force_norm = 1.0e-9_wp
  end subroutine bar

  function elements_of() result(elems)
    type(elem_t), allocatable :: elems(:)

    call list_elems(elems)
  end function elements_of

  !> Element forces and matrices of random numbers; matrices symmetric where the pattern is, with large diagonals.
  subroutine random_buffers(dofs, pattern, sample, buffers)
    type(dofs_t), intent(in) :: dofs
    type(pattern_t), intent(in) :: pattern
    type(sample_t), intent(inout) :: sample
    type(element_buffers_t), intent(out) :: buffers
    real(wp), allocatable :: k(:, :)
    integer :: g, e, i, n, start

    allocate (buffers%force(pattern%force_length), buffers%matrix(pattern%matrix_length))
    call sample%fill(-1.0_wp, 1.0_wp, buffers%force)
    do g = 1, size(dofs%groups)
      n = size(dofs%groups(g)%dof, 1)
      do e = 1, size(dofs%groups(g)%dof, 2)
        start = pattern%matrix_start(g) + (e - 1)*n*n
        call sample%fill(-1.0_wp, 1.0_wp, buffers%matrix(start + 1:start + n*n))
        k = reshape(buffers%matrix(start + 1:start + n*n), [n, n])
        if (pattern%symmetric) k = k + transpose(k)
        do i = 1, n
          k(i, i) = k(i, i) + 10
        end do
        buffers%matrix(start + 1:start + n*n) = reshape(k, [n*n])
      end do
    end do
  end subroutine random_buffers

  !> Matrix of all unknowns, prescribed ones too, by plain scattering.
  function dense_matrix(dofs, buffers) result(a)
    type(dofs_t), intent(in) :: dofs
    type(element_buffers_t), intent(in) :: buffers
    real(wp) :: a(dofs%ndof, dofs%ndof)
    integer :: g, e, i, j, place

    a = 0
    place = 0
    do g = 1, size(dofs%groups)
      associate (dof => dofs%groups(g)%dof)
        do e = 1, size(dof, 2)
          do j = 1, size(dof, 1)
            do i = 1, size(dof, 1)
              place = place + 1
              a(dof(i, e), dof(j, e)) = a(dof(i, e), dof(j, e)) + buffers%matrix(place)
            end do
          end do
        end do
      end associate
    end do
  end function dense_matrix

  !> Matrix of the equations from the nonzeros of a pattern.
  function matrix_of_pattern(pattern, values) result(a)
    type(pattern_t), intent(in) :: pattern
    real(wp), intent(in) :: values(:)
    real(wp) :: a(pattern%neq, pattern%neq)
    integer :: k

    a = 0
    do k = 1, pattern%nnz
      a(pattern%row(k), pattern%column(k)) = values(k)
      if (pattern%symmetric) a(pattern%column(k), pattern%row(k)) = values(k)
    end do
  end function matrix_of_pattern

end module solve_cases
