!> What must hold of numbers in a checkpoint before they are used: each rule names the dataset, what it holds, and what is wanted.
!>
!> A file records its first error and does nothing after it; a rule may so be asked of what was not read any more.
module exchange_rules
  use errors, only: exit_input
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: read_count, read_flag, read_list, read_matrix, read_numbers, require, require_range

  !> `require_range(file, place, values, low, high)`: all values are from `low` to `high`.
  interface require_range
    module procedure :: require_integer
    module procedure :: require_integers
    module procedure :: require_table
    module procedure :: require_real
    module procedure :: require_reals
  end interface require_range

contains

  !> Something must hold; `wanted` is put behind the name of the dataset.
  subroutine require(file, place, holds, wanted)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place   !! path of the dataset
    logical, intent(in) :: holds
    character(len=*), intent(in) :: wanted

    if (.not. holds) call file%record_error(exit_input, "dataset '"//place//"' "//wanted)
  end subroutine require

  subroutine require_integer(file, place, value, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: value, low, high

    call require_integers(file, place, [value], low, high)
  end subroutine require_integer

  subroutine require_integers(file, place, values, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: values(:)   !! (n)
    integer, intent(in) :: low, high
    integer :: k

    do k = 1, size(values)
      if (values(k) >= low .and. values(k) <= high) cycle
      if (high < huge(high)) then
        call require(file, place, .false., 'holds '//to_text(values(k))//', where '//to_text(low)//' to '//to_text(high)// &
                     ' is wanted')
      else
        call require(file, place, .false., 'holds '//to_text(values(k))//', where '//to_text(low)//' or more is wanted')
      end if
      return
    end do
  end subroutine require_integers

  subroutine require_table(file, place, values, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: values(:, :)   !! (nrow, ncolumn)
    integer, intent(in) :: low, high
    integer :: k

    do k = 1, size(values, 2)
      call require_integers(file, place, values(:, k), low, high)
    end do
  end subroutine require_table

  subroutine require_real(file, place, value, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(in) :: value, low, high

    call require_reals(file, place, [value], low, high)
  end subroutine require_real

  subroutine require_reals(file, place, values, low, high)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(in) :: values(:)   !! (n) [of any unit]
    real(wp), intent(in) :: low, high
    integer :: k

    do k = 1, size(values)
      if (values(k) >= low .and. values(k) <= high) cycle
      if (high < huge(high)) then
        call require(file, place, .false., 'holds '//to_text(values(k))//', where '//to_text(low)//' to '//to_text(high)// &
                     ' is wanted')
      else
        call require(file, place, .false., 'holds '//to_text(values(k))//', where '//to_text(low)//' or more is wanted')
      end if
      return
    end do
  end subroutine require_reals

  !> A number of things, not negative; 0 where it cannot be read.
  subroutine read_count(file, place, count, most)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(out) :: count
    integer, intent(in), optional :: most

    call file%read(place, count)
    if (present(most)) then
      call require_range(file, place, count, 0, most)
    else
      call require_range(file, place, count, 0, huge(count))
    end if
    if (file%failed()) count = 0
  end subroutine read_count

  !> Yes (1) or no (0).
  subroutine read_flag(file, place, flag)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    logical, intent(out) :: flag
    integer :: value

    call read_count(file, place, value, 1)
    flag = value == 1
  end subroutine read_flag

  !> A list of reals of known length; zeros where it cannot be read.
  subroutine read_list(file, place, list)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(out) :: list(:)   !! (n) [of any unit]
    real(wp), allocatable :: values(:)

    list = 0
    call file%require_shape(place, shape(list))
    call file%read(place, values)
    if (.not. file%failed()) list = values
  end subroutine read_list

  !> An array that replaces one of the same extents.
  subroutine read_matrix(file, place, matrix)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    real(wp), intent(inout) :: matrix(:, :)   !! (nrow, ncolumn) [of any unit]
    real(wp), allocatable :: values(:, :)

    call file%require_shape(place, shape(matrix))
    call file%read(place, values)
    if (.not. file%failed()) matrix = values
  end subroutine read_matrix

  !> A list of integers of known length; zeros where it cannot be read.
  subroutine read_numbers(file, place, list)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(out) :: list(:)   !! (n)
    integer, allocatable :: values(:)

    list = 0
    call file%require_shape(place, shape(list))
    call file%read(place, values)
    if (.not. file%failed()) list = values
  end subroutine read_numbers

end module exchange_rules
