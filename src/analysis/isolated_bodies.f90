!> Bodies whose temperature never changes, known before the run: alike everywhere at the start, with nothing that brings or takes
!> heat, and none made within. Mostly a card of exchange that was forgotten.
module isolated_bodies
  use fields, only: field_t, find_field
  use heat_sources, only: work_heated
  use kinds, only: wp
  use law_api, only: find_parameter, heat_law, law_t
  use materials, only: material_t
  use phase_growth, only: forms
  use scene, only: group_t, host_of, scene_t
  use solution, only: start_fields
  use state_variables, only: find_variable
  use steels, only: first_diffusive, last_diffusive
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: judge_isolated

contains

  !> A line for each such body. Bodies that share nodes are one; in a deck of several operations a later one may bring heat.
  subroutine judge_isolated(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    type(field_t), allocatable :: fields(:)
    logical :: changes(size(scene%mesh%coordinates, 2)), of_heat(size(scene%groups)), again
    integer :: f, g, first

    f = find_field(scene%fields, 'temperature')
    if (f == 0 .or. scene%operations > 1) return
    if (.not. scene%fields(f)%declared .or. scene%fields(f)%given) return
    call start_fields(scene, 0.0_wp, fields)
    of_heat = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      of_heat(g) = laws(scene%materials(scene%groups(g)%material)%law_id)%kind == heat_law
    end do
    call find_heated(scene, laws, of_heat, fields(f)%value(1, :), changes)
    associate (t => fields(f)%value(1, :))
      again = .true.
      do while (again)
        again = .false.
        do g = 1, size(scene%groups)
          if (.not. of_heat(g)) cycle
          associate (nodes => pack(scene%groups(g)%connectivity, .true.))
            if (.not. (any(changes(nodes)) .or. any(abs(t(nodes) - t(nodes(1))) > 0)) .or. all(changes(nodes))) cycle
            changes(nodes) = .true.
            again = .true.
          end associate
        end do
      end do
      do g = 1, size(scene%groups)
        if (.not. of_heat(g)) cycle
        first = scene%groups(g)%connectivity(1, 1)
        if (changes(first)) cycle
        call add_text(warnings, scene%groups(host_of(scene, g))%name//': it neither takes up heat nor loses or makes any, and ' &
                      //'keeps its temperature of '//to_text(t(first), 4)//': no CONVE, RADIA, FLUX, COU2DC, IMPOS T or source ' &
                      //'acts on it')
      end do
    end associate
  end subroutine judge_isolated

  !> Nodes that heat comes to by sides, sources, facing bodies, imposed temperatures, or by the body itself.
  subroutine find_heated(scene, laws, of_heat, temperatures, changes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    logical, intent(in) :: of_heat(:)    !! (ngroup) groups that conduct
    real(wp), intent(in) :: temperatures(:)   !! (nnode) at the start
    logical, intent(out) :: changes(:)   !! (nnode)
    logical :: warms
    integer :: f, g, k

    changes = .false.
    f = find_field(scene%fields, 'temperature')
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g))
        warms = group%brings_heat
        if (of_heat(g) .and. .not. warms) warms = makes_heat(g)
        if (warms) changes(pack(group%connectivity, .true.)) = .true.
        if (.not. group%brings_heat .or. group%die == 0) cycle
        if (allocated(scene%dies(group%die)%nodes)) changes(pack(scene%dies(group%die)%nodes, .true.)) = .true.
      end associate
    end do
    do k = 1, size(scene%fixations)
      if (scene%fixations(k)%field == f) changes(scene%fixations(k)%nodes) = .true.
    end do

  contains

    !> Plastic work, phases or a change of volume release heat in it.
    pure function makes_heat(own) result(yes)
      integer, intent(in) :: own
      logical :: yes

      associate (group => scene%groups(own), material => scene%materials(scene%groups(own)%material))
        yes = find_variable(group%variables, work_heated) > 0
        if (allocated(material%steel)) &
          yes = yes .or. phases_may_form(group, laws(material%law_id), material, temperatures(pack(group%connectivity, .true.)))
        if (yes .or. .not. associated(laws(material%law_id)%swell)) return
        yes = abs(laws(material%law_id)%swell(material, 0.0_wp)) > 0 .or. abs(laws(material%law_id)%swell(material, 1.0_wp)) > 0
      end associate
    end function makes_heat
  end subroutine find_heated

  !> A body of a steel changes its phases at temperatures that stay: not where it is austenite above Ms and all its curves.
  pure function phases_may_form(group, law, material, temperatures) result(yes)
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperatures(:)   !! of its nodes
    logical :: yes
    real(wp) :: t
    integer :: v, k, i

    yes = .true.
    v = find_variable(group%variables, 'austenite')
    if (v == 0) return
    if (group%variables(v)%initial < 1) return
    do k = 1, size(temperatures)
      t = temperatures(k) + material%values(find_parameter(law, 'ZERO'))
      if (t < material%steel%ms) return
      do i = first_diffusive, last_diffusive
        if (forms(material%steel, i, t)) return
      end do
    end do
    yes = .false.
  end function phases_may_form

end module isolated_bodies
