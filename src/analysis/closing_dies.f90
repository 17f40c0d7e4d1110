!> Rigid dies that go through each other by the motions a deck gives them: no room is left between them for the part.
!>
!> Only surfaces that face each other over a gap at first count: a plate wider than the bore it goes into crosses the wall of
!> that, at a right angle, and nothing is between the two.
module closing_dies
  use contact_outlook, only: moves
  use curve_search, only: closest_facing_point
  use closest_point, only: closest_point_t
  use dies, only: die_t, is_deformable
  use kinds, only: wp
  use parabolas, only: point_on, tangent_on
  use plane_vectors, only: left_of, turned
  use scene, only: pilot_at, scene_t
  use starting_sides, only: extent_of
  use text, only: add => add_text, string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: judge_closing

  !> Instants at which dies are looked at, places on each piece of one.
  integer, parameter :: ninstant = 200, nplace = 16
  !> Surfaces face each other where the cosine between their outer normals is below the negative of this.
  real(wp), parameter :: opposed = 0.5_wp
  !> Dies that are deeper in each other than this share of the way of one to the other do not just close.
  real(wp), parameter :: slight = 1.0e-3_wp

contains

  !> A line for each pair of rigid dies with contact, the first instant and the place.
  subroutine judge_closing(scene, warnings)
    type(scene_t), intent(in) :: scene                           !! as the deck gives it
    type(string_t), allocatable, intent(inout) :: warnings(:)    !! (nwarning) lines
    logical :: used(size(scene%dies))
    integer :: a, b

    do a = 1, size(scene%dies)
      ! where a force or a spring puts a die is not known
      used(a) = any(scene%groups%die == a .and. scene%groups%material > 0) .and. .not. is_deformable(scene%dies(a)) &
                .and. .not. any(scene%die_forces%die == a) .and. .not. any(scene%groups%die == a .and. scene%groups%component > 0)
    end do
    do a = 1, size(scene%dies)
      do b = 1, size(scene%dies)
        if (a == b .or. .not. (used(a) .and. used(b))) cycle
        ! places of the one that moves are looked at; of two that move, of the first
        if (.not. moves(scene, b) .or. moves(scene, a) .and. a < b) cycle
        call judge_pair(scene, a, b, warnings)
      end do
    end do
  end subroutine judge_closing

  !> Places of die b from instant to instant before die a.
  subroutine judge_pair(scene, a, b, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: a, b
    type(string_t), allocatable, intent(inout) :: warnings(:)
    logical, allocatable :: faced(:), faces(:)
    real(wp), allocatable :: depth(:), before(:), places(:, :)
    real(wp) :: time, reach, way, pilots(3, 2), last(3, 2)
    integer :: k, at

    reach = 4*extent_of(scene)
    last = reshape([pilot_at(scene, a, scene%strategy%begins), pilot_at(scene, b, scene%strategy%begins)], [3, 2])
    call look(scene%dies(a), scene%dies(b), last, reach, faced, before, places)
    way = 0
    do k = 1, ninstant
      time = scene%strategy%begins + (scene%strategy%end_time - scene%strategy%begins)*k/ninstant
      pilots = reshape([pilot_at(scene, a, time), pilot_at(scene, b, time)], [3, 2])
      way = way + length_of(pilots(1:2, 2) - last(1:2, 2) - pilots(1:2, 1) + last(1:2, 1))
      last = pilots
      call look(scene%dies(a), scene%dies(b), pilots, reach, faces, depth, places)
      ! behind the surface that it faced over a gap
      faced = faced .and. faces
      if (any(faced .and. before < 0 .and. depth > slight*way)) then
        at = maxloc(depth, 1, faced .and. before < 0)
        call add(warnings, 'dies '//scene%dies(b)%name//' and '//scene%dies(a)%name//' go through each other by their motions: ' &
                 //'no room is left for the part from about time '//to_text(time, 3)//' on, at '//to_text(places(1, at), 4) &
                 //' '//to_text(places(2, at), 4)//' (a shorter stroke, or dies that end where they should not meet)')
        return
      end if
      faced = faces
      where (.not. (faced .and. before < 0 .and. depth >= 0)) before = depth
    end do
  end subroutine judge_pair

  !> Depth in die a of the places of die b, and whether the surfaces face each other there.
  subroutine look(a, b, pilots, reach, faces, depth, places)
    type(die_t), intent(in) :: a, b
    real(wp), intent(in) :: pilots(3, 2)                   !! of a and b (x, y, angle) [length and radian]
    real(wp), intent(in) :: reach                          !! [length]
    logical, allocatable, intent(out) :: faces(:)          !! (nplace*npiece)
    real(wp), allocatable, intent(out) :: depth(:)         !! below 0 for a gap (nplace*npiece) [length]
    real(wp), allocatable, intent(out) :: places(:, :)     !! (2, nplace*npiece) [length]
    type(closest_point_t) :: closest
    real(wp) :: outward(2), xi
    integer :: k, i, n

    allocate (faces(nplace*size(b%pieces, 3)), depth(nplace*size(b%pieces, 3)), places(2, nplace*size(b%pieces, 3)))
    n = 0
    do k = 1, size(b%pieces, 3)
      do i = 1, nplace
        n = n + 1
        xi = -1 + (2*i - 1)/real(nplace, wp)
        places(:, n) = pilots(1:2, 2) + turned(point_on(b%pieces(:, :, k), xi), pilots(3, 2))
        outward = turned(left_of(tangent_on(b%pieces(:, :, k), xi)), pilots(3, 2) - pilots(3, 1))
        ! the part between the two would face a with its side there
        call closest_facing_point(a, turned(places(:, n) - pilots(1:2, 1), -pilots(3, 1)), -outward, reach, closest)
        faces(n) = closest%piece > 0
        if (faces(n)) faces(n) = .not. closest%at_vertex .and. dot_product(closest%normal, outward) > opposed
        depth(n) = closest%d
      end do
    end do
  end subroutine look

end module closing_dies
