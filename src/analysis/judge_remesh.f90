!> Whether a new mesh is good enough: the measures of the restart on it against the limits of REMSH ACCEPT, and which stage of the
!> remesh is responsible where it is not.
module judge_remesh
  use acceptance, only: acceptance_t
  use cuts, only: was_just_cut
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use residual_place, only: bad_shape
  use restore_balance, only: balance_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: advice_after_refusal, carried_change, energy_change, energy_limit, find_fault, force_alone, force_along, &
            force_change, force_limit, limit_lines, refuse_remesh, residual_limit, taken_up_words

  !> Pressures that miss the force of a die by more than this share of the largest were lost in the transfer. (Found: 0.27 where
  !> a point in a corner carried much of the force; Newton's method finds the rest.)
  real(wp), parameter :: lost_pressure = 0.5_wp

  !> Largest limit of the change of a force where the deck gives none, over the default.
  real(wp), parameter :: most_wrong = 2.0_wp
  !> The same where other new meshes agree on the change. Where an old mesh made half of the force, or as much too much, its
  !> estimated error, by recovery, is no measure of its error.
  real(wp), parameter :: most_agreed = 5.0_wp
  !> Changes are over the force of now, or over this share of the largest so far where the load is light: the tenth part of nothing
  !> says nothing about a mesh.
  real(wp), parameter :: light_load = 0.2_wp

  !> First residuals above this are those of a matrix that is singular (work_of_correction).
  real(wp), parameter :: without_correction = 1.0e100_wp

  character(len=*), parameter :: advice_after_refusal = &
    'remesh again from the checkpoint of the old mesh with another transfer or finer elements'

contains

  !> Change of the force of a die over the largest force on any, or what presses on one made of sides: the worst.
  pure function force_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change

    change = worst_change(balance, balance%pilot_after)
  end function force_change

  !> The same of the forces of the carried pressures, before the first iteration.
  pure function carried_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change

    change = worst_change(balance, balance%pilot_carried)
  end function carried_change

  pure function worst_change(balance, after) result(change)
    type(balance_t), intent(in) :: balance
    real(wp), intent(in) :: after(:, :)   !! (3, ndie) [force]
    real(wp) :: change
    real(wp) :: largest
    integer :: k

    change = 0
    largest = maxval([light_load*balance%largest_force, balance%pressed])
    do k = 1, size(after, 2)
      largest = max(largest, length_of(balance%pilot_before(1:2, k)))
      change = max(change, length_of(after(1:2, k) - balance%pilot_before(1:2, k)))
    end do
    if (largest > 0) change = change/largest
  end function worst_change

  !> Limit of the change of a force. Where few nodes bear the load it is up to what their number leaves open (bearing_nodes) and the
  !> old mesh's error says; where that is more than the force itself, as of a node on the axis, whose force goes with the square of
  !> the sides, the estimated error says nothing of it.
  pure function force_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = error_limit(accept, balance)
    if (accept%force_is_given) return
    if (balance%open_share > 1) then
      limit = max(limit, balance%open_share)
    else
      limit = max(limit, min(balance%old_error, balance%open_share))
    end if
  end function force_limit

  !> The same by the errors alone. Where the deck gives no limit an old mesh whose stress was wrong by more than the default may
  !> have had a force as wrong, and it is the new one that is right then; up to `most_wrong` times the default: a larger change may
  !> as well come of a bad new mesh.
  pure function error_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%force_change
    if (.not. accept%force_is_given) limit = max(limit, min(balance%old_error, most_wrong*limit))
  end function error_limit

  !> Limit of the first residual: about as large as the error of the stress on the old mesh in any case, where few nodes bear the
  !> load, and where the stress of the body is that around them; all of it where they leave open as much as the force.
  pure function residual_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%first_residual
    if (accept%residual_is_given) return
    if (balance%open_share >= 1) then
      limit = max(limit, 1.0_wp)
    else
      limit = max(limit, min(balance%old_error, balance%open_share))
    end if
  end function residual_limit

  !> The same of the elastic energy, which goes with the square of the force where few nodes bear that.
  pure function energy_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = accept%energy_change
    if (force_limit(accept, balance) > error_limit(accept, balance)) &
      limit = max(limit, (1 + force_limit(accept, balance))**2 - 1)
  end function energy_limit

  !> The pressures carried over miss the force of a die, and by more than few nodes explain: what these bear has a direction of its
  !> own, which it loses on the faces of the new sides; there it is enough that equilibrium brings the force back.
  pure function has_lost_force(accept, balance) result(lost)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    logical :: lost

    lost = carried_change(balance) > lost_limit(accept, balance)
    if (balance%restored .and. balance%open_share > most_wrong*accept%force_change) &
      lost = lost .and. force_change(balance) > force_limit(accept, balance)
  end function has_lost_force

  !> Limit of the change of the force of a die by the pressures that were carried.
  pure function lost_limit(accept, balance) result(limit)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    real(wp) :: limit

    limit = max(lost_pressure, force_limit(accept, balance))
  end function lost_limit

  !> Of the force that changes most: its change along what it was, over the largest force; negative where it becomes smaller.
  pure function force_along(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change
    integer :: worst, k
    real(wp) :: size_of(size(balance%pilot_before, 2))

    change = 0
    if (size(size_of) == 0) return
    size_of = [(length_of(balance%pilot_after(1:2, k) - balance%pilot_before(1:2, k)), k=1, size(size_of))]
    worst = maxloc(size_of, 1)
    if (.not. size_of(worst) > 0) return
    change = force_change(balance)
    if (dot_product(balance%pilot_after(1:2, worst) - balance%pilot_before(1:2, worst), balance%pilot_before(1:2, worst)) < 0) &
      change = -change
  end function force_along

  !> Does nothing but the force of a die speak against the mesh, with an energy that goes with the square of the force, and is the
  !> change within the error of the stress on the old mesh, and no larger than may be agreed on? Then it may be the old mesh that
  !> was wrong: other new ones show it. A limit that the deck gives holds in any case.
  pure function force_alone(accept, balance) result(alone)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    logical :: alone
    type(acceptance_t) :: other
    character(len=:), allocatable :: what

    alone = .false.
    if (accept%force_is_given .or. .not. balance%restored) return
    if (.not. balance%shape >= bad_shape .or. .not. force_change(balance) > force_limit(accept, balance)) return
    if (force_change(balance) > min(balance%old_error, most_agreed*accept%force_change)) return
    other = accept
    other%force_is_given = .true.
    other%force_change = force_change(balance)
    other%energy_change = max(accept%energy_change, (1 + force_change(balance))**2 - 1)
    call find_fault(other, balance, what)
    alone = len(what) == 0
  end function force_alone

  !> What is reported of a mesh that is taken up although a force changes; empty where that does not.
  pure function taken_up_words(accept, balance) result(words)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    character(len=:), allocatable :: words

    words = ''
    if (balance%refused .or. .not. balance%restored) return
    words = 'the force of a die changes by '//to_text(100*force_along(balance), 3)//' % at the new mesh: '
    if (balance%agreed) then
      words = words//'several new ones agree that it was wrong on the old one (error of its stress: ' &
              //to_text(100*balance%old_error, 3)//' %)'
    else if (force_change(balance) > error_limit(accept, balance)) then
      words = words//'few nodes bear it, and before the contact grows it goes with the size of the elements there'
    else
      words = ''
    end if
  end function taken_up_words

  !> Change of the elastic energy over what was carried; where that is round-off, over what round-off may be.
  pure function energy_change(balance) result(change)
    type(balance_t), intent(in) :: balance
    real(wp) :: change
    real(wp) :: carried

    carried = max(balance%before%elastic_energy, balance%round_off)
    change = 0
    if (carried > 0) change = abs(balance%after%elastic_energy - balance%before%elastic_energy)/carried
  end function energy_change

  !> The measures, each with its limit.
  function limit_lines(scene, balance) result(lines)
    type(scene_t), intent(in) :: scene
    type(balance_t), intent(in) :: balance
    type(string_t) :: lines(3)

    associate (accept => scene%remesher%accept)
      lines(1)%s = '  first residual '//held(balance%first_residual, residual_limit(accept, balance))//', iterations ' &
                   //to_text(balance%iterations)//' (limit '//to_text(accept%iterations)//')'
      lines(2)%s = '  equilibrium is left to the first step; change'
      if (balance%restored) lines(2)%s = '  change of die force '//held(force_change(balance), force_limit(accept, balance)) &
                                         //', of elastic energy '//held(energy_change(balance), energy_limit(accept, balance))//','
      lines(2)%s = lines(2)%s//' of depth '//held(balance%depth_change, accept%depth_change)
    end associate
    lines(3)%s = '  least scaled Jacobian '//held(balance%shape, bad_shape)//'; first residual: ' &
                 //to_text(100*balance%place%at_contact, 3)//' % of its square at sides of contact'
    if (balance%place%node > 0) lines(3)%s = lines(3)%s//', worst at node '//to_text(scene%mesh%labels(balance%place%node))
  end function limit_lines

  !> Over a limit a remesh is refused; `agreed`: but for the force of a die, on which other new meshes agree.
  subroutine refuse_remesh(scene, solution, agreed, balance, error)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: agreed
    type(balance_t), intent(inout) :: balance
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: what

    what = ''
    ! a cut sets free what it removes has carried: forces, energy and residual change with it
    if (.not. was_just_cut(solution%cuts, scene%generation)) call find_fault(scene%remesher%accept, balance, what)
    if (balance%shape < bad_shape) what = 'the scaled Jacobian of an element is '//to_text(balance%shape, 3)//', at least ' &
                                          //to_text(bad_shape, 3)
    if (agreed .and. force_alone(scene%remesher%accept, balance)) then
      balance%agreed = .true.
      what = ''
    end if
    balance%refused = len(what) > 0
    if (.not. balance%refused) return
    if (agreed .and. .not. scene%remesher%accept%force_is_given &
        .and. force_change(balance) > most_agreed*scene%remesher%accept%force_change) &
      what = what//' (where new meshes agree, at most '//to_text(100*most_agreed*scene%remesher%accept%force_change, 3)//' %)'
    balance%stage = responsible_stage(scene, balance)
    call fail(error, exit_no_convergence, 'mesh '//to_text(scene%generation)//' refused at step '//to_text(solution%step)//': ' &
              //what//'; responsible stage: '//balance%stage, advice_after_refusal)
  end subroutine refuse_remesh

  !> The first limit that is passed, in words; empty when all hold.
  pure subroutine find_fault(accept, balance, what)
    type(acceptance_t), intent(in) :: accept
    type(balance_t), intent(in) :: balance
    character(len=:), allocatable, intent(out) :: what

    what = ''
    if (balance%depth_change > accept%depth_change) then
      what = 'sides lie '//to_text(balance%depth_change, 3)//' times what is allowed from where they carried their pressure, ' &
             //'at most '//to_text(accept%depth_change, 3)
    else if (balance%first_residual > max(without_correction, accept%first_residual)) then
      what = 'the matrix is singular: nothing holds a body, or a die under a force, on this mesh; contact that a single corner ' &
             //'of a die has with a side may have been lost'
    else if (balance%first_residual > residual_limit(accept, balance)) then
      what = 'the first residual is '//to_text(balance%first_residual, 3)//' of the stress, in the norm of energy, at most ' &
             //to_text(residual_limit(accept, balance), 3)
    else if (has_lost_force(accept, balance)) then
      what = 'the pressures carried over miss the force of a die by '//percent(carried_change(balance), lost_limit(accept, balance))
    else if (.not. balance%restored) then
      return   ! the first step finds it, or the mesh is refused on probation
    else if (balance%iterations > accept%iterations) then
      what = to_text(balance%iterations)//' iterations to equilibrium, at most '//to_text(accept%iterations)
    else if (force_change(balance) > force_limit(accept, balance)) then
      what = 'the force of a die changes by '//percent(force_change(balance), force_limit(accept, balance))
    else if (energy_change(balance) > energy_limit(accept, balance)) then
      what = 'the elastic energy changes by '//percent(energy_change(balance), energy_limit(accept, balance))
    end if
  end subroutine find_fault

  !> The mesh, where an element is distorted; the contour, where it is not where it carried the pressures;
  !> the transfer of contact, where the pressures do not make the forces of the dies any more; else that of the state.
  pure function responsible_stage(scene, balance) result(stage)
    type(scene_t), intent(in) :: scene
    type(balance_t), intent(in) :: balance
    character(len=:), allocatable :: stage

    if (balance%shape < bad_shape) then
      stage = 'mesh'
    else if (balance%depth_change > scene%remesher%accept%depth_change) then
      stage = 'contour'
    else if (has_lost_force(scene%remesher%accept, balance)) then
      stage = 'contact'
    else
      stage = 'transfer'
    end if
  end function responsible_stage

  !> `0.05 (limit 0.25)`.
  pure function held(value, limit) result(s)
    real(wp), intent(in) :: value, limit
    character(len=:), allocatable :: s

    s = to_text(value, 3)//' (limit '//to_text(limit, 3)//')'
  end function held

  pure function percent(value, limit) result(s)
    real(wp), intent(in) :: value, limit
    character(len=:), allocatable :: s

    s = to_text(100*value, 3)//' %, at most '//to_text(100*limit, 3)//' %'
  end function percent

end module judge_remesh
