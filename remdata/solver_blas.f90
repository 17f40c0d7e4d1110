!> The BLAS of the solver, as --version shows it. REMDATA calls none and is not linked with it, so that it is not loaded at every
!> start: it is loaded here for this question alone.
module solver_blas
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_procpointer, c_funptr, c_int, c_null_char, c_ptr
  use run_version, only: blas_library
  use system, only: text_of_c
  implicit none
  private
  public :: ask_blas

  integer(c_int), parameter :: when_needed = 1   !! RTLD_LAZY

  abstract interface
    function answer_i() bind(c) result(address)
      import :: c_ptr
      type(c_ptr) :: address
    end function answer_i
  end interface

  interface
    function c_dlopen(file, mode) bind(c, name='dlopen') result(handle)
      import :: c_char, c_int, c_ptr
      character(kind=c_char), intent(in) :: file(*)
      integer(c_int), value :: mode
      type(c_ptr) :: handle
    end function c_dlopen

    function c_dlsym(handle, name) bind(c, name='dlsym') result(address)
      import :: c_char, c_funptr, c_ptr
      type(c_ptr), value :: handle
      character(kind=c_char), intent(in) :: name(*)
      type(c_funptr) :: address
    end function c_dlsym
  end interface

contains

  !> Name, version and options of its build, and the core whose kernels it takes; '' where it cannot be loaded.
  subroutine ask_blas(build, core)
    character(len=:), allocatable, intent(out) :: build, core
    type(c_ptr) :: handle

    build = ''
    core = ''
    handle = c_dlopen(blas_library//c_null_char, when_needed)
    if (.not. c_associated(handle)) return
    build = answer(handle, 'openblas_get_config')
    core = answer(handle, 'openblas_get_corename')
  end subroutine ask_blas

  function answer(handle, name) result(words)
    type(c_ptr), intent(in) :: handle
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: words
    procedure(answer_i), pointer :: ask
    type(c_funptr) :: address

    words = ''
    address = c_dlsym(handle, name//c_null_char)
    if (.not. c_associated(address)) return
    call c_f_procpointer(address, ask)
    words = text_of_c(ask())
  end function answer

end module solver_blas
