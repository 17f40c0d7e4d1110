!> Temperatures that another run has saved: of the nodes of one of its meshes, at all saved instants.
!>
!> Read from `NAME.gNN.h5` and the files of its instants beside it (instant_files), each with its hash checked. Elements are those
!> that conduct heat; places are where the mesh began.
module run_temperatures
  use errors, only: error_t, exit_input, fail
  use hash, only: sha256_length, sha256_t
  use hdf5_atomic, only: open_verified
  use hdf5_file, only: hdf5_file_t
  use instant_files, only: instant_path
  use kinds, only: wp
  use text, only: join, string_t
  implicit none
  private
  public :: run_temperatures_t, elements_of_body, read_run_temperatures, temperatures_digest

  type :: run_temperatures_t
    !> Where the mesh began (2, nnode) [length].
    real(wp), allocatable :: coordinates(:, :)
    !> Elements that conduct heat (8, nelem), and the name of the body of each (nelem).
    integer, allocatable :: connectivity(:, :)
    type(string_t), allocatable :: body(:)
    !> Instants, ascending (n) [time], and temperatures (nnode, n) [temperature].
    real(wp), allocatable :: time(:), values(:, :)
  end type run_temperatures_t

  character(len=*), parameter :: ending = '.h5'

contains

  !> Read all of it. Fails where a file is missing, damaged, or of a run without heat.
  subroutine read_run_temperatures(path, conducting, run, error)
    character(len=*), intent(in) :: path              !! NAME.gNN.h5
    type(string_t), intent(in) :: conducting(:)       !! (n) names of the elements of bodies that conduct heat
    type(run_temperatures_t), intent(out) :: run
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    type(string_t), allocatable :: names(:)
    integer :: k, n

    n = len(path) - len(ending)
    if (n < 1) then
      call fail(error, exit_input, ''''//path//''' is not the file of a mesh: expected NAME.g01.h5 in the folder of a run')
      return
    end if
    call file%open(path, error)
    if (allocated(error)) return
    call read_mesh(file, conducting, run)
    allocate (names(0))
    if (file%has('steps')) call file%list('steps', names)
    if (.not. file%failed() .and. size(names) == 0) call file%record_error(exit_input, 'holds no instant of a run')
    call file%close(error)
    if (allocated(error)) return
    allocate (run%time(size(names)), run%values(size(run%coordinates, 2), size(names)))
    do k = 1, size(names)
      call read_instant(instant_path(path(:n), names(k)%s), k, run, error)
      if (allocated(error)) return
    end do
  end subroutine read_run_temperatures

  !> Nodes, and the elements that conduct heat.
  subroutine read_mesh(file, conducting, run)
    type(hdf5_file_t), intent(inout) :: file
    type(string_t), intent(in) :: conducting(:)
    type(run_temperatures_t), intent(inout) :: run
    type(string_t), allocatable :: groups(:)
    character(len=:), allocatable :: elem
    type(string_t) :: name
    integer, allocatable :: nodes(:, :)
    integer :: k, i, body

    call file%read('mesh/coordinates', run%coordinates)
    if (.not. file%failed()) call file%require_shape('mesh/coordinates', [2, -1])
    allocate (run%connectivity(8, 0), run%body(0), groups(0))
    if (file%has('mesh/groups')) call file%list('mesh/groups', groups)
    do k = 1, size(groups)
      call file%read_attribute('mesh/groups/'//groups(k)%s, 'elem', elem)
      if (file%failed()) return
      if (.not. any([(conducting(i)%s == elem, i=1, size(conducting))])) cycle
      call file%read_attribute('mesh/groups/'//groups(k)%s, 'name', name%s)
      call file%require_shape('mesh/groups/'//groups(k)%s//'/connectivity', [8, -1])
      call file%read('mesh/groups/'//groups(k)%s//'/connectivity', nodes)
      if (file%failed()) return
      if (any(nodes < 0 .or. nodes >= size(run%coordinates, 2))) then
        call file%record_error(exit_input, 'an element has a node that is not there')
        return
      end if
      ! a further formulation is named BODY/ELEM
      body = len(name%s) - len('/'//elem)
      if (body > 0 .and. index(name%s, '/'//elem, back=.true.) == body + 1) name%s = name%s(:body)
      run%connectivity = reshape([run%connectivity, nodes + 1], [8, size(run%connectivity, 2) + size(nodes, 2)])
      run%body = [run%body, spread(name, 1, size(nodes, 2))]
    end do
    if (.not. file%failed() .and. size(run%body) == 0) &
      call file%record_error(exit_input, 'no body of this run conducts heat ('//join(conducting, ', ')//')')
  end subroutine read_mesh

  !> Time and temperatures of one instant.
  subroutine read_instant(path, k, run, error)
    character(len=*), intent(in) :: path
    integer, intent(in) :: k   !! number of the instant
    type(run_temperatures_t), intent(inout) :: run
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file
    real(wp), allocatable :: values(:)

    call open_verified(file, path, error)
    if (allocated(error)) return
    call file%read_attribute('/', 'time', run%time(k))
    call file%require_shape('node/temperature', [size(run%values, 1)])
    call file%read('node/temperature', values)
    if (.not. file%failed()) run%values(:, k) = values
    if (k > 1 .and. .not. file%failed()) then
      if (.not. run%time(k) > run%time(k - 1)) &
        call file%record_error(exit_input, 'its time is not after that of the instant before')
    end if
    call file%close(error)
  end subroutine read_instant

  !> Numbers of the elements of the body of this name, or of all elements where the run has no such body.
  pure subroutine elements_of_body(run, body, elements)
    type(run_temperatures_t), intent(in) :: run
    character(len=*), intent(in) :: body
    integer, allocatable, intent(out) :: elements(:)   !! (n)
    logical :: own(size(run%body))
    integer :: e

    own = .false.
    do e = 1, size(run%body)
      own(e) = run%body(e)%s == body
    end do
    if (.not. any(own)) own = .true.
    elements = pack([(e, e=1, size(own))], own)
  end subroutine elements_of_body

  !> SHA-256 of places, instants and temperatures.
  subroutine temperatures_digest(run, digest)
    type(run_temperatures_t), intent(in) :: run
    character(len=sha256_length), intent(out) :: digest
    type(sha256_t) :: hash
    character(len=8) :: bytes
    integer :: i, k

    do i = 1, size(run%coordinates, 2)
      do k = 1, 2
        call hash%add(transfer(run%coordinates(k, i), bytes))
      end do
    end do
    do k = 1, size(run%time)
      call hash%add(transfer(run%time(k), bytes))
      do i = 1, size(run%values, 1)
        call hash%add(transfer(run%values(i, k), bytes))
      end do
    end do
    digest = hash%digest()
  end subroutine temperatures_digest

end module run_temperatures
