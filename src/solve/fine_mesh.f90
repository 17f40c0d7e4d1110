!> The mesh twice as fine of bodies that conduct heat with temperatures on corners: every element is cut in four by the middles of
!> its sides and its centre, with a bilinear temperature in each quarter and the heat capacity lumped at its corners.
!>
!> Nodes of an element of it are those of the element of eight nodes, then the centre. Nodes of the mesh keep their numbers, centres
!> follow them in the order of the elements of all bodies.
module fine_mesh
  use equations, only: equations_t
  use fields, only: displacement_field, section_field
  use fine_mesh_data, only: fine_mesh_t
  use kinds, only: wp
  use kinetics_error, only: has_heat_law
  use law_api, only: driver_count, driver_temperature
  use quadrature, only: square_rule
  use scene, only: host_of, is_solid, scene_t, solid_elements
  use sections, only: thickness_at
  use shape_functions, only: quad4, quad8_corner, quad8_side
  use solution, only: present_coordinates, solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: corner_share, quarter_nodes, make_fine_mesh, place_fine_mesh

  !> A heat capacity that changes by more than this factor holds latent heat.
  real(wp), parameter :: many_times = 4.0_wp
  !> Nodes of the quarters, each at the corner of the element of the same number.
  integer, parameter :: quarter_nodes(4, 4) = reshape([1, 5, 9, 8, 5, 2, 6, 9, 9, 6, 3, 7, 8, 9, 7, 4], [4, 4])
  !> Value of the function of each corner at the nodes (corner, node).
  real(wp), parameter :: half = 0.5_wp, none = 0.0_wp
  real(wp), parameter :: corner_share(4, 9) = reshape([1.0_wp, none, none, none, none, 1.0_wp, none, none, none, none, 1.0_wp, &
                                                       none, none, none, none, 1.0_wp, half, half, none, none, none, half, half, &
                                                       none, none, none, half, half, half, none, none, half, 0.25_wp, 0.25_wp, &
                                                       0.25_wp, 0.25_wp], [4, 9])

contains

  !> Nodes, sides and elements, and where they stand at the start of the mesh.
  subroutine make_fine_mesh(scene, equations, solution, fine)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    type(fine_mesh_t), intent(out) :: fine
    logical :: warm(size(scene%groups))
    integer :: met(size(scene%mesh%coordinates, 2))
    integer :: g, e, n, k, before

    warm = has_heat_law(scene, equations)
    do g = 1, size(warm)
      if (warm(g)) fine%nelement = fine%nelement + size(scene%groups(g)%connectivity, 2)
    end do
    n = size(met)
    fine%nnode = n + solid_elements(scene)
    allocate (fine%nodes(9, fine%nelement), fine%group(fine%nelement), fine%element(fine%nelement), fine%ends(2, n), source=0)
    allocate (fine%volume(9, fine%nelement), fine%conduction(4, 4, 4, fine%nelement), source=0.0_wp)
    n = 0
    met = 0
    do g = 1, size(warm)
      if (.not. warm(g)) cycle
      before = elements_before(scene, host_of(scene, g))
      associate (nodes => scene%groups(g)%connectivity)
        do e = 1, size(nodes, 2)
          n = n + 1
          fine%nodes(:, n) = [nodes(:8, e), size(met) + before + e]
          fine%group(n) = g
          fine%element(n) = e
          do k = 1, 4
            associate (middle => nodes(quad8_side(2, k), e))
              fine%ends(:, middle) = nodes(quad8_side([1, 3], k), e)
              met(middle) = met(middle) + 1
            end associate
          end do
        end do
      end associate
    end do
    fine%outside = pack([(k, k=1, size(met))], met == 1)
    allocate (fine%side(size(met)), source=0)
    fine%side(fine%outside) = [(k, k=1, size(fine%outside))]
    call measure(scene%mesh%coordinates, scene%section, fine, .true.)
    allocate (fine%least(size(warm)), fine%latent(fine%nnode))
    do g = 1, size(warm)
      fine%least(g) = 0
      if (warm(g)) fine%least(g) = latent_capacity(scene, equations, g)
    end do
    fine%latent = 0
    do e = 1, fine%nelement
      if (fine%least(fine%group(e)) > 0) fine%latent(fine%nodes(:, e)) = fine%group(e)
    end do
    if (scene%finite) call place_fine_mesh(scene, solution, fine)
  end subroutine make_fine_mesh

  !> Where heat flows now, in bodies that move; the volumes that have the mass stay those of the start of the mesh.
  subroutine place_fine_mesh(scene, solution, fine)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(fine_mesh_t), intent(inout) :: fine
    real(wp) :: section(3)

    if (.not. (scene%finite .and. scene%fields(displacement_field)%declared)) return
    section = solution%fields(section_field)%value(:, 1)
    call measure(present_coordinates(scene, solution), section, fine, .false.)
  end subroutine place_fine_mesh

  !> The least heat capacity of a material that holds latent heat: whose largest one is a multiple of it; 0 of others.
  function latent_capacity(scene, equations, g) result(least)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g   !! the group
    real(wp) :: least          !! [energy/length^3/temperature]
    real(wp), allocatable :: bends(:), at(:, :), taken(:), capacity(:)
    integer :: n

    least = 0
    associate (material => scene%materials(scene%groups(g)%material))
      associate (law => equations%laws(material%law_id))
        if (associated(law%bends)) then
          call law%bends(material, bends)
        else
          if (.not. allocated(material%temperatures)) return
          allocate (bends, source=material%temperatures)
        end if
        n = size(bends)
        if (n < 2) return
        allocate (at(driver_count(law), 2*n - 1), taken(2*n - 1), capacity(2*n - 1))
        at = 0
        at(driver_temperature, 1::2) = bends
        at(driver_temperature, 2::2) = 0.5_wp*(bends(:n - 1) + bends(2:))
        call law%store(material, at, at, taken, capacity)
        if (any(capacity > 0)) least = minval(capacity, capacity > 0)
        if (.not. maxval(capacity) > many_times*least) least = 0
      end associate
    end associate
  end function latent_capacity

  !> Elements of bodies before the first one of a body.
  pure function elements_before(scene, body) result(n)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: body   !! number of its group
    integer :: n
    integer :: g

    n = 0
    do g = 1, body - 1
      if (is_solid(scene%groups(g))) n = n + size(scene%groups(g)%connectivity, 2)
    end do
  end function elements_before

  !> Volumes of the nodes, matrices of the quarters at a conductivity of 1, and areas of sides.
  subroutine measure(x, section, fine, with_volumes)
    real(wp), intent(in) :: x(:, :)       !! (2, nnode) [length]
    real(wp), intent(in) :: section(3)    !! (sections)
    type(fine_mesh_t), intent(inout) :: fine
    logical, intent(in) :: with_volumes
    real(wp) :: y(2, 9), volume(4)
    integer :: e, q, s

    do e = 1, fine%nelement
      y(:, :8) = x(:, fine%nodes(:8, e))
      y(:, 9) = 0.5_wp*sum(y(:, 5:8), 2) - 0.25_wp*sum(y(:, 1:4), 2)   ! the parabolic element's own
      if (with_volumes) fine%volume(:, e) = 0
      do q = 1, 4
        call measure_quarter(y(:, quarter_nodes(:, q)), section, fine%conduction(:, :, q, e), volume)
        if (with_volumes) fine%volume(quarter_nodes(:, q), e) = fine%volume(quarter_nodes(:, q), e) + volume
      end do
    end do
    if (.not. allocated(fine%area)) allocate (fine%area(3, size(fine%outside)))
    do s = 1, size(fine%outside)
      associate (ends => fine%ends(:, fine%outside(s)))
        fine%area(:, s) = areas_of_side(x(:, ends), section)
      end associate
    end do
  end subroutine measure

  !> Areas of the ends and the middle of a side that is cut in two.
  pure function areas_of_side(x, section) result(area)
    real(wp), intent(in) :: x(2, 2), section(3)   !! ends [length]; (sections)
    real(wp) :: area(3)                           !! first end, middle, second end [area]
    real(wp) :: t(3)

    t([1, 3]) = [thickness_at(section, x(:, 1)), thickness_at(section, x(:, 2))]
    t(2) = 0.5_wp*(t(1) + t(3))
    area = 0.5_wp*length_of(x(:, 2) - x(:, 1))*[2*t(1) + t(2), t(1) + 4*t(2) + t(3), t(2) + 2*t(3)]/6
  end function areas_of_side

  !> Volume of each node of a quarter, and integral of grad phi_a grad phi_b.
  pure subroutine measure_quarter(y, section, conduction, volume)
    real(wp), intent(in) :: y(2, 4)             !! [length]
    real(wp), intent(in) :: section(3)
    real(wp), intent(out) :: conduction(4, 4)   !! [volume/length^2]
    real(wp), intent(out) :: volume(4)          !! [volume]
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(4), dphi(2, 4), jacobian(2, 2), gradient(2, 4), detj, dv
    integer :: p, a

    call square_rule(4, xi, weight)
    conduction = 0
    volume = 0
    do p = 1, 4
      call quad4(xi(1, p), xi(2, p), phi)
      dphi(1, :) = 0.25_wp*quad8_corner(1, :)*(1 + quad8_corner(2, :)*xi(2, p))
      dphi(2, :) = 0.25_wp*quad8_corner(2, :)*(1 + quad8_corner(1, :)*xi(1, p))
      jacobian = matmul(y, transpose(dphi))
      detj = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
      if (.not. detj > 0) cycle
      dv = detj*weight(p)*thickness_at(section, matmul(y, phi))
      gradient(1, :) = (jacobian(2, 2)*dphi(1, :) - jacobian(2, 1)*dphi(2, :))/detj
      gradient(2, :) = (jacobian(1, 1)*dphi(2, :) - jacobian(1, 2)*dphi(1, :))/detj
      do a = 1, 4
        conduction(:, a) = conduction(:, a) + dv*(gradient(1, :)*gradient(1, a) + gradient(2, :)*gradient(2, a))
      end do
      volume = volume + phi*dv
    end do
  end subroutine measure_quarter

end module fine_mesh
