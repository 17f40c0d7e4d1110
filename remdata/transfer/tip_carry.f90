!> Transfer of the force of a node that stands in a corner of a die, at an end of a contact interval: the point of a wedge on a
!> plane of symmetry.
!>
!> It bears more than the faces beside it, in a direction of its own that its support gives it, and its pressure says nothing of
!> theirs: spread along an inclined face it would press there with another force, and several times as large. What it has beyond its
!> neighbour's pressure goes to the node of the new mesh in the same place.
module tip_carry
  use corner_weights, only: handing_over
  use dies, only: die_t, is_deformable
  use interval_points, only: interval_points_t, status_row
  use kinds, only: wp
  use new_interval_points, only: round_off
  use scene, only: scene_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: ends_in_tips, put_on, take_off

contains

  !> Whether the points at the beginning and the end of an interval are in a corner of their rigid die, and a support holds the
  !> node.
  pure function ends_in_tips(scene, g, row, state) result(in_tip)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g                     !! contact group
    type(interval_points_t), intent(in) :: row   !! of the old mesh
    real(wp), intent(in) :: state(:, :, :)       !! (component, point, side) [unit of each component]
    logical :: in_tip(2)
    integer :: piece, xi, p, k

    in_tip = .false.
    if (is_deformable(scene%dies(scene%groups(g)%die)) .or. status_row(scene, g) == 0) return
    associate (variables => scene%groups(g)%variables, sides => scene%groups(g)%connectivity, x => scene%mesh%coordinates)
      piece = find_variable(variables, 'die_piece')
      xi = find_variable(variables, 'die_xi')
      if (piece == 0 .or. xi == 0) return
      do p = 1, size(row%s)
        do k = 1, 2
          if (row%offset(p) /= 0 .or. .not. is_at_end(row, p, k)) cycle
          associate (point => state(:, row%point(p), row%element(p)), side => sides(:, row%element(p)))
            if (nint(point(status_row(scene, g))) == 0 .or. nint(point(variables(piece)%first)) == 0) cycle
            if (.not. any([is_held(scene, side(1)), is_held(scene, side(3))])) cycle
            if (is_in_corner(scene%dies(scene%groups(g)%die), nint(point(variables(piece)%first)), point(variables(xi)%first), &
                             handing_over*length_of(x(:, side(3)) - x(:, side(1))))) in_tip(k) = .true.
          end associate
        end do
      end do
    end associate
  end function ends_in_tips

  !> A node has a prescribed displacement.
  pure function is_held(scene, node) result(held)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: node
    logical :: held
    integer :: k

    held = .false.
    do k = 1, size(scene%fixations)
      held = held .or. any(scene%fixations(k)%nodes == node)
    end do
  end function is_held

  !> A place on a piece of a die is no farther than `reach` from a corner at its end.
  pure function is_in_corner(die, piece, xi, reach) result(yes)
    type(die_t), intent(in) :: die
    integer, intent(in) :: piece
    real(wp), intent(in) :: xi      !! [-]
    real(wp), intent(in) :: reach   !! [length]
    logical :: yes
    integer :: c

    yes = .false.
    associate (points => die%pieces(:, :, piece))
      if (0.5_wp*(1 - abs(xi))*length_of(points(:, 3) - points(:, 1)) > reach) return
      do c = 1, size(die%corners, 2)
        yes = yes .or. length_of(die%corners(1:2, c) - points(:, merge(1, 3, xi < 0))) <= round_off*reach
      end do
    end associate
  end function is_in_corner

  !> Take off what the points at an end have beyond the one next to them, where the new mesh has points there: as integrals.
  pure subroutine take_off(row, row_new, which, conserved, values, integrals)
    type(interval_points_t), intent(in) :: row, row_new
    integer, intent(in) :: which                !! 1 the beginning, 2 the end of the interval
    logical, intent(in) :: conserved(:)         !! (component) its integral is kept
    real(wp), intent(inout) :: values(:, :)     !! (component, npoint) [unit of each component]
    real(wp), intent(out) :: integrals(:)       !! (component) [unit of each component * length]
    logical :: here(size(row%s))
    integer :: p, v, next

    integrals = 0
    if (.not. sum(row_new%weight, mask=[(is_at_end(row_new, p, which), p=1, size(row_new%s))]) > 0) return
    here = [(is_at_end(row, p, which), p=1, size(here))]
    if (all(here)) return
    next = merge(minloc(row%s, 1, mask=.not. here), maxloc(row%s, 1, mask=.not. here), which == 1)
    do p = 1, size(here)
      if (.not. here(p)) cycle
      do v = 1, size(values, 1)
        if (.not. conserved(v) .or. abs(values(v, p)) <= abs(values(v, next))) cycle
        integrals(v) = integrals(v) + row%weight(p)*(values(v, p) - values(v, next))
        values(v, p) = values(v, next)
      end do
    end do
  end subroutine take_off

  !> Put it on the points of the new mesh there.
  pure subroutine put_on(row, which, integrals, values)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: which
    real(wp), intent(in) :: integrals(:)      !! (component) [unit of each component * length]
    real(wp), intent(inout) :: values(:, :)   !! (component, npoint) [unit of each component]
    logical :: here(size(row%s))
    integer :: p

    here = [(is_at_end(row, p, which), p=1, size(here))]
    if (.not. sum(row%weight, mask=here) > 0) return
    do p = 1, size(here)
      if (here(p)) values(:, p) = values(:, p) + integrals/sum(row%weight, mask=here)
    end do
  end subroutine put_on

  !> A point is at the beginning (1) or the end (2) of its interval.
  pure function is_at_end(row, p, which) result(yes)
    type(interval_points_t), intent(in) :: row
    integer, intent(in) :: p, which
    logical :: yes

    yes = abs(row%s(p) - merge(0.0_wp, row%length, which == 1)) <= round_off*row%length
  end function is_at_end

end module tip_carry
