!> What a run has cost so far, in `NAME.cost`: added up over all calls of the programs that it takes (operations, new meshes,
!> after a stop), so that a cycle knows its whole cost. Of runs of decks with ACCURACY or REMSH.
module cost_file
  use accuracy_rules, only: fineness_t
  use atomic, only: read_text, write_text
  use errors, only: error_t
  use exact_numbers, only: exact_text
  use kinds, only: wp
  use system, only: file_exists
  use text, only: to_text
  implicit none
  private
  public :: cost_t
  public :: add_remesher, ntask, read_cost, remesher_task, write_cost

  !> Tasks: elements, contact, factorisation, the rest of the solver, the remesher.
  integer, parameter :: ntask = 5, remesher_task = 5
  character(len=*), parameter :: nl = new_line('a')

  type :: cost_t
    !> Program and deck: a cost of others says nothing. One line.
    character(len=:), allocatable :: key
    type(fineness_t) :: fineness
    !> The scene has come to its end.
    logical :: finished = .false.
    integer :: elements = 0, steps = 0, iterations = 0
    !> Seconds of processor by tasks [s].
    real(wp) :: seconds(ntask) = 0.0_wp
    !> Estimated error of the stress at the end [-]; below 0 where there is none.
    real(wp) :: stress = -1.0_wp
  end type cost_t

contains

  !> The file of a run whose files begin with `stem`.
  pure function cost_path(stem) result(path)
    character(len=*), intent(in) :: stem
    character(len=:), allocatable :: path

    path = stem//'.cost'
  end function cost_path

  subroutine write_cost(stem, cost, error)
    character(len=*), intent(in) :: stem
    type(cost_t), intent(in) :: cost
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: seconds
    integer :: t

    seconds = ''
    do t = 1, ntask
      seconds = seconds//exact_text(cost%seconds(t))//' '
    end do
    call write_text(cost_path(stem), cost%key//nl &
                    //exact_text(cost%fineness%mesh)//' '//exact_text(cost%fineness%steps)//' '//exact_text(cost%fineness%depth) &
                    //nl &
                    //to_text(merge(1, 0, cost%finished))//' '//to_text(cost%elements)//' '//to_text(cost%steps)//' ' &
                    //to_text(cost%iterations)//nl//seconds//nl//exact_text(cost%stress)//nl, error)
  end subroutine write_cost

  !> `there` is false where the file is missing, damaged, or of another key.
  subroutine read_cost(stem, key, cost, there)
    character(len=*), intent(in) :: stem, key
    type(cost_t), intent(out) :: cost
    logical, intent(out) :: there

    call read_any(stem, cost, there)
    if (there) there = cost%key == key
  end subroutine read_cost

  !> Add what the remesher has taken; nothing where the run has no such file.
  subroutine add_remesher(stem, seconds, error)
    character(len=*), intent(in) :: stem
    real(wp), intent(in) :: seconds   !! [s]
    type(error_t), allocatable, intent(out) :: error
    type(cost_t) :: cost
    logical :: there

    call read_any(stem, cost, there)
    if (.not. there) return
    cost%seconds(remesher_task) = cost%seconds(remesher_task) + seconds
    call write_cost(stem, cost, error)
  end subroutine add_remesher

  subroutine read_any(stem, cost, there)
    character(len=*), intent(in) :: stem
    type(cost_t), intent(out) :: cost
    logical, intent(out) :: there
    character(len=:), allocatable :: text
    type(error_t), allocatable :: error
    integer :: first, next, finished, status

    there = file_exists(cost_path(stem))
    if (.not. there) return
    call read_text(cost_path(stem), text, error)
    there = .not. allocated(error)
    if (.not. there) return
    first = index(text, nl)
    there = first > 1
    if (.not. there) return
    cost%key = text(:first - 1)
    ! list-directed reading of an internal file sees one record
    do
      next = index(text(first:), nl)
      if (next == 0) exit
      text(first + next - 1:first + next - 1) = ' '
    end do
    read (text(first:), *, iostat=status) cost%fineness%mesh, cost%fineness%steps, cost%fineness%depth, finished, &
      cost%elements, cost%steps, cost%iterations, cost%seconds, cost%stress
    there = status == 0
    cost%finished = there .and. finished == 1
  end subroutine read_any

end module cost_file
