!> Whether a new mesh is good enough: the measures of the restart on it against the limits of REMSH ACCEPT, and which stage of the
!> remesh is responsible where it is not.
module judge_remesh
  use acceptance, only: acceptance_t
  use cuts, only: was_just_cut
  use errors, only: error_t, exit_no_convergence, fail
  use kinds, only: wp
  use remesh_limits, only: carried_change, energy_change, energy_limit, error_limit, force_along, force_change, force_limit, &
                           has_lost_force, lost_limit, residual_limit
  use residual_place, only: bad_shape
  use restore_balance, only: balance_t
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: string_t, to_text
  implicit none
  private
  public :: advice_after_refusal, find_fault, force_alone, limit_lines, refuse_remesh, taken_up_words

  !> Largest limit of the change of a force where other new meshes agree on it, over the default. Where an old mesh made half of the
  !> force, or as much too much, its estimated error, by recovery, is no measure of its error.
  real(wp), parameter :: most_agreed = 5.0_wp

  !> First residuals above this are those of a matrix that is singular (work_of_correction).
  real(wp), parameter :: without_correction = 1.0e100_wp

  character(len=*), parameter :: advice_after_refusal = &
    'remesh again from the checkpoint of the old mesh with another transfer or finer elements'

contains

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
