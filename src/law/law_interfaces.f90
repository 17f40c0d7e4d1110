!> Procedures of a law, as elements and kinematics call them, and what they answer.
!>
!> Strain and stress have the components xx, yy, xy, zz; the shear strain is the engineering one (2 eps_xy), so tangents are
!> symmetric for associated laws. A block of points is treated in one call.
module law_interfaces
  use kinds, only: wp
  use materials, only: material_t
  use text, only: string_t
  implicit none
  private
  public :: law_bends_i, law_check_i, law_conduct_i, law_elastic_i, law_flow_i, law_friction_i, law_phases_i, law_release_i
  public :: law_slide_i, law_store_i, law_swell_i, law_update_i
  public :: law_done, law_not_converged
  public :: contact_open, contact_slip, contact_stick
  public :: driver_temperature, row_of_volume, row_of_work

  !> Status of a law at a point.
  integer, parameter :: law_done = 0
  integer, parameter :: law_not_converged = 1

  !> Contact states of a point.
  integer, parameter :: contact_open = 0
  integer, parameter :: contact_stick = 1
  integer, parameter :: contact_slip = 2

  !> Rows of the tangent of a law for solids below those of the stress, d()/d(trial strain): tr(elastic strain) of laws with
  !> `swells_with`, and the `plastic_work` of those whose history has it.
  integer, parameter :: row_of_volume = 5, row_of_work = 6

  !> The temperature is the first driver of every law.
  integer, parameter :: driver_temperature = 1

  abstract interface
    !> Advance a block of n points from the committed history.
    !>
    !> `trial_strain` is the elastic strain if the step were elastic; on return `elastic_strain` is
    !> what is left of it after flow, `stress` follows from it, `history` is the trial history and
    !> `tangent` = d stress / d trial_strain. Rows of the history beyond the law's own are carried
    !> along. Pure: called by several threads.
    pure subroutine law_update_i(material, dt, drivers, trial_strain, committed, stress, elastic_strain, history, tangent, &
                                 status)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt                      !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :, :)        !! (ndriver, 2, n) at both ends of it, temperature first [unit of each driver]
      real(wp), intent(in) :: trial_strain(:, :)      !! (4, n) [-]
      real(wp), intent(in) :: committed(:, :)         !! (nhistory, n) [unit of each component]
      real(wp), intent(out) :: stress(:, :)           !! (4, n) [stress]
      real(wp), intent(out) :: elastic_strain(:, :)   !! (4, n) [-]
      real(wp), intent(out) :: history(:, :)          !! (nhistory, n) [unit of each component]
      real(wp), intent(out) :: tangent(:, :, :)       !! (4, 4, n) [stress]; where there is room also row_of_volume, row_of_work
      integer, intent(out) :: status(:)               !! (n) law_done or another answer
    end subroutine law_update_i

    !> Contact law at one point: pressure and friction from penetration and slip.
    !>
    !> Vectors have two tangential components, in the plane and across it (annex 3, eq. 1); `tangent` is
    !> d(pressure, tau)/d(penetration, slip). In zero time (dt = 0, equilibrium restored on a new mesh) the history does not change.
    pure subroutine law_slide_i(material, dt, drivers, penalty, augmentation, penetration, slip, tau_committed, committed, &
                                pressure, tau, history, tangent, status)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt                  !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :)       !! (ndriver, 2) at both ends of the step, temperature first [unit of each driver]
      real(wp), intent(in) :: penalty(2)          !! normal and tangential stiffness [stress/length]
      real(wp), intent(in) :: augmentation        !! multiplier carried from earlier augmentations [stress]
      real(wp), intent(in) :: penetration         !! d > 0 inside the die [length]
      real(wp), intent(in) :: slip(2)             !! relative slip of the step [length]
      real(wp), intent(in) :: tau_committed(2)    !! friction stress at the start of the step [stress]
      real(wp), intent(in) :: committed(:)        !! (nhistory) history at the start of the step [unit of each component]
      real(wp), intent(out) :: pressure, tau(2)   !! [stress]
      real(wp), intent(out) :: history(:)         !! (nhistory) [unit of each component]
      real(wp), intent(out) :: tangent(3, 3)      !! [stress/length]
      integer, intent(out) :: status              !! contact_open, contact_stick or contact_slip
    end subroutine law_slide_i

    !> Von Mises stress at which a point flows in its present state: it bounds the friction on it.
    pure function law_flow_i(material, drivers, history) result(flow)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: drivers(:)   !! (ndriver) as they are now, temperature first [unit of each driver]
      real(wp), intent(in) :: history(:)   !! (nhistory) of the law [unit of each component]
      real(wp) :: flow                     !! [stress]
    end function law_flow_i

    !> Coefficient of friction of a law of contact; `huge` where the limit of friction has other parts, or is 0.
    pure function law_friction_i(material) result(coefficient)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp) :: coefficient   !! [-]
    end function law_friction_i

    !> Isotropic elastic constants at a temperature.
    pure subroutine law_elastic_i(material, temperature, young, poisson)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: temperature
      real(wp), intent(out) :: young, poisson   !! [stress], [-]
    end subroutine law_elastic_i

    !> Conductivity of a block of n points, and its derivatives by the temperature and by the other drivers.
    pure subroutine law_conduct_i(material, drivers, conductivity, slope, by_driver)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: drivers(:, :)      !! (ndriver, n) as they are now, temperature first [unit of each driver]
      real(wp), intent(out) :: conductivity(:)   !! (n) [power/length/temperature]
      real(wp), intent(out) :: slope(:)          !! (n) [power/length/temperature^2]
      !> (ndriver, n) 0 for the temperature [power/length/temperature/unit of each driver]
      real(wp), intent(out), optional :: by_driver(:, :)
    end subroutine law_conduct_i

    !> Heat that a block of n points takes up from one state to another, and its derivative by the temperature at the end.
    pure subroutine law_store_i(material, before, now, taken, capacity)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: before(:, :), now(:, :)   !! (ndriver, n) drivers, temperature first [unit of each driver]
      real(wp), intent(out) :: taken(:)                 !! (n) [energy/length^3] per volume of the start
      real(wp), intent(out) :: capacity(:)              !! (n) [energy/length^3/temperature]
    end subroutine law_store_i

    !> Temperatures at which the heat capacity of `store` bends or jumps, ascending; none where it is a smooth function.
    pure subroutine law_bends_i(material, temperatures)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), allocatable, intent(out) :: temperatures(:)   !! (nbend)
    end subroutine law_bends_i

    !> Heat that a point releases in a step beside what flows, and its derivative by the temperature at the end.
    pure subroutine law_release_i(material, dt, drivers, committed, released, of_work, slope, history, surplus, changes)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: dt              !! length of the step [time]
      real(wp), intent(in) :: drivers(:, :)   !! (ndriver, 2) at both ends of the step, temperature first [unit of each driver]
      real(wp), intent(in) :: committed(:)    !! (nhistory) at the start of the step [unit of each component]
      real(wp), intent(out) :: released       !! [energy/length^3] per volume of the start
      real(wp), intent(out) :: of_work        !! by plastic work, beside it [energy/length^3] per volume that the work is per
      real(wp), intent(out) :: slope          !! [energy/length^3/temperature]
      real(wp), intent(out) :: history(:)     !! (nhistory) [unit of each component]
      !> Part of it that is no source: by how much `store` counts more than the point takes up [energy/length^3].
      real(wp), intent(out), optional :: surplus
      real(wp), intent(out), optional :: changes(:)   !! (nhistory) d(history)/d(temperature at the end)
    end subroutine law_release_i

    !> Heat taken up by a change of volume, per volume and unit of volume strain.
    pure function law_swell_i(material, temperature) result(heat)
      import :: material_t, wp
      type(material_t), intent(in) :: material
      real(wp), intent(in) :: temperature   !! at the start of the step
      real(wp) :: heat   !! [energy/length^3]
    end function law_swell_i

    !> Message on a wrong combination of the numbers of a card, beyond the range of each.
    pure subroutine law_check_i(material, problems)
      import :: material_t, string_t
      type(material_t), intent(in) :: material                  !! at one temperature
      type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem) a line each, none where all is well
    end subroutine law_check_i

    !> What a material lacks for phases that it begins with and that would not form in it.
    pure subroutine law_phases_i(material, given, problems)
      import :: material_t, string_t
      type(material_t), intent(in) :: material
      logical, intent(in) :: given(:)                           !! (phase_count)
      type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem) a line each, none where all is well
    end subroutine law_phases_i
  end interface

end module law_interfaces
