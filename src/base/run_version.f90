!> The version all programs carry, and what they are made of.
module run_version
  use, intrinsic :: iso_fortran_env, only: compiler_version
  use errors, only: error_t
  use standard_streams, only: print_line
  use text, only: to_text
  implicit none
  private
  public :: version_text, blas_library, print_version, blas_words

  include 'built_with.inc'

contains

  !> What --version prints: versions of the libraries that were built with, the BLAS and the threads as they are now.
  subroutine print_version(program_name, blas, threads, error)
    character(len=*), intent(in) :: program_name
    character(len=*), intent(in) :: blas       !! as `blas_words` has it
    integer, intent(in) :: threads             !! the most a run has
    type(error_t), allocatable, intent(inout) :: error

    call print_line(program_name//' '//version_text, error)
    call print_line('compiler: '//compiler_version(), error)
    call print_line('MUMPS: '//or_unknown(mumps_version), error)
    call print_line('METIS: '//or_unknown(metis_version), error)
    call print_line('HDF5: '//or_unknown(hdf5_version), error)
    call print_line('BLAS: '//blas, error)
    call print_line('threads: '//to_text(threads), error)
    call print_line('Gmsh: '//or_unknown(gmsh_version), error)
  end subroutine print_version

  !> Name and version of the BLAS, without the options of its build, and the core whose kernels it uses.
  pure function blas_words(build, core) result(words)
    character(len=*), intent(in) :: build, core
    character(len=:), allocatable :: words
    integer :: blank

    words = 'unknown'
    if (build == '') return
    blank = index(build, ' ')
    if (blank > 0) blank = blank + index(build(blank + 1:)//' ', ' ')
    if (blank == 0) blank = len(build) + 1
    words = trim(build(:blank - 1))//', core '//or_unknown(core)
  end function blas_words

  pure function or_unknown(word) result(words)
    character(len=*), intent(in) :: word
    character(len=:), allocatable :: words

    words = word
    if (words == '') words = 'unknown'
  end function or_unknown

end module run_version
