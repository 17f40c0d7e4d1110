!> Heat that is conducted in an element of PL8TM.
module heat_conduction
  use elem_api, only: instant_t
  use heat_points, only: functions_t, heat_points_t
  use kinds, only: wp
  use law_api, only: driver_temperature, law_t
  use materials, only: material_t
  implicit none
  private
  public :: add_flow

contains

  !> Heat conducted at one of the instants of the flow rule.
  pure subroutine add_flow(instant, k, law, material, finite, npoint, own, place, drivers, by_end, change, start, u, &
                           force, stiffness)
    type(instant_t), intent(in) :: instant
    integer, intent(in) :: k
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical, intent(in) :: finite
    integer, intent(in) :: npoint
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: drivers(:, :, :)      !! (ndriver, 2, npoint) [unit of each driver]
    real(wp), intent(in) :: change(:), start(:)   !! (n) of temperatures in the step, and they at its start [temperature]
    real(wp), intent(in) :: by_end(:, :)          !! (ndriver, npoint) d(drivers at the end)/d(temperature there) [unit/temperature]
    integer, intent(in) :: u                      !! local place of the first displacement, 0 where there is none
    real(wp), intent(inout) :: force(:)           !! (ndof) [power]
    real(wp), intent(inout) :: stiffness(:, :)    !! (ndof, ndof) [power/unknown]
    real(wp) :: t(size(start)), given(max(1, size(drivers, 1)), npoint), lambda(npoint), by_temperature(npoint), slope(2), dv
    real(wp) :: by_driver(max(1, size(drivers, 1)), npoint)
    integer :: p, j, i, n

    n = own%n
    associate (share => instant%flow%share(k), weight => instant%flow%weight(k))
      t = start + share*change
      given = 0
      if (size(drivers, 1) > 1) given(2:, :) = (1 - share)*drivers(2:, 1, :) + share*drivers(2:, 2, :)
      given(driver_temperature, :) = matmul(t, own%phi(:n, :npoint))
      if (instant%tangent .and. any(abs(by_end) > 0)) then
        call law%conduct(material, given, lambda, by_temperature, by_driver)
        by_temperature = by_temperature + sum(by_driver*by_end, 1)
      else
        call law%conduct(material, given, lambda, by_temperature)
      end if
      do p = 1, npoint
        dv = weight*place%dv(p)
        associate (gx => place%gx(:n, p), gy => place%gy(:n, p), nx => place%nx(:, p), ny => place%ny(:, p))
          slope = lambda(p)*[dot_product(gx, t), dot_product(gy, t)]
          force(:n) = force(:n) + dv*(gx*slope(1) + gy*slope(2))
          if (.not. instant%tangent) cycle
          do j = 1, n
            stiffness(:n, j) = stiffness(:n, j) + (share*dv*lambda(p))*(gx*gx(j) + gy*gy(j))
            if (abs(by_temperature(p)) > 0) stiffness(:n, j) = stiffness(:n, j) &
                                            + (share*dv*by_temperature(p)/lambda(p)*own%phi(j, p))*(gx*slope(1) + gy*slope(2))
          end do
          if (u == 0 .or. .not. finite) cycle
          do j = 1, 16
            stiffness(:n, u + j - 1) = stiffness(:n, u + j - 1) + dv*place%swelling(j, p)*(gx*slope(1) + gy*slope(2))
          end do
          ! gradients turn and stretch with the geometry: d(grad phi) = - grad(du)^T grad phi
          do j = 1, 8
            i = u + j - 1
            associate (along => nx(j)*slope(1) + ny(j)*slope(2), cross => gx*nx(j) + gy*ny(j))
              stiffness(:n, i) = stiffness(:n, i) - dv*(gx*along + cross*slope(1))
              stiffness(:n, i + 8) = stiffness(:n, i + 8) - dv*(gy*along + cross*slope(2))
            end associate
          end do
        end associate
      end do
      if (instant%monotone) call limit_flow(instant%tangent, share, weight*place%dv(:npoint)*lambda, &
                                            weight*place%dv(:npoint)*by_temperature, own, place, t, force, stiffness)
    end associate
  end subroutine add_flow

  !> Take out what flows between two nodes from the colder to the warmer one, as in elements far from rectangles: positive entries
  !> beside the diagonal of the matrix of conduction. The rest is a matrix of which no temperature leaves those around it, by lumped
  !> capacity and implicit Euler; what one node loses the other still gains. Source: D. Kuzmin, M.J. Shashkov, D. Svyatskiy,
  !> J. Comput. Phys. 228 (2009) 3448-3463.
  pure subroutine limit_flow(tangent, share, conduction, by_temperature, own, place, t, force, stiffness)
    logical, intent(in) :: tangent
    real(wp), intent(in) :: share               !! of the step after which the flow is [-]
    real(wp), intent(in) :: conduction(:)       !! (npoint) conductivity times volume [power*length/temperature]
    real(wp), intent(in) :: by_temperature(:)   !! (npoint) its derivative
    type(functions_t), intent(in) :: own
    type(heat_points_t), intent(in) :: place
    real(wp), intent(in) :: t(:)                !! (n) temperatures [temperature]
    real(wp), intent(inout) :: force(:), stiffness(:, :)
    real(wp) :: product(size(conduction)), entry, slope
    integer :: i, j, k, m

    m = size(conduction)
    do i = 1, own%n
      do j = i + 1, own%n
        product = place%gx(i, :m)*place%gx(j, :m) + place%gy(i, :m)*place%gy(j, :m)
        entry = dot_product(conduction, product)
        if (.not. entry > 0) cycle
        force([i, j]) = force([i, j]) - entry*[t(j) - t(i), t(i) - t(j)]
        if (.not. tangent) cycle
        stiffness([i, j], i) = stiffness([i, j], i) + share*entry*[1, -1]
        stiffness([i, j], j) = stiffness([i, j], j) + share*entry*[-1, 1]
        do k = 1, own%n
          slope = share*sum(by_temperature*own%phi(k, :m)*product)
          stiffness([i, j], k) = stiffness([i, j], k) - slope*[t(j) - t(i), t(i) - t(j)]
        end do
      end do
    end do
  end subroutine limit_flow

end module heat_conduction
