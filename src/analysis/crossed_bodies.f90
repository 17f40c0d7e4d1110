!> Bodies that have gone through each other at the end of a run: no contact was asked for between them.
module crossed_bodies
  use arc_crossings, only: crossings_between, find_meeting_arcs, most_crossings
  use kinds, only: wp
  use offset_parabolas, only: offset_parabola_t, point_at
  use own_crossings, only: free_sides_t
  use plane_vectors, only: cross
  use scene, only: scene_t
  use solution, only: present_coordinates, solution_t
  use text, only: add_text, string_t, to_text
  use touching_bodies, only: are_in_contact
  use vectors, only: length_of
  implicit none
  private
  public :: warn_of_crossed_bodies

  !> Sides cross where they are not parallel (sine between their chords), and not near the ends of both: bodies that only touch
  !> have no such sides.
  real(wp), parameter :: least_sine = 0.1_wp, near_end = 0.98_wp

contains

  !> A line for the first crossing of free sides of two bodies without contact between them.
  subroutine warn_of_crossed_bodies(scene, sides, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(free_sides_t), intent(in) :: sides   !! none where the geometry does not follow
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    type(offset_parabola_t) :: arcs(size(sides%nodes, 2))
    real(wp) :: xi(2, most_crossings), x(2, size(scene%mesh%coordinates, 2)), place(2)
    integer, allocatable :: pairs(:, :)
    integer :: number, i, m, r

    if (size(arcs) == 0) return
    if (all(sides%body == sides%body(1))) return
    x = present_coordinates(scene, solution)
    do i = 1, size(arcs)
      arcs(i)%points = x(:, sides%nodes(:, i))
    end do
    call find_meeting_arcs(arcs, pairs)
    do m = 1, size(pairs, 2)
      associate (i => pairs(1, m), k => pairs(2, m))
        if (sides%body(k) == sides%body(i)) cycle
        if (sine_between(arcs(i), arcs(k)) < least_sine) cycle
        call crossings_between(arcs(i), arcs(k), number, xi)
        do r = 1, number
          if (all(abs(xi(:, r)) > near_end)) cycle
          if (are_in_contact(scene, sides%body(i), sides%body(k))) exit
          place = point_at(arcs(i), xi(1, r))
          call add_text(warnings, scene%groups(sides%group(i))%name//' and '//scene%groups(sides%group(k))%name &
                        //' have gone through each other, at x = '//to_text(place(1), 5)//', y = '//to_text(place(2), 5) &
                        //': no contact is given between them (DIE name SIDES, CNT2D)')
          return
        end do
      end associate
    end do
  end subroutine warn_of_crossed_bodies

  pure function sine_between(one, two) result(sine)
    type(offset_parabola_t), intent(in) :: one, two
    real(wp) :: sine
    real(wp) :: a(2), b(2)

    a = one%points(:, 3) - one%points(:, 1)
    b = two%points(:, 3) - two%points(:, 1)
    sine = abs(cross(a, b))/(length_of(a)*length_of(b))
  end function sine_between

end module crossed_bodies
