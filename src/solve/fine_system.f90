!> Balance of heat of a step on the mesh twice as fine (fine_mesh), for the difference of its temperatures to those of the mesh: its
!> terms, filled in by bodies (fine_bodies) and loads (fine_loads), and what they make of a difference.
module fine_system
  use fine_mesh_data, only: fine_mesh_t
  use kinds, only: wp
  implicit none
  private
  public :: fine_system_t, flow_of, row_sums_of_flow, start_system, to_corners, to_nodes

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
  pure function row_sums_of_flow(fine, system) result(sums)
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
  end function row_sums_of_flow

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
