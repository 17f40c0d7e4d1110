!> Contact of the sides of a body with one another that no card gives.
!>
!> A part that folds onto itself, or whose hole closes, passes through itself where nothing keeps its sides apart (own_crossings).
!> Where shorter steps do so too its sides have met: from there on all free sides of the body are deformable dies, one for each
!> curve of them, and face one another, by the law of the first of the body's contacts that opens. So what folds nowhere has nothing
!> of this.
!>
!> A body of which a card lets sides meet is left as the card has it.
module folding_bodies
  use bodies, only: bodies_of_nodes
  use card_groups, only: append_group, start_group
  use cards_side_dies, only: curve_of_sides
  use contact_penalties, only: tangential_share
  use contact_rule, only: rule_on_body
  use contact_stiffness, only: find_stiffness
  use diagnostics, only: location_t
  use dies, only: die_t, place_on_nodes
  use law_api, only: law_of_material, law_t
  use own_contact, only: faces_itself, group_named
  use own_sides, only: list_own_sides
  use remesh, only: remesh_t
  use scene, only: group_t, role_contact, scene_t
  use scene_draft, only: draft_t
  use text, only: to_text
  implicit none
  private
  public :: give_own_contact, law_of_folds

contains

  !> The law by which the sides of a body would press on one another, place among the materials; 0 where there is none, or where the
  !> body's sides face one another already.
  pure function law_of_folds(scene, laws, g) result(material)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g          !! a group of elements of the body
    integer :: material
    integer :: body(size(scene%mesh%coordinates, 2)), k

    material = 0
    body = bodies_of_nodes(scene)
    do k = size(scene%groups), 1, -1
      associate (group => scene%groups(k))
        if (group%role /= role_contact .or. group%material == 0) cycle
        if (.not. any(body(group%connectivity(2, :)) == body(scene%groups(g)%connectivity(1, 1)))) cycle
        if (faces_itself(scene, group)) then
          material = 0
          return
        end if
        if (.not. laws(scene%materials(group%material)%law_id)%lasts) material = group%material
      end associate
    end do
  end function law_of_folds

  !> Dies and contacts of a body whose sides have met, behind all others. On a new mesh its sides are those that the remesher has
  !> put in their place.
  subroutine give_own_contact(name, remesh, draft)
    character(len=*), intent(in) :: name             !! of a group of the body
    type(remesh_t), intent(in), optional :: remesh
    type(draft_t), intent(inout) :: draft
    integer, allocatable :: rest(:, :), sides(:, :), curve(:, :)
    integer :: g, material, first, i, k
    logical :: known

    if (.not. (draft%mesh_sound .and. draft%groups_sound)) return
    g = group_named(draft%scene, name)
    if (g == 0) return
    material = law_of_folds(draft%scene, draft%laws, g)
    if (material == 0) return
    call list_own_sides(draft%scene, draft%laws, draft%sharing, draft%mesh_size, g, rest)
    known = .false.
    if (present(remesh)) then
      call sides_of_remesh(remesh, name_of_curve(name, 1), sides)
      known = size(sides, 2) > 0
    end if
    first = size(draft%scene%dies) + 1
    k = 0
    do
      k = k + 1
      if (known) then
        call sides_of_remesh(remesh, name_of_curve(name, k), sides)
        call curve_of_sides(sides, curve)
      else
        call curve_of_sides(rest, curve)
        sides = curve([3, 2, 1], :)
        rest = without(rest, curve)
      end if
      if (size(curve, 2) == 0) exit
      call add_die(name_of_curve(name, k), curve, draft)
      do i = first, size(draft%scene%dies)
        call add_contact(material, i, sides, draft)
      end do
    end do
  end subroutine give_own_contact

  !> Name of the die, and of the contact with itself, of one of the curves of a body; no card can give it.
  pure function name_of_curve(name, k)
    character(len=*), intent(in) :: name   !! of the body
    integer, intent(in) :: k               !! number of the curve
    character(len=:), allocatable :: name_of_curve

    name_of_curve = name//'/itself'
    if (k > 1) name_of_curve = name_of_curve//'.'//to_text(k)
  end function name_of_curve

  !> The sides of a contact on the mesh of a remesh; none where it has no such contact.
  pure subroutine sides_of_remesh(remesh, name, sides)
    type(remesh_t), intent(in) :: remesh
    character(len=*), intent(in) :: name
    integer, allocatable, intent(out) :: sides(:, :)   !! (3, nside)
    integer :: g

    allocate (sides(3, 0))
    do g = 1, size(remesh%groups)
      if (remesh%groups(g)%name == name) sides = remesh%groups(g)%connectivity
    end do
  end subroutine sides_of_remesh

  !> The sides that are not pieces of a curve.
  pure function without(sides, curve) result(rest)
    integer, intent(in) :: sides(:, :), curve(:, :)   !! (3, n)
    integer, allocatable :: rest(:, :)
    integer :: k

    rest = sides(:, pack([(k, k=1, size(sides, 2))], [(.not. any(curve(2, :) == sides(2, k)), k=1, size(sides, 2))]))
  end function without

  subroutine add_die(name, curve, draft)
    character(len=*), intent(in) :: name
    integer, intent(in) :: curve(:, :)   !! (3, npiece) nodes, along the die
    type(draft_t), intent(inout) :: draft
    type(die_t) :: die

    die%name = name
    die%unasked = .true.
    die%nodes = curve
    allocate (die%pieces(2, 3, size(curve, 2)))
    call place_on_nodes(draft%scene%mesh%coordinates, die)
    draft%scene%dies = [draft%scene%dies, die]
  end subroutine add_die

  !> Contact of the sides of the last die with a die, that one or another of the body.
  subroutine add_contact(material, die, sides, draft)
    integer, intent(in) :: material, die   !! places among the materials and the dies
    integer, intent(in) :: sides(:, :)     !! (3, nside)
    type(draft_t), intent(inout) :: draft
    type(group_t) :: group
    type(location_t) :: nowhere

    call start_group('CNTDF', draft, group)
    associate (dies => draft%scene%dies)
      group%name = dies(size(dies))%name
      if (die < size(dies)) group%name = group%name//'/'//dies(die)%name
    end associate
    group%die = die
    group%connectivity = sides
    group%pairs = maxval([0, draft%scene%groups%pairs]) + 1
    group%material = material
    group%rule_is_chosen = .true.
    group%rule = rule_on_body(draft%scene, group)
    associate (law => draft%laws(draft%scene%materials(material)%law_id))
      deallocate (group%variables)
      call draft%elems(group%elem_id)%variables(law_of_material(law, draft%scene%materials(material)), draft%scene%plane_state, &
                                                group%variables)
      group%tangential_share = tangential_share(law, draft%scene%materials(material))
    end associate
    call find_stiffness(draft, group)
    call append_group(draft, group, nowhere)
  end subroutine add_contact

end module folding_bodies
