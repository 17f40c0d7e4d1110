!> What a run of a deck with ACCURACY leaves for the choice of another one: its fineness and cost in `NAME.cost`, and its history.
module accuracy_samples
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use accuracy_costs, only: seconds_by_task
  use accuracy_rules, only: fineness_t
  use cost_file, only: cost_t, ntask, read_cost, write_cost
  use csv_reader, only: read_csv
  use equations, only: equations_t
  use errors, only: error_t, exit_input, fail
  use hash, only: sha256
  use kinds, only: wp
  use pilot_differences, only: sample_t
  use probes, only: probe_maximum, probe_minimum
  use run_options, only: run_options_t, stem_of
  use run_version, only: version_text
  use scene, only: axisymmetric, generalised_plane_strain, is_solid, scene_t
  use sections, only: section_forced, section_loads, section_motions
  use solution, only: solution_t
  use system, only: join_path
  use text, only: add_text, string_t
  implicit none
  private
  public :: add_cost, join_forces, key_of, range_of, read_sample, select_columns

  !> A quantity that changes by less than this share of the largest change in its unit is none by itself: the work of supports that
  !> hold a part which is quenched is what equilibrium is off by.
  real(wp), parameter :: hardly = 1.0e-3_wp
  !> Energies that are no quantities themselves, but tell how small a work is; forces of dies, also those that are not judged, as
  !> round the axis the ones along x, tell how small a force is.
  character(len=*), parameter :: energies(3) = [character(len=14) :: 'elastic_energy', 'plastic_work', 'friction_work']
  character(len=*), parameter :: of_dies = 'force_'
  !> Beginnings of columns that are judged where the card names none, with the load that LOADF finds and the probes that are no
  !> extremes: those jump from point to point, and grow without bound at sharp corners.
  character(len=*), parameter :: of_section = 'section_'
  character(len=*), parameter :: usual(8) = [character(len=14) :: 'external_work', 'force_', 'moment_', 'displacement_', &
                                             'rotation_', of_section, 'temperature_', 'heat_flow_']

contains

  !> Program and deck, as the cost of a run has them.
  function key_of(deck_text) result(key)
    character(len=*), intent(in) :: deck_text
    character(len=:), allocatable :: key

    key = version_text//' '//sha256(deck_text)
  end function key_of

  !> Add what a call of the solver has cost to what the run had cost before; what all has cost.
  subroutine add_cost(stem, deck_text, fineness, scene, equations, solution, processor, stress, finished, goes_on, cost, error)
    character(len=*), intent(in) :: stem, deck_text
    type(fineness_t), intent(in) :: fineness
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: processor   !! seconds of it [s]
    real(wp), intent(in) :: stress      !! estimated error of it [-], below 0 where there is none
    logical, intent(in) :: finished     !! the end of the scene
    logical, intent(in) :: goes_on      !! from an earlier operation, mesh or stop
    type(cost_t), intent(out) :: cost
    type(error_t), allocatable, intent(out) :: error
    type(cost_t) :: before
    logical :: there
    real(wp) :: seconds(ntask)
    integer :: g

    seconds = seconds_by_task(equations%timers)
    ! tasks are timed on the wall, of a machine that may have other work, and may lie within others
    if (sum(seconds) > processor) seconds = seconds*processor/sum(seconds)
    seconds(4) = processor - sum(seconds)
    if (goes_on) then
      call read_cost(stem, key_of(deck_text), before, there)
      if (there) there = is_same(before%fineness, fineness)
      if (there) seconds = seconds + before%seconds
    end if
    cost%key = key_of(deck_text)
    cost%fineness = fineness
    cost%finished = finished
    cost%elements = sum([(merge(size(scene%groups(g)%connectivity, 2), 0, is_solid(scene%groups(g))), g=1, size(scene%groups))])
    cost%steps = solution%step
    cost%iterations = solution%iterations
    cost%seconds = seconds
    cost%stress = stress
    call write_cost(stem, cost, error)
  end subroutine add_cost

  elemental function is_same(a, b) result(same)
    type(fineness_t), intent(in) :: a, b
    logical :: same

    same = abs(a%mesh - b%mesh) <= 0 .and. abs(a%steps - b%steps) <= 0 .and. abs(a%depth - b%depth) <= 0
  end function is_same

  !> A run that has reached its end, with its quantities.
  subroutine read_sample(options, deck_text, fineness, columns, sample, there)
    type(run_options_t), intent(in) :: options
    character(len=*), intent(in) :: deck_text
    type(fineness_t), intent(in) :: fineness
    type(string_t), intent(in) :: columns(:)   !! (ncolumn) titles of the judged ones
    type(sample_t), intent(out) :: sample
    logical, intent(out) :: there
    type(string_t), allocatable :: titles(:)
    real(wp), allocatable :: table(:, :)
    type(error_t), allocatable :: error
    type(cost_t) :: cost
    integer :: i, k

    call read_cost(join_path(options%out, stem_of(options%deck)), key_of(deck_text), cost, there)
    if (there) there = cost%finished .and. is_same(cost%fineness, fineness)
    sample%fineness = fineness
    sample%elements = cost%elements
    sample%steps = cost%steps
    sample%iterations = cost%iterations
    sample%seconds = cost%seconds
    sample%stress = cost%stress
    if (there) call read_csv(join_path(options%out, 'history.csv'), titles, table, error)
    there = there .and. .not. allocated(error)
    if (.not. there) return
    allocate (sample%time, source=table(1, :))
    allocate (sample%values(size(columns), size(table, 2)), source=0.0_wp)
    do k = 1, size(columns)
      do i = 1, size(titles)
        if (titles(i)%s == columns(k)%s) sample%values(k, :) = table(i, :)
      end do
    end do
  end subroutine read_sample

  !> Range of each quantity over a run; of one with a single instant its size.
  pure subroutine range_of(sample, scales)
    type(sample_t), intent(in) :: sample
    real(wp), allocatable, intent(inout) :: scales(:)   !! (ncolumn) [unit of each]
    integer :: k

    if (allocated(scales)) deallocate (scales)
    allocate (scales(size(sample%values, 1)))
    do k = 1, size(scales)
      associate (values => sample%values(k, :))
        scales(k) = maxval(values, mask=ieee_is_finite(values)) - minval(values, mask=ieee_is_finite(values))
        if (size(values) == 1) scales(k) = abs(values(1))
      end associate
    end do
  end subroutine range_of

  !> Both components of the force of a die are judged over the range of the larger one: the other may be what is left of parts that
  !> balance each other.
  pure subroutine join_forces(names, scales)
    type(string_t), intent(in) :: names(:)     !! (ncolumn) at least
    real(wp), intent(inout) :: scales(:)       !! (ncolumn) [unit of each]
    character(len=*), parameter :: along = 'force_x_', across = 'force_y_'
    integer :: i, k

    do i = 1, size(scales)
      if (index(names(i)%s, along) /= 1) cycle
      do k = 1, size(scales)
        if (names(k)%s == across//names(i)%s(len(along) + 1:)) scales([i, k]) = max(scales(i), scales(k))
      end do
    end do
  end subroutine join_forces

  !> Titles and names of the columns that are judged: those of the card, otherwise the usual ones that change.
  subroutine select_columns(options, scene, columns, names, error)
    type(run_options_t), intent(in) :: options   !! of a run that is there
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: columns(:), names(:)   !! (ncolumn)
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: titles(:)
    real(wp), allocatable :: table(:, :), scales(:)
    logical, allocatable :: chosen(:)
    type(sample_t) :: sample
    integer :: i, k

    call read_csv(join_path(options%out, 'history.csv'), titles, table, error)
    if (allocated(error)) return
    sample%values = table
    call range_of(sample, scales)
    allocate (chosen(size(titles)))
    if (size(scene%accuracy%columns) > 0) then
      chosen = .false.
      do k = 1, size(scene%accuracy%columns)
        associate (name => scene%accuracy%columns(k)%s)
          do i = 1, size(titles)
            if (name_of(titles(i)%s) == name) exit
          end do
          if (i > size(titles)) then
            call fail(error, exit_input, 'ACCURACY: the history has no column '''//name//'''')
            return
          end if
          if (.not. scales(i) > 0) then
            call fail(error, exit_input, 'ACCURACY: '''//name//''' does not change: it has no error over its range')
            return
          end if
          chosen(i) = .true.
        end associate
      end do
    else
      do i = 1, size(titles)
        chosen(i) = is_usual(scene, name_of(titles(i)%s)) .and. .not. is_moment_at_rest(i)
      end do
      do i = 1, size(titles)
        if (.not. chosen(i)) cycle
        do k = 1, size(titles)
          if (.not. (chosen(k) .or. any(name_of(titles(k)%s) == energies) .or. index(titles(k)%s, of_section) == 1 &
                     .or. index(titles(k)%s, of_dies) == 1)) cycle
          if (unit_of(titles(k)%s) == unit_of(titles(i)%s)) chosen(i) = chosen(i) .and. scales(i) > hardly*scales(k)
        end do
      end do
    end if
    columns = pack(titles, chosen)
    allocate (names(0))
    do k = 1, size(columns)
      call add_text(names, name_of(columns(k)%s))
    end do
    if (size(columns) == 0) call fail(error, exit_input, 'ACCURACY: there is nothing to judge: no force, work or probe changes', &
                                      'give a PROBE card, or names after OF')

  contains

    !> The moment of a die that never turns: how large it is, and what an error of it is over that, hangs on where its pilot stands.
    pure logical function is_moment_at_rest(i)
      integer, intent(in) :: i   !! its column
      character(len=*), parameter :: moment = 'moment_', rotation = 'rotation_'
      integer :: k

      is_moment_at_rest = index(titles(i)%s, moment) == 1
      if (.not. is_moment_at_rest) return
      do k = 1, size(titles)
        if (name_of(titles(k)%s) == rotation//name_of(titles(i)%s(len(moment) + 1:))) is_moment_at_rest = .not. scales(k) > 0
      end do
    end function is_moment_at_rest

  end subroutine select_columns

  pure function is_usual(scene, name) result(yes)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    logical :: yes
    integer :: k

    yes = any([(index(name, trim(usual(k))) == 1, k=1, size(usual))])
    k = scene%load_factor%multiplier
    if (k > 0) yes = yes .or. scene%multipliers(k)%name == name
    ! what is given of the section has no error, or that of equilibrium
    if (scene%plane_state == generalised_plane_strain) then
      do k = 1, size(scene%section_drives)
        yes = yes .and. name /= merge(section_loads(k), section_motions(k), scene%section_drives(k)%kind == section_forced)
      end do
    end if
    ! round the axis these forces are in balance by themselves
    if (scene%plane_state == axisymmetric) yes = yes .and. index(name, 'force_x_') /= 1 .and. index(name, 'moment_') /= 1
    do k = 1, size(scene%probes)
      if (scene%probes(k)%name == name) yes = all(scene%probes(k)%kind /= [probe_maximum, probe_minimum])
    end do
  end function is_usual

  pure function name_of(title) result(name)
    character(len=*), intent(in) :: title
    character(len=:), allocatable :: name

    name = title(:index(title//' [', ' [') - 1)
  end function name_of

  pure function unit_of(title) result(unit)
    character(len=*), intent(in) :: title
    character(len=:), allocatable :: unit

    unit = title(index(title//' [', ' ['):)
  end function unit_of

end module accuracy_samples
