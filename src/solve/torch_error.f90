!> What the estimates of the error of heat in time see of welding torches that is none.
!>
!> A step takes exactly the heat that a torch leaves meanwhile (torch_steps), but the difference of two formulas, sum of E_k q_k
!> over the instants of the step, has another sum over the nodes than 0 where the power changes. That sum is taken as the heat q of
!> the step is distributed, q sum(E_k q_k)/sum(q): all of the error of a torch that crosses the plane; of one that moves in it what
!> is left is where its heat comes, not how much.
module torch_error
  use equations, only: equations_t
  use kinds, only: wp
  use scene, only: scene_t
  implicit none
  private
  public :: add_torches, in_sum

contains

  !> Add the heat of torches at the nodes, as it was evaluated last: with the weight of its instant in the error, and in the step.
  pure subroutine add_torches(scene, equations, shares, erred, mean)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: shares(2)                   !! of the error, and of the step
    real(wp), intent(inout) :: erred(:), mean(:)        !! (ndof) [power]
    integer :: k, m, e, i

    do k = 1, size(equations%dofs%groups)
      if (.not. (equations%solves(equations%now)%active(k) .and. scene%groups(k)%source > 0)) cycle
      associate (dof => equations%dofs%groups(k)%dof)
        do e = 1, size(dof, 2)
          m = equations%solves(1)%pattern%force_start(k) + (e - 1)*size(dof, 1)
          do i = 1, size(dof, 1)
            erred(dof(i, e)) = erred(dof(i, e)) + shares(1)*equations%buffers%force(m + i)
            mean(dof(i, e)) = mean(dof(i, e)) + shares(2)*equations%buffers%force(m + i)
          end do
        end do
      end associate
    end do
  end subroutine add_torches

  !> What the error of the heat of torches is in sum over the nodes, as their heat of the step is distributed there.
  pure function in_sum(erred, mean) result(at_nodes)
    real(wp), intent(in) :: erred(:), mean(:)   !! (ndof) as of add_torches [power]
    real(wp) :: at_nodes(size(erred))           !! (ndof) [power]

    at_nodes = 0
    if (abs(sum(mean)) > 0) at_nodes = sum(erred)/sum(mean)*mean
  end function in_sum

end module torch_error
