!> Points of an element of heat: functions of the temperature, volumes, gradients and volume strain.
module heat_points
  use elem_api, only: instant_t
  use kinds, only: wp
  use quad8_geometry, only: derivatives, determinant, quad8_rule_t
  use quadrature, only: square_rule
  use scene, only: scene_t
  use sections, only: thickness_at
  use shape_functions, only: quad4, quad8_corner
  implicit none
  private
  public :: functions_t, heat_points_t, functions_of, place_element

  !> Functions of the temperature at the points: values (8, npoint) and parent derivatives (2, 8, npoint), as many as there are.
  type :: functions_t
    integer :: n = 0
    real(wp) :: phi(8, 9) = 0.0_wp, dphi(2, 8, 9) = 0.0_wp
  end type functions_t

  !> Geometry of an element in a step at its points.
  type :: heat_points_t
    real(wp) :: dv(9), dv0(9)                 !! volumes at the end of the step and at the start of the scene
    real(wp) :: worked(9)                     !! volumes that plastic work is per, at the start of the step
    real(wp) :: gx(8, 9), gy(8, 9)            !! gradients of the functions of the temperature
    real(wp) :: nx(8, 9), ny(8, 9)            !! gradients of the shape functions
    real(wp) :: strain(9), swelling(16, 9)    !! volume strain of the step, and its derivative along the displacements
    logical :: valid = .true.
  end type heat_points_t

contains

  !> Functions of the temperature at the points of the rule.
  pure subroutine functions_of(at_corners, rule, own)
    logical, intent(in) :: at_corners
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(out) :: own
    real(wp), allocatable :: xi(:, :), weight(:)
    integer :: p

    if (.not. at_corners) then
      own%n = 8
      own%phi = rule%phi
      own%dphi = rule%dphi
      return
    end if
    own%n = 4
    call square_rule(rule%npoint, xi, weight)
    do p = 1, rule%npoint
      call quad4(xi(1, p), xi(2, p), own%phi(:4, p))
      own%dphi(1, :4, p) = 0.25_wp*quad8_corner(1, :)*(1 + quad8_corner(2, :)*xi(2, p))
      own%dphi(2, :4, p) = 0.25_wp*quad8_corner(2, :)*(1 + quad8_corner(1, :)*xi(1, p))
    end do
  end subroutine functions_of

  !> Volumes, gradients and volume strain at the points of an element.
  pure subroutine place_element(scene, instant, finite, rule, own, x0, x, motion, place)
    type(scene_t), intent(in) :: scene
    type(instant_t), intent(in) :: instant
    logical, intent(in) :: finite
    type(quad8_rule_t), intent(in) :: rule
    type(functions_t), intent(in) :: own
    real(wp), intent(in) :: x0(2, 8), x(2, 8)   !! nodes at the start of the mesh, and of the step [length]
    real(wp), intent(in) :: motion(:)           !! (16) of the nodes, x then y; (0) where the scene has none [length]
    type(heat_points_t), intent(out) :: place
    real(wp) :: y(2, 8), nx(8), ny(8), detj, before, thickness, jacobian(2, 2), section(3)
    logical :: moves, moved
    integer :: p

    moves = size(motion) > 0
    y = x
    if (finite .and. moves) y = x + transpose(reshape(motion, [8, 2]))
    section = scene%section
    if (finite) section = instant%section
    moved = finite .or. any(abs(x - x0) > 0)
    do p = 1, rule%npoint
      if (moves) then
        call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      else
        detj = determinant(rule%dphi(:, :, p), y)
      end if
      thickness = thickness_at(section, matmul(y, rule%phi(:, p)))
      place%dv0(p) = detj*rule%weight(p)*thickness
      before = detj*thickness
      if (finite) before = determinant(rule%dphi(:, :, p), x)*thickness_at(section, matmul(x, rule%phi(:, p)))
      if (moved) place%dv0(p) = determinant(rule%dphi(:, :, p), x0)*rule%weight(p) &
                                *thickness_at(scene%section, matmul(x0, rule%phi(:, p)))
      place%worked(p) = before*rule%weight(p)
      place%valid = place%valid .and. detj > 0 .and. thickness > 0
      if (.not. place%valid) return
      place%dv(p) = detj*thickness*rule%weight(p)
      jacobian(:, 1) = matmul(y, rule%dphi(1, :, p))
      jacobian(:, 2) = matmul(y, rule%dphi(2, :, p))
      associate (d => own%dphi(:, :own%n, p))
        place%gx(:own%n, p) = (jacobian(2, 2)*d(1, :) - jacobian(2, 1)*d(2, :))/detj
        place%gy(:own%n, p) = (jacobian(1, 1)*d(2, :) - jacobian(1, 2)*d(1, :))/detj
      end associate
      ! nobody asks for what goes with a motion that is none
      place%strain(p) = 0
      if (.not. moves) cycle
      place%nx(:, p) = nx
      place%ny(:, p) = ny
      place%swelling(1:8, p) = nx + section(2)*rule%phi(:, p)/thickness
      place%swelling(9:16, p) = ny + section(3)*rule%phi(:, p)/thickness
      if (finite) then
        place%strain(p) = log(detj*thickness/before)
      else
        place%strain(p) = dot_product(place%swelling(:, p), motion)
      end if
    end do
  end subroutine place_element

end module heat_points
