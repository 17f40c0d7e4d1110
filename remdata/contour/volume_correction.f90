!> The boundary curve of a contour with the volume that it had.
!>
!> Where contact replaces the part's sides by the die's the volume changes slightly; a small uniform displacement of the free sides
!> restores it. Sides with supports, on walls, in contact, and those that are dies of another body are not moved.
module volume_correction
  use boundary_curves, only: closest_position, point_on, position_t
  use contour_assembly, only: assemble_boundary
  use contour_volume, only: shift_sides, volume_inside, volume_of_loop
  use corrected_contours, only: contour_options_t, contour_t
  use folded_sides, only: fold_t, own_sides
  use kinds, only: wp
  use loop_intervals, only: side_point_t
  use scene, only: axisymmetric, scene_t
  use short_die_arcs, only: drop_short_die_arcs
  use short_free_sides, only: drop_short_grounds, drop_short_sides
  use small_laps, only: cut_small_laps
  use vectors, only: length_of
  implicit none
  private
  public :: keep_volume

  !> The free sides are moved at most so many times, until the volume is the old one to the first of these shares; it is accepted
  !> when it is so to the second.
  integer, parameter :: most_shifts = 8
  real(wp), parameter :: same_volume = 1.0e-14_wp, kept_volume = 1.0e-13_wp

contains

  !> The boundary curve, and the displacement of the free sides that keeps the volume.
  pure subroutine keep_volume(scene, x, uncorrected, held, options, joints, contour)
    type(scene_t), intent(in) :: scene
    real(wp), intent(in) :: x(:, :)             !! (2, nnode) now, those on walls limited in depth [length]
    real(wp), intent(in) :: uncorrected(:, :)   !! (2, nnode) now, with folds opened [length]
    logical, intent(in) :: held(:)              !! (nnode) fixed nodes
    type(contour_options_t), intent(in) :: options
    type(side_point_t), intent(in) :: joints(:)   !! (njoint) ends of contact with other bodies
    type(contour_t), intent(inout) :: contour
    real(wp) :: moved(2, size(x, 2))
    logical :: may_move(size(contour%loop%sides, 2)), own(size(may_move)), round
    type(position_t) :: position
    real(wp) :: shift, gain
    logical :: moves
    integer :: k, i

    round = scene%plane_state == axisymmetric
    own = own_sides(scene, contour%tags)
    contour%volume_before = volume_of_loop(contour%loop, uncorrected, round)
    call draw_boundary(x, own, options, joints, contour)
    contour%volume_after = volume_inside(contour%boundary, round)
    if (size(contour%contacts) + size(contour%points) == 0) return
    moved = x
    may_move = .not. (contour%tags%on_wall .or. any(contour%tags%on_die, 1))
    do k = 1, size(contour%contacts)
      associate (interval => contour%contacts(k)%interval)
        do i = min(interval%from%side, interval%found(1)%side), max(interval%to%side, interval%found(2)%side)
          may_move(modulo(i - 1, size(may_move)) + 1) = .false.
        end do
      end associate
    end do
    may_move(contour%points%place%side) = .false.
    ! where the contour follows a die past the end of contact, the rest of a side depends on the position of the side
    do i = 1, most_shifts
      gain = contour%volume_before - contour%volume_after
      if (i > 1 .and. abs(gain) <= same_volume*abs(contour%volume_before)) exit
      call shift_sides(contour%loop, may_move, held, round, gain, moved, shift, moves)
      if (.not. moves) exit
      contour%shift = contour%shift + shift
      call draw_boundary(moved, own, options, joints, contour)
      contour%volume_after = volume_inside(contour%boundary, round)
    end do
    contour%restored = abs(contour%volume_before - contour%volume_after) <= kept_volume*abs(contour%volume_before)
    do k = 1, size(may_move)
      do i = 1, 2
        position = closest_position(contour%boundary, x(:, contour%loop%sides(i, k)))
        contour%largest_move = max(contour%largest_move, &
                                   length_of(point_on(contour%boundary, position) - x(:, contour%loop%sides(i, k))))
      end do
    end do
  end subroutine keep_volume

  !> The boundary curve of a contour with its nodes at x.
  pure subroutine draw_boundary(x, own, options, joints, contour)
    real(wp), intent(in) :: x(:, :)   !! (2, nnode) [length]
    logical, intent(in) :: own(:)     !! (nside) sides that face their own body
    type(contour_options_t), intent(in) :: options
    type(side_point_t), intent(in) :: joints(:)   !! (njoint) ends of contact with other bodies
    type(contour_t), intent(inout) :: contour

    call assemble_boundary(contour%loop, contour%tags, x, options%corner_turn, joints, contour%contacts, contour%boundary)
    if (options%least_free > 0) then
      call drop_short_die_arcs(options%least_free, contour%tags, contour%contacts, contour%boundary)
      call drop_short_sides(options%least_free, contour%tags, contour%contacts, contour%boundary)
      call drop_short_grounds(options%least_free, own, contour%tags, contour%contacts, contour%boundary)
    end if
    contour%laps = [fold_t ::]
    if (options%longest_lap > 0) &
      call cut_small_laps(options%longest_lap, contour%tags, contour%contacts, contour%boundary, contour%laps)
  end subroutine draw_boundary

end module volume_correction
