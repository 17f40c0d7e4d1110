!> The temperature at the points of a body: what drives its law.
!>
!> It is that of a TEMPE card, the same everywhere, or the field `temperature` of the run. Strains of the 8-node element are linear
!> to the order that counts, a temperature on eight nodes is quadratic: a thermal strain of second degree would make stresses that
!> no strain can answer. The temperature at the points is therefore its projection on the bilinear functions: that through its
!> values at 2 x 2 Gauss points, where the part of second degree (Legendre's) vanishes. Source: J. Barlow, Int. J. Num. Meth.
!> Engng 10 (1976) 243-251.
module point_temperatures
  use elem_api, only: layout_t
  use kinds, only: wp
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use quadrature, only: square_rule
  implicit none
  private
  public :: nodal_temperatures, point_temperatures_of, projected_functions, temperature_field, temperature_place

  !> Name of the field.
  character(len=*), parameter :: temperature_field = 'temperature'

contains

  !> Place of the temperature among the fields of an element's layout, 0 where the element has none: the only field of one
  !> component that solids read.
  pure function temperature_place(layout) result(u)
    type(layout_t), intent(in) :: layout
    integer :: u
    integer :: k

    u = 0
    do k = 1, layout%nfield
      if (layout%first(1, k) > 0 .and. layout%first(2, k) == 0) u = k
    end do
  end function temperature_place

  !> Values at the eight nodes: those of corners, and in the middle of sides the mean of the ends where there are no others.
  pure function nodal_temperatures(values) result(nodal)
    real(wp), intent(in) :: values(:)   !! (4) or (8) [temperature]
    real(wp) :: nodal(8)

    nodal(:size(values)) = values
    if (size(values) == 4) nodal(5:8) = 0.5_wp*(values + cshift(values, 1))
  end function nodal_temperatures

  !> Functions of the nodal temperatures at the points of a rule, projected on the bilinear ones.
  pure function projected_functions(rule) result(phi)
    type(quad8_rule_t), intent(in) :: rule
    real(wp) :: phi(8, rule%npoint)   !! (8, npoint)
    type(quad8_rule_t) :: barlow
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: share(4)
    integer :: p

    phi = rule%phi(:, :rule%npoint)
    if (rule%npoint <= 4) return
    call quad8_rule(4, barlow)
    call square_rule(rule%npoint, xi, weight)
    do p = 1, rule%npoint
      ! xi runs fastest among the points; parent coordinates over those of the Gauss points, sqrt(1/3)
      associate (a => sqrt(3.0_wp)*xi(1, p), b => sqrt(3.0_wp)*xi(2, p))
        share = 0.25_wp*[(1 - a)*(1 - b), (1 + a)*(1 - b), (1 - a)*(1 + b), (1 + a)*(1 + b)]
      end associate
      phi(:, p) = matmul(barlow%phi(:, :4), share)
    end do
  end function projected_functions

  !> Temperatures at the start and at the end of the step at the points of one element that has them among its unknowns.
  pure subroutine point_temperatures_of(layout, phi, du, start, temperature)
    type(layout_t), intent(in) :: layout
    real(wp), intent(in) :: phi(:, :)            !! (8, npoint) shape functions [-]
    real(wp), intent(in) :: du(:)                !! (ndof) motion of the local unknowns [unknown]
    real(wp), intent(in) :: start(:)             !! (ndof) their values at the start of the step [unknown]
    real(wp), intent(out) :: temperature(:, :)   !! (2, npoint) [temperature]
    real(wp) :: nodal(2, 8)
    integer :: u, first, last

    u = temperature_place(layout)
    first = layout%first(1, u)
    last = first + layout%count(u) - 1
    nodal(1, :) = nodal_temperatures(start(first:last))
    nodal(2, :) = nodal_temperatures(start(first:last) + du(first:last))
    temperature = matmul(nodal, phi(:, :size(temperature, 2)))
  end subroutine point_temperatures_of

end module point_temperatures
