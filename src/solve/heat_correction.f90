!> Corrections of temperatures where the heat capacity changes along them, as in a narrow interval of melting.
!>
!> A correction is linear in the heat content as much as in the temperature: C dT. Where the capacity further on is another one by
!> much, the temperature is taken that has the content H(T) + C dT: from within the interval the correction does not end at its
!> edge, and from outside it stops in the interval instead of passing over it. This is Newton's method in the variable in which
!> neither function is steep (K. Brenner, C. Cances, SIAM J. Numer. Anal. 55 (2017) 1760-1785). For temperatures on corners, whose
!> capacity is lumped: a content of their own goes with them.
module heat_correction
  use equations, only: equations_t
  use fields, only: displacement_field, find_field, has_corners_only
  use kinds, only: eps, wp
  use law_api, only: driver_count, driver_temperature, heat_law, law_t
  use materials, only: material_t
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: follow_content, is_steep, temperature_after

  !> The content is followed where it differs by more than this factor from the linear one.
  real(wp), parameter :: much = 3.0_wp
  !> Halvings that find a temperature to round-off.
  integer, parameter :: halvings = 200

contains

  !> Change the correction of the free temperatures of bodies whose heat capacity varies much.
  subroutine follow_content(scene, equations, solution, du, correction, followed)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: du(:)               !! (ndof) motion of the step so far [unknown]
    real(wp), intent(inout) :: correction(:)    !! (ndof) [unknown]
    logical, intent(out) :: followed            !! some were changed
    logical :: done(size(du))
    real(wp) :: now, new
    integer :: f, g, e, k, d

    followed = .false.
    f = find_field(scene%fields, 'temperature')
    if (f == 0) return
    if (.not. (equations%solves(equations%now)%own(f) .and. has_corners_only(scene%fields(f)))) return
    done = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (material => scene%materials(scene%groups(g)%material), nodes => scene%groups(g)%connectivity, &
                 number => equations%dofs%fields(f)%number(1, :))
        if (equations%laws(material%law_id)%kind /= heat_law) cycle
        if (.not. varies_much(equations%laws(material%law_id), material)) cycle
        do e = 1, size(nodes, 2)
          do k = 1, size(nodes, 1)
            d = number(nodes(k, e))
            if (d == 0) cycle
            if (done(d) .or. equations%solves(equations%now)%equation(d) == 0) cycle
            done(d) = .true.
            now = solution%fields(f)%value(1, nodes(k, e)) + du(d)
            new = temperature_after(equations%laws(material%law_id), material, now, correction(d))
            if (abs(new - (now + correction(d))) <= 0) cycle
            correction(d) = new - now
            followed = .true.
          end do
        end do
      end associate
    end do
  end subroutine follow_content

  !> Temperatures on 8 nodes are solved for, alone, and the heat capacity of a body varies much: the content is of points between
  !> the nodes, no temperature of a node has it. For one conductivity the balance is the minimum of a convex function, so that
  !> Newton's method with a search for the zero along each correction comes to it.
  pure function is_steep(scene, equations) result(yes)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    logical :: yes
    integer :: f, g

    yes = .false.
    f = find_field(scene%fields, 'temperature')
    if (f == 0) return
    associate (own => equations%solves(equations%now)%own)
      if (.not. own(f) .or. own(displacement_field) .or. has_corners_only(scene%fields(f))) return
    end associate
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (material => scene%materials(scene%groups(g)%material))
        if (equations%laws(material%law_id)%kind /= heat_law) cycle
        yes = yes .or. varies_much(equations%laws(material%law_id), material)
      end associate
    end do
  end function is_steep

  !> The heat capacities of a material at the temperatures of its card differ by more than the factor.
  pure function varies_much(law, material) result(yes)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    logical :: yes
    real(wp), allocatable :: there(:, :), taken(:), capacity(:)

    yes = .false.
    if (.not. allocated(material%temperatures)) return
    allocate (there(driver_count(law), size(material%temperatures)), source=0.0_wp)
    allocate (taken(size(there, 2)), capacity(size(there, 2)))
    there(driver_temperature, :) = material%temperatures
    call law%store(material, there, there, taken, capacity)
    yes = maxval(capacity) > much*minval(capacity)
  end function varies_much

  !> The temperature with the heat content that the capacity now gives for a change; now + change where it hardly differs.
  pure function temperature_after(law, material, now, change) result(after)
    type(law_t), intent(in) :: law
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: now, change   !! [temperature]
    real(wp) :: after
    real(wp) :: goal, taken, capacity, near, far
    integer :: k

    after = now + change
    if (.not. abs(change) > 0) return
    call content(now, capacity, taken)
    goal = capacity*change
    call content(after, capacity, taken)
    if (much*taken/goal > 1 .and. taken/goal < much) return
    near = now
    far = after
    do k = 1, halvings
      call content(far, capacity, taken)
      if (abs(taken) >= abs(goal)) exit
      near = far
      far = now + 2*(far - now)
    end do
    do k = 1, halvings
      if (abs(far - near) <= 2*eps*max(abs(near), abs(far))) exit
      after = 0.5_wp*(near + far)
      call content(after, capacity, taken)
      if (abs(taken) < abs(goal)) then
        near = after
      else
        far = after
      end if
    end do
    after = 0.5_wp*(near + far)

  contains

    !> Heat taken up from `now` to a temperature, and the capacity there.
    pure subroutine content(temperature, capacity, taken)
      real(wp), intent(in) :: temperature
      real(wp), intent(out) :: capacity, taken
      real(wp) :: before(driver_count(law), 1), there(driver_count(law), 1), c(1), h(1)

      before = 0
      there = 0
      before(driver_temperature, 1) = now
      there(driver_temperature, 1) = temperature
      call law%store(material, before, there, h, c)
      capacity = c(1)
      taken = h(1)
    end subroutine content

  end function temperature_after

end module heat_correction
