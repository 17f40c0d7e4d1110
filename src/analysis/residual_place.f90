!> How large a residual force is, and where it acts: it shows whether a remesh failed, and at which stage.
module residual_place
  use dofs, only: dofs_t
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  use sharp_corners, only: least_scaled_jacobian
  implicit none
  private
  public :: bad_shape, least_shape, place_residual, residual_place_t

  type :: residual_place_t
    !> Node that carries most of it, 0 where there is none.
    integer :: node = 0
    !> Its norm over that of the forces at the nodes of sides that face dies, at supports and at loads. (Over those at all nodes a
    !> loss of all contact would look the smaller, the finer the mesh.)
    real(wp) :: relative = 0.0_wp
    !> Share of its square at nodes of sides that face dies.
    real(wp) :: at_contact = 0.0_wp
  end type residual_place_t

  !> Elements of a smaller scaled Jacobian are distorted (the remesher makes none but in sharper corners).
  real(wp), parameter :: bad_shape = 0.2_wp

contains

  pure subroutine place_residual(scene, dofs, external, magnitude, residual, place)
    type(scene_t), intent(in) :: scene
    type(dofs_t), intent(in) :: dofs
    real(wp), intent(in) :: external(:)    !! loads (ndof) [force]
    real(wp), intent(in) :: magnitude(:)   !! sum of what elements do there, each by its size (ndof) [force]
    real(wp), intent(in) :: residual(:)    !! of free unknowns, 0 elsewhere (ndof) [force]
    type(residual_place_t), intent(out) :: place
    real(wp) :: square(size(dofs%fields(displacement_field)%number, 2)), reference, largest
    logical :: on_side(size(dofs%fields(displacement_field)%number, 2))
    integer :: g, e, k, c, d

    on_side = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. scene%groups(g)%material == 0) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        on_side(scene%groups(g)%connectivity(:, e)) = .true.
      end do
    end do
    square = 0
    reference = 0
    largest = 0
    do k = 1, size(square)
      do c = 1, 2
        d = dofs%fields(displacement_field)%number(c, k)
        if (d == 0) cycle
        square(k) = square(k) + residual(d)**2
        largest = largest + magnitude(d)**2
        if (.not. (on_side(k) .or. .not. dofs%is_free(d) .or. abs(external(d)) > 0)) cycle
        reference = reference + max(magnitude(d), abs(external(d)))**2
      end do
    end do
    if (.not. any(square > 0)) return
    ! nothing holds or loads the body: there are only residual stresses
    if (.not. reference > 0) reference = largest
    if (reference > 0) place%relative = sqrt(sum(square)/reference)
    place%node = maxloc(square, 1)
    place%at_contact = sum(square, mask=on_side)/sum(square)
  end subroutine place_residual

  !> Least scaled Jacobian of the elements, or of those around a node, but where a corner of their material is sharper itself.
  pure function least_shape(scene, x, node) result(least)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)   !! nodes (2, nnode) [length]
    integer, intent(in), optional :: node
    real(wp) :: least
    integer, allocatable :: connectivity(:, :), material(:)
    logical, allocatable :: counts(:)
    integer :: nelem, n, g, e

    nelem = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) nelem = nelem + size(scene%groups(g)%connectivity, 2)
    end do
    allocate (connectivity(8, nelem), material(nelem), counts(nelem))
    n = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        n = n + 1
        connectivity(:, n) = scene%groups(g)%connectivity(:, e)
        material(n) = scene%groups(g)%material
      end do
    end do
    counts = .true.
    if (present(node)) counts = [(any(connectivity(:, e) == node), e=1, nelem)]
    least = least_scaled_jacobian(x, connectivity, material, bad_shape, counts)
  end function least_shape

end module residual_place
