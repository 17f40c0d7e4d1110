!> What can be seen of contact before a run: gaps and depths at the start, and when a die will meet the part by its own motion.
!>
!> Only dies move here, the part stands as it begins: what a die meets first does not depend on how the part deforms.
module contact_outlook
  use curve_search, only: closest_facing_point, closest_on_pieces
  use closest_point, only: closest_point_t
  use dies, only: die_t, in_pilot_axes, is_deformable, present_die
  use kinds, only: wp
  use piecewise_curves, only: adjacent_piece
  use plane_vectors, only: turned
  use scene, only: group_t, pilot_at, scene_t
  use shape_functions, only: line3
  use starting_sides, only: extent_of, sides_at_start
  use vectors, only: length_of
  implicit none
  private
  public :: depth_of_node, gaps_at_rest, lies_on, look_at_contact, moves, outlook_t

  !> Instants at which a moving die is looked at.
  integer, parameter :: ninstant = 50
  !> A die lies on a side where it is no farther off, or deeper in it, than this share of the side.
  real(wp), parameter :: lies_on = 1.0e-6_wp
  !> Shape functions of a side at its nodes.
  real(wp), parameter :: at_node(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1]*1.0_wp, [3, 3])

  !> A die goes into a part, not along it, where it gets deeper by more than this share of its way.
  real(wp), parameter :: across = 0.5_wp

  type :: outlook_t
    !> A side has a closest point on the die at the start, at the end of the die's motion; also where the die ends behind the place
    !> of a part that it goes into, as a punch that bends a sheet does: the part will not stand there then.
    logical :: faces = .false., faces_at_end = .false.
    !> Depth of the deepest node at the start, below 0 for a gap; and over the length of its side.
    real(wp) :: depth = 0.0_wp, over_side = 0.0_wp
    !> First instant at which a node is in the die; below 0 where none is, or where sides lie on it at the start and it never
    !> presses them.
    real(wp) :: first = -1.0_wp
    !> Sides whose element lies in the die's body, of those that have a closest point.
    integer :: inside = 0, seen = 0
    !> Least and largest component along X and Y of the unit vectors along which the die would push the nodes that face it at the
    !> start; the least above the largest where none does.
    real(wp) :: least_push(2) = 1.0_wp, largest_push(2) = -1.0_wp
  end type outlook_t

contains

  !> Outlook of a group that faces a rigid die.
  pure subroutine look_at_contact(scene, group, outlook)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(outlook_t), intent(out) :: outlook
    real(wp), allocatable :: sides(:, :, :), behind(:, :)
    real(wp) :: depth, over_side, time, reach, depth_before, pilot(3), pilot_before(3)
    logical :: faces, pressed, enters
    integer :: k

    associate (die => scene%dies(group%die))
      if (is_deformable(die)) return
      call sides_at_start(scene, group, sides, behind)
      reach = 4*extent_of(scene)
      call deepest(sides, die, pilot_at(scene, group%die, scene%strategy%begins), reach, outlook%faces, outlook%depth, &
                   outlook%over_side)
      call find_pushes(sides, die, reach, outlook)
      call count_inside(behind, die, outlook)
      outlook%faces_at_end = outlook%faces
      if (outlook%faces .and. outlook%depth >= 0) outlook%first = scene%strategy%begins
      if (.not. moves(scene, group%die)) return
      pressed = .false.
      enters = .false.
      pilot_before = pilot_at(scene, group%die, scene%strategy%begins)
      depth_before = outlook%depth
      do k = 1, ninstant
        time = scene%strategy%begins + (scene%strategy%end_time - scene%strategy%begins)*k/ninstant
        pilot = pilot_at(scene, group%die, time)
        call deepest(sides, die, pilot, reach, faces, depth, over_side)
        if (faces) then
          enters = depth > 0 .and. depth - depth_before > across*length_of(pilot(1:2) - pilot_before(1:2))
          depth_before = depth
        end if
        pilot_before = pilot
        pressed = pressed .or. (faces .and. over_side > lies_on)
        if (faces .and. depth >= 0 .and. outlook%first < 0) outlook%first = time
      end do
      if (abs(outlook%over_side) < lies_on .and. faces .and. .not. pressed) outlook%first = -1
      outlook%faces_at_end = faces .or. enters
    end associate
  end subroutine look_at_contact

  !> Gaps of five points of every side to a die at rest, rigid or made of sides: below 0 for a depth, huge where there is no
  !> closest point; in lengths and over that of the side.
  pure subroutine gaps_at_rest(scene, group, gap, over_side)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    real(wp), allocatable, intent(out) :: gap(:, :), over_side(:, :)   !! (5, nside) [length], [-]
    real(wp), parameter :: places(5) = [-0.8_wp, -0.4_wp, 0.0_wp, 0.4_wp, 0.8_wp]
    type(die_t) :: die
    real(wp) :: phi(3), dphi(3)
    real(wp), allocatable :: sides(:, :, :), behind(:, :)
    integer :: e, k
    logical :: faces

    die = present_die(scene%dies(group%die), scene%mesh%coordinates)
    call sides_at_start(scene, group, sides, behind)
    allocate (gap(size(places), size(sides, 3)), over_side(size(places), size(sides, 3)), source=huge(1.0_wp))
    do e = 1, size(sides, 3)
      do k = 1, size(places)
        call line3(places(k), phi, dphi)
        call depth_of(sides(:, :, e), phi, die, die%pilot, 4*extent_of(scene), faces, gap(k, e), over_side(k, e))
        gap(k, e) = merge(-gap(k, e), huge(1.0_wp), faces)
        over_side(k, e) = merge(-over_side(k, e), huge(1.0_wp), faces)
      end do
    end do
  end subroutine gaps_at_rest

  !> The die's pilot is given a motion that is not rest.
  pure function moves(scene, die) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die
    logical :: yes
    integer :: k

    yes = .false.
    do k = 1, size(scene%die_motions)
      associate (motion => scene%die_motions(k))
        if (motion%die /= die .or. motion%multiplier == 0) cycle
        associate (value => scene%multipliers(motion%multiplier)%value)
          yes = yes .or. maxval(abs(motion%amplitude*value)) > 0
        end associate
      end associate
    end do
  end function moves

  !> Depth of the deepest node of the sides, the largest gap closed first.
  pure subroutine deepest(sides, die, pilot, reach, faces, depth, over_side)
    real(wp), intent(in) :: sides(:, :, :)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), reach
    logical, intent(out) :: faces
    real(wp), intent(out) :: depth, over_side
    real(wp) :: d, share
    integer :: e, k
    logical :: found

    faces = .false.
    depth = -huge(depth)
    over_side = 0
    do e = 1, size(sides, 3)
      do k = 1, 3
        call depth_of(sides(:, :, e), at_node(:, k), die, pilot, reach, found, d, share)
        if (.not. found) cycle
        faces = .true.
        if (.not. d > depth) cycle
        depth = d
        over_side = share
      end do
    end do
    if (.not. faces) depth = 0
  end subroutine deepest

  !> Depth in the die of a node of a side, as the deck gives it, over the length of the side: below 0 for a gap, and where no point
  !> of the die is closest.
  pure subroutine depth_of_node(scene, group, side, node, pilot, over_side)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    integer, intent(in) :: side, node      !! number of the side, and 1 to 3
    real(wp), intent(in) :: pilot(3)       !! of the die (x, y, angle) [length and radian]
    real(wp), intent(out) :: over_side     !! [-]
    real(wp) :: depth
    logical :: faces

    call depth_of(scene%mesh%coordinates(:, group%connectivity(:3, side)), at_node(:, node), scene%dies(group%die), pilot, &
                  4*extent_of(scene), faces, depth, over_side)
    if (.not. faces) over_side = -huge(over_side)
  end subroutine depth_of_node

  !> Directions along which a die would push the nodes of sides, where it stands at the start.
  pure subroutine find_pushes(sides, die, reach, outlook)
    real(wp), intent(in) :: sides(:, :, :)   !! (2, 3, nside) [length]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: reach            !! [length]
    type(outlook_t), intent(inout) :: outlook
    real(wp) :: depth, over_side, push(2)
    integer :: e, k
    logical :: found

    do e = 1, size(sides, 3)
      do k = 1, 3
        call depth_of(sides(:, :, e), at_node(:, k), die, die%pilot, reach, found, depth, over_side, push)
        if (.not. found) cycle
        outlook%least_push = min(outlook%least_push, push)
        outlook%largest_push = max(outlook%largest_push, push)
      end do
    end do
  end subroutine find_pushes

  !> Depth of a point of a side, and over the length of the side.
  pure subroutine depth_of(nodes, phi, die, pilot, reach, faces, depth, over_side, push)
    real(wp), intent(in) :: nodes(2, 3)   !! [length]
    real(wp), intent(in) :: phi(3)        !! shape functions at the point [-]
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: pilot(3), reach
    logical, intent(out) :: faces
    real(wp), intent(out) :: depth, over_side
    real(wp), intent(out), optional :: push(2)   !! unit vector along which the die would push the point [-]
    type(closest_point_t) :: closest
    real(wp) :: local(2, 3), chord(2), side

    local = in_pilot_axes(nodes, pilot)
    chord = local(:, 3) - local(:, 1)
    side = length_of(chord)
    call closest_facing_point(die, matmul(local, phi), [-chord(2), chord(1)]/side, reach, closest)
    faces = closest%piece > 0 .and. .not. lies_beyond_end(die, matmul(local, phi), closest%d)
    depth = closest%d
    over_side = depth/side
    if (present(push)) push = -turned(closest%normal, pilot(3))
  end subroutine depth_of

  !> An end of an open curve is nearer to a point than the depth at which it lies behind a piece: the point is beside the die, as a
  !> wire before a drawing die is far below the face at its exit, and not in its body.
  pure function lies_beyond_end(die, place, depth) result(yes)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: place(2)   !! in the pilot's axes [length]
    real(wp), intent(in) :: depth      !! below 0 for a gap [length]
    logical :: yes
    integer :: npiece

    npiece = size(die%pieces, 3)
    yes = .false.
    if (adjacent_piece(die, npiece, 1) > 0) return
    yes = min(length_of(place - die%pieces(:, 1, 1)), length_of(place - die%pieces(:, 3, npiece))) < depth*(1 - lies_on)
  end function lies_beyond_end

  !> Points behind the sides that lie in the die's body: on the right of the curve.
  pure subroutine count_inside(behind, die, outlook)
    real(wp), intent(in) :: behind(:, :)
    type(die_t), intent(in) :: die
    type(outlook_t), intent(inout) :: outlook
    type(closest_point_t) :: closest
    real(wp) :: place(2)
    integer :: e

    do e = 1, size(behind, 2)
      place = turned(behind(:, e) - die%pilot(1:2), -die%pilot(3))
      call closest_on_pieces(die, place, 1, size(die%pieces, 3), closest)
      if (closest%piece == 0 .or. lies_beyond_end(die, place, closest%d)) cycle
      outlook%seen = outlook%seen + 1
      if (closest%d > 0) outlook%inside = outlook%inside + 1
    end do
  end subroutine count_inside

end module contact_outlook
