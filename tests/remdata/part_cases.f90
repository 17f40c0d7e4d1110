!> Parts in contact for the tests of corrected contours.
module part_cases
  use block_mesh, only: block_t, side_parabola
  use contact_ends, only: contact_end_t
  use contour_cases, only: add_block, add_contact, add_die, begin_scene, box, ends_of, polyline, start, touch
  use corrected_contours, only: contour_report_t, contour_t
  use dies, only: die_t, finish_die
  use fields, only: displacement_field, pilot_field
  use kinds, only: wp
  use loads, only: fixation_t
  use scene, only: scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: bottom, count_of, disputed_case, folded_billet, left, right, volume_is_kept

contains

  !> The bottom of a part, one parabola y = 0.2 x**2 - 0.1 from 1 (x = -1) to 3 (x = 1) with 2 in the middle; it dips into a die
  !> of two parabolas that meet in a corner 103 at x = 0.45, from A at x = 0.2 to B at x = 0.8. 102 and 104 are their middles.
  subroutine disputed_case(scene, solution, ends)
    type(scene_t), intent(out) :: scene
    type(solution_t), intent(out) :: solution
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    type(block_t) :: block
    type(die_t) :: die
    integer :: k

    call begin_scene(scene, .false.)
    block = box([-1.0_wp, 0.1_wp], [1.0_wp, 1.1_wp], [1, 1])
    block%form(1) = side_parabola
    block%point(:, 1) = [0.0_wp, -0.1_wp]
    call add_block(scene, 'part', block)
    allocate (die%pieces(2, 3, 2))
    die%pieces(1, :, :) = reshape([-0.35_wp, 0.05_wp, 0.45_wp, 0.45_wp, 0.7_wp, 0.95_wp], [3, 2])
    do k = 1, 3
      die%pieces(2, k, :) = [left(die%pieces(1, k, 1)), right(die%pieces(1, k, 2))]
    end do
    call finish_die(die)
    die%name = 'tool'
    call add_die(scene, die)
    call add_contact(scene, 1, 1, -3)
    call start(scene, solution)
    solution%groups(2)%committed(2, 2, 1) = 1
    allocate (ends(2))
    ends(1) = contact_end_t(.true., 2, 1, 0.2_wp, 1, (0.2_wp - 0.05_wp)/0.4_wp)
    ends(2) = contact_end_t(.false., 2, 1, 0.8_wp, 2, (0.8_wp - 0.7_wp)/0.25_wp)
  end subroutine disputed_case

  pure function bottom(x) result(y)
    real(wp), intent(in) :: x
    real(wp) :: y

    y = 0.2_wp*x**2 - 0.1_wp
  end function bottom

  !> The die before and behind 103: the part's parabola and one that is zero at A, and at B.
  pure function left(x) result(y)
    real(wp), intent(in) :: x
    real(wp) :: y

    y = bottom(x) + 0.3_wp*(x - 0.2_wp)*(1.2_wp - x)
  end function left

  pure function right(x) result(y)
    real(wp), intent(in) :: x
    real(wp) :: y

    y = bottom(x) + 0.3_wp*0.1875_wp/0.2975_wp*(x + 0.4_wp)*(0.8_wp - x)
  end function right

  !> Upper half of a billet about its axis, flattened between dies: its side has bulged and folded onto the die y = 9.95 from
  !> t = sqrt(0.005) below its old corner; the set part.2 ends in that corner, far inside the contact.
  subroutine folded_billet(npoint, scene, solution, ends)
    integer, intent(in) :: npoint
    type(scene_t), intent(out) :: scene
    type(solution_t), intent(out) :: solution
    type(contact_end_t), allocatable, intent(out) :: ends(:)
    type(fixation_t) :: fixations(2)
    integer :: k, g

    call begin_scene(scene, .true.)
    call add_block(scene, 'part', box([0.0_wp, 0.0_wp], [10.0_wp, 15.0_wp], [6, 16]))
    call add_die(scene, polyline(reshape([40.0_wp, 15.0_wp, -1.0_wp, 15.0_wp], [2, 2]), [0.0_wp, 15.0_wp, 0.0_wp]))
    call add_contact(scene, 3, 1, npoint)
    call add_contact(scene, 2, 1, npoint)
    do k = 1, 2
      allocate (fixations(k)%nodes, source=pack(scene%mesh%sides(merge(1, 4, k == 1))%nodes, .true.))
      fixations(k)%component = merge(2, 1, k == 1)
    end do
    deallocate (scene%fixations)
    ! the axis needs no support to stay
    allocate (scene%fixations, source=fixations(:merge(1, 2, npoint == 3)))
    call start(scene, solution)
    solution%fields(pilot_field)%value(:, 1) = [0.0_wp, 9.95_wp, 0.0_wp]
    associate (x => scene%mesh%coordinates, u => solution%fields(displacement_field)%value)
      u(1, :) = x(1, :)*0.5_wp*(1 - (x(2, :)/15)**4)
      u(2, :) = 10*(1 - (1 - x(2, :)/15)**2) - x(2, :)
    end associate
    do g = 2, 3
      call touch(scene, solution, g, 9.95_wp, .true.)
      ! the axis has no surface
      if (g == 2 .and. npoint < 0) then
        where (abs(scene%mesh%coordinates(1, scene%groups(g)%connectivity(3, :))) <= 0) &
          solution%groups(g)%committed(2, size(solution%groups(g)%committed, 2), :) = 0
      end if
    end do
    call ends_of(scene, solution, ends)
  end subroutine folded_billet

  pure function count_of(these) result(n)
    logical, intent(in) :: these(:)
    integer :: n

    n = count(these)
  end function count_of

  !> The corrected contours have the volumes that the bodies had.
  pure function volume_is_kept(contours, report) result(yes)
    type(contour_t), intent(in) :: contours(:)
    type(contour_report_t), intent(in) :: report
    logical :: yes

    yes = all(contours%restored) &
          .and. all(abs(contours%volume_after - contours%volume_before) <= 1.0e-13_wp*maxval(abs(contours%volume_before))) &
          .and. report%volume_error < 1.0e-13_wp
  end function volume_is_kept

end module part_cases
