!> Heat through sides, from torches and other loads in the balance of heat on the mesh twice as fine (fine_system).
module fine_loads
  use elem_heat_sides, only: flow_in
  use equations, only: equations_t
  use fine_mesh, only: corner_share
  use fine_mesh_data, only: fine_mesh_t
  use fine_system, only: fine_system_t
  use kinds, only: wp
  use loads, only: exchange_t, multiplier_at
  use scene, only: role_body, role_second, role_side_load, scene_t
  implicit none
  private
  public :: add_loads, by_tables

  !> Differences of temperatures below this share of them are round-off.
  real(wp), parameter :: resolution = 1.0e-9_wp

contains

  !> between them; and how it goes with the temperature.
  subroutine add_loads(scene, equations, fine, field, time, error, system, slopes_alone)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(fine_mesh_t), intent(in) :: fine
    integer, intent(in) :: field         !! the temperature in the list of the scene
    real(wp), intent(in) :: time         !! end of the step
    real(wp), intent(in) :: error(:)     !! (nnode) what temperatures of the fine mesh are more, as known so far [temperature]
    type(fine_system_t), intent(inout) :: system
    logical, intent(in), optional :: slopes_alone   !! what is unbalanced is known: only how heat goes with the temperature, anew
    real(wp) :: facing(equations%dofs%ndof), unbalanced(fine%nnode)
    real(wp) :: multipliers(size(scene%multipliers))
    integer :: start(size(scene%groups))
    integer :: g, e, n

    multipliers = [(multiplier_at(scene%multipliers(n), time), n=1, size(multipliers))]
    unbalanced = system%unbalanced
    system%exchange = 0
    facing = 0
    start = -1
    do e = fine%nelement, 1, -1
      start(fine%group(e)) = e - fine%element(e)
    end do
    do g = 1, size(scene%groups)
      if (any(scene%groups(g)%role == [role_body, role_second])) cycle
      if (.not. (equations%solves(equations%now)%active(g) .and. acts_on(equations, g, field))) cycle
      do e = 1, size(equations%dofs%groups(g)%dof, 2)
        if (scene%groups(g)%host > 0 .and. size(scene%groups(g)%connectivity, 1) == 8) then
          n = heated(scene, start, g)
          if (n >= 0) call add_to_element(n + e)
        else
          call add_to_side()
        end if
      end do
    end do
    if (any(abs(facing) > 0)) call add_facing(equations, fine, field, facing, system)
    if (.not. present(slopes_alone)) return
    if (slopes_alone) system%unbalanced = unbalanced

  contains

    !> What passes a side; and what comes to the sides that it faces, at their ends.
    subroutine add_to_side()
      real(wp) :: force(2), slope(2), out(2), whole(2), area(3), of_side(3)
      logical :: turned
      integer :: i, m

      turned = .false.

      associate (dof => equations%dofs%groups(g)%dof, nodes => scene%groups(g)%connectivity(:, e))
        call of_element(force, slope)
        area = [0.25_wp, 0.5_wp, 0.25_wp]
        if (fine%side(nodes(2)) > 0) area = fine%area(:, fine%side(nodes(2)))
        if (fine%side(nodes(2)) > 0) turned = fine%ends(1, nodes(2)) /= nodes(1)
        if (turned) area = area([3, 2, 1])
        whole = area([1, 3]) + 0.5_wp*area(2)
        out = force/whole
        system%unbalanced(nodes(2)) = system%unbalanced(nodes(2)) - 0.5_wp*area(2)*sum(out)
        system%unbalanced(nodes([1, 3])) = system%unbalanced(nodes([1, 3])) + force &
                                           - (area([1, 3])*out + 0.25_wp*area(2)*sum(out))
        if (scene%groups(g)%role == role_side_load .and. fine%side(nodes(2)) > 0) then
          call ask_side(scene%groups(g)%exchange, multipliers, system%temperature(nodes), error(nodes), area, &
                        system%unbalanced(nodes(2)), of_side)
          system%exchange(nodes) = system%exchange(nodes) + of_side
        else
          slope = slope/whole
          system%exchange(nodes) = system%exchange(nodes) + area*[slope(1), 0.5_wp*sum(slope), slope(2)]
        end if
        m = equations%solves(1)%pattern%force_start(g) + (e - 1)*size(dof, 1)
        do i = 3, equations%dofs%groups(g)%layout%count(1)
          facing(dof(i, e)) = facing(dof(i, e)) - equations%buffers%force(m + i)
        end do
      end associate
    end subroutine add_to_side

    !> What comes to the volume of an element.
    subroutine add_to_element(n)
      integer, intent(in) :: n   !! of those of the fine mesh
      real(wp) :: force(4), slope(4), volume(4), load(9)

      call of_element(force, slope)
      associate (v => fine%volume(:, n), nodes => fine%nodes(:, n))
        volume = matmul(corner_share, v)
        load = -v*matmul(force/volume, corner_share)
        load(:4) = 0
        system%unbalanced(nodes) = system%unbalanced(nodes) + load
        system%exchange(nodes) = system%exchange(nodes) + v*matmul(slope/volume, corner_share)
      end associate
    end subroutine add_to_element

    !> Flows out of the corners of an element, and how they rise with the temperatures there.
    subroutine of_element(force, slope)
      real(wp), intent(out) :: force(:)   !! [power]
      real(wp), intent(out) :: slope(:)   !! [power/temperature]
      integer :: i, m, k

      associate (ndof => size(equations%dofs%groups(g)%dof, 1), pattern => equations%solves(1)%pattern)
        m = pattern%force_start(g) + (e - 1)*ndof
        k = pattern%matrix_start(g) + (e - 1)*ndof*ndof
        force = equations%buffers%force(m + 1:m + size(force))
        slope = [(equations%buffers%matrix(k + (i - 1)*ndof + i), i=1, size(slope))]
      end associate
    end subroutine of_element

  end subroutine add_loads

  !> the temperature, from that of the mesh to that of the fine one as known so far.
  pure subroutine ask_side(exchange, multipliers, t, error, area, unbalanced, slopes)
    type(exchange_t), intent(in) :: exchange
    real(wp), intent(in) :: multipliers(:)       !! (nmultiplier)
    real(wp), intent(in) :: t(3), error(3)       !! at end, middle, end of the side [temperature]
    real(wp), intent(in) :: area(3)              !! [area]
    real(wp), intent(inout) :: unbalanced        !! at the middle [power]
    real(wp), intent(out) :: slopes(3)           !! [power/temperature]
    real(wp) :: q(3), there, slope(3), unused
    integer :: i

    do i = 1, 3
      call flow_in(exchange, multipliers, multipliers, t(i), q(i), slope(i))
      if (.not. abs(error(i)) > resolution*abs(t(i))) cycle
      call flow_in(exchange, multipliers, multipliers, t(i) + error(i), there, unused)
      slope(i) = (there - q(i))/error(i)
    end do
    unbalanced = unbalanced + area(2)*(q(2) - 0.5_wp*(q(1) + q(3)))
    slopes = -area*slope
  end subroutine ask_side

  !> Heat passes sides by tables of the temperature.
  pure function by_tables(scene) result(yes)
    type(scene_t), intent(in) :: scene
    logical :: yes
    integer :: g

    yes = .false.
    do g = 1, size(scene%groups)
      yes = yes .or. (scene%groups(g)%role == role_side_load .and. allocated(scene%groups(g)%exchange%table))
    end do
  end function by_tables

  !> The elements of a group, as loads before solves know it, act on a field first of all.
  pure function acts_on(equations, g, field) result(yes)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: g, field
    logical :: yes

    associate (layout => equations%dofs%groups(g)%layout)
      yes = layout%nfield > 0
      if (yes) yes = layout%field(1) == field .and. layout%acts(1)
    end associate
  end function acts_on

  !> Elements of the fine mesh before those of the body that a load heats; less than 0 where it conducts no heat.
  pure function heated(scene, start, g) result(n)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: start(:)   !! (ngroup) elements before those of each group
    integer, intent(in) :: g          !! of the load
    integer :: n
    integer :: k

    n = -1
    do k = 1, size(scene%groups)
      if (start(k) >= 0 .and. (k == scene%groups(g)%host .or. scene%groups(k)%host == scene%groups(g)%host)) n = start(k)
    end do
  end function heated

  !> What comes to the ends of sides that others face, per area linear between them.
  subroutine add_facing(equations, fine, field, facing, system)
    type(equations_t), intent(in) :: equations
    type(fine_mesh_t), intent(in) :: fine
    integer, intent(in) :: field
    real(wp), intent(in) :: facing(:)   !! (ndof) [power]
    type(fine_system_t), intent(inout) :: system
    real(wp) :: area(size(facing))
    logical :: is_faced(size(fine%outside))
    integer :: s, dof(2)

    area = 0
    do s = 1, size(fine%outside)
      dof = equations%dofs%fields(field)%number(1, fine%ends(:, fine%outside(s)))
      is_faced(s) = all(dof > 0)
      if (is_faced(s)) is_faced(s) = all(abs(facing(dof)) > 0)
      if (is_faced(s)) area(dof) = area(dof) + fine%area([1, 3], s) + 0.5_wp*fine%area(2, s)
    end do
    do s = 1, size(fine%outside)
      if (.not. is_faced(s)) cycle
      dof = equations%dofs%fields(field)%number(1, fine%ends(:, fine%outside(s)))
      associate (middle => fine%outside(s))
        system%unbalanced(middle) = system%unbalanced(middle) + 0.5_wp*fine%area(2, s)*sum(facing(dof)/area(dof))
      end associate
    end do
  end subroutine add_facing

end module fine_loads
