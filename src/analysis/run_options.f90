!> The command line of `lagamine`.
module run_options
  use accuracy_rules, only: fineness_t
  use arguments, only: argument, refuse_option, value_of
  use errors, only: error_t, exit_input, fail
  use text, only: string_t
  implicit none
  private
  public :: run_options_t, read_options, stem_of, usage_text

  type :: run_options_t
    character(len=:), allocatable :: deck
    !> Folder of the results; by default the deck's name, in the present folder.
    character(len=:), allocatable :: out
    !> No folder is given: it is called as the deck.
    logical :: default_out = .false.
    character(len=:), allocatable :: resume
    !> Law whose card is asked for; empty for the list of all.
    character(len=:), allocatable :: law
    !> File of steels (.MET) to print.
    character(len=:), allocatable :: met
    type(string_t), allocatable :: overrides(:)
    !> What a run with ACCURACY is expected to be: its pilots are made, not the run.
    logical :: forecast = .false.
    logical :: check = .false., point = .false., quiet = .false., help = .false., version = .false.
    !> The keywords of all cards are asked for.
    logical :: cards = .false.
    !> Progress only, also where the output is no terminal.
    logical :: progress = .false.
    !> Other new meshes agree on the forces of the one that is taken up.
    logical :: force_agreed = .false.
    !> Fineness of a run of a deck with ACCURACY, over what the deck says; not allocated before it is chosen.
    type(fineness_t), allocatable :: fineness
    integer :: threads = 0   !! 0: as many as there are free processors
  end type run_options_t

contains

  !> Read the arguments of the program; all mistakes end in `error`.
  subroutine read_options(options, error)
    type(run_options_t), intent(out) :: options
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: word
    integer :: k, status

    allocate (options%overrides(0))
    k = 0
    do while (k < command_argument_count() .and. .not. allocated(error))
      k = k + 1
      call argument(k, word)
      select case (word)
      case ('--help', '-h')
        options%help = .true.
      case ('--version')
        options%version = .true.
      case ('--cards')
        options%cards = .true.
      case ('--check')
        options%check = .true.
      case ('--forecast')
        options%check = .true.
        options%forecast = .true.
      case ('--point')
        options%point = .true.
      case ('--quiet')
        options%quiet = .true.
      case ('--progress')
        options%progress = .true.
      case ('--agreed')
        options%force_agreed = .true.
      case ('--out')
        call value_of(word, k, options%out, error)
      case ('--resume')
        call value_of(word, k, options%resume, error)
      case ('--fineness')
        call value_of('--fineness', k, word, error)
        if (.not. allocated(error)) call read_fineness(word, options%fineness, error)
      case ('--law')
        if (k == command_argument_count()) then
          options%law = ''
        else
          call value_of(word, k, options%law, error)
        end if
      case ('--met')
        call value_of(word, k, options%met, error)
      case ('-p')
        call value_of('-p', k, word, error)
        if (allocated(error)) exit
        if (index(word, '=') < 2) call fail(error, exit_input, '-p '//word//': expected NAME=VALUE')
        options%overrides = [options%overrides, string_t(word)]
      case ('--threads')
        call value_of('--threads', k, word, error)
        if (allocated(error)) exit
        read (word, *, iostat=status) options%threads
        if (status /= 0 .or. options%threads < 1 .or. verify(word, '0123456789') > 0) then
          call fail(error, exit_input, '--threads: expected a number of threads (1, 2, ...), found '''//word//'''')
        end if
      case default
        if (word(1:min(1, len(word))) == '-' .or. len(word) == 0) then
          call refuse_option(word, [string_t('--help'), string_t('--version'), string_t('--check'), string_t('--quiet'), &
                                    string_t('--forecast'), string_t('--fineness'), string_t('--agreed'), &
                                    string_t('--progress'), string_t('--out'), string_t('--resume'), string_t('--law'), &
                                    string_t('--met'), string_t('--cards'), string_t('--point'), string_t('-p'), &
                                    string_t('--threads')], &
                             'lagamine', error)
        else if (allocated(options%deck)) then
          call fail(error, exit_input, 'one deck at a time: found '''//options%deck//''' and '''//word//'''')
        else
          options%deck = word
        end if
      end select
    end do
    if (allocated(error) .or. options%help .or. options%version .or. options%cards .or. allocated(options%law)) return
    if (options%force_agreed .and. .not. allocated(options%resume)) then
      call fail(error, exit_input, '--agreed: expected --resume with a checkpoint on a new mesh')
    else if (allocated(options%met)) then
      if (allocated(options%deck)) call fail(error, exit_input, '--met takes no deck: found '''//options%deck//'''')
      if (.not. allocated(options%out)) options%out = stem_of(options%met)
    else if (options%point .and. allocated(options%resume)) then
      call fail(error, exit_input, '--resume: a path of a point (--point) has no checkpoint to go on from')
    else if (.not. allocated(options%deck)) then
      call fail(error, exit_input, 'no deck given', 'lagamine --help shows how to call')
    else if (.not. allocated(options%out)) then
      options%default_out = .true.
      options%out = stem_of(options%deck)
    else if (len_trim(options%out) == 0) then
      call fail(error, exit_input, '--out: expected the name of a folder, found nothing')
    end if
  end subroutine read_options

  !> `MESH,STEPS,DEPTH`: factors over the deck's.
  subroutine read_fineness(word, fineness, error)
    character(len=*), intent(in) :: word
    type(fineness_t), allocatable, intent(out) :: fineness
    type(error_t), allocatable, intent(out) :: error
    integer :: k, status

    allocate (fineness)
    read (word, *, iostat=status) fineness%mesh, fineness%steps, fineness%depth
    if (status == 0 .and. verify(word, '0123456789.,+-Ee') == 0 .and. count([(word(k:k) == ',', k=1, len(word))]) == 2 &
        .and. index(word, ',,') == 0) then
      if (min(fineness%mesh, fineness%steps, fineness%depth) > 0) return
    end if
    call fail(error, exit_input, '--fineness: expected three numbers above 0 and commas between them, found '''//word &
              //'''', &
              'elements along a line, length of steps and penetration, each over what the deck says')
  end subroutine read_fineness

  !> Name of a file without folders and ending.
  pure function stem_of(path) result(stem)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: stem
    integer :: dot

    stem = path(index(path, '/', back=.true.) + 1:)
    dot = index(stem, '.', back=.true.)
    if (dot > 1) stem = stem(:dot - 1)
  end function stem_of

  !> What --help prints.
  function usage_text() result(text)
    character(len=:), allocatable :: text
    character(len=*), parameter :: nl = new_line('a')

    text = 'lagamine: metal forming and heat treatment in two dimensions'//nl//nl// &
           'lagamine DECK [--out DIR] [--check|--forecast] [--resume CHECKPOINT] [-p NAME=VALUE]...'//nl// &
           '         [--fineness M,S,D] [--threads N] [--progress|--quiet] [--agreed]'//nl// &
           'lagamine --point DECK [--out DIR] [--check] [-p NAME=VALUE]... [--quiet]'//nl// &
           'lagamine --met FILE [--out DIR] [--check] [-p NAME=VALUE]... [--quiet]'//nl// &
           'lagamine --law [NAME] | --cards | --help | --version'//nl//nl// &
           '  --out DIR       folder of the results (default: the deck''s name); with --check: for DIR/NAME.scene.json'//nl// &
           '  --check         read the deck, print the scene, run nothing'//nl// &
           '  --forecast      of a deck with ACCURACY: make its pilots, print what the run is expected to be'//nl// &
           '  --fineness M,S,D  with M times the deck''s elements along a line, steps S times as long, D times its'//nl// &
           '                  penetration: a pilot of ACCURACY, which lagacycle asks for where it takes new meshes'//nl// &
           '  --resume FILE   go on from a checkpoint of the same deck'//nl// &
           '  --agreed        with --resume: other new meshes agree on the force of a die, it refuses none'//nl// &
           '  -p NAME=VALUE   set a parameter of the deck'//nl// &
           '  --threads N     threads (default: as many as processors are free); the same bits for any number'//nl// &
           '  --point         one material point along the deck''s PATH; its answer comes into DIR/NAME.point.csv'//nl// &
           '  --met FILE      print the steels of a .MET file: temperatures, isothermal diagram, coolings; tables into DIR'//nl// &
           '  --progress      print the progress only, no summary; once a minute where that goes into a file'//nl// &
           '  --quiet         print errors only'//nl// &
           '  --law [NAME]    print the card of a law: parameters, units, state, source; without a name, list all laws'//nl// &
           '  --cards         list the keywords of all cards'//nl//nl// &
           'Exit codes: 0 done, 2 input refused, 3 no convergence at the smallest step, 4 remesh due,'//nl// &
           '            7 a pilot of ACCURACY is due that takes new meshes (lagacycle makes it),'//nl// &
           '            5 the machine failed, 6 a check of our own failed, 128+n stopped by signal n'
  end function usage_text

end module run_options
