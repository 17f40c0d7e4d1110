!> What elastic strain has made of the volume of bodies: the drift of the volume of a run is that without it.
module elastic_volume
  use kinds, only: wp
  use scene, only: scene_t
  use solution, only: solution_t
  use state_pieces, only: mesh_of, solid_pieces, state_pieces_t
  use state_variables, only: find_variable
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: unloaded_share

contains

  !> Volume of all bodies without elastic strain, dv exp(-tr e) as the solver measures it (elem_pl8ls), over their volume. 1 with
  !> small strains, whose volume is that of the start.
  pure function unloaded_share(scene, solution) result(share)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp) :: share
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh
    real(wp) :: growth
    integer :: k, e, p, v, n

    share = 1
    if (.not. scene%finite) return
    call solid_pieces(scene, pieces, solution)
    call mesh_of(pieces, mesh)
    n = 0
    share = 0
    do k = 1, size(pieces%groups)
      associate (group => pieces%groups(k))
        v = find_variable(group%variables, 'elastic_strain')
        if (v > 0) v = group%variables(v)%first
        do e = 1, size(group%connectivity, 2)
          do p = 1, group%npoint
            n = n + 1
            growth = 0
            if (v > 0) growth = sum(group%values([v, v + 1, v + 3], p, e))
            share = share + mesh%volumes(n)*exp(-growth)
          end do
        end do
      end associate
    end do
    share = share/sum(mesh%volumes)
  end function unloaded_share

end module elastic_volume
