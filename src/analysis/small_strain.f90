!> How large strains are where `KINEM SMALL` takes them as small.
!>
!> With SMALL the geometry is that of the start: errors are of the order of the strain itself, and a body compressed to nothing goes
!> on as if nothing had happened. A run whose strain is beyond the bound in more than a small part of a body is no result; beside a
!> corner or a notch, where the strain of linear theory has no bound, it may be.
module small_strain
  use errors, only: error_t, exit_no_convergence, fail
  use fields, only: displacement_field, section_field
  use kinds, only: wp
  use law_api, only: law_t
  use quad8_geometry, only: derivatives, quad8_rule, quad8_rule_t
  use scene, only: is_solid, plane_stress, scene_t
  use sections, only: thickness_at
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: refuse_large_strain

  !> Largest principal strain that counts as small: forces are wrong by about as much.
  real(wp), parameter :: largest_small_strain = 0.1_wp
  !> Share of a body's volume that may have more.
  real(wp), parameter :: largest_share = 0.05_wp

contains

  !> An error where SMALL has strains above the bound in too much of a body.
  subroutine refuse_large_strain(scene, laws, solution, error)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    type(solution_t), intent(in) :: solution
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: advice
    real(wp) :: beyond, volume, worst, part(3)
    integer :: g, e, element

    if (scene%finite .or. .not. scene%fields(displacement_field)%declared) return
    do g = 1, size(scene%groups)
      associate (body => scene%groups(g))
        if (.not. is_solid(body) .or. body%material == 0) cycle
        beyond = 0
        volume = 0
        worst = 0
        element = 0
        do e = 1, size(body%connectivity, 2)
          part = strains_of_element(scene, solution, g, e)
          volume = volume + part(1)
          beyond = beyond + part(2)
          if (part(3) > worst) element = e
          worst = max(worst, part(3))
        end do
        if (.not. beyond > largest_share*volume) cycle
        advice = 'take KINEM LOG, in which the geometry follows; or less load'
        if (body%rule%n == 9 .and. body%option == 0 .and. associated(laws(scene%materials(body%material)%law_id)%flow_stress)) &
          advice = advice//'; where all of a body flows PL8LS with 9 points without MEAN locks, and finds equilibrium beyond the ' &
                   //'limit load: take 4 points or MEAN'
        call fail(error, exit_no_convergence, 'large strain in KINEM SMALL: step '//to_text(solution%step)//', time ' &
                  //to_text(solution%time)//', strains above '//to_text(largest_small_strain)//' in ' &
                  //to_text(100*beyond/volume, 3)//' % of '//body%name//' (allowed '//to_text(100*largest_share)//' %), up to ' &
                  //to_text(worst, 3)//' in element '//to_text(element), advice)
        return
      end associate
    end do
  end subroutine refuse_large_strain

  !> Volume of an element, that of its points whose principal strains are above the bound, and the largest of these by size; from
  !> its displacement since the mesh began, or since it was laid down.
  pure function strains_of_element(scene, solution, g, e) result(part)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e   !! group and element
    real(wp) :: part(3)
    type(quad8_rule_t) :: rule
    real(wp) :: x(2, 8), u(2, 8), nx(8), ny(8), detj, here(2), xx, yy, xy, across, middle, radius, strain, volume
    integer :: p

    part = 0
    associate (group => scene%groups(g), motion => solution%fields(section_field)%value(:, 1) - scene%section)
      call quad8_rule(group%rule%n, rule)
      x = scene%mesh%coordinates(:, group%connectivity(:, e))
      u = solution%fields(displacement_field)%value(:, group%connectivity(:, e))
      if (allocated(solution%groups(g)%laid)) then
        if (size(solution%groups(g)%laid) > 0) u = u - solution%groups(g)%laid(:, :, e)
      end if
      do p = 1, group%rule%n
        call derivatives(rule%dphi(:, :, p), x, nx, ny, detj)
        here = matmul(x, rule%phi(:, p))
        xx = dot_product(nx, u(1, :))
        yy = dot_product(ny, u(2, :))
        xy = 0.5_wp*(dot_product(ny, u(1, :)) + dot_product(nx, u(2, :)))
        across = 0
        ! the section, of which an axisymmetric one is a case
        if (scene%plane_state /= plane_stress) &
          across = (thickness_at(motion, here) + dot_product(scene%section(2:3), matmul(u, rule%phi(:, p)))) &
                   /thickness_at(scene%section, here)
        middle = 0.5_wp*(xx + yy)
        radius = hypot(0.5_wp*(xx - yy), xy)
        strain = max(abs(middle + radius), abs(middle - radius), abs(across))
        volume = detj*rule%weight(p)*thickness_at(scene%section, here)
        part(1) = part(1) + volume
        if (strain > largest_small_strain) part(2) = part(2) + volume
        part(3) = max(part(3), strain)
      end do
    end associate
  end function strains_of_element

end module small_strain
