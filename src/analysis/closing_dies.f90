!> Rigid dies that go through each other, or through a plane of symmetry, by the motions a deck gives them: no room is left for the
!> part.
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
  use scene, only: pilot_at, scene_t, wall_t
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

  !> A line for each pair of rigid dies with contact, and for each of them and a plane of symmetry: the first instant and place.
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
      if (.not. (used(a) .and. moves(scene, a) .and. allocated(scene%walls))) cycle
      do b = 1, size(scene%walls)
        call judge_plane(scene, a, scene%walls(b), warnings)
      end do
    end do
  end subroutine judge_closing

  !> Places of a die from instant to instant before a plane of symmetry, opposite to the sides that are held in it: the mirror image
  !> of the die, which is in no deck, comes to meet it there.
  subroutine judge_plane(scene, die, wall, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    type(wall_t), intent(in) :: wall
    type(string_t), allocatable, intent(inout) :: warnings(:)
    logical, allocatable :: faces(:)
    real(wp), allocatable :: height(:), before(:), places(:, :)
    real(wp) :: time, way, pilot(3), last(3), ends(2)
    integer :: k, at, along

    along = 3 - wall%component
    ends = [huge(ends), -huge(ends)]
    do k = 1, size(scene%fixations)
      associate (support => scene%fixations(k), x => scene%mesh%coordinates)
        if (support%label /= wall%label .or. support%component /= wall%component) cycle
        ends = [min(ends(1), minval(x(along, support%nodes))), max(ends(2), maxval(x(along, support%nodes)))]
      end associate
    end do
    last = pilot_at(scene, die, scene%strategy%begins)
    way = 0
    do k = 0, ninstant
      time = scene%strategy%begins + (scene%strategy%end_time - scene%strategy%begins)*k/ninstant
      pilot = pilot_at(scene, die, time)
      way = way + length_of(pilot(1:2) - last(1:2))
      last = pilot
      call look_at_plane(scene, die, wall, pilot, ends, faces, height, places)
      if (k > 0) then
        if (any(faces .and. before > 0 .and. height < -slight*way)) then
          at = minloc(height, 1, faces .and. before > 0)
          call add(warnings, 'die '//scene%dies(die)%name//' goes through the plane in which '//wall%label//' holds the part, by ' &
                   //'its motion: no room is left for the part from about time '//to_text(time, 3)//' on, at ' &
                   //to_text(places(1, at), 4)//' '//to_text(places(2, at), 4)//' (a shorter stroke)')
          return
        end if
        where (before > 0 .and. height > 0) before = height
      else
        before = height
      end if
    end do
  end subroutine judge_plane

  !> Height of the places of a die above a plane of symmetry, and whether they face it opposite to what is held in it.
  pure subroutine look_at_plane(scene, die, wall, pilot, ends, faces, height, places)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    type(wall_t), intent(in) :: wall
    real(wp), intent(in) :: pilot(3)   !! x, y, angle [length and radian]
    real(wp), intent(in) :: ends(2)    !! of the sides that are held, along the plane [length]
    logical, allocatable, intent(out) :: faces(:)        !! (nplace*npiece)
    real(wp), allocatable, intent(out) :: height(:)      !! (nplace*npiece) [length]
    real(wp), allocatable, intent(out) :: places(:, :)   !! (2, nplace*npiece) [length]
    real(wp) :: outward(2), xi
    integer :: k, i, n, along

    along = 3 - wall%component
    associate (pieces => scene%dies(die)%pieces)
      allocate (faces(nplace*size(pieces, 3)), height(nplace*size(pieces, 3)), places(2, nplace*size(pieces, 3)))
      do k = 1, size(pieces, 3)
        do i = 1, nplace
          n = nplace*(k - 1) + i
          xi = -1 + (2*i - 1)/real(nplace, wp)
          places(:, n) = pilot(1:2) + turned(point_on(pieces(:, :, k), xi), pilot(3))
          outward = turned(left_of(tangent_on(pieces(:, :, k), xi)), pilot(3))
          height(n) = wall%side*(places(wall%component, n) - scene%mesh%coordinates(wall%component, wall%node))
          faces(n) = wall%side*outward(wall%component) < -opposed*length_of(outward) &
                     .and. places(along, n) > ends(1) .and. places(along, n) < ends(2)
        end do
      end do
    end associate
  end subroutine look_at_plane

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
