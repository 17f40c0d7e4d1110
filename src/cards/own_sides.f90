!> Free sides of a body that may meet others of it (folding_bodies): all but those that supports hold or that lie on the axis, where
!> a curve that is symmetric ends, and those that are glued.
module own_sides
  use bodies, only: bodies_of_nodes
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: law_t
  use scene, only: axisymmetric, is_solid, role_contact, scene_t
  use shape_functions, only: quad8_side
  implicit none
  private
  public :: list_own_sides

  !> A radius below this share of the size of the mesh is the axis [-].
  real(wp), parameter :: on_axis = 1.0e-9_wp

contains

  !> Free sides of the body of a group that may meet others, walked with the body on the left. Where there are new meshes they are
  !> sides of named sets, by which the remesher finds them again.
  subroutine list_own_sides(scene, laws, sharing, mesh_size, g, sides)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: sharing(:)                  !! (nnode) elements that have each node in the middle of a side
    real(wp), intent(in) :: mesh_size                  !! [length]
    integer, intent(in) :: g
    integer, allocatable, intent(out) :: sides(:, :)   !! (3, nside)
    integer :: body(size(sharing)), own, e, k, i, n
    logical :: may(size(sharing))

    body = bodies_of_nodes(scene)
    own = body(scene%groups(g)%connectivity(1, 1))
    may = sharing == 1 .and. body == own
    call leave_out(scene, laws, may)
    allocate (sides(3, count(may)))
    n = 0
    do k = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(k))) cycle
      do e = 1, size(scene%groups(k)%connectivity, 2)
        do i = 1, 4
          associate (side => scene%groups(k)%connectivity(quad8_side(:, i), e))
            if (.not. may(side(2))) cycle
            if (is_held(scene, mesh_size, side)) cycle
            n = n + 1
            sides(:, n) = side
          end associate
        end do
      end do
    end do
    sides = sides(:, :n)
  end subroutine list_own_sides

  !> Sides, by their middle nodes, that are of no named set, where there are new meshes; and those whose contact does not open.
  subroutine leave_out(scene, laws, may)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical, intent(inout) :: may(:)   !! (nnode)
    logical :: of_a_set(size(may))
    integer :: k

    of_a_set = .not. scene%remesh%on
    do k = 1, size(scene%mesh%sides)
      of_a_set(scene%mesh%sides(k)%nodes(2, :)) = .true.
    end do
    may = may .and. of_a_set
    do k = 1, size(scene%groups)
      associate (group => scene%groups(k))
        if (group%role /= role_contact .or. group%material == 0) cycle
        if (laws(scene%materials(group%material)%law_id)%lasts) may(group%connectivity(2, :)) = .false.
      end associate
    end do
  end subroutine leave_out

  !> A side whose nodes one support holds, or that lies on the axis.
  pure function is_held(scene, mesh_size, side) result(yes)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: mesh_size   !! [length]
    integer, intent(in) :: side(3)
    logical :: yes
    integer :: f, k

    yes = scene%plane_state == axisymmetric .and. all(abs(scene%mesh%coordinates(1, side)) <= on_axis*mesh_size)
    do f = 1, size(scene%fixations)
      associate (fixation => scene%fixations(f))
        if (fixation%field == displacement_field) yes = yes .or. all([(any(fixation%nodes == side(k)), k=1, 3)])
      end associate
    end do
  end function is_held

end module own_sides
