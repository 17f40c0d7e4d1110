!> Reading the state of a checkpoint: from a file that `open_checkpoint` has found whole, once for all that is read from it.
module exchange_read
  use acceptance, only: probation_steps
  use contact_ends, only: contact_end_t
  use errors, only: error_t
  use exchange_fields, only: read_field_values
  use exchange_parts, only: check_shapes
  use exchange_rules, only: read_count, read_flag, read_list, read_matrix, require, require_range
  use exchange_schema, only: group_place
  use hash, only: sha256
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use pairs, only: pairs_t
  use remeshing, only: estimate_t
  use scene, only: group_t, is_solid, scene_t
  use solution, only: solution_t
  use text, only: to_text
  implicit none
  private
  public :: read_contact_ends, read_deck_of_checkpoint, read_state

  !> Places on sides and pieces are from -1 to 1, and some round-off.
  real(wp), parameter :: on_side = 1.0_wp + 1.0e-6_wp

contains

  !> The deck a checkpoint was made from.
  subroutine read_deck_of_checkpoint(file, deck_path, deck_text, error)
    type(hdf5_file_t), intent(inout) :: file
    character(len=:), allocatable, intent(out) :: deck_path, deck_text
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: fingerprint

    call file%read('deck/path', deck_path)
    call file%read('deck/text', deck_text)
    call file%read('deck/sha256', fingerprint)
    call require(file, 'deck/sha256', fingerprint == sha256(deck_text), 'is not that of deck/text')
    call file%status(error)
  end subroutine read_deck_of_checkpoint

  !> Take up the state of a checkpoint in a scene read from the same deck.
  subroutine read_state(file, scene, solution, error)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution   !! started from the scene
    type(error_t), allocatable, intent(out) :: error

    call read_progress(file, solution)
    call read_field_values(file, solution%fields)
    call read_spurious_mode(file, scene, solution)
    call read_states(file, scene, solution)
    call read_estimate(file, scene, solution%estimate)
    if (.not. file%failed()) call check_shapes(file, scene, solution)
    call file%status(error)
  end subroutine read_state

  !> Where the run stands, and what it has cost and borne.
  subroutine read_progress(file, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(solution_t), intent(inout) :: solution
    real(wp) :: friction(2), worst(6), steps(2)

    call file%read('progress/time', solution%time)
    call require_range(file, 'progress/time', solution%time, 0.0_wp, huge(1.0_wp))
    call read_count(file, 'progress/step', solution%step)
    call read_flag(file, 'progress/unbalanced', solution%unbalanced)
    call file%read('progress/last_step', solution%last_step)
    call require_range(file, 'progress/last_step', solution%last_step, 0.0_wp, huge(1.0_wp))
    call file%read('progress/next_step', solution%next_step)
    call require_range(file, 'progress/next_step', solution%next_step, 0.0_wp, huge(1.0_wp))
    call read_list(file, 'progress/recent_steps', solution%probation%recent)
    call require_range(file, 'progress/recent_steps', solution%probation%recent, 0.0_wp, huge(1.0_wp))
    call read_count(file, 'progress/probation', solution%probation%left, probation_steps)
    call read_list(file, 'progress/probation_steps', steps)
    call require_range(file, 'progress/probation_steps', steps, 0.0_wp, huge(1.0_wp))
    solution%probation%before = steps(1)
    solution%probation%least = steps(2)
    call read_count(file, 'progress/iterations', solution%iterations)
    call read_count(file, 'progress/cutbacks', solution%cutbacks)
    call file%read('progress/external_work', solution%external_work)
    call read_list(file, 'progress/friction_work', friction)
    solution%friction_work = friction(1)
    solution%friction_apart = friction(2)
    call file%read('progress/initial_volume', solution%initial_volume)
    call require_range(file, 'progress/initial_volume', solution%initial_volume, 0.0_wp, huge(1.0_wp))
    call read_list(file, 'progress/worst', worst)
    solution%worst_linear_residual = worst(1)
    solution%worst_penetration = worst(2)
    solution%worst_penetration_ratio = worst(3)
    solution%least_dissipation = worst(4)
    solution%worst_sample = worst(5)
    solution%worst_sample_ratio = worst(6)
  end subroutine read_progress

  !> The motion that points did not see: its share, and where it was, 0 and 0 for nowhere.
  subroutine read_spurious_mode(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp) :: mode(3)

    call read_list(file, 'progress/spurious_mode', mode)
    call require_range(file, 'progress/spurious_mode', mode(2), 0.0_wp, real(size(scene%groups), wp))
    call require_range(file, 'progress/spurious_mode', mode(3), 0.0_wp, real(huge(1), wp))
    if (file%failed()) return
    solution%worst_spurious = mode(1)
    solution%spurious_group = nint(mode(2))
    solution%spurious_element = nint(mode(3))
  end subroutine read_spurious_mode

  subroutine read_states(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(inout) :: solution
    real(wp), allocatable :: state(:, :, :)
    integer :: g

    do g = 1, size(scene%groups)
      associate (group => scene%groups(g), committed => solution%groups(g)%committed)
        if (group%pairs > 0) &
          call read_pairs(file, group_place(g)//'/pairs', size(scene%dies(group%die)%nodes, 2), solution%pairs(group%pairs))
        call file%require_shape(group_place(g)//'/state', shape(committed))
        call file%read(group_place(g)//'/state', state)
        if (file%failed()) return
        if (group%die > 0) call check_contact(file, group_place(g)//'/state', scene, group, state)
        committed = state
        solution%groups(g)%trial = state
      end associate
    end do
  end subroutine read_states

  !> What of the state of contact stands for a place in a list: how a point touches, and the piece of the die.
  subroutine check_contact(file, place, scene, group, state)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: state(:, :, :)
    real(wp) :: high
    integer :: v

    do v = 1, size(group%variables)
      select case (group%variables(v)%name)
      case ('contact_status', 'corner_contact_status')
        high = 2
      case ('die_piece', 'corner_die_piece')
        high = size(scene%dies(group%die)%pieces, 3)
      case default
        cycle
      end select
      call require_range(file, place, pack(state(group%variables(v)%first, :, :), .true.), 0.0_wp, high)
    end do
  end subroutine check_contact

  !> Errors so far. What made the run stop is of the past: it has gone on.
  subroutine read_estimate(file, scene, estimate)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(estimate_t), intent(inout) :: estimate
    real(wp), allocatable :: sums(:, :)
    logical :: wanted
    integer :: g, n, last

    call read_flag(file, 'estimate/wanted', wanted)
    call require(file, 'estimate/wanted', wanted .eqv. scene%remesh%estimate, 'is not what the deck asks for')
    if (.not. wanted .or. file%failed()) return
    call file%read('estimate/stress', estimate%stress)
    call file%read('estimate/strain', estimate%strain)
    call read_count(file, 'remesh/last_stop', estimate%last_stop)
    call file%read('remesh/first_stress', estimate%first_stress)
    call require_range(file, 'remesh/first_stress', estimate%first_stress, 0.0_wp, huge(1.0_wp))
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      n = last + 1
      last = last + size(scene%groups(g)%connectivity, 2)
      call read_list(file, group_place(g)//'/error_stress', estimate%stress_of(n:last))
      call read_list(file, group_place(g)//'/error_strain', estimate%strain_of(n:last))
      sums = estimate%strain_sums(:, n:last)
      call read_matrix(file, group_place(g)//'/strain_sums', sums)
      call require_range(file, group_place(g)//'/strain_sums', pack(sums, .true.), 0.0_wp, huge(1.0_wp))
      estimate%strain_sums(:, n:last) = sums
    end do
  end subroutine read_estimate

  !> Pairs decide the order in which the matrix is eliminated: a run that goes on needs them, to the last bit.
  subroutine read_pairs(file, place, npiece, pairs)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: place
    integer, intent(in) :: npiece   !! of the die
    type(pairs_t), intent(inout) :: pairs
    integer, allocatable :: piece(:, :)

    call file%require_shape(place, shape(pairs%piece))
    call file%read(place, piece)
    call require_range(file, place, piece, 0, npiece)
    if (.not. file%failed()) pairs%piece = piece
  end subroutine read_pairs

  !> Where contact begins and ends at the instant of a checkpoint.
  subroutine read_contact_ends(file, scene, ends, error)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(contact_end_t), allocatable, intent(out) :: ends(:)   !! (nend)
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: begins(:), group(:), side(:), piece(:)
    real(wp), allocatable :: place(:), xi(:)
    integer :: k, n

    call file%read('contact_ends/begins', begins)
    n = size(begins)
    call file%require_shape('contact_ends/group', [n])
    call file%require_shape('contact_ends/side', [n])
    call file%require_shape('contact_ends/place', [n])
    call file%require_shape('contact_ends/die_piece', [n])
    call file%require_shape('contact_ends/die_xi', [n])
    call file%read('contact_ends/group', group)
    call file%read('contact_ends/side', side)
    call file%read('contact_ends/place', place)
    call file%read('contact_ends/die_piece', piece)
    call file%read('contact_ends/die_xi', xi)
    call require_range(file, 'contact_ends/begins', begins, 0, 1)
    call require_range(file, 'contact_ends/group', group, 1, size(scene%groups))
    call require_range(file, 'contact_ends/place', place, -on_side, on_side)
    call require_range(file, 'contact_ends/die_xi', xi, -on_side, on_side)
    do k = 1, n
      if (file%failed()) exit
      associate (at => scene%groups(group(k)))
        call require_range(file, 'contact_ends/side', side(k), 1, size(at%connectivity, 2))
        call require(file, 'contact_ends/group', at%die > 0 .and. at%material > 0, 'holds '//to_text(group(k))// &
                     ', which is no group of contact')
        if (at%die > 0) call require_range(file, 'contact_ends/die_piece', piece(k), 0, size(scene%dies(at%die)%pieces, 3))
      end associate
    end do
    call file%status(error)
    if (allocated(error)) n = 0
    allocate (ends(n))
    if (n == 0) return
    ends%begins = begins == 1
    ends%group = group
    ends%side = side
    ends%place = place
    ends%piece = piece
    ends%xi = xi
  end subroutine read_contact_ends

end module exchange_read
