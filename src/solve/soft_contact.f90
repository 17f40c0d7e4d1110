!> New contact that comes in softly, where a step has failed because contact kept changing.
!>
!> A sheet that lies on a die and is bent peels off it node by node: the node at the front is pried off, the next one takes its
!> place, and Newton's method finds the set of points in contact in as many iterations as there are nodes, if at all, whatever the
!> length of the step. On a foundation k times as stiff a beam is in contact over k**(-1/4) times the length (M. Hetenyi, Beams on
!> Elastic Foundation, 1946, ch. I): with penalties of a millionth over thirty times as many sides, which all find their place at
!> once. So the points that had no pressure at the start of the step press with a small share of their penalties first, and
!> with a larger one from the equilibrium of each (a homotopy in the penalty: R. Fletcher, Practical Methods of Optimization, 1987,
!> sec. 12.1), until it is the whole: what is found in the end is an equilibrium with the penalties of the deck. Points that had
!> a pressure keep their penalties, so that nothing that is in balance is taken out of it.
module soft_contact
  use elem_api, only: mode_advance
  use equations, only: equations_t
  use fields, only: displacement_field
  use iteration_history, only: iteration_t
  use kinds, only: wp
  use scene, only: scene_t
  implicit none
  private
  public :: begin_softly, end_softly, is_stage_done, stiffen

  !> The first share of the penalties, and from one to the next: the length in contact changes to a third.
  real(wp), parameter :: first_share = 1.0e-6_wp, factor = 1.0e2_wp
  !> The equilibrium of a share need not be exact, and takes no more than so many iterations.
  real(wp), parameter :: near_enough = 1.0e-2_wp
  integer, parameter :: most_iterations = 12
  !> Contact kept changing where it did so in each of so many last iterations.
  integer, parameter :: last_iterations = 5

contains

  !> An attempt at a step begins.
  pure subroutine begin_softly(scene, dt, equations)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: dt   !! [time]
    type(equations_t), intent(inout) :: equations

    equations%penalty_share = 1
    if (equations%softly .and. dt > 0 .and. equations%mode == mode_advance .and. any(scene%groups%die > 0) &
        .and. equations%solves(equations%now)%own(displacement_field)) equations%penalty_share = first_share
  end subroutine begin_softly

  !> The equilibrium of the present share is found, or has been sought long enough. Points that bear nothing may go on opening and
  !> closing in it.
  pure function is_stage_done(scene, equations, history) result(done)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(iteration_t), intent(in) :: history(:)   !! (niteration) of this share
    logical :: done
    integer :: n

    done = equations%penalty_share < 1 .and. size(history) > 1
    if (.not. done) return
    n = size(history)
    done = n > most_iterations .or. history(n)%force_norm < near_enough .and. .not. history(n)%contact_changed &
           .or. history(n)%force_norm <= scene%strategy%force_norm
  end function is_stage_done

  !> The next share.
  pure subroutine stiffen(equations)
    type(equations_t), intent(inout) :: equations

    equations%penalty_share = factor*equations%penalty_share
    ! powers of ten are not exact
    if (2*equations%penalty_share > 1) equations%penalty_share = 1
  end subroutine stiffen

  !> An attempt has ended: after one that failed while contact changed the next is soft, or the other way. One that is to be made
  !> shorter before it has begun says nothing; past a limit point contact is not what fails it (pseudo_transient).
  pure subroutine end_softly(converged, history, equations)
    logical, intent(in) :: converged
    type(iteration_t), intent(in) :: history(:)   !! (niteration)
    type(equations_t), intent(inout) :: equations
    logical :: changing

    equations%penalty_share = 1
    if (size(history) == 0 .or. .not. equations%solves(equations%now)%own(displacement_field)) return
    changing = size(history) > last_iterations
    if (changing) changing = all(history(size(history) - last_iterations + 1:)%contact_changed) &
                             .and. .not. any(history%past_limit)
    equations%softly = .not. (converged .or. equations%softly) .and. changing
  end subroutine end_softly

end module soft_contact
