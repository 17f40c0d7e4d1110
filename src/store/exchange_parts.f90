!> Conditions between the parts of a scene that a checkpoint holds: elements on nodes, sides on elements, contact on dies.
!>
!> All of them hold for what cards and the remesher make. A file in which they do not was not written by these programs, and using
!> it would read past the ends of arrays or never end a search.
module exchange_parts
  use block_mesh, only: least_jacobian
  use dies, only: is_deformable
  use exchange_rules, only: require, require_range
  use exchange_schema, only: group_place
  use fields, only: displacement_field
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use mesh, only: side_set_t
  use scene, only: axisymmetric, group_t, is_solid, role_contact, role_heat_contact, role_load_factor, role_second, &
                   role_volume_load, scene_t
  use shape_functions, only: quad8, quad8_side
  use quadrature, only: rule_number, square_rule
  use solution, only: solution_t
  use state_variables, only: find_variable
  use text, only: to_text
  implicit none
  private
  public :: check_parts, check_shapes

  !> Sides of the elements of matter, each known by its middle node: how many elements have it, and its ends as the first of them
  !> walks (2, nnode).
  type :: sides_t
    integer, allocatable :: elements(:), ends(:, :)
  end type sides_t

contains

  !> A scene read from a checkpoint alone.
  subroutine check_parts(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(sides_t) :: known
    integer :: g, k

    call begin_sides(size(scene%mesh%coordinates, 2), known)
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) call check_solid(file, group_place(g), scene%groups(g), scene%mesh%coordinates, known)
    end do
    call check_sets(file, scene%mesh%sides, known)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) call check_group(file, group_place(g), scene, scene%groups(g), known)
    end do
    do k = 1, size(scene%dies)
      call require(file, 'dies/'//to_text(k)//'/name', count_name(scene, k) == 1, 'holds the name of another die')
      if (is_deformable(scene%dies(k))) call check_sides(file, 'dies/'//to_text(k)//'/nodes', scene%dies(k)%nodes, known)
    end do
    associate (options => scene%remesher)
      do k = 1, size(options%marks)
        call require_range(file, 'remesher/points/'//to_text(k)//'/die', options%marks(k)%die, 0, size(scene%dies))
      end do
      do k = 1, size(options%zones)
        call require_solid(file, 'remesher/zones/'//to_text(k)//'/group', scene, options%zones(k)%group)
      end do
      do k = 1, size(options%contours)
        call require_solid(file, 'remesher/contours/'//to_text(k)//'/group', scene, options%contours(k)%group)
      end do
    end associate
  end subroutine check_parts

  !> Elements as they are at the instant of the checkpoint: the solver accepts no step in which one of them is turned inside out.
  subroutine check_shapes(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), allocatable :: xi(:, :), weight(:), dphi(:, :, :), phi(:, :)
    real(wp) :: x(2, 8), jacobian(2, 2)
    integer :: g, e, p

    if (.not. scene%finite) return
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      call square_rule(scene%groups(g)%rule%n, xi, weight)
      allocate (phi(8, size(weight)), dphi(2, 8, size(weight)))
      do p = 1, size(weight)
        call quad8(xi(1, p), xi(2, p), phi(:, p), dphi(:, :, p))
      end do
      do e = 1, size(scene%groups(g)%connectivity, 2)
        associate (nodes => scene%groups(g)%connectivity(:, e))
          x = scene%mesh%coordinates(:, nodes) + solution%fields(displacement_field)%value(:, nodes)
        end associate
        do p = 1, size(weight)
          jacobian = matmul(dphi(:, :, p), transpose(x))
          if (jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1) > 0 .and. &
              (scene%plane_state /= axisymmetric .or. dot_product(x(1, :), phi(:, p)) > 0)) cycle
          call require(file, 'fields/displacement/value', .false., 'turns element '//to_text(e)//' of '//group_place(g) &
                       //' inside out')
          return
        end do
      end do
      deallocate (phi, dphi)
    end do
  end subroutine check_shapes

  subroutine begin_sides(nnode, known)
    integer, intent(in) :: nnode
    type(sides_t), intent(out) :: known

    allocate (known%elements(nnode), known%ends(2, nnode), source=0)
  end subroutine begin_sides

  !> Elements of matter: their rule, their shape at the start, their sides.
  subroutine check_solid(file, place, group, coordinates, known)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: coordinates(:, :)
    type(sides_t), intent(inout) :: known
    integer :: e

    call require(file, place//'/npoint', any(rule_number(group%rule) == [1, 4, 9, 16]), &
                 'holds '//to_text(rule_number(group%rule))//', where 1, 4, 9 or 16 points are wanted')
    call require(file, place//'/connectivity', size(group%connectivity, 1) == 8, 'has no 8-node elements')
    if (file%failed()) return
    do e = 1, size(group%connectivity, 2)
      if (least_jacobian(coordinates(:, group%connectivity(:, e)), group%rule%n) > 0) cycle
      call require(file, place//'/connectivity', .false., 'has a folded element, '//to_text(e))
      return
    end do
    call enter_sides(file, place//'/connectivity', group%connectivity, known)
  end subroutine check_solid

  !> A side belongs to one element, or to two that walk it to and fro.
  subroutine enter_sides(file, place, connectivity, known)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: connectivity(:, :)
    type(sides_t), intent(inout) :: known
    integer :: side(3), e, k

    do e = 1, size(connectivity, 2)
      do k = 1, 4
        side = connectivity(quad8_side(:, k), e)
        associate (elements => known%elements(side(2)), ends => known%ends(:, side(2)))
          if (elements == 0) then
            ends = side([1, 3])
          else if (elements > 1 .or. any(ends /= side([3, 1]))) then
            call require(file, place, .false., 'has a side of element '//to_text(e)//' that does not fit other elements')
            return
          end if
          elements = elements + 1
        end associate
      end do
    end do
  end subroutine enter_sides

  subroutine check_sets(file, sets, known)
    type(hdf5_file_t), intent(inout) :: file
    type(side_set_t), intent(in) :: sets(:)
    type(sides_t), intent(in) :: known
    integer :: k

    do k = 1, size(sets)
      call check_sides(file, 'mesh/sides/'//to_text(k)//'/nodes', sets(k)%nodes, known)
    end do
  end subroutine check_sets

  !> Sides are those of elements, walked either way.
  subroutine check_sides(file, place, sides, known)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: sides(:, :)   !! (3, n)
    type(sides_t), intent(in) :: known
    integer :: k

    do k = 1, size(sides, 2)
      associate (ends => known%ends(:, sides(2, k)))
        if (all(ends == sides([1, 3], k)) .or. all(ends == sides([3, 1], k))) cycle
        call require(file, place, .false., 'holds '//to_text(k)//', which is no side of an element')
        return
      end associate
    end do
  end subroutine check_sides

  !> Contact, loads, springs.
  subroutine check_group(file, place, scene, group, known)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(sides_t), intent(in) :: known
    character(len=*), parameter :: of_contact(*) = ['contact_status ', 'penetration    ', 'pressure       ', 'die_piece      ', &
                                                    'die_xi         ']
    integer :: k

    if (group%role == role_load_factor) then
      call require(file, place//'/connectivity', size(group%connectivity, 1) == 1, 'has '// &
                   to_text(size(group%connectivity, 1))//' nodes an element, where 1 is wanted')
      call require(file, place//'/connectivity', all(group%connectivity <= size(scene%mesh%coordinates, 2)), &
                   'has a node that the mesh has not')
      return
    end if
    call require(file, place//'/connectivity', any(size(group%connectivity, 1) == [0, 3, 8]), 'has '// &
                 to_text(size(group%connectivity, 1))//' nodes an element, where 0, 3 or 8 are wanted')
    if (size(group%connectivity, 1) == 3) call check_sides(file, place//'/connectivity', group%connectivity, known)
    if (any(group%role == [role_second, role_volume_load])) then
      call require_solid(file, place//'/host', scene, group%host)
      if (file%failed()) return
      call require(file, place//'/connectivity', same_elements(group%connectivity, scene%groups(group%host)%connectivity), &
                   'holds other elements than those of its body')
    else if (group%role == role_heat_contact) then
      if (group%host == 0) return
      call require(file, place//'/host', scene%groups(group%host)%role == role_contact, 'holds '//to_text(group%host)// &
                   ', which is no contact')
      call require(file, place//'/connectivity', same_elements(group%connectivity, scene%groups(group%host)%connectivity), &
                   'holds other sides than those of its contact')
    else
      call require(file, place//'/host', group%host == 0, 'holds '//to_text(group%host)//', where 0 is wanted')
    end if
    if (group%die == 0 .or. group%material == 0) return
    call require(file, place//'/connectivity', size(group%connectivity, 1) == 3, 'is not one of sides')
    do k = 1, size(of_contact)
      call require(file, place//'/variables', find_variable(group%variables, trim(of_contact(k))) > 0, &
                   'lacks '''//trim(of_contact(k))//'''')
    end do
  end subroutine check_group

  pure function same_elements(a, b) result(same)
    integer, intent(in) :: a(:, :), b(:, :)   !! (nnode, nelem)
    logical :: same

    same = all(shape(a) == shape(b))
    if (same) same = all(a == b)
  end function same_elements

  subroutine require_solid(file, place, scene, group)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: group

    call require_range(file, place, group, 1, size(scene%groups))
    if (.not. file%failed()) call require(file, place, is_solid(scene%groups(group)), 'holds '//to_text(group)// &
                                         ', which is no group of matter')
  end subroutine require_solid

  pure function count_name(scene, die) result(n)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    integer :: n
    integer :: k

    n = count([(scene%dies(k)%name == scene%dies(die)%name, k=1, size(scene%dies))])
  end function count_name

end module exchange_parts
