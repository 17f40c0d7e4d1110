!> Method 1: moving least squares over the nearest integration points (generalised finite differences).
!>
!> Sources: P. Lancaster, K. Salkauskas, Math. Comput. 37 (1981) 141-158; T. Liszka, J. Orkisz, Comput. Struct. 11 (1980) 83-95.
!> The weight of a neighbour is the quartic spline of T. Belytschko et al., Comput. Methods Appl. Mech. Eng. 139 (1996) 3-47,
!> eq. 20; it vanishes at the nearest point left out, so that values are continuous as neighbours change.
module transfer_moving_squares
  use connected_points, only: nearest_connected
  use errors, only: error_t
  use kinds, only: wp
  use local_fit, only: fit_polynomial, max_terms, most_amplified, terms_of
  use locate_point, only: element_location_t, locate
  use patch_nodes, only: number_nodes, patch_nodes_t
  use transfer_api, only: check_materials, transfer_options_t, transfer_t
  use transfer_map, only: append_rows, start_rows, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: transfer_moving_squares_row

  !> How often the neighbours are doubled, where they do not determine the polynomial, before its degree is lowered: in a layer of
  !> flat elements the nearest points lie on a line.
  integer, parameter :: doublings = 2
  !> Points whose rows are appended to the map at once.
  integer, parameter :: block = 512

contains

  function transfer_moving_squares_row() result(row)
    type(transfer_t) :: row

    row%name = 'SQUARES'
    row%purpose = 'polynomial through the nearest points by moving least squares'
    row%number = 1
    row%exact_degree = 2
    row%weights => weights
  end function transfer_moving_squares_row

  subroutine weights(mesh, options, points, material, map, error)
    type(transfer_mesh_t), intent(in) :: mesh
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: points(:, :)
    integer, intent(in) :: material(:)
    type(transfer_map_t), intent(out) :: map
    type(error_t), allocatable, intent(out) :: error
    type(patch_nodes_t) :: nodes
    type(element_location_t) :: location
    integer :: source(options%neighbours*2**doublings, block), used(block), p, k, n
    real(wp) :: weight(size(source, 1), block)

    call check_materials(mesh, material, error)
    if (allocated(error)) return
    call number_nodes(mesh, nodes)
    n = size(material)
    call start_rows(n, map)
    allocate (map%outside(n), source=0.0_wp)
    allocate (map%degree(n), source=0)
    do p = 0, n - 1, block
      !$omp parallel do schedule(static) private(location)
      do k = 1, min(block, n - p)
        call locate(mesh, material(p + k), points(:, p + k), 0.0_wp, location)
        map%outside(p + k) = location%distance
        call weights_of_point(mesh, nodes, options, points(:, p + k), location%element, source(:, k), weight(:, k), used(k), &
                              map%degree(p + k))
      end do
      !$omp end parallel do
      call append_rows(p, source, weight, used(:min(block, n - p)), map)
    end do
  end subroutine weights

  !> The polynomial's value at its centre is its first coefficient. More points, then a lower degree, until they determine it.
  pure subroutine weights_of_point(mesh, nodes, options, point, element, source, weight, used, degree)
    type(transfer_mesh_t), intent(in) :: mesh
    type(patch_nodes_t), intent(in) :: nodes
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: point(2)
    integer, intent(in) :: element
    integer, intent(out) :: source(:)
    real(wp), intent(out) :: weight(:)
    integer, intent(out) :: used, degree
    integer :: items(size(source) + 1), found, n, doubling
    real(wp) :: squares(size(source) + 1), local(2, size(source)), fit(max_terms, size(source)), kernel(size(source)), reach
    logical :: determined

    determined = .false.
    n = 0
    do degree = options%degree, 0, -1
      do doubling = 0, doublings
        n = options%neighbours*2**doubling
        call nearest_connected(mesh, nodes, element, point, found, items(:n + 1), squares(:n + 1))
        ! the last point found sets the radius; where the material has no more points all of them are used
        if (found == n + 1) then
          reach = sqrt(squares(n + 1))
        else
          n = found
          reach = 2*sqrt(squares(n))
        end if
        if (.not. reach > 0) reach = 1
        kernel(:n) = quartic(sqrt(squares(:n))/reach)
        local(:, :n) = (mesh%points(:, items(:n)) - spread(point, 2, n))/reach
        call fit_polynomial(local(:, :n), kernel(:n), terms_of(degree), fit(:, :n), determined)
        if (determined .and. degree > 0) determined = sum(abs(fit(1, :n))) <= most_amplified
        if (determined .or. found <= n) exit
      end do
      if (determined) exit
    end do
    used = n
    source(:n) = items(:n)
    weight(:n) = fit(1, :n)
    if (determined) return
    ! all points at the same distance: their mean
    degree = 0
    weight(:n) = 1/real(n, wp)
  end subroutine weights_of_point

  !> 1 at s = 0, 0 with its first two derivatives at s = 1.
  pure elemental function quartic(s) result(w)
    real(wp), intent(in) :: s
    real(wp) :: w

    w = 0
    ! 1 - 6 s^2 + 8 s^3 - 3 s^4, never below 0 by round-off
    if (s < 1) w = (1 - s)**3*(1 + 3*s)
  end function quartic

end module transfer_moving_squares
