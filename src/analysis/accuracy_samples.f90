!> What a run of a deck with ACCURACY leaves for the choice of another one: its fineness and cost in `NAME.cost`, and its history.
module accuracy_samples
  use accuracy_laws, only: sample_t
  use accuracy_rules, only: fineness_t
  use atomic, only: read_text, write_text
  use csv_reader, only: read_csv
  use equations, only: equations_t
  use errors, only: error_t, exit_input, fail
  use exact_numbers, only: exact_text
  use hash, only: sha256
  use kinds, only: wp
  use probes, only: probe_maximum, probe_minimum
  use run_options, only: run_options_t, stem_of
  use run_version, only: version_text
  use scene, only: axisymmetric, is_solid, scene_t
  use solution, only: solution_t
  use system, only: file_exists, join_path
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: range_of, read_sample, select_columns, write_cost

  !> A quantity that changes by less than this share of the largest change in its unit is none by itself.
  real(wp), parameter :: hardly = 1.0e-3_wp
  !> Beginnings of columns that are judged where the card names none, with the probes that are no extremes: those jump from point
  !> to point, and grow without bound at sharp corners.
  character(len=*), parameter :: usual(8) = [character(len=14) :: 'external_work', 'force_', 'moment_', 'displacement_', &
                                             'rotation_', 'section_', 'temperature_', 'heat_flow_']

contains

  !> Write what the run has cost. Operations add up.
  subroutine write_cost(stem, deck_text, fineness, scene, equations, solution, processor, stress, goes_on, error)
    character(len=*), intent(in) :: stem, deck_text
    type(fineness_t), intent(in) :: fineness
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: processor   !! seconds of it [s]
    real(wp), intent(in) :: stress   !! estimated error of it [-], below 0 where there is none
    logical, intent(in) :: goes_on   !! from an earlier operation
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: nl = new_line('a')
    type(sample_t) :: before
    logical :: there
    real(wp) :: seconds(4)
    integer :: t, g, n

    seconds = 0
    do t = 1, equations%timers%size()
      n = 1
      if (equations%timers%name(t) == 'contact') n = 2
      if (equations%timers%name(t) == 'factorisation') n = 3
      seconds(n) = seconds(n) + equations%timers%seconds(t)
    end do
    ! tasks are timed on the wall, of a machine that may have other work, and may lie within others
    if (sum(seconds) > processor) seconds = seconds*processor/sum(seconds)
    seconds(4) = processor - sum(seconds)
    if (goes_on) then
      call read_cost(stem, deck_text, fineness, before, there)
      if (there) seconds = seconds + before%seconds
    end if
    n = sum([(merge(size(scene%groups(g)%connectivity, 2), 0, is_solid(scene%groups(g))), g=1, size(scene%groups))])
    call write_text(stem//'.cost', version_text//' '//sha256(deck_text)//nl &
                    //exact_text(fineness%mesh)//' '//exact_text(fineness%steps)//' '//exact_text(fineness%depth)//nl &
                    //to_text(n)//' '//to_text(solution%step)//' '//to_text(solution%iterations)//nl &
                    //exact_text(seconds(1))//' '//exact_text(seconds(2))//' '//exact_text(seconds(3)) &
                    //' '//exact_text(seconds(4))//nl &
                    //exact_text(stress)//nl, error)
  end subroutine write_cost

  !> `there` is false where the file is missing, or of another deck, program or fineness.
  subroutine read_cost(stem, deck_text, fineness, sample, there)
    character(len=*), intent(in) :: stem, deck_text
    type(fineness_t), intent(in) :: fineness
    type(sample_t), intent(out) :: sample
    logical, intent(out) :: there
    character(len=:), allocatable :: text
    type(error_t), allocatable :: error
    character(len=*), parameter :: nl = new_line('a')
    integer :: first, status

    there = file_exists(stem//'.cost')
    if (.not. there) return
    call read_text(stem//'.cost', text, error)
    there = .not. allocated(error)
    if (there) there = index(text, version_text//' '//sha256(deck_text)//nl) == 1
    if (.not. there) return
    first = index(text, nl) + 1
    ! list-directed reading of an internal file sees one record
    do
      if (index(text(first:), nl) == 0) exit
      text(first + index(text(first:), nl) - 1:first + index(text(first:), nl) - 1) = ' '
    end do
    read (text(first:), *, iostat=status) sample%fineness%mesh, sample%fineness%steps, sample%fineness%depth, &
      sample%elements, sample%steps, sample%iterations, sample%seconds, sample%stress
    there = status == 0 .and. abs(sample%fineness%mesh - fineness%mesh) <= 0 &
            .and. abs(sample%fineness%steps - fineness%steps) <= 0 .and. abs(sample%fineness%depth - fineness%depth) <= 0
  end subroutine read_cost

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
    integer :: i, k

    call read_cost(join_path(options%out, stem_of(options%deck)), deck_text, fineness, sample, there)
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
        scales(k) = maxval(values, mask=abs(values) <= huge(values)) - minval(values, mask=abs(values) <= huge(values))
        if (size(values) == 1) scales(k) = abs(values(1))
      end associate
    end do
  end subroutine range_of

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
        chosen(i) = is_usual(scene, name_of(titles(i)%s))
      end do
      do i = 1, size(titles)
        if (.not. chosen(i)) cycle
        do k = 1, size(titles)
          if (.not. chosen(k)) cycle
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
  end subroutine select_columns

  pure function is_usual(scene, name) result(yes)
    type(scene_t), intent(in) :: scene
    character(len=*), intent(in) :: name
    logical :: yes
    integer :: k

    yes = any([(index(name, trim(usual(k))) == 1, k=1, size(usual))])
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
