!> The hash of a whole file, checked before HDF5 reads it.
!>
!> HDF5 leaves the first 512 bytes of a file to its user ("user block"): HDF5 itself, h5py and ParaView skip them. Here they hold
!> three lines, the rest null bytes: what the file is, its length, and SHA-256 of all bytes that follow the block. Every bit of the
!> file is covered, those of the block too, since all of it follows from length and hash.
submodule(hdf5_file) hdf5_file_hash
  use errors, only: exit_input, exit_machine
  use file_kinds, only: file_kind, kind_in_words, nothing, regular_file
  use hash, only: sha256_length, sha256_t
  use kinds, only: i8
  use text, only: to_text
  implicit none

  character(len=*), parameter :: first_line = 'LAGAMINE file with its hash'//achar(10)
  !> Bytes read at a time.
  integer, parameter :: piece_length = 1048576

contains

  module procedure write_hash
    character(len=sha256_length) :: digest
    character(len=200) :: why
    integer(i8) :: length
    integer :: unit, status

    if (self%failed()) return
    open (newunit=unit, file=self%file_path, status='old', action='readwrite', access='stream', form='unformatted', &
      iostat=status, iomsg=why)
    if (status == 0) then
      call take_hash(unit, digest, length, status, why)
      if (status == 0) write (unit, pos=1, iostat=status, iomsg=why) block_of(length, digest)
      if (status == 0) flush (unit, iostat=status, iomsg=why)
      close (unit)
    end if
    if (status /= 0) call self%record_error(exit_machine, 'its hash cannot be written: '//trim(why))
  end procedure write_hash

  module procedure check_hash
    character(len=user_block_length) :: block
    character(len=sha256_length) :: digest
    character(len=200) :: why
    integer(i8) :: length
    integer :: unit, status, kind

    kind = file_kind(self%file_path)
    if (kind == nothing) then
      call self%record_error(exit_input, 'no such file')
    else if (kind /= regular_file) then
      call self%record_error(exit_input, kind_in_words(kind)//', where a file is wanted')
    end if
    if (self%failed()) return
    open (newunit=unit, file=self%file_path, status='old', action='read', access='stream', form='unformatted', iostat=status, &
      iomsg=why)
    if (status /= 0) then
      call self%record_error(exit_input, trim(why))
      return
    end if
    inquire (unit=unit, size=length)
    read (unit, iostat=status) block
    if (status /= 0 .or. index(block, first_line) /= 1) then
      call self%record_error(exit_input, 'not a file of this program: it does not begin with a length and a hash')
    else if (index(block, length_line(length)) == 0) then
      call self%record_error(exit_input, 'cut short or damaged: '//to_text(length)//' bytes are not what its beginning states')
    else if (.not. length_alone) then
      call take_hash(unit, digest, length, status, why)
      if (status /= 0) then
        call self%record_error(exit_input, 'cannot be read: '//trim(why))
      else if (block /= block_of(length, digest)) then
        call self%record_error(exit_input, 'altered or damaged: its contents do not agree with its hash')
      end if
    end if
    close (unit)
  end procedure check_hash

  !> SHA-256 of what follows the user block of an open file.
  subroutine take_hash(unit, digest, length, status, why)
    integer, intent(in) :: unit
    character(len=sha256_length), intent(out) :: digest
    integer(i8), intent(out) :: length                 !! of the whole file [byte]
    integer, intent(out) :: status                     !! 0: all was read
    character(len=200), intent(inout) :: why           !! it was not
    character(len=:), allocatable :: piece
    type(sha256_t) :: hash
    integer(i8) :: place

    allocate (character(len=piece_length) :: piece)
    inquire (unit=unit, size=length)
    status = 0
    do place = user_block_length + 1, length, piece_length
      associate (n => min(int(piece_length, i8), length - place + 1))
        read (unit, pos=place, iostat=status, iomsg=why) piece(:n)
        if (status /= 0) exit
        call hash%add(piece(:n))
      end associate
    end do
    digest = hash%digest()
  end subroutine take_hash

  !> The user block of a file of this length and hash.
  pure function block_of(length, digest) result(block)
    integer(i8), intent(in) :: length
    character(len=*), intent(in) :: digest
    character(len=user_block_length) :: block

    block = first_line//length_line(length)//'sha256 '//digest//achar(10)
    block(len_trim(block) + 1:) = repeat(achar(0), user_block_length)
  end function block_of

  pure function length_line(length) result(line)
    integer(i8), intent(in) :: length
    character(len=:), allocatable :: line

    line = 'length '//to_text(length)//achar(10)
  end function length_line

end submodule hdf5_file_hash
