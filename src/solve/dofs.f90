!> Unknowns by the scene: numbered only where an element calls for them.
!>
!> An unknown is a component of a field at a place: a displacement of a node, a motion of a die's pilot or of the section, a
!> temperature of a node. Each is free (it has an equation) or prescribed (its motion is known: elimination, no penalty).
module dofs
  use elem_api, only: layout_t
  use fields, only: field_t
  use kinds, only: wp
  use text, only: string_t
  implicit none
  private
  public :: dofs_t, field_dofs_t, group_dofs_t, prescribed_t, is_driven, move_fields

  !> Unknown of each component of a field at each place (ncomp, place), 0 where there is none.
  type :: field_dofs_t
    integer, allocatable :: number(:, :)
    !> The places are nodes of the mesh.
    logical :: at_nodes = .false.
  end type field_dofs_t

  type :: group_dofs_t
    !> Nodes and unknowns of each element, in the local order of the ELEM family (nnode, nelem), (ndof, nelem).
    integer, allocatable :: nodes(:, :), dof(:, :)
    type(layout_t) :: layout
  end type group_dofs_t

  !> An unknown whose motion, or whose value, is amplitude times multiplier; multiplier 0 holds it.
  type :: prescribed_t
    integer :: dof = 0
    real(wp) :: amplitude = 0.0_wp
    integer :: multiplier = 0
    !> Field and place of a value that is imposed as such; 0 where the motion since the start is.
    integer :: field = 0, component = 0, place = 0
    !> History of the scene that gives the value, and the row there; 0 for others.
    integer :: history = 0, row = 0
    !> It has moved already, before the first step, by what the multiplier begins with.
    logical :: moved = .false.
  end type prescribed_t

  type :: dofs_t
    integer :: ndof = 0
    !> Unknowns of the fields of the scene.
    type(field_dofs_t), allocatable :: fields(:)
    !> Unknowns whose motion is not prescribed (ndof).
    logical, allocatable :: is_free(:)
    !> Unknowns that are angles, and tilts of the section (their forces are moments).
    logical, allocatable :: is_angle(:)
    !> Quantities of the fields, and that of each unknown (ndof).
    type(string_t), allocatable :: quantities(:)
    integer, allocatable :: quantity(:)
    type(prescribed_t), allocatable :: prescribed(:)
    type(group_dofs_t), allocatable :: groups(:)
  end type dofs_t

contains

  !> A support or a die moves: some prescribed unknown that is a motion.
  pure function is_driven(dofs, motion) result(yes)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)   !! (nprescribed) [unknown]
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(motion)
      associate (q => dofs%quantity(dofs%prescribed(k)%dof))
        if (dofs%quantities(q)%s == 'motion') yes = yes .or. abs(motion(k)) > 0
      end associate
    end do
  end function is_driven

  !> Advance all fields: nodes, pilots and section move, temperatures change. Places without an unknown stay as they are.
  pure subroutine move_fields(dofs, motion, fields)
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: motion(:)            !! (ndof) [unknown]
    type(field_t), intent(inout) :: fields(:)    !! (nfield)
    integer :: f, k, c, d

    do f = 1, size(fields)
      fields(f)%older_increment = fields(f)%last_increment
      do k = 1, size(fields(f)%value, 2)
        do c = 1, fields(f)%ncomp
          d = dofs%fields(f)%number(c, k)
          ! what was carried to a new mesh is of no step of this one
          fields(f)%last_increment(c, k) = 0
          if (d > 0) fields(f)%last_increment(c, k) = motion(d)
        end do
      end do
      fields(f)%value = fields(f)%value + fields(f)%last_increment
    end do
  end subroutine move_fields

end module dofs
