!> Fields of the solid bodies at the nodes, for pictures: every component of their states, and von Mises' equivalent stress. Further
!> formulations on a body (phases) add what the body does not have itself.
!>
!> Where materials meet, a node has the mean of the values of each material there, weighed by the number of its elements: the
!> stress of one is no bound for that of the other.
module nodal_fields
  use kinds, only: wp
  use nodal_average, only: add_elements, begin_average, limited_average, nodal_average_t
  use scene, only: is_solid, role_second, scene_t
  use solution, only: solution_t
  use state_variables, only: component_names, find_variable
  use stress_measures, only: von_mises
  use text, only: string_t
  implicit none
  private
  public :: list_nodal_fields, nodal_field, error_prefix

  character(len=*), parameter :: mises_name = 'mises'
  !> Before the name of a component: its error that comes of temperatures in space (space_phases).
  character(len=*), parameter :: error_prefix = 'error_'

contains

  !> Names of all fields, in a fixed order.
  pure subroutine list_nodal_fields(scene, names)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: names(:)   !! (nname)
    type(string_t), allocatable :: own(:)
    integer :: g, c

    names = [string_t(mises_name)]
    do g = 1, size(scene%groups)
      if (.not. has_points(scene, g)) cycle
      call component_names(scene%groups(g)%variables, own)
      do c = 1, size(own)
        if (place_of(own(c)%s, names) == 0) names = [names, own(c)]
      end do
    end do
  end subroutine list_nodal_fields

  !> A field at the nodes; 0 at nodes of bodies that do not have it.
  pure subroutine nodal_field(scene, solution, name, at)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(out) :: at(:)   !! (nnode) [unit of the field]
    type(nodal_average_t) :: average
    integer, allocatable :: elements(:)   !! of all materials at a node
    integer :: m, nnode

    nnode = size(scene%mesh%coordinates, 2)
    allocate (at(nnode), source=0.0_wp)
    allocate (elements(nnode), source=0)
    do m = 1, size(scene%materials)
      call begin_average(nnode, average)
      call add_material(scene, solution, name, m, average)
      if (all(average%count == 0)) cycle
      at = at + average%count*limited_average(average)
      elements = elements + average%count
    end do
    where (elements > 0) at = at/elements
  end subroutine nodal_field

  !> All groups of a material that have the field.
  pure subroutine add_material(scene, solution, name, material, average)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=*), intent(in) :: name
    integer, intent(in) :: material
    type(nodal_average_t), intent(inout) :: average
    type(string_t), allocatable :: own(:)
    integer :: g, c

    do g = 1, size(scene%groups)
      if (.not. has_points(scene, g) .or. scene%groups(g)%material /= material) cycle
      if (.not. is_solid(scene%groups(g))) then
        call component_names(scene%groups(scene%groups(g)%host)%variables, own)
        if (name == mises_name .or. place_of(name, own) > 0) cycle
      end if
      associate (state => solution%groups(g)%committed, nodes => scene%groups(g)%connectivity)
        if (name == mises_name) then
          ! bodies of heat alone have none
          c = find_variable(scene%groups(g)%variables, 'stress')
          if (c > 0) c = scene%groups(g)%variables(c)%first
          if (c > 0) call add_elements(nodes, mises(state(c:c + 3, :, :)), average)
        else
          call component_names(scene%groups(g)%variables, own)
          c = place_of(name, own)
          if (c > 0) call add_elements(nodes, state(c, :, :), average)
          if (c > 0 .or. index(name, error_prefix) /= 1 .or. size(solution%groups(g)%space_error) == 0) cycle
          c = place_of(name(len(error_prefix) + 1:), own)
          if (c > 0) call add_elements(nodes, solution%groups(g)%space_error(c, :, :), average)
        end if
      end associate
    end do
  end subroutine add_material

  !> The points of a group are those of a body.
  pure function has_points(scene, g) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    logical :: yes

    yes = is_solid(scene%groups(g)) .or. scene%groups(g)%role == role_second
  end function has_points

  !> von Mises' equivalent stress of stresses.
  pure function mises(stress) result(q)
    real(wp), intent(in) :: stress(:, :, :)   !! (4, npoint, nelem) [stress]
    real(wp) :: q(size(stress, 2), size(stress, 3))
    integer :: p, e

    do e = 1, size(q, 2)
      do p = 1, size(q, 1)
        q(p, e) = von_mises(stress(:, p, e))
      end do
    end do
  end function mises

  !> Index of a word among others, 0 where it is not.
  pure function place_of(word, words) result(place)
    character(len=*), intent(in) :: word
    type(string_t), intent(in) :: words(:)
    integer :: place

    do place = size(words), 1, -1
      if (words(place)%s == word) return
    end do
  end function place_of

end module nodal_fields
