!> What a solution holds, but contact, from the old mesh to the new one: progress, state of the solids, fields on nodes.
module carry_solution
  use bearing_nodes, only: open_share
  use errors, only: error_t
  use fields, only: displacement_field, fill_middle_nodes, find_field, has_corners_only, on_nodes
  use kept_members, only: member_memory_t
  use kinds, only: wp
  use nodal_balance, only: keep_nodal_means
  use remeshing, only: carry_error
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use state_pieces, only: change_volume_ratios, mesh_of, solid_pieces, state_pieces_t, store_states, take_values
  use transfer_api, only: transfer_options_t
  use transfer_mesh, only: build_mesh_trees, transfer_mesh_t
  use transfer_nodes, only: carry_at_nodes
  use transfer_report, only: transfer_report_t
  use transfer_states, only: carry_states
  use visit_solution, only: visit_solution_members
  implicit none
  private
  public :: carry_progress, carry_solids

contains

  !> Time, dies, work: what does not depend on the mesh (visit_solution says of each member how it is carried).
  subroutine carry_progress(old, before, after)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(solution_t), intent(inout) :: after
    type(member_memory_t) :: memory
    type(solution_t), allocatable :: shown   ! a visitor may change what it visits

    allocate (shown, source=before)
    call visit_solution_members(memory, shown)
    memory%gives = .true.
    call visit_solution_members(memory, after)
    after%estimate%began = before%step
    after%estimate%last_stop = before%step
    after%estimate%previous_stress = before%estimate%stress
    after%estimate%previous_open = open_share(old, before)
    call carry_error(before%estimate, after%estimate)
    after%unbalanced = .true.
  end subroutine carry_progress

  !> State of the solids and nodal fields: initial position of the material points, displacement of the last step, and displacement
  !> since the start where the mesh is not updated.
  subroutine carry_solids(old, before, moved, cut, new, after, report, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    real(wp), intent(in) :: moved(:, :)   !! (2, nnode) [length]
    logical, intent(in) :: cut(:)         !! bodies a part of which was cut off (ngroup)
    type(scene_t), intent(inout) :: new
    type(solution_t), intent(inout) :: after
    type(transfer_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(state_pieces_t) :: from, to, start
    type(transfer_options_t) :: options
    type(transfer_mesh_t) :: mesh, target, rest
    integer, allocatable :: material(:)
    integer :: k, g

    options%method = old%remesher%transfer
    options%exponent = old%remesher%exponent
    options%neighbours = old%remesher%neighbours
    call solid_pieces(old, from, before)
    call solid_pieces(new, to)
    do k = 1, size(to%groups)
      call take_values(after, to%groups(k))
    end do
    call mesh_of(from, mesh)
    call solid_pieces(old, start)
    call mesh_of(start, rest)
    call change_volume_ratios(rest%volumes, mesh%volumes, from)
    call build_mesh_trees(mesh)
    call mesh_of(to, target)
    allocate (options%cut(max(mesh%nmaterial, target%nmaterial)), source=.false.)
    do k = 1, size(from%groups)
      g = from%groups(k)%scene_group
      if (cut(g)) options%cut(from%groups(k)%material) = .true.
    end do
    call carry_states(mesh, target, from, to, options, report, error)
    if (allocated(error)) return
    call store_states(to, after)

    allocate (material(size(new%mesh%coordinates, 2)), source=0)
    do k = 1, size(target%material)
      material(target%connectivity(:, k)) = target%material(k)
    end do
    call carry_nodes(mesh, target, old, before, moved, material, options, new, after, error)
  end subroutine carry_solids

  !> What belongs to nodes, by the shape functions of the old mesh: origin of the material, and of every field on nodes the change
  !> of the last step and the value; of the displacement the value is what was `moved`. What is solved for beside the motion, as the
  !> temperature, keeps its means.
  subroutine carry_nodes(mesh, target, old, before, moved, material, options, new, after, error)
    type(transfer_mesh_t), intent(in) :: mesh, target
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    real(wp), intent(in) :: moved(:, :)      !! (2, nnode) [length]
    integer, intent(in) :: material(:)       !! of the new nodes (nnode)
    type(transfer_options_t), intent(in) :: options
    type(scene_t), intent(inout) :: new
    type(solution_t), intent(inout) :: after
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: from(:, :), to(:, :)
    real(wp) :: farthest
    integer :: f, k, n, pass
    logical :: has_errors, is_followed, has_spans

    n = 2
    do f = 1, size(before%fields)
      if (is_carried(f)) n = n + 2*before%fields(f)%ncomp
    end do
    has_errors = size(before%heat%temperature_error) == size(moved, 2) .and. size(after%heat%temperature_error) == size(material)
    if (has_errors) n = n + 1
    is_followed = size(before%heat%finer) > size(moved, 2) .and. size(after%heat%finer) > size(material)
    if (is_followed) n = n + 1
    has_spans = any([(size(before%groups(f)%span) > 0, f=1, size(before%groups))])
    if (has_spans) n = n + 1
    allocate (from(n, size(moved, 2)), to(n, size(material)))
    from(1:2, :) = old%mesh%origin
    do pass = 1, 2
      n = 2
      do f = 1, size(before%fields)
        if (.not. is_carried(f)) cycle
        associate (m => before%fields(f)%ncomp)
          if (pass == 1) then
            from(n + 1:n + m, :) = before%fields(f)%last_increment
            from(n + m + 1:n + 2*m, :) = before%fields(f)%value
            if (f == displacement_field) from(n + m + 1:n + 2*m, :) = moved
          else
            after%fields(f)%last_increment = to(n + 1:n + m, :)
            after%fields(f)%value = to(n + m + 1:n + 2*m, :)
          end if
          n = n + 2*m
        end associate
      end do
      if (has_errors) then
        if (pass == 1) from(n + 1:n + 1, :) = errors_at_nodes(old, before)
        if (pass == 2) after%heat%temperature_error = to(n + 1, :)
        n = n + 1
      end if
      if (is_followed) then
        if (pass == 1) from(n + 1, :) = before%heat%finer(:size(moved, 2))
        if (pass == 2) call place_finer(new, to(n + 1, :), after%heat%finer)
        n = n + 1
      end if
      if (has_spans) then
        if (pass == 1) from(n + 1, :) = spans_at_nodes(old, before, size(moved, 2))
        if (pass == 2) call place_spans(new, to(n + 1, :), after)
      end if
      if (pass == 2) exit
      call carry_at_nodes(mesh, from, new%mesh%coordinates, material, options%outside, to, farthest, error)
      if (allocated(error)) return
    end do
    new%mesh%origin = to(1:2, :)
    if (has_errors) then
      ! errors of the temperatures go on as these do; those of the heat contents are found from them (heat_error_start)
      after%heat%error_of_mesh = before%heat%error_of_mesh
      if (size(after%heat%die_error) == size(before%heat%die_error)) after%heat%die_error = before%heat%die_error
    end if
    do f = 1, size(before%fields)
      if (.not. is_carried(f) .or. before%fields(f)%given .or. before%fields(f)%quantity == 'motion') cycle
      do k = 1, before%fields(f)%ncomp
        call keep_nodal_means(mesh, before%fields(f)%value(k, :), has_corners_only(before%fields(f)), options, target, &
                              after%fields(f)%value(k, :), error)
        if (allocated(error)) return
      end do
    end do

  contains

    pure function is_carried(k) result(yes)
      integer, intent(in) :: k
      logical :: yes

      yes = before%fields(k)%place == on_nodes .and. before%fields(k)%declared
    end function is_carried

  end subroutine carry_nodes

  !> Temperatures that a finer mesh has more, at the nodes of the new mesh and at the centres of its elements (space_error).
  pure subroutine place_finer(scene, at_nodes, finer)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: at_nodes(:)     !! (nnode) [temperature]
    real(wp), intent(inout) :: finer(:)     !! (nnode + nelem) [temperature]
    integer :: g, e, n

    n = size(at_nodes)
    finer(:n) = at_nodes
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        n = n + 1
        associate (nodes => scene%groups(g)%connectivity(:, e))
          finer(n) = 0.5_wp*sum(at_nodes(nodes(5:8))) - 0.25_wp*sum(at_nodes(nodes(1:4)))
        end associate
      end do
    end do
  end subroutine place_finer

  !> What elements have held of fronts (strain_spans), at the nodes: the mean of those that meet there.
  pure function spans_at_nodes(scene, solution, nnode) result(spans)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: nnode
    real(wp) :: spans(nnode)   !! [-]
    integer :: number(nnode), g, e

    spans = 0
    number = 0
    do g = 1, size(scene%groups)
      do e = 1, size(solution%groups(g)%span)
        associate (nodes => scene%groups(g)%connectivity(:8, e))
          spans(nodes) = spans(nodes) + solution%groups(g)%span(e)
          number(nodes) = number(nodes) + 1
        end associate
      end do
    end do
    spans = spans/max(number, 1)
  end function spans_at_nodes

  !> The mean of the corners in the new elements.
  pure subroutine place_spans(scene, at_nodes, solution)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: at_nodes(:)   !! (nnode) [-]
    type(solution_t), intent(inout) :: solution
    integer :: g, e

    do g = 1, size(scene%groups)
      do e = 1, size(solution%groups(g)%span)
        solution%groups(g)%span(e) = max(0.25_wp*sum(at_nodes(scene%groups(g)%connectivity(:4, e))), 0.0_wp)
      end do
    end do
  end subroutine place_spans

  !> Errors of the temperatures in time, at middle nodes too where temperatures stand on corners.
  pure function errors_at_nodes(scene, solution) result(errors)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: errors(1, size(solution%heat%temperature_error))   !! [temperature]
    integer :: f, g

    errors(1, :) = solution%heat%temperature_error
    f = find_field(scene%fields, 'temperature')
    if (f == 0) return
    if (.not. has_corners_only(solution%fields(f))) return
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) call fill_middle_nodes(scene%groups(g)%connectivity, errors)
    end do
  end function errors_at_nodes

end module carry_solution
