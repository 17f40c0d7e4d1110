!> The solid elements of a scene with their state.
!>
!> The state of a body is that of its own formulation and of all further ones on the same points (heat with phases). Variables of
!> the latter are known here by the name of their element and their own, `PL8TM austenite`: names may be the same in both.
module state_pieces
  use kinds, only: wp
  use scene, only: axisymmetric, is_solid, role_second, scene_t
  use solution, only: present_coordinates, solution_t
  use state_variables, only: name_of_ratio, state_variable_t, total_components
  use transfer_mesh, only: set_up_mesh, transfer_mesh_t
  implicit none
  private
  public :: state_group_t, state_pieces_t, solid_pieces, take_values, store_states, mesh_of, change_volume_ratios

  !> Elements with the same state variables.
  type :: state_group_t
    !> Values are exchanged between groups of the same number (one material, one body).
    integer :: material = 0
    !> Points of an element.
    integer :: npoint = 0
    integer, allocatable :: connectivity(:, :)   !! (8, nelem)
    type(state_variable_t), allocatable :: variables(:)
    real(wp), allocatable :: values(:, :, :)   !! (component, point, element)
    !> Number of the group in its scene.
    integer :: scene_group = 0
    !> Groups of the scene whose states these are, the body first, and the first component of each.
    integer, allocatable :: parts(:), rows(:)
  end type state_group_t

  type :: state_pieces_t
    real(wp), allocatable :: nodes(:, :)   !! (2, nnode), where they are now [length]
    logical :: axisymmetric = .false.
    type(state_group_t), allocatable :: groups(:)
  end type state_pieces_t

contains

  !> Solid groups of a scene in its initial position or, with a solution, its present one. Groups of the same materials that share
  !> nodes have one number, that of the first of them: bodies of one material that only touch are kept apart.
  pure subroutine solid_pieces(scene, pieces, solution)
    type(scene_t), intent(in) :: scene
    type(state_pieces_t), intent(out) :: pieces
    type(solution_t), intent(in), optional :: solution
    logical :: touched(size(scene%mesh%coordinates, 2))
    integer :: g, k, other, nsolid, low, high

    allocate (pieces%nodes, source=scene%mesh%coordinates)
    if (present(solution)) pieces%nodes = present_coordinates(scene, solution)
    pieces%axisymmetric = scene%plane_state == axisymmetric
    nsolid = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) nsolid = nsolid + 1
    end do
    allocate (pieces%groups(nsolid))
    k = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      k = k + 1
      associate (group => pieces%groups(k))
        group%scene_group = g
        group%material = k
        group%npoint = scene%groups(g)%rule%n
        allocate (group%connectivity, source=scene%groups(g)%connectivity)
        call list_parts(scene, group)
        if (present(solution)) call take_values(solution, group)
      end associate
    end do
    do k = 2, nsolid
      touched = .false.
      call touch(pieces%groups(k)%connectivity, touched)
      do other = 1, k - 1
        if (.not. alike(scene, pieces%groups(k), pieces%groups(other))) cycle
        if (.not. touches(pieces%groups(other)%connectivity, touched)) cycle
        low = min(pieces%groups(k)%material, pieces%groups(other)%material)
        high = max(pieces%groups(k)%material, pieces%groups(other)%material)
        do g = 1, k
          if (pieces%groups(g)%material == high) pieces%groups(g)%material = low
        end do
      end do
    end do
  end subroutine solid_pieces

  !> The formulations on a body that have a state, and their variables one after the other.
  pure subroutine list_parts(scene, group)
    type(scene_t), intent(in) :: scene
    type(state_group_t), intent(inout) :: group   !! its scene_group is set
    type(state_variable_t), allocatable :: variables(:), list(:)
    integer :: s, v, n

    allocate (variables, source=scene%groups(group%scene_group)%variables)
    allocate (group%parts(1), source=group%scene_group)
    allocate (group%rows(1), source=1)
    do s = 1, size(scene%groups)
      if (scene%groups(s)%role /= role_second .or. scene%groups(s)%host /= group%scene_group) cycle
      if (size(scene%groups(s)%variables) == 0) cycle
      n = total_components(variables)
      group%parts = [group%parts, s]
      group%rows = [group%rows, n + 1]
      allocate (list(size(variables) + size(scene%groups(s)%variables)))
      list(:size(variables)) = variables
      do v = 1, size(scene%groups(s)%variables)
        associate (variable => list(size(variables) + v))
          variable = scene%groups(s)%variables(v)
          variable%name = scene%groups(s)%elem//' '//variable%name
          variable%first = n + variable%first
        end associate
      end do
      call move_alloc(list, variables)
    end do
    call move_alloc(variables, group%variables)
  end subroutine list_parts

  !> Values of all parts of a group.
  pure subroutine take_values(solution, group)
    type(solution_t), intent(in) :: solution
    type(state_group_t), intent(inout) :: group
    integer :: p

    allocate (group%values(total_components(group%variables), group%npoint, size(group%connectivity, 2)))
    do p = 1, size(group%parts)
      associate (state => solution%groups(group%parts(p))%committed)
        group%values(group%rows(p):group%rows(p) + size(state, 1) - 1, :, :) = state
      end associate
    end do
  end subroutine take_values

  !> Two bodies are of the same materials, in all formulations that have a state.
  pure function alike(scene, one, other) result(yes)
    type(scene_t), intent(in) :: scene
    type(state_group_t), intent(in) :: one, other
    logical :: yes

    yes = size(one%parts) == size(other%parts)
    if (yes) yes = all(scene%groups(one%parts)%material == scene%groups(other%parts)%material)
  end function alike

  pure subroutine touch(connectivity, touched)
    integer, intent(in) :: connectivity(:, :)
    logical, intent(inout) :: touched(:)
    integer :: e

    do e = 1, size(connectivity, 2)
      touched(connectivity(:, e)) = .true.
    end do
  end subroutine touch

  pure function touches(connectivity, touched) result(yes)
    integer, intent(in) :: connectivity(:, :)
    logical, intent(in) :: touched(:)
    logical :: yes
    integer :: e

    yes = .false.
    do e = 1, size(connectivity, 2)
      yes = yes .or. any(touched(connectivity(:, e)))
    end do
  end function touches

  !> The states of the pieces become those of a solution that was started on their scene.
  pure subroutine store_states(pieces, solution)
    type(state_pieces_t), intent(in) :: pieces
    type(solution_t), intent(inout) :: solution
    integer :: k, p, last

    do k = 1, size(pieces%groups)
      associate (group => pieces%groups(k))
        do p = 1, size(group%parts)
          associate (state => solution%groups(group%parts(p)))
            last = group%rows(p) + size(state%committed, 1) - 1
            state%committed = group%values(group%rows(p):last, :, :)
            state%trial = state%committed
          end associate
        end do
      end associate
    end do
  end subroutine store_states

  !> Volume ratios at the start of the next mesh: those of this one, times what the volume has changed on it.
  pure subroutine change_volume_ratios(before, now, pieces)
    real(wp), intent(in) :: before(:), now(:)   !! (npoint) volumes of the points of all groups in sequence [volume]
    type(state_pieces_t), intent(inout) :: pieces
    integer :: g, k, v, e, p, n

    n = 0
    do g = 1, size(pieces%groups)
      associate (group => pieces%groups(g))
        ! of the body itself, or of a further formulation
        k = 0
        do v = 1, size(group%variables)
          associate (name => group%variables(v)%name)
            if (name(max(1, len(name) - len(name_of_ratio) + 1):) == name_of_ratio) k = group%variables(v)%first
          end associate
        end do
        do e = 1, size(group%connectivity, 2)
          do p = 1, group%npoint
            n = n + 1
            if (k > 0) group%values(k, p, e) = group%values(k, p, e)*now(n)/before(n)
          end do
        end do
      end associate
    end do
  end subroutine change_volume_ratios

  !> All elements of the groups, in their order.
  pure subroutine mesh_of(pieces, mesh)
    type(state_pieces_t), intent(in) :: pieces
    type(transfer_mesh_t), intent(out) :: mesh
    integer, allocatable :: connectivity(:, :), material(:), npoint(:)
    integer :: g, n, before

    n = 0
    do g = 1, size(pieces%groups)
      n = n + size(pieces%groups(g)%connectivity, 2)
    end do
    allocate (connectivity(8, n), material(n), npoint(n))
    before = 0
    do g = 1, size(pieces%groups)
      n = before + size(pieces%groups(g)%connectivity, 2)
      connectivity(:, before + 1:n) = pieces%groups(g)%connectivity
      material(before + 1:n) = pieces%groups(g)%material
      npoint(before + 1:n) = pieces%groups(g)%npoint
      before = n
    end do
    call set_up_mesh(pieces%nodes, connectivity, material, npoint, pieces%axisymmetric, mesh)
  end subroutine mesh_of

end module state_pieces
