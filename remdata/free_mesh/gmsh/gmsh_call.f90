!> Gmsh's mesh of one body, by the program `remdata_gmsh`: input files, a child process, an output file.
module gmsh_call
  use arguments, only: argument
  use child_process, only: ending_t, own_process, run_child
  use errors, only: error_t, exit_no_convergence, fail
  use gmsh_files, only: cell_t, read_quads, unit_frame_t, write_script
  use kinds, only: wp
  use quad_lists, only: quads_t
  use system, only: directory_of, from_environment, join_path, remove_file
  use text, only: string_t, to_text
  implicit none
  private
  public :: gmsh_t, find_gmsh, mesh_outline

  !> How Gmsh is called.
  type :: gmsh_t
    character(len=:), allocatable :: program_name
    !> Prefix of the file names, unique to this process: a child may outlive a parent that was killed.
    character(len=:), allocatable :: stem
    !> Longest time for a mesh [s].
    real(wp) :: limit = 0.0_wp
    !> Result of the last call: it could be started; it exceeded the time limit.
    logical :: available = .true., late = .false.
  end type gmsh_t

contains

  !> The program named by REMDATA_GMSH in the environment, or the one in the folder of this program.
  subroutine find_gmsh(beside, limit, gmsh)
    character(len=*), intent(in) :: beside   !! files are written in the folder of this one
    real(wp), intent(in) :: limit            !! longest time for a mesh [s]
    type(gmsh_t), intent(out) :: gmsh
    character(len=:), allocatable :: own_path

    gmsh%stem = beside//'.'//to_text(own_process())
    gmsh%limit = limit
    gmsh%program_name = from_environment('REMDATA_GMSH')
    if (gmsh%program_name /= '') return
    gmsh%program_name = 'remdata_gmsh'
    call argument(0, own_path)
    if (index(own_path, '/') > 0) gmsh%program_name = join_path(directory_of(own_path), gmsh%program_name)
    if (index(gmsh%program_name, '/') == 0 .and. index(own_path, '/') > 0) gmsh%program_name = './'//gmsh%program_name
  end subroutine find_gmsh

  !> Quadrilaterals between points along the contours of a body.
  subroutine mesh_outline(gmsh, points, first, cells, factor, quads, error)
    type(gmsh_t), intent(inout) :: gmsh
    real(wp), intent(in) :: points(:, :)   !! (2, n) [length]
    integer, intent(in) :: first(:)        !! (ncontour + 1) of each contour among the points, and one past the last
    type(cell_t), intent(in) :: cells(:)   !! (ncell)
    real(wp), intent(in) :: factor         !! ratio of the sizes to those of the cells
    type(quads_t), intent(out) :: quads
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: late
    type(ending_t) :: ending
    type(unit_frame_t) :: frame
    type(string_t) :: words(3)
    character(len=:), allocatable :: script, mesh, log_file

    script = gmsh%stem//'.geo'
    mesh = gmsh%stem//'.msh'
    log_file = gmsh%stem//'.said'
    frame%low = minval(points, 2)
    frame%width = maxval(maxval(points, 2) - frame%low)
    call remove_file(mesh, error)
    if (.not. allocated(error)) call write_script(script, frame, points, first, cells, factor, error)
    if (.not. allocated(error)) then
      words(1)%s = gmsh%program_name
      words(2)%s = script
      words(3)%s = mesh
      call run_child(words, log_file, gmsh%limit, ending)
      call check_ending(gmsh, ending, log_file, error)
    end if
    if (.not. allocated(error)) call read_quads(mesh, frame, size(points, 2), quads, error)
    call remove_file(script, late)
    call remove_file(mesh, late)
    call remove_file(log_file, late)
    if (allocated(late) .and. .not. allocated(error)) call move_alloc(late, error)
  end subroutine mesh_outline

  !> One message for each kind of failure.
  subroutine check_ending(gmsh, ending, log_file, error)
    type(gmsh_t), intent(inout) :: gmsh
    type(ending_t), intent(in) :: ending
    character(len=*), intent(in) :: log_file
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: advice = 'give ZONE cards, or other sizes of elements'

    gmsh%available = ending%started
    gmsh%late = ending%late
    if (.not. ending%started) then
      call fail(error, exit_no_convergence, "remdata: a contour without zones is meshed by Gmsh, and '"//gmsh%program_name &
                //"' cannot be started", 'give ZONE cards, or install libgmsh-dev (Debian, Ubuntu) and build again')
    else if (ending%late) then
      call fail(error, exit_no_convergence, 'remdata: Gmsh gave no mesh in '//to_text(gmsh%limit)//' s', advice)
    else if (ending%signal /= 0) then
      call fail(error, exit_no_convergence, 'remdata: Gmsh crashed, signal '//to_text(ending%signal), advice)
    else if (ending%code /= 0) then
      call fail(error, exit_no_convergence, 'remdata: Gmsh made no mesh, exit code '//to_text(ending%code)//last_words(log_file), &
                advice)
    end if
  end subroutine check_ending

  !> The last line that is not empty, after a colon.
  function last_words(log_file) result(words)
    character(len=*), intent(in) :: log_file
    character(len=:), allocatable :: words
    character(len=200) :: line
    integer :: unit, status

    words = ''
    open (newunit=unit, file=log_file, status='old', action='read', iostat=status)
    if (status /= 0) return
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (line /= '') words = ': '//trim(line)
    end do
    close (unit)
  end function last_words

end module gmsh_call
