!> One pilot of a deck with ACCURACY: a short run in a folder of its own beside the results.
!> A pilot that is there already, of the same deck and program, is not made again. Those of a deck with REMSH need new meshes,
!> which the solver does not make: it asks `lagacycle` for one after the other (`NAME.pilot`, exit code 7).
module accuracy_pilots
  use accuracy_plan, only: accuracy_plan_t, fineness_words
  use accuracy_rules, only: fineness_t, stress_name
  use accuracy_samples, only: key_of, read_sample, select_columns
  use atomic, only: read_text, write_text
  use cost_file, only: cost_t, read_cost
  use errors, only: error_t, exit_done, exit_input, exit_no_convergence, exit_pilot, fail
  use exact_numbers, only: exact_text
  use kinds, only: wp
  use pilot_differences, only: sample_t
  use run_options, only: run_options_t, stem_of
  use scene, only: scene_t
  use standard_streams, only: print_line
  use system, only: file_exists, join_path, make_directory
  use text, only: add_text, string_t, to_text
  implicit none
  private
  public :: add_pilot, run_i

  abstract interface
    !> A run by its options; its exit code, where there is no error.
    recursive subroutine run_i(options, code, error)
      import :: error_t, run_options_t
      type(run_options_t), intent(in) :: options
      integer, intent(out) :: code
      type(error_t), allocatable, intent(out) :: error
    end subroutine run_i
  end interface

contains

  !> One pilot, made where it is not there, added to those of the plan; `there` is false where it did not reach its end.
  recursive subroutine add_pilot(options, scene, deck_text, run, fineness, plan, there, code, error)
    type(run_options_t), intent(in) :: options   !! of the run
    type(scene_t), intent(in) :: scene           !! as the deck says
    character(len=*), intent(in) :: deck_text
    procedure(run_i) :: run
    type(fineness_t), intent(in) :: fineness
    type(accuracy_plan_t), intent(inout) :: plan
    logical, intent(out) :: there
    integer, intent(out) :: code                 !! of a pilot that was stopped by a signal
    type(error_t), allocatable, intent(out) :: error
    type(run_options_t) :: own
    type(sample_t) :: sample

    code = exit_done
    own = options_of_pilot(options, fineness)
    call read_sample(own, deck_text, fineness, plan%columns, sample, there)
    if (.not. there) then
      if (scene%remesh%on) then
        call ask_for_cycle(options, own, deck_text, error)
        if (allocated(error)) return
      else
        call run_pilot(options, own, run, there, code, error)
        if (allocated(error) .or. code /= exit_done) return
      end if
      if (.not. there) then
        call add_text(plan%notes, 'the pilot with '//fineness_words(fineness)//' did not reach its end')
        return
      end if
    end if
    call name_columns(own, scene, plan, error)
    if (allocated(error)) return
    call read_sample(own, deck_text, fineness, plan%columns, sample, there)
    if (.not. there) then
      call fail(error, exit_input, 'ACCURACY: the pilot in '//own%out//' cannot be read')
      return
    end if
    plan%pilots = [plan%pilots, sample]
    plan%pilot_seconds = plan%pilot_seconds + sum(sample%seconds)
  end subroutine add_pilot

  !> Options of a pilot: those of the run, in a folder that is named after its fineness.
  function options_of_pilot(options, fineness) result(own)
    type(run_options_t), intent(in) :: options
    type(fineness_t), intent(in) :: fineness
    type(run_options_t) :: own

    own = options
    own%out = join_path(options%out, 'pilot_'//to_text(fineness%mesh, 3)//'_'//to_text(fineness%steps, 3)//'_' &
                        //to_text(fineness%depth, 3))
    own%default_out = .false.
    own%check = .false.
    own%forecast = .false.
    own%quiet = .true.
    own%progress = .false.
    if (allocated(own%resume)) deallocate (own%resume)
    own%fineness = fineness
  end function options_of_pilot

  !> Run a pilot. One that finds no equilibrium is no reason why the run should not: no error, `done` is false.
  recursive subroutine run_pilot(options, own, run, done, code, error)
    type(run_options_t), intent(in) :: options, own   !! of the run and of the pilot
    procedure(run_i) :: run
    logical, intent(out) :: done                      !! it has reached its end
    integer, intent(out) :: code
    type(error_t), allocatable, intent(out) :: error

    done = .false.
    code = exit_done
    if (.not. (options%quiet .or. options%progress)) &
      call print_line('pilot of ACCURACY: '//fineness_words(own%fineness), error)
    if (.not. allocated(error)) call run(own, code, error)
    if (allocated(error)) code = error%code
    done = .not. allocated(error) .and. code == exit_done
    if (code /= exit_no_convergence) return
    if (allocated(error)) deallocate (error)
    code = exit_done
  end subroutine run_pilot

  !> Columns of the history that are judged, once a pilot has one.
  subroutine name_columns(own, scene, plan, error)
    type(run_options_t), intent(in) :: own   !! of the pilot
    type(scene_t), intent(in) :: scene
    type(accuracy_plan_t), intent(inout) :: plan
    type(error_t), allocatable, intent(out) :: error

    associate (only_stress => scene%accuracy%stress .and. size(scene%accuracy%columns) == 0)
      if (size(plan%columns) == 0 .and. .not. only_stress) then
        call select_columns(own, scene, plan%columns, plan%names, error)
        if (allocated(error)) return
        if (scene%accuracy%stress) call add_text(plan%names, stress_name)
        plan%scales = spread(1.0_wp, 1, size(plan%columns))
      else if (size(plan%names) == 0) then
        plan%names = [string_t(stress_name)]
      end if
    end associate
  end subroutine name_columns

  !> Ask for a pilot that needs new meshes: `NAME.pilot` names its folder, its fineness, and how it begins. No error where it has
  !> been made and did not reach its end: then its folder has that file.
  subroutine ask_for_cycle(options, own, deck_text, error)
    type(run_options_t), intent(in) :: options, own   !! of the run and of the pilot
    character(len=*), intent(in) :: deck_text
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: nl = new_line('a')
    character(len=:), allocatable :: name, what, tried
    type(cost_t) :: cost
    logical :: there

    name = stem_of(options%deck)//'.pilot'
    what = own%out//nl//exact_text(own%fineness%mesh)//','//exact_text(own%fineness%steps)//','//exact_text(own%fineness%depth)//nl
    if (file_exists(join_path(own%out, name))) then
      call read_text(join_path(own%out, name), tried, error)
      if (allocated(error)) return
      if (index(tried, what) == 1 .and. index(tried, nl//key_of(deck_text)//nl) > 0) return
    end if
    call read_cost(join_path(own%out, stem_of(options%deck)), key_of(deck_text), cost, there)
    call make_directory(options%out, error)
    if (.not. allocated(error)) &
      call write_text(join_path(options%out, name), what//trim(merge('go on', 'begin', there .and. .not. cost%finished))//nl &
                                                  //key_of(deck_text)//nl, error)
    if (allocated(error)) return
    call fail(error, exit_pilot, 'ACCURACY with REMSH: the pilot with '//fineness_words(own%fineness) &
              //' is missing, and needs new meshes', &
              'call lagacycle with this deck, or lagacycle --forecast: it makes pilots and new meshes')
  end subroutine ask_for_cycle

end module accuracy_pilots
