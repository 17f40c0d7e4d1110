!> Estimated error of stress and strain of a scene at an accepted instant.
!>
!> Stress: eta = ||sigma* - sigma_h|| / ||sigma*|| in the norm of the elastic complementary energy, s:s/(4 G) + p^2/(2 K); where
!> some solid law has no elastic moduli the norm is s:s for all. Strain: in every step the recovered less the computed strain
!> increment, in the norm of its deviator; errors and increments of an element are summed over the steps since the mesh began.
!> An error that the stress had when the mesh began goes where the body flows: with a flow of the strain de against the direction of
!> the stress s, 2 G de/|s| is the logarithm by which a deviation from it falls, as ds = 2 G (de - de_p) and de_p = |de_p| s/|s|
!> for a flow along the deviator (R. Hill, The Mathematical Theory of Plasticity, 1950, II.3). Pressures follow by balance. Elastic
!> parts keep it: the strain of which the stress is elastic is taken off.
!> Recovery (patch_recovery) goes over all elements of one material, and not across the line to another.
module estimator
  use elasticity, only: moduli
  use estimator_parts, only: estimator_t, part_t
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use loads, only: multiplier_at
  use quad8_geometry, only: derivatives, quad8_rule_t
  use recovered_errors, only: missing_squares, ncomp, npoint
  use scene, only: scene_t, solid_elements
  use sections, only: thickness_at
  use solution, only: solution_t
  implicit none
  private
  public :: estimate_errors, stress_error_now

  !> Stress over the shear modulus (over the largest stress where there are no moduli), or strain, below which it counts as zero:
  !> round-off of a stress that is zero.
  real(wp), parameter :: at_rest = 1.0e-9_wp
  !> A new mesh shows an error of its own when less than this share is left of those of the stress that was carried to it.
  real(wp), parameter :: forgotten = 0.1_wp
  !> An error that falls to this share of what the mesh has shown first is what another one would begin with: contact that began at
  !> a point has grown.
  real(wp), parameter :: fallen = 2.0_wp/3.0_wp

contains

  !> Errors of the stress now, and of the strain of the step just accepted added to those before.
  pure subroutine estimate_errors(self, scene, solution)
    type(estimator_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), dimension(2, size(solution%estimate%stress_of)) :: missing, whole
    real(wp), dimension(size(missing, 2)) :: volume, elastic, energy
    real(wp) :: stiffness, left

    call gather_squares(self, scene, solution, missing, whole, volume, elastic, stiffness)
    energy = whole(1, :)
    left = solution%estimate%stress_left
    associate (estimate => solution%estimate)
      call relate(missing(1, :), whole(1, :), volume, sum(whole(1, :)) > at_rest**2*stiffness, estimate%stress, estimate%stress_of)
      estimate%strain_sums = estimate%strain_sums + sqrt(reshape([missing(2, :)/volume, whole(2, :)/volume], &
                                                                 [2, size(volume)], order=[2, 1]))
      missing(2, :) = volume*estimate%strain_sums(1, :)**2
      whole(2, :) = volume*estimate%strain_sums(2, :)**2
      call relate(missing(2, :), whole(2, :), volume, sum(whole(2, :)) > at_rest**2*sum(volume), estimate%strain, &
                  estimate%strain_of)
      estimate%stress_left = left_of_stress(energy, elastic, estimate%strain_sums(2, :))
      if (estimate%first_stress > 0 .and. left > forgotten .and. solution%step - estimate%began <= scene%remesh%least_steps) &
        estimate%first_stress = estimate%stress
      if (estimate%stress > 0 .and. estimate%stress < fallen*estimate%first_stress) estimate%first_stress = estimate%stress
    end associate
  end subroutine estimate_errors

  !> Share that is left of an error that the stress had when the mesh began, in the norm of its energy: of an error that was spread
  !> as the energy is now.
  pure function left_of_stress(energy, elastic, strain) result(left)
    real(wp), intent(in) :: energy(:)    !! (nelem) of the stress [energy]
    real(wp), intent(in) :: elastic(:)   !! (nelem) strain of which the deviator is elastic [-]; 0 where not known
    real(wp), intent(in) :: strain(:)    !! (nelem) sum of the increments of the deviator since then [-]
    real(wp) :: left
    real(wp), parameter :: forgotten_flow = -0.5_wp*log(tiny(1.0_wp))
    real(wp) :: flow(size(energy))

    left = 0
    if (.not. sum(energy) > 0) return
    flow = merge(0.0_wp, forgotten_flow, strain <= elastic)
    where (strain > elastic .and. elastic > 0) flow = min(strain/elastic - 1, forgotten_flow)
    left = sqrt(sum(energy*exp(-2*flow))/sum(energy))
  end function left_of_stress

  !> Error of the stress at an instant, where no step before it was followed.
  pure subroutine stress_error_now(self, scene, solution, error)
    type(estimator_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(out) :: error   !! share of the stress, in its norm
    real(wp), allocatable :: missing(:, :), whole(:, :), volume(:), error_of(:), elastic(:)
    real(wp) :: stiffness
    integer :: n

    n = solid_elements(scene)
    allocate (missing(2, n), whole(2, n), volume(n), error_of(n), elastic(n))
    call gather_squares(self, scene, solution, missing, whole, volume, elastic, stiffness)
    call relate(missing(1, :), whole(1, :), volume, sum(whole(1, :)) > at_rest**2*stiffness, error, error_of)
  end subroutine stress_error_now

  !> Squares of the errors (missing) of stress and strain increments and of these themselves (whole), and volumes, of all elements.
  pure subroutine gather_squares(self, scene, solution, missing, whole, volume, elastic, stiffness)
    type(estimator_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(out) :: missing(:, :), whole(:, :)   !! stress and strain of each element (2, nelem)
    real(wp), intent(out) :: volume(:)                    !! (nelem) [volume]
    real(wp), intent(out) :: elastic(:)                   !! (nelem) strain of which the deviator is elastic; 0 without moduli [-]
    real(wp), intent(out) :: stiffness                    !! sum of G V [energy], or of the largest stress squared
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), section(3)
    integer :: k

    x = scene%mesh%coordinates
    section = scene%section
    if (scene%finite) then
      x = x + solution%fields(displacement_field)%value
      section = solution%fields(section_field)%value(:, 1)
    end if
    stiffness = 0
    ! where there is no stress there is nothing to weigh
    missing = 0
    whole = 0
    elastic = 0
    volume = tiny(volume)
    do k = 1, size(self%parts)
      call of_part(self, self%parts(k), scene, solution, x, section, missing, whole, volume, elastic, stiffness)
    end do
  end subroutine gather_squares

  !> The error of the whole, and that of elements as densities over the density of the whole; zero at rest.
  pure subroutine relate(missing, whole, volume, moved, error, error_of)
    real(wp), intent(in) :: missing(:), whole(:), volume(:)
    logical, intent(in) :: moved
    real(wp), intent(out) :: error, error_of(:)

    error = 0
    error_of = 0
    if (.not. moved) return
    error = sqrt(sum(missing)/sum(whole))
    error_of = sqrt(missing/volume*(sum(volume)/sum(whole)))
  end subroutine relate

  !> Squares of the elements of one material, and the sum of G V to compare energies with (without moduli: of the largest stress,
  !> squared).
  pure subroutine of_part(self, part, scene, solution, x, section, missing, whole, volume, elastic, stiffness)
    type(estimator_t), intent(in) :: self
    type(part_t), intent(in) :: part
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: x(:, :), section(3)
    real(wp), intent(inout) :: missing(:, :), whole(:, :), volume(:), elastic(:), stiffness
    real(wp) :: value(ncomp, npoint, size(part%place)), weights(2, size(part%place)), shear
    real(wp) :: missing_here(2, size(part%place)), whole_here(2, size(part%place)), volume_here(size(part%place))
    integer :: e, g, n

    shear = 0
    do e = 1, size(part%place)
      g = part%group(e)
      n = scene%groups(g)%rule%n
      value(1:4, :n, e) = solution%groups(g)%committed(1:4, :, part%element(e))
      if (.not. self%elastic) shear = max(shear, maxval(value(1:4, :n, e)**2))
      associate (nodes => part%connectivity(:, e))
        call increments(self%fields(part%rule(e))%own, scene%finite, section, &
                        solution%fields(section_field)%last_increment(:, 1), x(:, nodes), &
                        solution%fields(displacement_field)%last_increment(:, nodes), value(5:8, :n, e))
      end associate
      weights(:, e) = energy_weights(self, scene, g, solution%time)
      elastic(part%place(e)) = merge(2*weights(1, e)*root_of_deviator(value(1:4, :n, e)), 0.0_wp, self%elastic)
    end do
    call missing_squares(part%patches, self%fields, part%rule, section, x, part%connectivity, value, weights, &
                         missing_here, whole_here, volume_here)
    missing(:, part%place) = missing_here
    whole(:, part%place) = whole_here
    volume(part%place) = volume_here
    if (self%elastic) shear = 0.25_wp/minval(weights(1, :))
    stiffness = stiffness + shear*sum(volume_here)
  end subroutine of_part

  !> Root of s:s of the stress deviator, in the mean square over points.
  pure function root_of_deviator(stress) result(root)
    real(wp), intent(in) :: stress(:, :)   !! xx, yy, xy, zz (4, npoint) [stress]
    real(wp) :: root
    real(wp) :: mean(size(stress, 2))

    mean = (stress(1, :) + stress(2, :) + stress(4, :))/3
    root = sqrt(sum((stress(1, :) - mean)**2 + (stress(2, :) - mean)**2 + (stress(4, :) - mean)**2 + 2*stress(3, :)**2) &
                /size(mean))
  end function root_of_deviator

  !> 1/(4 G) and 1/(2 K) of a group at its temperature.
  pure function energy_weights(self, scene, g, time) result(weights)
    type(estimator_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: time
    real(wp) :: weights(2)
    real(wp) :: temperature, young, poisson, bulk, shear

    weights = [1.0_wp, 0.0_wp]
    if (.not. self%elastic) return
    associate (group => scene%groups(g), material => scene%materials(scene%groups(g)%material))
      temperature = 0
      if (group%temperature_multiplier > 0) &
        temperature = group%temperature_amplitude*multiplier_at(scene%multipliers(group%temperature_multiplier), time)
      call self%constants(group%material)%at(material, temperature, young, poisson)
      call moduli(young, poisson, bulk, shear)
    end associate
    weights = [0.25_wp/shear, 0.5_wp/bulk]
  end function energy_weights

  !> Strain increments of a step at the points of an element, on the geometry of its middle (of the start for small
  !> displacements): a second order of the logarithmic strain. Source: T.J.R. Hughes, J. Winget, Int. J. Num. Meth. Engng 15 (1980)
  !> 1862-1867. Across the plane that of the section; in plane stress none.
  pure subroutine increments(rule, finite, section, motion, x, du, strain)
    type(quad8_rule_t), intent(in) :: rule
    logical, intent(in) :: finite
    real(wp), intent(in) :: section(3), motion(3)   !! at the end of the step, and its motion
    real(wp), intent(in) :: x(2, 8), du(2, 8)       !! nodes at the end of the step, and their motion [length]
    real(wp), intent(out) :: strain(:, :)           !! xx, yy, xy, zz (4, npoint)
    real(wp) :: y(2, 8), a(3), nx(8), ny(8), detj, here(2), way(2)
    integer :: p

    y = x
    a = section
    if (finite) then
      y = x - 0.5_wp*du
      a = section - 0.5_wp*motion
    end if
    do p = 1, rule%npoint
      call derivatives(rule%dphi(:, :, p), y, nx, ny, detj)
      here = matmul(y, rule%phi(:, p))
      way = matmul(du, rule%phi(:, p))
      strain(:, p) = [dot_product(nx, du(1, :)), dot_product(ny, du(2, :)), &
                      0.5_wp*(dot_product(ny, du(1, :)) + dot_product(nx, du(2, :))), &
                      (dot_product(a(2:3), way) + thickness_at(motion, here))/thickness_at(a, here)]
    end do
  end subroutine increments

end module estimator
