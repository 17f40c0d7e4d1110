!> Where contours cross themselves or each other: laps that a new mesh would seal or tear.
!>
!> Stretches are looked at as chords; chords that cross are followed to the point where the curves do, by Newton's method. Where
!> two bodies are in contact one lies in the other by the depth of contact: what follows a deformable die may cross that die, and so
!> may sides that face it, where contact covers too little of a side to be a run.
module contour_laps
  use contour_chain, only: chain_t, joint_after, joint_point, kind_entry, kind_exit
  use kinds, only: eps, wp
  use stretches, only: cross, point_at, stretch_t, tangent_at
  use vectors, only: length_of
  implicit none
  private
  public :: lap_t, find_laps

  type :: lap_t
    !> Chains and stretches that cross.
    integer :: chains(2) = 0, stretches(2) = 0
    real(wp) :: point(2) = 0.0_wp   !! [length]
  end type lap_t

  !> Chords of a stretch.
  integer, parameter :: nchord = 8
  !> Ends of contact touch the die: crossings nearer to them than this share of the stretch are none.
  real(wp), parameter :: touching = 1.0e-6_wp
  !> Depths from a corner in contact to where its free side leaves the die: sides that stand at 20 degrees or more.
  real(wp), parameter :: oblique = 3.0_wp

contains

  !> All crossings, in the order of chains and stretches.
  pure subroutine find_laps(chains, on_die, faces, laps)
    type(chain_t), intent(in) :: chains(:)
    integer, intent(in) :: on_die(:, :)        !! deformable die that a side of a chain is a piece of, or 0 (nside, nchain)
    logical, intent(in) :: faces(:, :, :)      !! a side has elements of contact with a die (ndie, nside, nchain)
    type(lap_t), allocatable, intent(out) :: laps(:)
    real(wp), allocatable :: boxes(:, :)
    integer, allocatable :: chain_of(:), stretch_of(:)
    type(lap_t) :: one
    logical :: crossed
    integer :: c, i, k, n

    n = 0
    do c = 1, size(chains)
      n = n + size(chains(c)%stretches)
    end do
    allocate (boxes(4, n), chain_of(n), stretch_of(n), laps(0))
    n = 0
    do c = 1, size(chains)
      do k = 1, size(chains(c)%stretches)
        n = n + 1
        chain_of(n) = c
        stretch_of(n) = k
        boxes(:, n) = box_of(chains(c)%stretches(k))
      end do
    end do
    do i = 1, n
      do k = i + 1, n
        if (any(boxes(1:2, i) > boxes(3:4, k)) .or. any(boxes(1:2, k) > boxes(3:4, i))) cycle
        one%chains = chain_of([i, k])
        one%stretches = stretch_of([i, k])
        if (may_touch(chains, on_die, faces, one)) cycle
        call find_crossing(chains(one%chains(1)), chains(one%chains(2)), one, crossed)
        if (crossed) crossed = .not. is_end_of_die(chains, on_die, one)
        if (crossed) laps = [laps, one]
      end do
    end do
  end subroutine find_laps

  !> Box around the points that the chords join (xmin, ymin, xmax, ymax).
  pure function box_of(stretch) result(box)
    type(stretch_t), intent(in) :: stretch
    real(wp) :: box(4)
    real(wp) :: p(2, 0:nchord)

    p = chord_points(stretch)
    box = [minval(p, 2), maxval(p, 2)]
  end function box_of

  pure function chord_points(stretch) result(p)
    type(stretch_t), intent(in) :: stretch
    real(wp) :: p(2, 0:nchord)
    integer :: k

    do k = 0, nchord
      p(:, k) = point_at(stretch, stretch%range(1) + (stretch%range(2) - stretch%range(1))*k/nchord)
    end do
  end function chord_points

  !> One stretch follows the deformable die that the other one is a side of, or is of a side that faces it.
  pure function may_touch(chains, on_die, faces, lap) result(may)
    type(chain_t), intent(in) :: chains(:)
    integer, intent(in) :: on_die(:, :)
    logical, intent(in) :: faces(:, :, :)
    type(lap_t), intent(in) :: lap
    logical :: may
    integer :: k, other

    may = .false.
    do k = 1, 2
      other = 3 - k
      associate (one => chains(lap%chains(k))%stretches(lap%stretches(k)), &
                 die => on_die(chains(lap%chains(other))%stretches(lap%stretches(other))%side, lap%chains(other)))
        if (die == 0) cycle
        may = may .or. one%die == die .or. faces(die, one%side, lap%chains(k))
      end associate
    end do
  end function may_touch

  !> One stretch goes on over the end of the deformable die that it follows: deep in the die, it leaves it across the side behind.
  pure function is_end_of_die(chains, on_die, lap) result(yes)
    type(chain_t), intent(in) :: chains(:)
    integer, intent(in) :: on_die(:, :)
    type(lap_t), intent(in) :: lap
    logical :: yes
    integer :: k, i, n, die, stretch, before

    yes = .false.
    do k = 1, 2
      die = chains(lap%chains(k))%stretches(lap%stretches(k))%die
      if (die == 0) cycle
      associate (other => chains(lap%chains(3 - k)), on => on_die(:, lap%chains(3 - k)))
        n = size(other%stretches)
        do i = 0, 1
          stretch = modulo(lap%stretches(3 - k) + i - 1, n) + 1
          before = modulo(stretch - 2, n) + 1
          if (on(other%stretches(stretch)%side) /= die .and. on(other%stretches(before)%side) /= die) cycle
          yes = yes .or. length_of(joint_point(other, stretch) - lap%point) &
                <= oblique*maxval(abs(chains(lap%chains(k))%stretches(lap%stretches(k))%depth))
        end do
      end associate
    end do
  end function is_end_of_die

  !> The first crossing of two stretches, if there is one besides a joint that they share.
  pure subroutine find_crossing(chain, other, lap, crossed)
    type(chain_t), intent(in) :: chain, other
    type(lap_t), intent(inout) :: lap
    logical, intent(out) :: crossed
    real(wp) :: p(2, 0:nchord), q(2, 0:nchord), xi(2)
    logical :: follow
    integer :: i, k

    crossed = .false.
    follow = lap%chains(1) == lap%chains(2) .and. (joint_after(chain, lap%stretches(1)) == lap%stretches(2) .or. &
                                                   joint_after(chain, lap%stretches(2)) == lap%stretches(1))
    associate (one => chain%stretches(lap%stretches(1)), two => other%stretches(lap%stretches(2)))
      p = chord_points(one)
      q = chord_points(two)
      do i = 1, nchord
        do k = 1, nchord
          if (.not. chords_cross(p(:, i - 1:i), q(:, k - 1:k))) cycle
          xi = [one%range(1) + (one%range(2) - one%range(1))*(i - 0.5_wp)/nchord, &
                two%range(1) + (two%range(2) - two%range(1))*(k - 0.5_wp)/nchord]
          call settle(one, two, xi, crossed)
          if (.not. crossed) cycle
          lap%point = point_at(one, xi(1))
          crossed = .not. (is_shared(one, two, follow, lap%point) .or. is_end_of_contact(chain, lap%stretches(1), lap%point) &
                           .or. is_end_of_contact(other, lap%stretches(2), lap%point))
          if (crossed) return
        end do
      end do
    end associate
  end subroutine find_crossing

  !> The point is the joint of two stretches that follow each other, or a node that two loops have in common.
  pure function is_shared(one, two, follow, point) result(shared)
    type(stretch_t), intent(in) :: one, two
    logical, intent(in) :: follow
    real(wp), intent(in) :: point(2)
    logical :: shared
    real(wp) :: p(2), q(2)
    integer :: i, k

    shared = .false.
    do i = 1, 2
      do k = 1, 2
        p = point_at(one, one%range(i))
        q = point_at(two, two%range(k))
        if (.not. follow .and. any(abs(p - q) > 0)) cycle
        shared = shared .or. max(length_of(p - point), length_of(q - point)) <= touching*min(extent(one), extent(two))
      end do
    end do
  end function is_shared

  !> The point is where contact begins or ends on a stretch, or as near to that as it is deep.
  pure function is_end_of_contact(chain, k, point) result(yes)
    type(chain_t), intent(in) :: chain
    integer, intent(in) :: k
    real(wp), intent(in) :: point(2)
    logical :: yes
    real(wp) :: slack
    integer :: joint, before

    yes = .false.
    do joint = 1, size(chain%kinds)
      if (chain%kinds(joint) /= kind_entry .and. chain%kinds(joint) /= kind_exit) cycle
      before = merge(size(chain%kinds), joint - 1, joint == 1)
      if (joint /= k .and. before /= k) cycle
      slack = touching*extent(chain%stretches(k)) + oblique*max(abs(chain%stretches(joint)%depth(1)), &
                                                               abs(chain%stretches(before)%depth(2)))
      yes = yes .or. length_of(joint_point(chain, joint) - point) <= slack
    end do
  end function is_end_of_contact

  pure function extent(stretch) result(length)
    type(stretch_t), intent(in) :: stretch
    real(wp) :: length

    length = length_of(stretch%points(:, 3) - stretch%points(:, 1))
  end function extent

  !> The ends of each chord lie on both sides of the other one, what lies on it being on its left.
  pure function chords_cross(p, q) result(yes)
    real(wp), intent(in) :: p(2, 2), q(2, 2)
    logical :: yes
    real(wp) :: a(2), b(2)

    a = p(:, 2) - p(:, 1)
    b = q(:, 2) - q(:, 1)
    yes = (cross(a, q(:, 1) - p(:, 1)) < 0 .neqv. cross(a, q(:, 2) - p(:, 1)) < 0) .and. &
          (cross(b, p(:, 1) - q(:, 1)) < 0 .neqv. cross(b, p(:, 2) - q(:, 1)) < 0)
  end function chords_cross

  !> Newton's method on X1(a) - X2(b) = 0 from where the chords cross.
  pure subroutine settle(one, two, xi, met)
    type(stretch_t), intent(in) :: one, two
    real(wp), intent(inout) :: xi(2)
    logical, intent(out) :: met
    real(wp) :: gap(2), a(2), b(2), det, step(2), slack(2)
    integer :: iteration
    integer, parameter :: most_iterations = 30

    slack = touching*[one%range(2) - one%range(1), two%range(2) - two%range(1)]
    met = .false.
    do iteration = 1, most_iterations
      gap = point_at(one, xi(1)) - point_at(two, xi(2))
      a = tangent_at(one, xi(1))
      b = tangent_at(two, xi(2))
      det = cross(a, b)
      if (.not. abs(det) > eps*length_of(a)*length_of(b)) return
      step = [-cross(gap, b), -cross(gap, a)]/det
      xi = min(max(xi + step, [one%range(1), two%range(1)]), [one%range(2), two%range(2)])
      if (maxval(abs(step)) <= 64*eps) exit
    end do
    gap = point_at(one, xi(1)) - point_at(two, xi(2))
    met = all(abs(step) <= slack) .and. length_of(gap) <= touching*min(extent(one), extent(two))
  end subroutine settle

end module contour_laps
