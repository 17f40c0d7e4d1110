!> Balance of heat of a step on the mesh twice as fine (fine_mesh), for the difference of its temperatures to those of the mesh:
!> capacities, flows, exchange at sides, and what the temperatures of the mesh leave unbalanced there.
!>
!> What is unbalanced at middles of sides and centres are heat contents, flows and loads with the temperatures of the mesh, linear
!> between its corners. Against the functions of the mesh itself these temperatures are in balance, but for the heat capacity and
!> the exchange at sides, which are lumped at other nodes there.
module fine_system
  use drivers, only: own_states_at_end
  use equations, only: equations_t
  use fine_mesh, only: corner_share, quarter_nodes
  use fine_mesh_data, only: fine_mesh_t
  use elem_heat_sides, only: flow_in
  use kinds, only: wp
  use law_api, only: driver_count, driver_temperature
  use loads, only: exchange_t, multiplier_at
  use scene, only: role_body, role_second, role_side_load, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: fine_system_t, add_bodies, add_loads, by_tables, chord_capacities, diagonal_of_flow, flow_of, start_system, &
            to_corners, to_nodes

  !> Differences of temperatures below this share of them are round-off.
  real(wp), parameter :: resolution = 1.0e-9_wp

  type :: fine_system_t
    !> Matrices of the flows of the elements (9, 9, nelement), and what is exchanged at a node by its temperature (nnode)
    !> [power/temperature].
    real(wp), allocatable :: flow(:, :, :), exchange(:)
    !> Heat capacity [energy/temperature], volume [volume], temperature of the mesh at the end of the step [temperature] (nnode).
    real(wp), allocatable :: capacity(:), volume(:), temperature(:)
    !> Roots of the heat capacity over that of the mesh, at corners with latent heat, 1 at others (nnode).
    real(wp), allocatable :: stiffened(:)
    !> What is unbalanced: at middles and centres what goes to the node, at corners what the function of the mesh there sees (nnode)
    !> [power].
    real(wp), allocatable :: unbalanced(:)
  end type fine_system_t

contains

  subroutine start_system(fine, system)
    type(fine_mesh_t), intent(in) :: fine
    type(fine_system_t), intent(out) :: system

    associate (n => fine%nnode)
      allocate (system%flow(9, 9, fine%nelement), system%exchange(n), system%capacity(n), system%volume(n), &
                system%temperature(n), system%stiffened(n), system%unbalanced(n), source=0.0_wp)
    end associate
    system%stiffened = 1
  end subroutine start_system

  !> Heat contents, flows and sources of the bodies.
  subroutine add_bodies(scene, equations, solution, fine, before, now, mean, dt, length, system)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution      !! the trial states are those of the end of the step
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: before(:), now(:)     !! (nnode of the mesh) at both ends of the step [temperature]
    real(wp), intent(in) :: mean(:)               !! (nnode of the mesh) by which heat flows in the step [temperature]
    real(wp), intent(in) :: dt, length            !! the step, and by what its elements divide changes of the content [time]
    type(fine_system_t), intent(inout) :: system
    real(wp) :: taken(9), capacity(9), lambda(4), unbalanced(9), source, volume
    integer :: e, q, m

    do e = 1, fine%nelement
      associate (g => fine%group(e), corners => fine%nodes(:4, e), nodes => fine%nodes(:, e), v => fine%volume(:, e))
        call ask_law(scene, equations, solution, g, fine%element(e), before(corners), now(corners), taken, capacity, lambda)
        system%flow(:, :, e) = 0
        do q = 1, 4
          associate (at => quarter_nodes(:, q))
            system%flow(at, at, e) = system%flow(at, at, e) + lambda(q)*fine%conduction(:, :, q, e)
          end associate
        end do
        system%capacity(nodes) = system%capacity(nodes) + capacity*v
        system%volume(nodes) = system%volume(nodes) + v
        system%temperature(nodes) = matmul(now(corners), corner_share)
        ! all that is released in the element, evenly
        m = equations%solves(1)%pattern%force_start(g) + (fine%element(e) - 1)*size(equations%dofs%groups(g)%dof, 1)
        volume = sum(v)
        source = (dot_product(matmul(corner_share, v), taken(:4)) - length*sum(equations%buffers%force(m + 1:m + 4)))/dt
        unbalanced = source/volume*v - taken*v/dt - matmul(system%flow(:, :, e), matmul(mean(corners), corner_share))
        ! against the functions of the mesh: the capacity is lumped elsewhere
        unbalanced(:4) = (matmul(corner_share, v)*taken(:4) - matmul(corner_share, v*taken))/dt
        system%unbalanced(nodes) = system%unbalanced(nodes) + unbalanced
      end associate
    end do
  end subroutine add_bodies

  !> Heat capacities of nodes that hold latent heat: those of the chord to the temperature that a content above that of the mesh
  !> makes there.
  subroutine chord_capacities(scene, equations, fine, content, system)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: content(:)   !! (nnode) [energy]
    type(fine_system_t), intent(inout) :: system
    integer, parameter :: halvings = 40
    real(wp), allocatable :: at(:, :), now(:, :), taken(:), capacity(:), wanted(:), near(:), far(:)
    integer, allocatable :: nodes(:)
    integer :: g, k, n

    do g = 1, size(fine%least)
      if (.not. fine%least(g) > 0) cycle
      nodes = pack([(k, k=1, fine%nnode)], fine%latent == g .and. abs(content) > 0)
      associate (material => scene%materials(scene%groups(g)%material))
        associate (law => equations%laws(material%law_id))
          allocate (at(driver_count(law), size(nodes)), taken(size(nodes)), capacity(size(nodes)))
          at = 0
          at(driver_temperature, :) = system%temperature(nodes)
          now = at
          wanted = content(nodes)/system%volume(nodes)
          near = 0*wanted
          far = wanted/fine%least(g)
          do n = 1, halvings
            now(driver_temperature, :) = at(driver_temperature, :) + 0.5_wp*(near + far)
            call law%store(material, at, now, taken, capacity)
            where (abs(taken) < abs(wanted))
              near = 0.5_wp*(near + far)
            else where
              far = 0.5_wp*(near + far)
            end where
          end do
          capacity = system%capacity(nodes)
          where (abs(far) > 0) system%capacity(nodes) = content(nodes)/far
          system%stiffened(nodes) = sqrt(max(1.0_wp, system%capacity(nodes)/capacity))
          deallocate (at, taken, capacity)
        end associate
      end associate
    end do
  end subroutine chord_capacities

  !> What the law of a body answers in an element: what its nodes take up, their capacities, and conductivities of the quarters.
  subroutine ask_law(scene, equations, solution, g, e, before, now, taken, capacity, lambda)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(in) :: solution
    integer, intent(in) :: g, e                  !! group and its element
    real(wp), intent(in) :: before(4), now(4)    !! at the corners [temperature]
    real(wp), intent(out) :: taken(9)            !! [energy/length^3]
    real(wp), intent(out) :: capacity(9)         !! [energy/length^3/temperature]
    real(wp), intent(out) :: lambda(4)           !! [power/length/temperature]
    integer, parameter :: of_four(4) = [1, 2, 4, 3], of_nine(4) = [1, 3, 9, 7]
    real(wp), dimension(max(1, size(equations%drivers(g)%value, 1)), 9) :: start, end
    real(wp) :: slope(4), points(max(1, size(equations%drivers(g)%value, 1)), scene%groups(g)%rule%n)
    integer :: at(4), m

    at = of_four
    if (scene%groups(g)%rule%n == 9) at = of_nine
    associate (material => scene%materials(scene%groups(g)%material), own => equations%drivers(g))
      associate (law => equations%laws(material%law_id))
        start = 0
        end = 0
        start(driver_temperature, :) = matmul(before, corner_share)
        end(driver_temperature, :) = matmul(now, corner_share)
        m = max(1, min(size(own%value, 1), driver_count(law)))
        call law%store(material, start(:m, :), end(:m, :), taken, capacity)
        points = 0
        if (size(own%value, 1) > 0) then
          points = own%value(:, 2, :, e)
          call own_states_at_end(own, solution%groups(g), g, e, points)
        end if
        points(driver_temperature, at) = 0.25_wp*[sum(end(1, quarter_nodes(:, 1))), sum(end(1, quarter_nodes(:, 2))), &
                                                  sum(end(1, quarter_nodes(:, 3))), sum(end(1, quarter_nodes(:, 4)))]
        call law%conduct(material, points(:m, at), lambda, slope)
      end associate
    end associate
  end subroutine ask_law

  !> Heat through sides, from torches and from other loads on bodies, as the mesh has it at its corners, per area or volume linear
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

  !> Heat through a side by the temperature there: what comes in at its middle beside the mean of its ends, and how it falls with
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

  !> What flows out of the nodes at differences of the temperature.
  pure function flow_of(fine, system, t) result(flow)
    type(fine_mesh_t), intent(in) :: fine
    type(fine_system_t), intent(in) :: system
    real(wp), intent(in) :: t(:)      !! (nnode) [temperature]
    real(wp) :: flow(size(t))         !! [power]
    real(wp) :: of_element(9), t_at
    integer :: nodes(9), e, j

    flow = system%exchange*t
    do e = 1, fine%nelement
      nodes = fine%nodes(:, e)
      of_element = 0
      do j = 1, 9
        t_at = t(nodes(j))
        of_element = of_element + system%flow(1:9, j, e)*t_at
      end do
      do j = 1, 9
        flow(nodes(j)) = flow(nodes(j)) + of_element(j)
      end do
    end do
  end function flow_of

  !> Sums of the sizes of the rows of the flow (nnode) [power/temperature].
  pure function diagonal_of_flow(fine, system) result(sums)
    type(fine_mesh_t), intent(in) :: fine
    type(fine_system_t), intent(in) :: system
    real(wp) :: sums(fine%nnode)
    integer :: e

    sums = abs(system%exchange)
    do e = 1, fine%nelement
      associate (nodes => fine%nodes(:, e))
        sums(nodes) = sums(nodes) + sum(abs(system%flow(:, :, e)), 2)
      end associate
    end do
  end function diagonal_of_flow

  !> What comes to the nodes as the functions of the corners see it.
  pure function to_corners(fine, at_nodes) result(at_corners)
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: at_nodes(:)         !! (nnode) [power]
    real(wp) :: at_corners(size(at_nodes))      !! (nnode), 0 at others than corners [power]
    integer :: n, e

    at_corners = at_nodes
    do n = 1, size(fine%ends, 2)
      if (fine%ends(1, n) == 0) cycle
      at_corners(fine%ends(:, n)) = at_corners(fine%ends(:, n)) + 0.5_wp*at_nodes(n)
      at_corners(n) = 0
    end do
    do e = 1, fine%nelement
      associate (nodes => fine%nodes(:, e))
        at_corners(nodes(:4)) = at_corners(nodes(:4)) + 0.25_wp*at_nodes(nodes(9))
        at_corners(nodes(9)) = 0
      end associate
    end do
  end function to_corners

  !> Temperatures of all nodes, linear between those of the corners.
  pure function to_nodes(fine, at_corners) result(at_nodes)
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: at_corners(:)         !! (nnode) [temperature]
    real(wp) :: at_nodes(size(at_corners))        !! (nnode) [temperature]
    integer :: n, e

    at_nodes = at_corners
    do n = 1, size(fine%ends, 2)
      if (fine%ends(1, n) > 0) at_nodes(n) = 0.5_wp*sum(at_corners(fine%ends(:, n)))
    end do
    do e = 1, fine%nelement
      at_nodes(fine%nodes(9, e)) = 0.25_wp*sum(at_corners(fine%nodes(:4, e)))
    end do
  end function to_nodes

end module fine_system
