!> What bodies have in the balance of heat on the mesh twice as fine (fine_system): capacities, flows, and what the temperatures of
!> the mesh leave unbalanced there.
!>
!> What is unbalanced at middles of sides and centres are heat contents, flows and loads with the temperatures of the mesh, linear
!> between its corners. Against the functions of the mesh itself these temperatures are in balance, but for the heat capacity and
!> the exchange at sides, which are lumped at other nodes there.
module fine_bodies
  use drivers, only: own_states_at_end
  use equations, only: equations_t
  use fine_mesh, only: corner_share, quarter_nodes
  use fine_mesh_data, only: fine_mesh_t
  use fine_system, only: fine_system_t
  use kinds, only: wp
  use law_api, only: driver_count, driver_temperature
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: add_bodies, chord_capacities, contents_of

contains

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

  !> Heat contents that differences of the temperature make at the start of a step, however large they are.
  subroutine contents_of(scene, equations, fine, before, differences, content)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(fine_mesh_t), intent(in) :: fine
    real(wp), intent(in) :: before(:)        !! (nnode of the mesh) [temperature]
    real(wp), intent(in) :: differences(:)   !! (nnode) [temperature]
    real(wp), intent(out) :: content(:)      !! (nnode) [energy]
    real(wp), allocatable, dimension(:, :) :: mesh, other
    real(wp) :: taken(9), capacity(9)
    integer :: e

    content = 0
    do e = 1, fine%nelement
      associate (g => fine%group(e), nodes => fine%nodes(:, e))
        if (.not. any(abs(differences(nodes)) > 0)) cycle
        associate (material => scene%materials(scene%groups(g)%material))
          associate (law => equations%laws(material%law_id))
            allocate (mesh(driver_count(law), 9), source=0.0_wp)
            mesh(driver_temperature, :) = matmul(before(nodes(:4)), corner_share)
            other = mesh
            other(driver_temperature, :) = other(driver_temperature, :) + differences(nodes)
            call law%store(material, mesh, other, taken, capacity)
            deallocate (mesh, other)
          end associate
        end associate
        content(nodes) = content(nodes) + fine%volume(:, e)*taken
      end associate
    end do
  end subroutine contents_of

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

end module fine_bodies
