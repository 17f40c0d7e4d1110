!> `lagamine --point DECK`: one material point along a path of strains and stresses, its response as a table.
module point_run
  use csv_writer, only: csv_t
  use deck_reader, only: deck_t, of_point, read_deck, refuse_other_kind
  use diagnostics, only: diagnostics_t
  use errors, only: error_t, exit_no_convergence, fail
  use folder_lock, only: folder_lock_t, lock_folder, unlock_folder
  use kinds, only: wp
  use kinematics_api, only: kinematics_t, solid_variables
  use kinematics_registry, only: list_kinematics
  use law_api, only: law_done, law_of_material, law_t
  use law_registry, only: list_laws
  use point_paths, only: point_path_t, ramp_t
  use point_reader, only: read_point
  use point_step, only: advance_point, point_t
  use run_options, only: run_options_t, stem_of
  use standard_streams, only: print_line
  use state_variables, only: component_names, state_variable_t, total_components
  use stress_measures, only: von_mises
  use system, only: join_path, make_directory
  use text, only: string_t, to_text
  implicit none
  private
  public :: run_point

  !> A step is cut back by halves down to this share of it.
  real(wp), parameter :: least_share = 2.0_wp**(-12)

  type :: counts_t
    integer :: steps = 0, iterations = 0, cutbacks = 0
  end type counts_t

contains

  !> Read the deck, follow the path, write `NAME.point.csv`, report the result.
  subroutine run_point(options, error)
    type(run_options_t), intent(in) :: options
    type(error_t), allocatable, intent(out) :: error
    type(point_path_t) :: path
    type(folder_lock_t) :: lock

    call read_path(options, path, error)
    if (allocated(error)) return
    if (.not. options%check) then
      call make_directory(options%out, error)
      if (.not. allocated(error)) call lock_folder(options%out, 'lagamine', lock, error)
    end if
    if (.not. allocated(error)) call follow_path(options, path, error)
    call unlock_folder(lock)
  end subroutine run_point

  !> From the first ramp to the last.
  subroutine follow_path(options, path, error)
    type(run_options_t), intent(in) :: options
    type(point_path_t), intent(in) :: path
    type(error_t), allocatable, intent(out) :: error
    type(point_t) :: point
    type(state_variable_t), allocatable :: variables(:)
    type(csv_t) :: table
    type(counts_t) :: counts
    type(error_t), allocatable :: late, unseen
    character(len=:), allocatable :: file
    real(wp) :: temperature, time
    integer :: k

    call place_point(path, point, variables)
    if (.not. options%quiet) call print_path(path, point, error)
    if (options%check .or. allocated(error)) return
    file = join_path(options%out, stem_of(options%deck)//'.point.csv')
    call begin_table(variables, file, table, error)
    if (allocated(error)) return
    temperature = path%temperature
    time = 0
    call write_row(table, time, temperature, counts, 0, point, error)
    if (.not. options%quiet) call print_point(time, point, unseen, heading=.true.)
    do k = 1, size(path%ramps)
      if (allocated(error)) exit
      call follow(path%ramps(k), point, time, temperature, counts, table, error)
      if (.not. options%quiet) call print_point(time, point, unseen)
    end do
    call table%close(late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
    if (allocated(error) .or. options%quiet) return
    call print_line('done: '//to_text(counts%steps)//' steps, '//to_text(counts%iterations)//' iterations, ' &
                    //to_text(counts%cutbacks)//' cutbacks; table in '//file, unseen)
    if (allocated(unseen)) call move_alloc(unseen, error)
  end subroutine follow_path

  subroutine read_path(options, path, error)
    type(run_options_t), intent(in) :: options
    type(point_path_t), intent(out) :: path
    type(error_t), allocatable, intent(out) :: error
    type(deck_t), target :: deck
    type(diagnostics_t), target :: diagnostics
    logical :: refused

    call read_deck(options%deck, options%overrides, deck, diagnostics)
    refused = .false.
    if (deck%complete) call refuse_other_kind(deck, of_point, diagnostics, refused)
    if (deck%complete .and. .not. refused) call read_point(deck, path, diagnostics)
    call diagnostics%error(error)
  end subroutine read_path

  !> The point at rest, and the variables of its state.
  subroutine place_point(path, point, variables)
    type(point_path_t), intent(in) :: path
    type(point_t), intent(out) :: point
    type(state_variable_t), allocatable, intent(out) :: variables(:)
    type(law_t), allocatable :: laws(:)
    type(kinematics_t), allocatable :: kinematics(:)
    integer :: k

    call list_laws(laws)
    call list_kinematics(kinematics)
    point%material = path%material
    point%law = law_of_material(laws(path%material%law_id), point%material)
    point%kinematics = kinematics(path%kinematics_id)
    call solid_variables(point%law, variables)
    allocate (point%state(total_components(variables)), source=0.0_wp)
    do k = 1, size(variables)
      point%state(variables(k)%first:variables(k)%first + variables(k)%ncomp - 1) = variables(k)%initial
    end do
  end subroutine place_point

  !> All steps of a ramp, one row of the table each. A step without a solution is cut back.
  subroutine follow(ramp, point, time, temperature, counts, table, error)
    type(ramp_t), intent(in) :: ramp
    type(point_t), intent(inout) :: point
    real(wp), intent(inout) :: time, temperature
    type(counts_t), intent(inout) :: counts
    type(csv_t), intent(inout) :: table
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: start(4), begun, warm, at, to, share, ends(2)
    integer :: k, iterations, status, sum_of_iterations

    start = merge(point%state(1:4), point%strain, ramp%stress)
    point%rate = 0
    begun = time
    warm = temperature
    at = 0
    do k = 1, ramp%steps
      to = real(k, wp)/ramp%steps
      share = to - at
      sum_of_iterations = 0
      do while (at < to)
        ! the last piece ends where the step does, to the last bit
        ends = [at, merge(to, at + share, share >= (to - at)*(1 - least_share/2))]
        call advance_point(point, (ends(2) - ends(1))*(ramp%time - begun), warm + ends*(ramp%temperature - warm), ramp%stress, &
                           start + ends(2)*(ramp%values - start), iterations, status)
        sum_of_iterations = sum_of_iterations + iterations
        if (status == law_done) then
          at = ends(2)
          share = min(2*share, to - at)
          cycle
        end if
        counts%cutbacks = counts%cutbacks + 1
        share = share/2
        if (share*ramp%steps >= least_share) cycle
        time = begun + at*(ramp%time - begun)
        call fail(error, exit_no_convergence, ramp%where_defined//': PATH: no solution after time '//to_text(time) &
                  //', step '//to_text(counts%steps + 1)//', even when the step is cut back to 1/' &
                  //to_text(nint(1/least_share))//' of its length', &
                  'a given stress may be out of reach, or take smaller steps')
        return
      end do
      counts%steps = counts%steps + 1
      counts%iterations = counts%iterations + sum_of_iterations
      time = begun + to*(ramp%time - begun)
      temperature = warm + to*(ramp%temperature - warm)
      if (k == ramp%steps) time = ramp%time
      if (k == ramp%steps) temperature = ramp%temperature
      call write_row(table, time, temperature, counts, sum_of_iterations, point, error)
      if (allocated(error)) return
    end do
  end subroutine follow

  subroutine begin_table(variables, file, table, error)
    type(state_variable_t), intent(in) :: variables(:)
    character(len=*), intent(in) :: file
    type(csv_t), intent(inout) :: table
    type(error_t), allocatable, intent(out) :: error
    type(string_t), allocatable :: names(:), columns(:)
    integer :: k, c, n

    call component_names(variables, names)
    allocate (columns(9 + size(names)))
    columns(:9) = [string_t('time [time]'), string_t('step [-]'), string_t('iterations [-]'), &
                   string_t('temperature [temperature]'), string_t('strain_xx [-]'), string_t('strain_yy [-]'), &
                   string_t('shear_xy [-]'), string_t('strain_zz [-]'), string_t('von_mises [stress]')]
    n = 0
    do k = 1, size(variables)
      do c = 1, variables(k)%ncomp
        n = n + 1
        columns(9 + n)%s = names(n)%s//' ['//variables(k)%unit//']'
      end do
    end do
    call table%create(file, columns, error)
  end subroutine begin_table

  subroutine write_row(table, time, temperature, counts, iterations, point, error)
    type(csv_t), intent(inout) :: table
    real(wp), intent(in) :: time, temperature
    type(counts_t), intent(in) :: counts
    integer, intent(in) :: iterations
    type(point_t), intent(in) :: point
    type(error_t), allocatable, intent(out) :: error

    call table%put(time)
    call table%put([counts%steps, iterations])
    call table%put(temperature)
    call table%put(point%strain)
    call table%put(von_mises(point%state(1:4)))
    call table%put(point%state)
    call table%end_row()
    call table%status(error)
  end subroutine write_row

  subroutine print_path(path, point, error)
    type(point_path_t), intent(in) :: path
    type(point_t), intent(in) :: point
    type(error_t), allocatable, intent(inout) :: error

    call print_line(path%title, error)
    call print_line('a point of '//path%material%name//' ('//point%law%name//': '//point%law%purpose//'), kinematics ' &
                    //point%kinematics%name//', '//to_text(size(path%ramps))//' ramps, '//to_text(sum(path%ramps%steps)) &
                    //' steps until time '//to_text(path%ramps(size(path%ramps))%time), error)
  end subroutine print_path

  !> A line for the screen: time, strains, stresses.
  subroutine print_point(time, point, error, heading)
    real(wp), intent(in) :: time
    type(point_t), intent(in) :: point
    type(error_t), allocatable, intent(inout) :: error
    logical, intent(in), optional :: heading
    character(len=11), parameter :: titles(10) = [character(len=11) :: 'time', 'strain xx', 'yy', 'shear xy', 'zz', 'stress xx', &
                                                  'yy', 'xy', 'zz', 'von Mises']
    character(len=120) :: line

    if (present(heading)) then
      write (line, '(10(1x, a11))') adjustr(titles)
      call print_line(line, error)
    end if
    write (line, '(10(1x, es11.4))') time, point%strain, point%state(1:4), von_mises(point%state(1:4))
    call print_line(line, error)
  end subroutine print_point

end module point_run
