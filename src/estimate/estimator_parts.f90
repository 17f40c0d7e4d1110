!> What an estimator of errors makes once for a mesh: the elements of every material, and their patches.
module estimator_parts
  use law_api, only: law_elastic_i, law_t
  use recovered_errors, only: fields_of_rule, fields_t
  use scene, only: group_t, host_of, is_solid, role_body, role_second, scene_t
  use state_variables, only: find_variable
  use vertex_patches, only: find_patches, patches_t
  implicit none
  private
  public :: estimator_t, part_t, set_up_estimator

  !> Elements of one material.
  type :: part_t
    integer :: material = 0
    type(patches_t) :: patches
    integer, allocatable :: connectivity(:, :)   !! (8, nelem)
    !> Group, element of the group, number among all solid elements, rule (nelem).
    integer, allocatable :: group(:), element(:), place(:), rule(:)
  end type part_t

  !> Elastic constants of a material by temperature; not associated where its law has none.
  type :: constants_t
    procedure(law_elastic_i), nopass, pointer :: at => null()
  end type constants_t

  !> What is made once for a mesh.
  type :: estimator_t
    type(part_t), allocatable :: parts(:)
    type(fields_t) :: fields(2)
    !> Elastic constants of each material.
    type(constants_t), allocatable :: constants(:)
    !> Every solid law has elastic moduli: errors are energies.
    logical :: elastic = .true.
  end type estimator_t

contains

  !> Patches of all materials.
  pure subroutine set_up_estimator(scene, laws, self)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(estimator_t), intent(out) :: self
    integer :: m, n
    integer :: list(size(scene%materials))

    self%fields = [fields_of_rule(4), fields_of_rule(9)]
    allocate (self%constants(size(scene%materials)))
    n = 0
    do m = 1, size(scene%materials)
      if (.not. any(is_part(scene, m))) cycle
      n = n + 1
      list(n) = m
      self%constants(m)%at => laws(scene%materials(m)%law_id)%elastic
      self%elastic = self%elastic .and. associated(self%constants(m)%at)
    end do
    allocate (self%parts(n))
    do m = 1, n
      call gather_part(scene, list(m), self%parts(m))
    end do
  end subroutine set_up_estimator

  !> Groups of elements of a material.
  pure function is_part(scene, material) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material
    logical :: yes(size(scene%groups))
    integer :: g

    do g = 1, size(yes)
      yes(g) = bears_stress(scene%groups(g)) .and. scene%groups(g)%material == material
    end do
  end function is_part

  !> A body, or what is added to one (ADDEL), whose points have a stress: one of heat alone has none.
  pure function bears_stress(group) result(yes)
    type(group_t), intent(in) :: group
    logical :: yes

    yes = any(group%role == [role_body, role_second])
    if (yes) yes = find_variable(group%variables, 'stress') > 0
  end function bears_stress

  !> Elements of bodies before the first one of a group.
  pure function elements_before(scene, g) result(n)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g   !! number of the group
    integer :: n
    integer :: k

    n = 0
    do k = 1, host_of(scene, g) - 1
      if (is_solid(scene%groups(k))) n = n + size(scene%groups(k)%connectivity, 2)
    end do
  end function elements_before

  pure subroutine gather_part(scene, material, part)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material
    type(part_t), intent(out) :: part
    logical :: mine(size(scene%groups))
    integer :: g, e, n, before, total

    mine = is_part(scene, material)
    total = 0
    do g = 1, size(mine)
      if (mine(g)) total = total + size(scene%groups(g)%connectivity, 2)
    end do
    part%material = material
    allocate (part%connectivity(8, total), part%group(total), part%element(total), part%place(total), part%rule(total))
    n = 0
    do g = 1, size(mine)
      if (.not. mine(g)) cycle
      before = elements_before(scene, g)
      do e = 1, size(scene%groups(g)%connectivity, 2)
        n = n + 1
        part%connectivity(:, n) = scene%groups(g)%connectivity(:, e)
        part%group(n) = g
        part%element(n) = e
        part%place(n) = before + e
        part%rule(n) = merge(1, 2, scene%groups(g)%rule%n == 4)
      end do
    end do
    call find_patches(part%connectivity, part%patches)
  end subroutine gather_part

end module estimator_parts
