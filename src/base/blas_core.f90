!> Which kernels OpenBLAS should take on this processor.
!>
!> OpenBLAS knows processors by their family and model; on one younger than itself it falls back to its oldest kernels, whatever
!> the processor can do. Then a core is chosen by the instruction sets. A core that OpenBLAS has picked for processors with AVX2,
!> and one that is not known here, stays.
module blas_core
  use text, only: string_t
  implicit none
  private
  public :: core_to_ask_for, core_of_flags

  !> Cores of processors without AVX, and of those with AVX and without AVX2, as OpenBLAS names them.
  character(len=12), parameter :: cores_sse(20) = [character(len=12) :: 'Katmai', 'Coppermine', 'Northwood', 'Prescott', &
                                                   'Banias', 'Atom', 'Core2', 'Penryn', 'Dunnington', 'Nehalem', 'Athlon', &
                                                   'Opteron', 'Opteron_SSE3', 'Barcelona', 'Bobcat', 'Nano', 'Vortex', &
                                                   'Generic', 'generic', 'Unknown']
  character(len=12), parameter :: cores_avx(4) = [character(len=12) :: 'Sandybridge', 'Bulldozer', 'Piledriver', 'Steamroller']

  !> Cores to ask for, the best first, and what the processor must have for each (flags of /proc/cpuinfo).
  character(len=*), parameter :: candidates(3) = [character(len=12) :: 'SkylakeX', 'Haswell', 'Sandybridge']
  character(len=*), parameter :: needs(3) = [character(len=48) :: 'avx512f avx512cd avx512bw avx512dq avx512vl', 'avx2 fma', 'avx']

contains

  !> The core to ask OpenBLAS for in place of the present one; '' where that one is as good. A library built without the core
  !> that was asked for takes its oldest again: then the next one is tried.
  pure function core_to_ask_for(present_core, asked, flags) result(core)
    character(len=*), intent(in) :: present_core   !! picked by OpenBLAS
    character(len=*), intent(in) :: asked          !! asked for before this, '' = none
    character(len=*), intent(in) :: flags          !! of the processor, separated by blanks
    character(len=:), allocatable :: core
    type(string_t), allocatable :: better(:)
    integer :: k

    core = ''
    if (.not. (any(present_core == cores_sse) .or. any(present_core == cores_avx))) return
    call core_of_flags(flags, better)
    do k = size(better), 1, -1
      if (better(k)%s == asked) exit
      if (better(k)%s == 'Sandybridge' .and. any(present_core == cores_avx)) cycle
      core = better(k)%s
    end do
  end function core_to_ask_for

  !> Cores that a processor with these flags can run, the best first.
  pure subroutine core_of_flags(flags, cores)
    character(len=*), intent(in) :: flags
    type(string_t), allocatable, intent(out) :: cores(:)   !! (ncore)
    integer :: k

    allocate (cores(0))
    do k = 1, size(candidates)
      if (has_all(flags, needs(k))) cores = [cores, string_t(trim(candidates(k)))]
    end do
  end subroutine core_of_flags

  !> Are all words of `wanted` among the flags?
  pure function has_all(flags, wanted) result(all_there)
    character(len=*), intent(in) :: flags, wanted
    logical :: all_there
    integer :: first, length

    all_there = .true.
    first = 1
    do while (first <= len_trim(wanted) .and. all_there)
      length = index(wanted(first:)//' ', ' ') - 1
      all_there = index(' '//flags//' ', ' '//wanted(first:first + length - 1)//' ') > 0
      first = first + length + 1
    end do
  end function has_all

end module blas_core
