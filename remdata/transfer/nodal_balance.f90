!> Temperatures at nodes that keep what they held: their means over the volume of each material, as on the old mesh.
!>
!> The shape functions of the old mesh give the new nodes values that are right there, but lines between these are not the old ones:
!> where temperatures fall towards the inside of a part, as from a chilled face, they lie above. What that makes is taken off where
!> it is, c_i = integral N_i (old - new) / integral N_i with bilinear N over the points of the elements, within the range of the
!> material; what is left, as their sum is not exact, in proportion to the distances from both ends of the range (transfer_balance).
module nodal_balance
  use errors, only: error_t
  use fields, only: fill_middle_nodes
  use kinds, only: wp
  use quadrature, only: square_rule
  use shape_functions, only: quad4, quad8
  use transfer_api, only: transfer_options_t
  use transfer_balance, only: same_integral
  use transfer_map, only: carry, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  use transfer_nodes, only: shape_weights
  implicit none
  private
  public :: keep_nodal_means, mean_of_nodal

  integer, parameter :: most_sweeps = 50

contains

  !> Values at the nodes of a new mesh, carried there by shape functions, so that the means over the materials are those of the old.
  !> Nodes that materials share stay as they are.
  subroutine keep_nodal_means(old, values, corners_only, options, new, new_values, error)
    type(transfer_mesh_t), intent(in) :: old, new   !! the old one with its trees
    real(wp), intent(in) :: values(:)               !! (nnode) of the old mesh [unit of the field]
    logical, intent(in) :: corners_only             !! in the middle of sides the field is the mean of the ends
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(inout) :: new_values(:)        !! (nnode) [unit of the field]
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: old_at_points(1, size(new%volumes)), lower, upper, mean, volume
    logical :: own(size(new_values)), here(size(new%volumes))
    type(transfer_map_t) :: map
    integer :: m, k

    if (corners_only) call fill_middle(new, new_values)
    call shape_weights(old, old%connectivity, new%points, new%point_material, options%outside, map, error)
    if (allocated(error)) return
    call carry(map, reshape(values, [1, size(values)]), old_at_points)
    do m = 1, new%nmaterial
      own = .false.
      do k = 1, size(new%material)
        if (new%material(k) == m) own(new%connectivity(:, k)) = .true.
      end do
      do k = 1, size(new%material)
        if (new%material(k) /= m) own(new%connectivity(:, k)) = .false.
      end do
      if (.not. (any(own) .and. any(old%material == m))) cycle
      lower = huge(lower)
      upper = -huge(upper)
      do k = 1, size(old%material)
        if (old%material(k) /= m) cycle
        lower = min(lower, minval(values(old%connectivity(:, k))))
        upper = max(upper, maxval(values(old%connectivity(:, k))))
      end do
      if (.not. upper > lower) cycle
      call take_off_here(new, m, own, old_at_points(1, :), lower, upper, new_values)
      here = new%point_material == m
      volume = sum(new%volumes, mask=here)
      mean = mean_of_nodal(old, m, values)
      ! a part that was cut has the mean of what is left, as far as the new points see it
      if (options%was_cut(m)) mean = sum(old_at_points(1, :)*new%volumes, mask=here)/volume
      call keep_mean_of_all(new, m, own, corners_only, mean, lower, upper, new_values)
    end do
  end subroutine keep_nodal_means

  !> Mean of a nodal field over the volume of a material.
  pure function mean_of_nodal(mesh, m, values) result(mean)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: m             !! number of the material
    real(wp), intent(in) :: values(:)    !! (nnode) [unit of the field]
    real(wp) :: mean
    real(wp) :: at_points(size(mesh%volumes))

    call interpolate(mesh, values, at_points)
    mean = sum(at_points*mesh%volumes, mask=mesh%point_material == m)/sum(mesh%volumes, mask=mesh%point_material == m)
  end function mean_of_nodal

  !> Values at the integration points by the shape functions of the mesh.
  pure subroutine interpolate(mesh, values, at_points)
    type(transfer_mesh_t), intent(in) :: mesh
    real(wp), intent(in) :: values(:)        !! (nnode) [unit of the field]
    real(wp), intent(out) :: at_points(:)    !! (npoint) [unit of the field]
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8), dphi(2, 8)
    integer :: e, p, n

    n = 0
    do e = 1, size(mesh%material)
      associate (first => mesh%first_point(e), rule => mesh%first_point(e + 1) - mesh%first_point(e))
        if (rule /= n) call square_rule(rule, xi, weight)
        n = rule
        do p = 1, rule
          call quad8(xi(1, p), xi(2, p), phi, dphi)
          at_points(first + p - 1) = dot_product(phi, values(mesh%connectivity(:, e)))
        end do
      end associate
    end do
  end subroutine interpolate

  !> The difference to the old field at the points, taken off at the corners of their elements and, by the mean, between these.
  pure subroutine take_off_here(mesh, m, own, old_at_points, lower, upper, values)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: m                     !! number of the material
    logical, intent(in) :: own(:)                !! (nnode) of this material alone
    real(wp), intent(in) :: old_at_points(:)     !! (npoint) [unit of the field]
    real(wp), intent(in) :: lower, upper         !! range of the material [unit of the field]
    real(wp), intent(inout) :: values(:)         !! (nnode) [unit of the field]
    real(wp) :: at_points(size(mesh%volumes)), total(size(values)), volume(size(values)), change(1, size(values))
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(4), part
    integer :: e, p, n

    call interpolate(mesh, values, at_points)
    total = 0
    volume = 0
    n = 0
    do e = 1, size(mesh%material)
      if (mesh%material(e) /= m) cycle
      associate (first => mesh%first_point(e), rule => mesh%first_point(e + 1) - mesh%first_point(e), &
                 corners => mesh%connectivity(:4, e))
        if (rule /= n) call square_rule(rule, xi, weight)
        n = rule
        do p = first, first + rule - 1
          call quad4(xi(1, p - first + 1), xi(2, p - first + 1), phi)
          part = mesh%volumes(p)*(old_at_points(p) - at_points(p))
          total(corners) = total(corners) + phi*part
          volume(corners) = volume(corners) + phi*mesh%volumes(p)
        end do
      end associate
    end do
    change(1, :) = merge(total/merge(volume, 1.0_wp, volume > 0), 0.0_wp, own .and. volume > 0)
    change(1, :) = max(min(lower - values, 0.0_wp), min(max(upper - values, 0.0_wp), change(1, :)))
    call fill_middle_nodes(mesh%connectivity(:, pack([(e, e=1, size(mesh%material))], mesh%material == m)), change)
    values = values + merge(change(1, :), 0.0_wp, own)
  end subroutine take_off_here

  !> What is left, by nodes that are at neither end of the range.
  pure subroutine keep_mean_of_all(mesh, m, own, corners_only, mean, lower, upper, values)
    type(transfer_mesh_t), intent(in) :: mesh
    integer, intent(in) :: m               !! number of the material
    logical, intent(in) :: own(:)          !! (nnode) of this material alone
    logical, intent(in) :: corners_only
    real(wp), intent(in) :: mean, lower, upper   !! that is wanted; range of the material [unit of the field]
    real(wp), intent(inout) :: values(:)   !! (nnode) [unit of the field]
    real(wp) :: freedom(size(values)), missing, room
    integer :: sweep

    do sweep = 1, most_sweeps
      missing = mean - mean_of_nodal(mesh, m, values)
      if (abs(missing) <= same_integral*(upper - lower)) exit
      freedom = merge(max(0.0_wp, values - lower)*max(0.0_wp, upper - values)/(upper - lower), 0.0_wp, own)
      if (corners_only) call fill_middle(mesh, freedom)
      room = mean_of_nodal(mesh, m, freedom)
      if (.not. room > tiny(1.0_wp)) exit
      values = values + max(-1.0_wp, min(1.0_wp, missing/room))*freedom
      if (corners_only) call fill_middle(mesh, values)
    end do
  end subroutine keep_mean_of_all

  pure subroutine fill_middle(mesh, values)
    type(transfer_mesh_t), intent(in) :: mesh
    real(wp), intent(inout) :: values(:)   !! (nnode) [unit of the field]
    real(wp) :: row(1, size(values))

    row(1, :) = values
    call fill_middle_nodes(mesh%connectivity, row)
    values = row(1, :)
  end subroutine fill_middle

end module nodal_balance
