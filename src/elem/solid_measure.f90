!> Volumes and energies of solids, from the state of their points.
module solid_measure
  use elem_api, only: totals_t
  use kinds, only: wp
  use kinematics_api, only: first_history, first_strain
  use law_api, only: law_t
  use mean_dilatation, only: dilatation_t, mean_option, share_pressure
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: group_t, plane_stress, scene_t
  use sections, only: thickness_at
  use solid_terms, only: first_element
  use state_variables, only: find_variable
  implicit none
  private
  public :: measure_solid

contains

  !> Volumes and energies. Work densities are per stress-free volume, dv/J with J = exp(tr e). A law's `plastic_work` is what
  !> is dissipated, its `stored_work` what is kept beside the elastic energy and counted with it.
  subroutine measure_solid(scene, group, law, section, penalty_share, x, state, before, totals)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(law_t), intent(in) :: law
    real(wp), intent(in) :: section(3)         !! thickness at the origin [length], and its slopes [-]
    real(wp), intent(in) :: penalty_share      !! of contact: not asked for
    real(wp), intent(in) :: x(:, :, :)         !! (2, 8, nelem) nodes now [length]
    real(wp), intent(in) :: state(:, :, :), before(:, :, :)   !! (nstate, npoint, nelem) now, and a step before [unit of each]
    type(totals_t), intent(out) :: totals
    type(quad8_rule_t) :: rule
    type(dilatation_t) :: own
    real(wp) :: nx(8), ny(8), detj, dv, volume(group%rule%n), m(group%rule%n), shared(4, group%rule%n), stress(4), strain(4)
    real(wp) :: thickness(3)
    integer :: e, p, k, kept

    call quad8_rule(group%rule%n, rule)
    ! small strains: the section stays where it was, as the nodes do
    thickness = scene%section
    if (scene%finite) thickness = section
    k = find_variable(law%history, 'plastic_work')
    if (k > 0) k = group%variables(find_variable(group%variables, 'plastic_work'))%first
    kept = find_variable(group%variables, 'stored_work')
    if (kept > 0) kept = group%variables(kept)%first
    do e = 1, size(x, 3)
      do p = 1, group%rule%n
        call derivatives(rule%dphi(:, :, p), x(:, :, e), nx, ny, detj)
        volume(p) = detj*rule%weight(p)*thickness_at(thickness, matmul(x(:, :, e), rule%phi(:, p)))
        if (scene%plane_state == plane_stress .and. scene%finite) volume(p) = volume(p)*state(size(state, 1), p, e)
      end do
      totals%volume = totals%volume + sum(volume)
      if (group%option == mean_option) then
        call first_element(scene, rule, group%connectivity(:, e), own)
        call share_pressure(own, volume, state(1:4, :, e), m, shared)
      else
        m = volume
      end if
      do p = 1, group%rule%n
        dv = m(p)
        stress = state(1:4, p, e)
        strain = state(first_strain:first_history - 1, p, e)
        totals%elastic_energy = totals%elastic_energy &
                                + 0.5_wp*dv*(dot_product(stress, strain) + stress(3)*strain(3))
        totals%passed = totals%passed + abs(dv*(elastic_density(state(:, p, e)) - elastic_density(before(:, p, e))))
        if (scene%finite) dv = dv*exp(-strain(1) - strain(2) - strain(4))
        totals%unloaded_volume = totals%unloaded_volume + dv
        if (k == 0) cycle
        ! deviators work on the present volume
        dv = dv*(volume(p)/m(p))
        totals%plastic_work = totals%plastic_work + state(k, p, e)*dv
        totals%dissipated = totals%dissipated + (state(k, p, e) - before(k, p, e))*dv
        if (kept > 0) totals%elastic_energy = totals%elastic_energy + state(kept, p, e)*dv
        totals%least_dissipation = min(totals%least_dissipation, state(k, p, e) - before(k, p, e))
      end do
    end do
  end subroutine measure_solid

  !> Elastic energy of a point per volume: half of stress times elastic strain.
  pure function elastic_density(state) result(energy)
    real(wp), intent(in) :: state(:)   !! (nstate) [unit of each component]
    real(wp) :: energy

    associate (stress => state(1:4), strain => state(first_strain:first_history - 1))
      energy = 0.5_wp*(dot_product(stress, strain) + stress(3)*strain(3))
    end associate
  end function elastic_density

end module solid_measure
