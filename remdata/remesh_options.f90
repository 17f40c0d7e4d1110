!> The command line of `remdata`.
module remesh_options
  use arguments, only: argument, refuse_option, value_of
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use remesher_options, only: by_free, by_gmsh, by_zones
  use text, only: string_t
  implicit none
  private
  public :: remesh_options_t, read_remesh_options, remesh_usage

  type :: remesh_options_t
    !> Checkpoint of the old mesh, and file for the new one.
    character(len=:), allocatable :: checkpoint, out
    !> Method of state transfer in place of the deck's (-1: the deck's).
    integer :: transfer = -1
    !> Mesher in place of the deck's (-1: the deck's).
    integer :: mesher = -1
    !> The requested sizes are divided by this factor.
    real(wp) :: finer = 1.0_wp
    !> The requested sizes are those of the old elements.
    logical :: same_sizes = .false.
    !> Checkpoint of a run on the first mesh, by whose errors it is made again; not allocated: none.
    character(len=:), allocatable :: sizes_of
    !> What the files of the run begin with whose cost grows by that of this program; not allocated: none.
    character(len=:), allocatable :: cost
    !> Time limit for Gmsh to make a mesh [s].
    real(wp) :: limit = 300.0_wp
    !> Only print the contents of the checkpoint.
    logical :: about = .false.
    !> Only print what is in a checkpoint of this program.
    logical :: schema = .false.
    logical :: quiet = .false., help = .false., version = .false.
  end type remesh_options_t

  !> What whole numbers and numbers are written with: reading alone stops at a comma, a blank or a slash, and takes what is before.
  character(len=*), parameter :: digits = '0123456789', of_numbers = digits//'.+-Ee'

contains

  subroutine read_remesh_options(options, error)
    type(remesh_options_t), intent(out) :: options
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: word
    integer :: k, status

    k = 0
    do while (k < command_argument_count() .and. .not. allocated(error))
      k = k + 1
      call argument(k, word)
      select case (word)
      case ('--help', '-h')
        options%help = .true.
      case ('--version')
        options%version = .true.
      case ('--about')
        options%about = .true.
      case ('--schema')
        options%schema = .true.
      case ('--quiet')
        options%quiet = .true.
      case ('--out')
        call value_of(word, k, options%out, error)
      case ('--cost')
        call value_of(word, k, options%cost, error)
      case ('--transfer')
        call value_of('--transfer', k, word, error)
        if (allocated(error)) exit
        read (word, *, iostat=status) options%transfer
        if (status /= 0 .or. verify(word, digits) > 0) &
          call fail(error, exit_input, '--transfer: expected the number of a method (0, 1, 2), found '''//word//'''')
      case ('--finer')
        call value_of('--finer', k, word, error)
        if (allocated(error)) exit
        read (word, *, iostat=status) options%finer
        if (status /= 0 .or. verify(word, of_numbers) > 0 .or. .not. options%finer > 0) &
          call fail(error, exit_input, '--finer: expected a number above 0, found '''//word//'''')
      case ('--mesher')
        call value_of('--mesher', k, word, error)
        if (allocated(error)) exit
        select case (word)
        case ('zones')
          options%mesher = by_zones
        case ('free')
          options%mesher = by_free
        case ('gmsh')
          options%mesher = by_gmsh
        case default
          call fail(error, exit_input, '--mesher: expected zones, free or gmsh, found '''//word//'''')
        end select
      case ('--same-sizes')
        options%same_sizes = .true.
      case ('--sizes-of')
        call value_of(word, k, options%sizes_of, error)
      case ('--limit')
        call value_of('--limit', k, word, error)
        if (allocated(error)) exit
        read (word, *, iostat=status) options%limit
        if (status /= 0 .or. verify(word, of_numbers) > 0 .or. .not. options%limit > 0) &
          call fail(error, exit_input, '--limit: expected seconds above 0, found '''//word//'''')
      case default
        if (word(1:min(1, len(word))) == '-' .or. len(word) == 0) then
          call refuse_option(word, [string_t('--help'), string_t('--version'), string_t('--quiet'), string_t('--out'), &
                                    string_t('--cost'), string_t('--transfer'), string_t('--finer'), string_t('--mesher'), &
                                    string_t('--same-sizes'), string_t('--sizes-of'), string_t('--limit'), &
                                    string_t('--about'), string_t('--schema')], 'remdata', error)
        else if (allocated(options%checkpoint)) then
          call fail(error, exit_input, 'one checkpoint at a time: found '''//options%checkpoint//''' and '''//word//'''')
        else
          options%checkpoint = word
        end if
      end select
    end do
    if (allocated(error) .or. options%help .or. options%version .or. options%schema) return
    if (.not. allocated(options%checkpoint)) then
      call fail(error, exit_input, 'no checkpoint given', 'remdata --help shows how to call')
    else if (options%about) then
      return
    else if (.not. allocated(options%out)) then
      call fail(error, exit_input, '--out is missing: the checkpoint of the new mesh', 'remdata --help shows how to call')
    else if (options%out == options%checkpoint) then
      call fail(error, exit_input, '--out: the old checkpoint may not be overwritten')
    end if
  end subroutine read_remesh_options

  !> What --help prints.
  function remesh_usage() result(text)
    character(len=:), allocatable :: text
    character(len=*), parameter :: nl = new_line('a')

    text = 'remdata: a new mesh and the state on it, from a checkpoint of lagamine'//nl//nl// &
           'remdata CHECKPOINT --out NEW [--transfer N] [--finer F] [--mesher M] [--same-sizes] [--sizes-of RUN]'//nl// &
           '        [--limit SECONDS] [--cost DIR/NAME] [--quiet]'//nl// &
           'remdata --about CHECKPOINT'//nl// &
           'remdata --schema'//nl// &
           'remdata --next DIR/NAME [--tries N] [--fresh] [--ran WHAT --code N --said FILE [--from NAME] [--late S]]'//nl// &
           'remdata --help | --version'//nl//nl// &
           '  --out NEW       checkpoint of the new mesh, for lagamine --resume; facts in NEW.json'//nl// &
           '  --transfer N    state transfer: 0 inverse distance, 1 moving least squares, 2 patches (default: the deck''s)'//nl// &
           '  --finer F       divide the wanted sizes of elements by F'//nl// &
           '  --mesher M      zones, free or gmsh (default: MESHER of the deck); free and gmsh do without its zones'//nl// &
           '  --same-sizes    elements of the size of the old ones in each place, not as the error and the shape want them'//nl// &
           '  --sizes-of RUN  a first mesh made again, as the errors in RUN want it: a checkpoint of a run on it'//nl// &
           '  --limit SECONDS longest time for Gmsh, where it makes the mesh (default 300)'//nl// &
           '  --cost DIR/NAME add the seconds of this program to DIR/NAME.cost, if the run of deck NAME has that file'//nl// &
           '  --about         check the file and print what it holds, a word and its value a line'//nl// &
           '  --schema        print what is in a checkpoint: every member with unit, range, and what a remesh does with it'//nl// &
           '  --quiet         print errors only'//nl// &
           '  --next DIR/NAME say what lagacycle does next for deck NAME with results in DIR, a word and its value a line;'//nl// &
           '                  --ran check, lagamine or remdata and what follows: how the program ended that it called'//nl//nl// &
           'Exit codes: 0 done, 2 input refused, 3 no mesh that is good enough, 5 the machine failed, 6 a check of our own failed'
  end function remesh_usage

end module remesh_options
