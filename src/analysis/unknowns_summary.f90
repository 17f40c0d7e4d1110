!> What a scene costs, for --check: unknowns, fill, memory, expected seconds per iteration.
module unknowns_summary
  use equation_set_up, only: set_up
  use equations, only: equations_t
  use errors, only: error_t
  use kinds, only: wp
  use memory_limits, only: megabytes, memory_left
  use scene, only: is_solid, scene_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: unknowns_lines

  !> Measured on one core of a 2020s server, Release: seconds per element for forces, matrices and
  !> their gathering (tests/bench); floating-point operations per second in the factorisation.
  real(wp), parameter :: seconds_per_element = 4.0e-6_wp
  real(wp), parameter :: flops_per_second = 1.0e10_wp

contains

  subroutine unknowns_lines(scene, lines, error)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(out) :: lines(:)   !! (nline)
    type(error_t), allocatable, intent(out) :: error
    type(equations_t) :: equations
    real(wp) :: bytes, seconds, entries, operations, left, addresses
    character(len=:), allocatable :: by_what
    integer :: g, s, nelem, nonzeros

    allocate (lines(0))
    call set_up(scene, equations, error)
    if (allocated(error)) return
    nelem = 0
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) nelem = nelem + size(scene%groups(g)%connectivity, 2)
    end do
    bytes = 8.0_wp*real(equations%solves(1)%pattern%matrix_length, wp)
    entries = 0
    operations = 0
    nonzeros = 0
    do s = 1, size(equations%solves)
      associate (solve => equations%solves(s))
        bytes = bytes + 8.0_wp*solve%pattern%nnz + 4.0_wp*(size(solve%pattern%entry) + 3.0_wp*solve%pattern%nnz) &
                + 8.0_wp*solve%solver%estimated_entries
        entries = entries + solve%solver%estimated_entries
        operations = operations + solve%solver%estimated_flops
        nonzeros = nonzeros + solve%pattern%nnz
      end associate
    end do
    seconds = seconds_per_element*nelem + operations/flops_per_second
    call memory_left(left, addresses, by_what)
    deallocate (lines)
    allocate (lines(5))
    lines(1)%s = ''
    lines(2)%s = 'Unknowns: '//to_text(equations%dofs%ndof)//', of them '//to_text(sum(equations%solves%neq)) &
                 //' free; matrix '//trim(merge('symmetric  ', 'unsymmetric', all(equations%solves%pattern%symmetric)))//', ' &
                 //to_text(nonzeros)//' nonzeros'
    lines(3)%s = 'Factors: '//to_text(entries, 3)//' entries, ' &
                 //to_text(operations, 3)//' operations; memory about '//to_text(bytes/2.0_wp**20, 3)//' MB'
    lines(4)%s = 'Memory left: '//megabytes(left)//' '//by_what//trim(merge(', too little', '            ', bytes > left))
    lines(5)%s = 'Expected: about '//to_text(seconds, 2)//' s per iteration on one core'
    if (equations%patch_size > 0) lines(5)%s = lines(5)%s//'; patches of at most '//to_text(equations%patch_size)// &
                                               ' elements (NORMS PATCH)'
  end subroutine unknowns_lines

end module unknowns_summary
