!> Parts without room to flow: a closed die that is full, a container without an exit.
!>
!> Metal flows at constant volume. Where dies enclose it and go on, its elastic volume is pressed together, and their forces are
!> those of its bulk modulus: equilibrium is found as ever, by far beyond what tools bear, and the run ends with 0. Such a step is
!> known by its work, most of which goes into elastic energy, while the body flows: its mean pressure is well above its flow stress.
!> Where a die is only about to be filled, or has an exit, most of the work is that of the flow; what was noted while pressure was
!> built up, as at the start of an extrusion, is dropped then.
module confinement
  use confinement_record, only: confinement_record_t, no_room_advice
  use kinds, only: wp
  use law_api, only: law_t
  use point_volumes, only: volumes_of_points
  use quad8_geometry, only: quad8_rule, quad8_rule_t
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use state_variables, only: find_variable
  use stress_measures, only: stress_measure, von_mises
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: confinement_words, note_confinement, warn_of_confinement

  !> Share of the work of a step that goes into elastic energy.
  real(wp), parameter :: most_of_work = 0.5_wp
  !> Elastic change of the volume of a body from which on it is reported, and its mean pressure over the mean of von Mises' stress.
  real(wp), parameter :: least_change = 5.0e-3_wp, least_pressure = 2.0_wp
  !> A change that is reported whatever comes later: laws have a constant bulk modulus, that of metals grows by 4 to 6 times the
  !> pressure (F.D. Murnaghan, Proc. Natl. Acad. Sci. 30 (1944) 244): the pressure is wrong by 6 to 9 %, at 5 GPa in steel.
  real(wp), parameter :: lasting_change = 0.03_wp
  integer, parameter :: mean_stress = 2   !! among the measures of a stress

contains

  !> The step just accepted and committed.
  pure subroutine note_confinement(scene, laws, stored, given, solution)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)      !! (nlaw)
    real(wp), intent(in) :: stored, given   !! elastic energy and work from outside of the step [energy]
    type(solution_t), intent(inout) :: solution
    real(wp) :: change, over_stress
    integer :: g

    solution%confinement%now = .false.
    if (.not. given > 0) return
    if (.not. stored > most_of_work*given) then
      if (solution%confinement%change > -lasting_change) solution%confinement = confinement_record_t()
      return
    end if
    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), record => solution%confinement)
        if (.not. is_solid(group) .or. group%material == 0) cycle
        if (.not. associated(laws(scene%materials(group%material)%law_id)%flow_stress)) cycle
        call measure(scene, solution, g, change, over_stress)
        if (.not. (change < -least_change .and. over_stress > least_pressure)) cycle
        record%now = .true.
        if (record%group == 0) record%since = solution%time - solution%last_step
        if (.not. change < record%change) cycle
        record%group = g
        record%change = change
        record%over_stress = over_stress
      end associate
    end do
  end subroutine note_confinement

  !> Means over the volume of a body: its elastic change of volume [-], and its pressure over von Mises' stress [-].
  pure subroutine measure(scene, solution, g, change, over_stress)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g   !! group
    real(wp), intent(out) :: change, over_stress
    type(quad8_rule_t) :: rule
    real(wp), allocatable :: dv(:)
    real(wp) :: volume, pressure, mises, trace
    integer :: e, p, s, v

    change = 0
    over_stress = 0
    associate (group => scene%groups(g))
      s = find_variable(group%variables, 'stress')
      v = find_variable(group%variables, 'elastic_strain')
      if (s == 0 .or. v == 0) return
      s = group%variables(s)%first
      v = group%variables(v)%first
      call quad8_rule(group%rule%n, rule)
      volume = 0
      pressure = 0
      mises = 0
      trace = 0
      do e = 1, size(group%connectivity, 2)
        dv = volumes_of_points(scene, solution, rule, group%connectivity(:, e))
        do p = 1, rule%npoint
          associate (state => solution%groups(g)%committed(:, p, e))
            volume = volume + dv(p)
            pressure = pressure - dv(p)*stress_measure(mean_stress, state(s:s + 3))
            mises = mises + dv(p)*von_mises(state(s:s + 3))
            trace = trace + dv(p)*(state(v) + state(v + 1) + state(v + 3))
          end associate
        end do
      end do
    end associate
    change = trace/volume
    ! logarithmic
    if (scene%finite) change = exp(change) - 1
    if (mises > 0) over_stress = pressure/mises
  end subroutine measure

  !> What is known of it; nothing where there was none.
  pure function confinement_words(scene, record) result(words)
    type(scene_t), intent(in) :: scene
    type(confinement_record_t), intent(in) :: record
    character(len=:), allocatable :: words

    words = ''
    if (record%group == 0 .or. record%group > size(scene%groups)) return
    words = scene%groups(record%group)%name//' has had hardly any room to flow since time '//to_text(record%since, 4) &
            //': dies press it together elastically, by up to '//to_text(-100*record%change, 2)//' % of its volume, with a mean ' &
            //'pressure of '//to_text(record%over_stress, 2)//' times its von Mises stress; '//no_room_advice
  end function confinement_words

  !> A line, added to the warnings of a run at its end.
  subroutine warn_of_confinement(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    character(len=:), allocatable :: words

    words = confinement_words(scene, solution%confinement)
    if (len(words) > 0) call add_text(warnings, words)
  end subroutine warn_of_confinement

end module confinement
