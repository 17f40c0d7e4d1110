!> Text as HDF5 keeps it here: single characters, each word filled up with nulls to one width.
module hdf5_text
  use hdf5, only: h5t_c_s1, h5t_cset_utf8_f, h5t_str_nullpad_f, h5tcopy_f, h5tset_cset_f, h5tset_size_f, h5tset_strpad_f, hid_t, &
    size_t
  use text, only: string_t
  implicit none
  private
  public :: make_text_type, letters_of, get_words

  character(len=1), parameter :: null = achar(0)

contains

  !> The type of texts of `width` bytes in a file and in memory; the caller closes it.
  subroutine make_text_type(width, type)
    integer, intent(in) :: width
    integer(hid_t), intent(out) :: type
    integer :: flag

    ! A call that fails leaves a handle that HDF5 refuses later: it is detected there.
    call h5tcopy_f(h5t_c_s1, type, flag)
    call h5tset_size_f(type, int(width, size_t), flag)
    call h5tset_strpad_f(type, h5t_str_nullpad_f, flag)
    call h5tset_cset_f(type, h5t_cset_utf8_f, flag)
  end subroutine make_text_type

  !> All words in a row, each as wide as the longest (at least 1: HDF5 has no text of width 0).
  pure subroutine letters_of(words, letters)
    type(string_t), intent(in) :: words(:)                     !! (n)
    character(len=1), allocatable, intent(out) :: letters(:)   !! (n*width)
    integer :: width, i, j

    width = 1
    do i = 1, size(words)
      if (allocated(words(i)%s)) width = max(width, len(words(i)%s))
    end do
    allocate (letters(width*max(size(words), 1)), source=null)
    do i = 1, size(words)
      if (.not. allocated(words(i)%s)) cycle
      do j = 1, len(words(i)%s)
        letters((i - 1)*width + j) = words(i)%s(j:j)
      end do
    end do
  end subroutine letters_of

  !> The words in `letters`, without the nulls behind them; `words` has the right size already.
  pure subroutine get_words(letters, words)
    character(len=1), intent(in) :: letters(:)   !! (n*width)
    type(string_t), intent(inout) :: words(:)    !! (n)
    integer :: width, length, i, j

    width = size(letters)/max(size(words), 1)
    do i = 1, size(words)
      associate (word => letters((i - 1)*width + 1:i*width))
        length = width
        do while (length > 0)
          if (word(length) /= null) exit
          length = length - 1
        end do
        words(i)%s = repeat(' ', length)
        do j = 1, length
          words(i)%s(j:j) = word(j)
        end do
      end associate
    end do
  end subroutine get_words

end module hdf5_text
