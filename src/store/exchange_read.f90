!> Reading the state of a checkpoint: from a file that `open_checkpoint` has found whole, once for all that is read from it.
module exchange_read
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use acceptance, only: probation_t
  use contact_ends, only: contact_end_t
  use errors, only: error_t, exit_input
  use exchange_schema, only: group_place, read_matrix, read_triple, refuse_not_finite
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use pairs, only: pairs_t
  use remeshing, only: estimate_t
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: read_contact_ends, read_deck_of_checkpoint, read_state

contains

  !> The deck a checkpoint was made from.
  subroutine read_deck_of_checkpoint(file, deck_path, deck_text, error)
    type(hdf5_file_t), intent(inout) :: file
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(error_t), allocatable, intent(out) :: error

    call file%read('deck/path', deck_path)
    call file%read('deck/text', deck_text)
    call file%status(error)
  end subroutine read_deck_of_checkpoint

  !> Take up the state of a checkpoint in a scene read from the same deck.
  subroutine read_state(file, scene, solution, error)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! started from the scene
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: worst(:), friction(:)
    real(wp) :: spurious(3)
    integer :: unbalanced

    call file%read('progress/time', solution%time)
    call file%read('progress/step', solution%step)
    unbalanced = 0
    call file%read('progress/unbalanced', unbalanced)
    solution%unbalanced = unbalanced == 1
    call file%read('progress/last_step', solution%last_step)
    call file%read('progress/next_step', solution%next_step)
    call read_probation(file, solution%probation)
    call file%read('progress/iterations', solution%iterations)
    call file%read('progress/cutbacks', solution%cutbacks)
    call file%read('progress/external_work', solution%external_work)
    call file%read('progress/friction_work', friction)
    if (size(friction) == 2) then
      solution%friction_work = friction(1)
      solution%friction_apart = friction(2)
    end if
    call file%read('progress/initial_volume', solution%initial_volume)
    call file%read('progress/force_floor', solution%force_floor)
    call file%read('progress/worst', worst)
    if (size(worst) == 6) then
      solution%worst_linear_residual = worst(1)
      solution%worst_penetration = worst(2)
      solution%worst_penetration_ratio = worst(3)
      solution%least_dissipation = worst(4)
      solution%worst_sample = worst(5)
      solution%worst_sample_ratio = worst(6)
    end if
    call read_matrix(file, 'nodes/displacement', solution%displacement)
    call read_matrix(file, 'nodes/last_increment', solution%last_increment)
    call read_matrix(file, 'nodes/applied', solution%applied)
    spurious = 0
    call read_triple(file, 'progress/spurious_mode', spurious)
    solution%worst_spurious = spurious(1)
    solution%spurious_group = nint(spurious(2))
    solution%spurious_element = nint(spurious(3))
    call read_triple(file, 'section/position', solution%section)
    call read_triple(file, 'section/last_increment', solution%last_section_increment)
    call read_triple(file, 'section/applied', solution%section_applied)
    call refuse_not_finite(file, 'progress', all(ieee_is_finite([solution%time, solution%last_step, solution%next_step, &
                                                      solution%external_work, solution%initial_volume])))
    call read_dies(file, scene, solution)
    call read_states(file, scene, solution)
    if (scene%remesh%estimate) call read_estimate(file, scene, solution%estimate)
    call file%status(error)
  end subroutine read_state

  subroutine read_probation(file, probation)
    type(hdf5_file_t), intent(inout) :: file
    type(probation_t), intent(inout) :: probation
    real(wp), allocatable :: recent(:), steps(:)

    call file%read('progress/recent_steps', recent)
    call file%read('progress/probation', probation%left)
    call file%read('progress/probation_steps', steps)
    if (size(recent) /= size(probation%recent) .or. size(steps) /= 2) return
    probation%recent = recent
    probation%before = steps(1)
    probation%least = steps(2)
    call refuse_not_finite(file, 'progress/recent_steps', all(ieee_is_finite([recent, steps])))
  end subroutine read_probation

  subroutine read_dies(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    integer :: k

    do k = 1, size(scene%dies)
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/pilot', solution%pilots(:, k))
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/last_increment', solution%last_pilot_increment(:, k))
      call read_triple(file, 'dies/'//scene%dies(k)%name//'/applied', solution%pilot_applied(:, k))
    end do
  end subroutine read_dies

  subroutine read_states(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: state(:, :, :)
    integer :: g

    do g = 1, size(scene%groups)
      if (size(scene%groups(g)%variables) == 0) cycle
      if (scene%groups(g)%pairs > 0) call read_pairs(file, group_place(g)//'/pairs', solution%pairs(scene%groups(g)%pairs))
      call file%read(group_place(g)//'/state', state)
      if (all(shape(state) == shape(solution%groups(g)%committed))) then
        solution%groups(g)%committed = state
        solution%groups(g)%trial = state
        call refuse_not_finite(file, group_place(g)//'/state', all(ieee_is_finite(state)))
      else
        call file%record_error(exit_input, group_place(g)//'/state: does not fit the deck''s group '//scene%groups(g)%name)
      end if
    end do
  end subroutine read_states

  !> Errors so far. What made the run stop is of the past: it has gone on.
  subroutine read_estimate(file, scene, estimate)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(estimate_t), intent(inout) :: estimate
    real(wp), allocatable :: stress(:), strain(:), sums(:, :)
    integer :: g, n, last

    call file%read('estimate/stress', estimate%stress)
    call file%read('estimate/strain', estimate%strain)
    call file%read('remesh/last_stop', estimate%last_stop)
    call file%read('remesh/first_stress', estimate%first_stress)
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      n = last + 1
      last = last + size(scene%groups(g)%connectivity, 2)
      call file%read(group_place(g)//'/error_stress', stress)
      call file%read(group_place(g)//'/error_strain', strain)
      call file%read(group_place(g)//'/strain_sums', sums)
      if (size(stress) == last - n + 1 .and. size(strain) == last - n + 1 .and. size(sums) == 2*(last - n + 1)) then
        estimate%stress_of(n:last) = stress
        estimate%strain_of(n:last) = strain
        estimate%strain_sums(:, n:last) = sums
      else
        call file%record_error(exit_input, group_place(g)//'/strain_sums: does not fit the deck''s group '//scene%groups(g)%name)
      end if
    end do
  end subroutine read_estimate

  !> Pairs decide the order in which the matrix is eliminated: a run that goes on needs them, to the last bit.
  subroutine read_pairs(file, place, pairs)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(pairs_t), intent(inout) :: pairs
    integer, allocatable :: piece(:, :)

    call file%read(place, piece)
    if (all(shape(piece) == shape(pairs%piece))) then
      pairs%piece = piece
    else
      call file%record_error(exit_input, place//': does not fit the deck''s contact')
    end if
  end subroutine read_pairs

  !> Where contact begins and ends at the instant of a checkpoint.
  subroutine read_contact_ends(file, ends, error)
    type(hdf5_file_t), intent(inout) :: file
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: begins(:), group(:), side(:), piece(:)
    real(wp), allocatable :: place(:), xi(:)
    integer :: n

    allocate (ends(0))
    call file%read('contact_ends/begins', begins)
    call file%read('contact_ends/group', group)
    call file%read('contact_ends/side', side)
    call file%read('contact_ends/place', place)
    call file%read('contact_ends/die_piece', piece)
    call file%read('contact_ends/die_xi', xi)
    n = size(begins)
    if (any([size(group), size(side), size(place), size(piece), size(xi)] /= n)) &
      call file%record_error(exit_input, 'contact_ends: lists of unlike lengths')
    call file%status(error)
    if (allocated(error)) return
    deallocate (ends)
    allocate (ends(n))
    ends%begins = begins == 1
    ends%group = group
    ends%side = side
    ends%place = place
    ends%piece = piece
    ends%xi = xi
  end subroutine read_contact_ends

end module exchange_read
