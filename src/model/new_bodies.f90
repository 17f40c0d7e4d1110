!> Bodies that come with an operation: where their nodes are, so that they fit those that were there.
module new_bodies
  use fields, only: displacement_field
  use kinds, only: wp
  use scene, only: group_t, is_solid, scene_t
  implicit none
  private
  public :: note_laid, place_new_nodes

  !> Sweeps over new nodes end where they change displacements by less than this share of the largest.
  real(wp), parameter :: smooth = 1.0e-6_wp
  integer, parameter :: most_sweeps = 1000

contains

  !> Where the nodes of a body are that comes: it has no strain there.
  pure subroutine note_laid(group, displacement, laid)
    type(group_t), intent(in) :: group
    real(wp), intent(in) :: displacement(:, :)            !! (2, nnode), of no nodes where nothing moves [length]
    real(wp), allocatable, intent(out) :: laid(:, :, :)   !! (2, node, element) [length]
    integer :: e

    if (size(displacement, 2) == 0) return
    allocate (laid(2, size(group%connectivity, 1), size(group%connectivity, 2)))
    do e = 1, size(laid, 3)
      laid(:, :, e) = displacement(:, group%connectivity(:, e))
    end do
  end subroutine note_laid

  !> Bodies that come fit those that were there: displacements of their nodes are the means of their neighbours' (Laplace's equation
  !> on the elements, by Jacobi's iterations), those of shared nodes and of supports are given.
  pure subroutine place_new_nodes(scene, was_there, displacement)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: was_there(:)             !! (nnode)
    real(wp), intent(inout) :: displacement(:, :)   !! (2, nnode) [length]
    logical :: given(2, size(was_there)), comes(size(was_there))
    real(wp) :: total(2, size(was_there)), mean(2), change
    integer :: number(size(was_there)), g, e, k, sweep

    comes = .false.
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) comes([scene%groups(g)%connectivity]) = .true.
    end do
    comes = comes .and. .not. was_there
    if (.not. any(comes)) return
    given = spread(.not. comes, 1, 2)
    do k = 1, size(scene%fixations)
      if (scene%fixations(k)%field == displacement_field) given(scene%fixations(k)%component, scene%fixations(k)%nodes) = .true.
    end do
    do sweep = 1, most_sweeps
      total = 0
      number = 0
      do g = 1, size(scene%groups)
        if (.not. is_solid(scene%groups(g))) cycle
        do e = 1, size(scene%groups(g)%connectivity, 2)
          associate (nodes => scene%groups(g)%connectivity(:, e))
            if (.not. any(comes(nodes))) cycle
            mean = sum(displacement(:, nodes), 2)/size(nodes)
            total(:, nodes) = total(:, nodes) + spread(mean, 2, size(nodes))
            number(nodes) = number(nodes) + 1
          end associate
        end do
      end do
      total = merge(displacement, total/spread(max(number, 1), 1, 2), given)
      change = maxval(abs(total - displacement))
      displacement = total
      if (.not. change > smooth*maxval(abs(displacement))) return
    end do
  end subroutine place_new_nodes

end module new_bodies
