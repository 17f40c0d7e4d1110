!> Element sizes where sides did not fit their die: what asked for a new mesh must not come back on it.
!>
!> A side spans a bend of its die by a depth that grows with the square of its length, and the depth allowed with its length: the
!> misfit goes with the length.
module contact_misfits
  use contact_quality, only: misfit_of_sides
  use kinds, only: wp
  use scene, only: scene_t
  use size_field, only: need_t
  use solution, only: present_coordinates, solution_t
  use vectors, only: length_of
  implicit none
  private
  public :: needs_of_misfits

  !> Sides are made for this share of the limit, and become no shorter than this share of what they were at once.
  real(wp), parameter :: aim = 0.5_wp, least_share = 0.25_wp

contains

  !> Needs at the sides that are beyond that share of a limit of CONTACT, where it was passed.
  pure subroutine needs_of_misfits(scene, solution, needs)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(need_t), allocatable, intent(out) :: needs(:)   !! (nneed)
    real(wp) :: x(2, size(scene%mesh%coordinates, 2)), length, limit
    real(wp), allocatable :: of_sides(:, :)
    type(need_t) :: need
    integer :: k, e

    allocate (needs(0))
    x = present_coordinates(scene, solution)
    do k = 1, size(solution%estimate%triggers)
      associate (trigger => solution%estimate%triggers(k))
        if (index(trigger%name, 'contact_') /= 1) cycle
        associate (sides => scene%groups(trigger%group)%connectivity)
          if (allocated(of_sides)) deallocate (of_sides)
          allocate (of_sides, source=misfit_of_sides(scene, trigger%group, solution))
          ! the checkpoint has no laws: what is allowed follows from the side that is worst
          limit = maxval(of_sides(:, trigger%element))*trigger%limit/trigger%value
          do e = 1, size(sides, 2)
            if (.not. maxval(of_sides(:, e)) > aim*limit) cycle
            length = length_of(x(:, sides(3, e)) - x(:, sides(1, e)))
            need%x = x(:, sides(2, e))
            need%size = max(aim*limit/maxval(of_sides(:, e)), least_share)*length
            need%radius = 0.5_wp*length
            needs = [needs, need]
          end do
        end associate
      end associate
    end do
  end subroutine needs_of_misfits

end module contact_misfits
