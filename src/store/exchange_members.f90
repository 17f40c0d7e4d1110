!> Conditions between members of a checkpoint that were read one by one: positions in lists, extents of arrays that go together.
module exchange_members
  use contact_ends, only: contact_end_t
  use dies, only: die_t, finish_die, is_deformable
  use exchange_rules, only: require, require_range
  use exchange_schema, only: group_place
  use fields, only: field_t, mechanical_fields
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use remesher_options, only: remesher_options_t
  use scene, only: group_t, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable, is_transfer_kind, state_variable_t, total_components
  use text, only: to_text
  implicit none
  private
  public :: check_contact_ends, check_scene, check_solution

contains

  !> A scene as it was read: derived data are filled in. Nothing is used before it has been found in its range.
  subroutine check_scene(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(inout) :: scene
    integer :: g, k, nnode

    if (file%failed()) return
    nnode = size(scene%mesh%coordinates, 2)
    call require(file, 'mesh/origin', size(scene%mesh%origin, 2) == nnode, 'has not the extents of mesh/coordinates')
    call require(file, 'mesh/labels', size(scene%mesh%labels) == nnode, 'has not as many entries as there are nodes')
    do k = 1, size(scene%mesh%sides)
      call require_range(file, 'mesh/sides/'//to_text(k)//'/nodes', pack(scene%mesh%sides(k)%nodes, .true.), 1, nnode)
    end do
    do k = 1, size(scene%fixations)
      call require_range(file, 'fixations/'//to_text(k)//'/nodes', scene%fixations(k)%nodes, 1, nnode)
    end do
    do k = 1, size(scene%walls)
      call require_range(file, 'walls/'//to_text(k)//'/node', [scene%walls(k)%node], 1, nnode)
      call require(file, 'walls/'//to_text(k)//'/side', abs(scene%walls(k)%side) == 1, 'is neither 1 nor -1')
    end do
    call check_fields(file, scene%fields)
    call check_remesher(file, size(scene%dies), scene%remesher)
    do k = 1, size(scene%dies)
      if (.not. file%failed()) call check_die(file, 'dies/'//to_text(k), nnode, scene%dies(k))
    end do
    do g = 1, size(scene%groups)
      if (.not. file%failed()) call check_members_of_group(file, g, scene)
    end do
  end subroutine check_scene

  !> Fields of mechanics come first, and no name comes twice.
  subroutine check_fields(file, fields)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), intent(in) :: fields(:)
    type(field_t) :: mechanical(3)
    integer :: i, k

    mechanical = mechanical_fields()
    call require(file, 'declared_fields/count', size(fields) >= size(mechanical), 'is less than the number of fields of mechanics')
    if (file%failed()) return
    do k = 1, size(fields)
      call require(file, 'declared_fields/'//to_text(k)//'/name', all([(fields(k)%name /= fields(i)%name, i=1, k - 1)]), &
                   'holds the name of another field')
      if (k > size(mechanical)) cycle
      call require(file, 'declared_fields/'//to_text(k)//'/name', fields(k)%name == mechanical(k)%name .and. &
                   fields(k)%place == mechanical(k)%place .and. fields(k)%ncomp == mechanical(k)%ncomp, &
                   'is not the field of mechanics that stands there')
    end do
  end subroutine check_fields

  subroutine check_remesher(file, ndie, options)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: ndie
    type(remesher_options_t), intent(in) :: options
    character(len=:), allocatable :: place
    integer :: k

    call require(file, 'remesher/smallest', options%smallest <= options%largest, 'is above remesher/largest')
    call require(file, 'remesher/smallest_at_bends', options%smallest_at_bends <= options%smallest, 'is above remesher/smallest')
    call require(file, 'remesher/smallest_at_corners', options%smallest_at_corners <= options%smallest, &
                 'is above remesher/smallest')
    do k = 1, size(options%windows)
      place = 'remesher/windows/'//to_text(k)
      call require(file, place//'/low', all(options%windows(k)%low < options%windows(k)%high), 'is not below '//place//'/high')
      call require(file, place//'/smallest', options%windows(k)%smallest <= options%windows(k)%largest, &
                   'is above '//place//'/largest')
      call require_range(file, place//'/die', options%windows(k)%die, 0, ndie)
    end do
    do k = 1, size(options%zones)
      call require_range(file, 'remesher/zones/'//to_text(k)//'/points', options%zones(k)%marks, 1, size(options%marks))
    end do
    do k = 1, size(options%contours)
      place = 'remesher/contours/'//to_text(k)
      call require(file, place//'/side', size(options%contours(k)%row) > 0, 'is empty')
      call require(file, place//'/pieces', size(options%contours(k)%pieces, 3) == size(options%contours(k)%row), &
                   'has not as many entries as '//place//'/side')
      call require(file, place//'/loop', size(options%contours(k)%loop) == size(options%contours(k)%row), &
                   'has not as many entries as '//place//'/side')
    end do
  end subroutine check_remesher

  !> Its pieces are in the pilot's axes already. One made of sides has none before its deck has seen a mesh.
  subroutine check_die(file, place, nnode, die)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: nnode
    type(die_t), intent(inout) :: die
    real(wp) :: pilot(3)

    if (is_deformable(die)) then
      call require(file, place//'/nodes', size(die%nodes, 2) == size(die%pieces, 3), &
                   'has not as many entries as '//place//'/pieces')
      call require_range(file, place//'/nodes', pack(die%nodes, .true.), 1, nnode)
    else
      call require(file, place//'/pieces', size(die%pieces, 3) > 0, 'is empty')
    end if
    if (file%failed()) return
    pilot = die%pilot
    die%pilot = 0
    call finish_die(die)
    die%pilot = pilot
  end subroutine check_die

  subroutine check_members_of_group(file, g, scene)
    type(hdf5_file_t), intent(inout) :: file
    integer, intent(in) :: g
    type(scene_t), intent(inout) :: scene
    character(len=:), allocatable :: place

    place = group_place(g)
    associate (group => scene%groups(g))
      call require_range(file, place//'/host', group%host, 0, size(scene%groups))
      call require_range(file, place//'/die', group%die, 0, size(scene%dies))
      call require_range(file, place//'/material', group%material, 0, size(scene%materials))
      call check_connectivity(file, place//'/connectivity', group%connectivity, size(scene%mesh%coordinates, 2))
      call check_variables(file, place//'/variables', group%variables)
      call file%require_shape(place//'/state', [total_components(group%variables), group%rule%n, &
                                                size(group%connectivity, 2)])
      if (file%failed() .or. group%die == 0) return
      if (.not. is_deformable(scene%dies(group%die))) return
      if (size(scene%dies(group%die)%nodes) == 0) return
      group%pairs = maxval([0, scene%groups(:g - 1)%pairs]) + 1
      ! heat through a contact has the pairs of that
      if (group%host > 0) group%pairs = scene%groups(group%host)%pairs
    end associate
  end subroutine check_members_of_group

  !> Nodes of the elements of a group, each once in an element.
  subroutine check_connectivity(file, place, connectivity, nnode)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: connectivity(:, :)   !! (nnode of an element, nelem)
    integer, intent(in) :: nnode
    integer :: e, i

    call require_range(file, place, pack(connectivity, .true.), 1, nnode)
    do e = 1, size(connectivity, 2)
      do i = 2, size(connectivity, 1)
        if (all(connectivity(:i - 1, e) /= connectivity(i, e))) cycle
        call require(file, place, .false., 'has a node twice in element '//to_text(e))
        return
      end do
    end do
  end subroutine check_connectivity

  !> The declared state of a group's points.
  subroutine check_variables(file, place, variables)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(state_variable_t), intent(inout) :: variables(:)   !! (n)
    character(len=:), allocatable :: here
    integer :: v

    if (file%failed()) return
    do v = 1, size(variables)
      here = place//'/'//to_text(v)
      call require(file, here//'/components', variables(v)%ncomp == 1 .or. variables(v)%ncomp == 4, 'holds '// &
                   to_text(variables(v)%ncomp)//', where 1 (a number) or 4 (a tensor) is wanted')
      call require(file, here//'/transfer', is_transfer_kind(variables(v)%transfer), 'holds '''//variables(v)%transfer// &
                   ''', which is no kind of transfer')
      call require(file, here//'/name', find_variable(variables(:v - 1), variables(v)%name) == 0, &
                   'holds '''//variables(v)%name//''' twice')
      variables(v)%first = total_components(variables(:v - 1)) + 1
    end do
  end subroutine check_variables

  !> A solution that was read into one started from the scene.
  subroutine check_solution(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer :: g, k, most

    call require_range(file, 'progress/spurious_group', solution%spurious_group, 0, size(scene%groups))
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        associate (laid => solution%groups(g)%laid)
          call require(file, group_place(g)//'/laid', all(shape(laid) == 0) .or. &
                       all(shape(laid) == [2, shape(group%connectivity)]), 'has not the extents of the group''s connectivity')
        end associate
        if (group%die > 0) call check_contact(file, group_place(g)//'/state', scene, group, solution%groups(g)%committed)
        if (group%pairs > 0) call require_range(file, 'pairs/'//to_text(group%pairs)//'/piece', &
                                                pack(solution%pairs(group%pairs)%piece, .true.), 0, &
                                                size(scene%dies(group%die)%nodes, 2))
      end associate
    end do
    do k = 1, size(solution%estimate%triggers)
      associate (trigger => solution%estimate%triggers(k))
        call require_range(file, 'estimate/triggers/'//to_text(k)//'/group', trigger%group, 0, size(scene%groups))
        if (file%failed()) return
        most = 0
        if (trigger%group > 0) most = size(scene%groups(trigger%group)%connectivity, 2)
        call require_range(file, 'estimate/triggers/'//to_text(k)//'/element', trigger%element, 0, most)
      end associate
    end do
  end subroutine check_solution

  !> What of the state of contact stands for a place in a list: how a point touches, and the piece of the die.
  subroutine check_contact(file, place, scene, group, state)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)   !! (component, point, element)
    real(wp) :: high
    integer :: v

    do v = 1, size(group%variables)
      select case (group%variables(v)%name)
      case ('contact_status', 'corner_contact_status')
        high = 2
      case ('die_piece', 'corner_die_piece')
        high = size(scene%dies(group%die)%pieces, 3)
      case default
        cycle
      end select
      call require_range(file, place, pack(state(group%variables(v)%first, :, :), .true.), 0.0_wp, high)
    end do
  end subroutine check_contact

  subroutine check_contact_ends(file, scene, ends)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(contact_end_t), intent(in) :: ends(:)   !! (n)
    character(len=:), allocatable :: place
    integer :: k

    do k = 1, size(ends)
      place = 'contact_ends/'//to_text(k)
      call require_range(file, place//'/group', ends(k)%group, 1, size(scene%groups))
      if (file%failed()) return
      associate (at => scene%groups(ends(k)%group))
        call require_range(file, place//'/side', ends(k)%side, 1, size(at%connectivity, 2))
        call require(file, place//'/group', at%die > 0 .and. at%material > 0, 'holds '//to_text(ends(k)%group)// &
                     ', which is no group of contact')
        if (at%die > 0) call require_range(file, place//'/die_piece', ends(k)%piece, 0, size(scene%dies(at%die)%pieces, 3))
      end associate
    end do
  end subroutine check_contact_ends

end module exchange_members
