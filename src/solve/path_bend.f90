!> How the path of the last two steps bends: what an extrapolation of second order adds to the last motion in proportion.
!>
!> With the velocities v0 and v1 of the last two steps of lengths h0 and h1 the velocity in the middle of the next one, of length h,
!> is v1 + (v1 - v0) (h1 + h)/(h0 + h1), so that its motion is h v1 and
!>
!>     bend = (v1 - v0) h (h1 + h)/(h0 + h1)
!>
!> (E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, Springer 1993, sec. III.5: divided differences on
!> steps of unlike lengths).
module path_bend
  use dofs, only: dofs_t
  use fields, only: displacement_field, pilot_field, section_field
  use kinds, only: wp
  use solution, only: solution_t
  implicit none
  private
  public :: bend_of_path

  !> A bend above this share of the motion is none that goes on.
  real(wp), parameter :: steady = 0.1_wp
  !> Nor is there one in a step below this share of the last: it is short since others failed.
  real(wp), parameter :: shortened = 0.3_wp

contains

  !> Bend of the motion of nodes, dies and the section in the next step; 0 where two steps do not tell.
  pure function bend_of_path(dofs, solution, dt) result(bend)
    type(dofs_t), intent(in) :: dofs
    type(solution_t), intent(in) :: solution
    real(wp), intent(in) :: dt     !! of the next step [time]
    real(wp) :: bend(dofs%ndof)    !! [unknown]
    integer, parameter :: moving(3) = [displacement_field, pilot_field, section_field]
    real(wp) :: turned, moved, ahead
    integer :: f, i, k, c

    bend = 0
    turned = 0
    moved = 0
    if (.not. solution%older_step > 0 .or. .not. dt > shortened*solution%last_step) return
    ahead = dt*(solution%last_step + dt)/(solution%older_step + solution%last_step)
    do i = 1, size(moving)
      f = moving(i)
      associate (field => solution%fields(f), number => dofs%fields(f)%number)
        do k = 1, size(number, 2)
          do c = 1, size(number, 1)
            if (.not. number(c, k) > 0) cycle
            bend(number(c, k)) = ahead*(field%last_increment(c, k)/solution%last_step &
                                        - field%older_increment(c, k)/solution%older_step)
            if (f /= displacement_field) cycle
            turned = turned + bend(number(c, k))**2
            moved = moved + (dt/solution%last_step*field%last_increment(c, k))**2
          end do
        end do
      end associate
    end do
    if (turned > steady**2*moved) bend = 0
  end function bend_of_path

end module path_bend
