!> Unknowns by the scene: numbered only where a card calls for them.
!>
!> An unknown is a displacement of a node, a motion of a die's pilot, or in generalised plane strain a
!> motion of the section. Each is free (it has an
!> equation) or prescribed (its motion is known: elimination, no penalty).
module dofs
  use elem_api, only: elem_t
  use kinds, only: wp
  use loads, only: multiplier_at
  use pairs, only: nodes_per_point, paired_nodes, pairs_t, start_pairs
  use scene, only: generalised_plane_strain, scene_t
  use sections, only: section_forced, section_moved
  implicit none
  private
  public :: dofs_t, group_dofs_t, number_dofs, number_pairs, prescribed_motion

  type :: group_dofs_t
    !> Nodes and unknowns of each element, in the local order of the ELEM family (nnode, nelem), (ndof, nelem).
    integer, allocatable :: nodes(:, :), dof(:, :)
  end type group_dofs_t

  !> An unknown whose motion is amplitude times multiplier; multiplier 0 holds it.
  type :: prescribed_t
    integer :: dof = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
  end type prescribed_t

  type :: dofs_t
    integer :: ndof = 0
    !> Number of equations.
    integer :: neq = 0
    !> Unknowns of the nodes (2, nnode) and of the pilots (3, ndie); 0 where there is none.
    integer, allocatable :: node(:, :), pilot(:, :)
    !> Unknowns of the section, 0 where there are none.
    integer :: section(3) = 0
    !> Equation of each unknown, 0 when prescribed.
    integer, allocatable :: equation(:)
    !> Unknowns that are angles, and tilts of the section (their forces are moments).
    logical, allocatable :: is_angle(:)
    type(prescribed_t), allocatable :: prescribed(:)
    type(group_dofs_t), allocatable :: groups(:)
  end type dofs_t

contains

  !> Number the unknowns of a scene.
  subroutine number_dofs(scene, elems, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)
    type(dofs_t), intent(out) :: dofs
    integer :: g, e, k, d, nnode

    nnode = size(scene%mesh%coordinates, 2)
    allocate (dofs%node(2, nnode), dofs%pilot(3, size(scene%dies)), source=0)
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        do e = 1, size(group%connectivity, 2)
          dofs%node(:, group%connectivity(:, e)) = 1
        end do
        if (elems(group%elem_id)%pilot) dofs%pilot(:, group%die) = 1
      end associate
    end do
    do k = 1, nnode
      do d = 1, 2
        call take_number(dofs%node(d, k))
      end do
    end do
    do k = 1, size(scene%dies)
      do d = 1, 3
        call take_number(dofs%pilot(d, k))
      end do
    end do

    if (scene%plane_state == generalised_plane_strain) then
      do d = 1, 3
        dofs%section(d) = 1
        call take_number(dofs%section(d))
      end do
    end if

    allocate (dofs%is_angle(dofs%ndof), source=.false.)
    do k = 1, size(scene%dies)
      if (dofs%pilot(3, k) > 0) dofs%is_angle(dofs%pilot(3, k)) = .true.
    end do
    if (dofs%section(1) > 0) dofs%is_angle(dofs%section(2:3)) = .true.

    call list_prescribed(scene, dofs)
    allocate (dofs%equation(dofs%ndof), source=1)
    dofs%equation(dofs%prescribed%dof) = 0
    do k = 1, dofs%ndof
      if (dofs%equation(k) == 0) cycle
      dofs%neq = dofs%neq + 1
      dofs%equation(k) = dofs%neq
    end do
    call list_elements(scene, elems, dofs)

  contains

    subroutine take_number(place)
      integer, intent(inout) :: place

      if (place == 0) return
      dofs%ndof = dofs%ndof + 1
      place = dofs%ndof
    end subroutine take_number

  end subroutine number_dofs

  !> Fixations, imposed displacements and pilots; an unknown held twice is listed once.
  subroutine list_prescribed(scene, dofs)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(inout) :: dofs
    type(prescribed_t) :: by_dof(dofs%ndof)
    integer :: k, i, d

    do k = 1, size(dofs%pilot, 2)
      if (dofs%pilot(1, k) > 0) by_dof(dofs%pilot(:, k))%dof = dofs%pilot(:, k)
    end do
    do k = 1, size(scene%die_forces)
      d = dofs%pilot(scene%die_forces(k)%component, scene%die_forces(k)%die)
      if (d > 0) by_dof(d)%dof = 0
    end do
    do k = 1, 3
      if (dofs%section(k) == 0 .or. scene%section_drives(k)%kind == section_forced) cycle
      by_dof(dofs%section(k))%dof = dofs%section(k)
      if (scene%section_drives(k)%kind /= section_moved) cycle
      by_dof(dofs%section(k)) = prescribed_t(dofs%section(k), scene%section(1)*scene%section_drives(k)%amplitude, &
                                             scene%section_drives(k)%multiplier)
    end do
    do k = 1, size(scene%die_motions)
      associate (motion => scene%die_motions(k))
        if (dofs%pilot(1, motion%die) == 0) cycle
        d = dofs%pilot(motion%component, motion%die)
        by_dof(d) = prescribed_t(d, motion%amplitude, motion%multiplier)
      end associate
    end do
    do k = 1, size(scene%fixations)
      associate (fixation => scene%fixations(k))
        do i = 1, size(fixation%nodes)
          d = dofs%node(fixation%component, fixation%nodes(i))
          by_dof(d) = prescribed_t(d, fixation%amplitude, fixation%multiplier)
        end do
      end associate
    end do
    dofs%prescribed = pack(by_dof, by_dof%dof > 0)
  end subroutine list_prescribed

  !> Unknowns of every element.
  subroutine list_elements(scene, elems, dofs)
    type(scene_t), intent(in) :: scene
    type(elem_t), intent(in) :: elems(:)
    type(dofs_t), intent(inout) :: dofs
    type(pairs_t), allocatable :: pairs(:)
    integer :: g

    allocate (dofs%groups(size(scene%groups)))
    call start_pairs(scene, pairs)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%pairs == 0) dofs%groups(g)%nodes = scene%groups(g)%connectivity
      if (scene%groups(g)%pairs == 0) call number_elements(elems(scene%groups(g)%elem_id)%pilot, scene%groups(g)%die, dofs, g)
    end do
    call number_pairs(scene, pairs, dofs)
  end subroutine list_elements

  !> Unknowns of the elements that face deformable dies, with the pairs of now.
  subroutine number_pairs(scene, pairs, dofs)
    type(scene_t), intent(in) :: scene
    type(pairs_t), intent(in) :: pairs(:)
    type(dofs_t), intent(inout) :: dofs
    integer :: g, e

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        if (group%pairs == 0) cycle
        associate (middle => pairs(group%pairs)%piece)
          if (.not. allocated(dofs%groups(g)%nodes)) then
            allocate (dofs%groups(g)%nodes(size(group%connectivity, 1) + nodes_per_point*size(middle, 1), size(middle, 2)))
          end if
          do e = 1, size(middle, 2)
            dofs%groups(g)%nodes(:, e) = paired_nodes(scene%dies(group%die), group%connectivity(:, e), middle(:, e))
          end do
        end associate
        call number_elements(.false., group%die, dofs, g)
      end associate
    end do
  end subroutine number_pairs

  !> Unknowns of the elements of a group from their nodes.
  subroutine number_elements(pilot, die, dofs, g)
    logical, intent(in) :: pilot
    integer, intent(in) :: die, g
    type(dofs_t), intent(inout) :: dofs
    integer :: e, n, ndof

    n = size(dofs%groups(g)%nodes, 1)
    ndof = 2*n
    if (pilot) ndof = ndof + 3
    if (dofs%section(1) > 0) ndof = ndof + 3
    if (.not. allocated(dofs%groups(g)%dof)) allocate (dofs%groups(g)%dof(ndof, size(dofs%groups(g)%nodes, 2)))
    associate (dof => dofs%groups(g)%dof, nodes => dofs%groups(g)%nodes)
      do e = 1, size(nodes, 2)
        dof(:n, e) = dofs%node(1, nodes(:, e))
        dof(n + 1:2*n, e) = dofs%node(2, nodes(:, e))
        if (pilot) dof(2*n + 1:2*n + 3, e) = dofs%pilot(:, die)
        if (dofs%section(1) > 0) dof(ndof - 2:, e) = dofs%section
      end do
    end associate
  end subroutine number_elements

  !> Motion of the prescribed unknowns from time t0 (or from rest) to t1, in the order of the list.
  pure subroutine prescribed_motion(scene, dofs, from_rest, t0, t1, motion)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    logical, intent(in) :: from_rest
    real(wp), intent(in) :: t0, t1
    real(wp), intent(out) :: motion(:)
    integer :: k

    do k = 1, size(dofs%prescribed)
      motion(k) = 0
      associate (p => dofs%prescribed(k))
        if (p%multiplier == 0) cycle
        motion(k) = multiplier_at(scene%multipliers(p%multiplier), t1)
        if (.not. from_rest) motion(k) = motion(k) - multiplier_at(scene%multipliers(p%multiplier), t0)
        motion(k) = p%amplitude*motion(k)
      end associate
    end do
  end subroutine prescribed_motion

end module dofs
