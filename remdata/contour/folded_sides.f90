!> Folds of a body: sides that lie on other sides of their own body (own_contact).
!>
!> Both overlap by the depth of contact, and a contour that crosses itself cannot be meshed. So both are moved back by the depth,
!> or, where that is more, by what new sides, straight to the mesher and with their ends elsewhere, may miss of wavy ones: the
!> contour follows the fold to its ground. On the new mesh they are moved together again (fold_closing). Nodes move against the
!> sides' normals, along what their supports leave free; at the ground of a fold, where normals face each other, they stay.
module folded_sides
  use fields, only: displacement_field
  use kinds, only: wp
  use own_contact, only: faces_itself
  use quadrature, only: line_rule
  use scene, only: axisymmetric, scene_t
  use shape_functions, only: line3
  use solution, only: solution_t
  use side_tags, only: side_tags_t
  use state_variables, only: find_variable
  use vectors, only: length_of
  implicit none
  private
  public :: fold_t, open_folds, own_sides

  !> A fold: sides in contact one after the other along the die that they are; what is open between two of their points belongs to
  !> it.
  type :: fold_t
    !> Ends of the contact, and the length between them along the sides that have the points of contact [length].
    real(wp) :: from(2) = 0.0_wp, to(2) = 0.0_wp, length = 0.0_wp
  end type fold_t

  !> Sides are moved by this share of their chord at least.
  real(wp), parameter :: least_move = 0.03_wp
  !> Sum of unit normals below which a node is the ground of a fold, over their number.
  real(wp), parameter :: ground = 0.3_wp

contains

  !> Sides of a loop that face their own body.
  pure function own_sides(scene, tags) result(own)
    type(scene_t), intent(in) :: scene
    type(side_tags_t), intent(in) :: tags
    logical :: own(size(tags%on_group, 2))   !! (nside)
    integer :: g

    own = .false.
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0 .or. .not. faces_itself(scene, scene%groups(g))) cycle
      own = own .or. tags%on_group(g, :)
    end do
  end function own_sides

  !> List the folds and move their sides apart.
  subroutine open_folds(scene, solution, x, folds, opened)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    real(wp), intent(inout) :: x(:, :)                 !! (2, nnode) now [length]
    type(fold_t), allocatable, intent(out) :: folds(:)   !! (nfold)
    !> Moves of the nodes (2, nnode), where there are folds [length].
    real(wp), allocatable, intent(out) :: opened(:, :)
    real(wp) :: normal(2, size(x, 2)), move(size(x, 2)), way(2)
    integer :: number(size(x, 2)), g, k

    allocate (folds(0))
    normal = 0
    move = 0
    number = 0
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0 .or. .not. faces_itself(scene, scene%groups(g))) cycle
      call add_group(scene, g, solution%groups(g)%committed, x, normal, move, number, folds)
    end do
    if (size(folds) == 0) return
    allocate (opened, source=x)
    do k = 1, size(scene%fixations)
      associate (fixation => scene%fixations(k))
        if (fixation%field == displacement_field) normal(fixation%component, fixation%nodes) = 0
      end associate
    end do
    if (scene%plane_state == axisymmetric) then
      where (.not. x(1, :) > 0) normal(1, :) = 0
    end if
    do k = 1, size(x, 2)
      way = normal(:, k)
      if (number(k) == 0 .or. length_of(way) <= ground*number(k)) cycle
      x(:, k) = x(:, k) + move(k)*way/length_of(way)
    end do
    opened = x - opened
  end subroutine open_folds

  !> Sides of a group in contact, in the order of the die, and those that they lie on.
  subroutine add_group(scene, g, state, x, normal, move, number, folds)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp), intent(in) :: state(:, :, :), x(:, :)
    real(wp), intent(inout) :: normal(:, :), move(:)
    integer, intent(inout) :: number(:)
    type(fold_t), allocatable, intent(inout) :: folds(:)
    real(wp), allocatable :: xi(:), weight(:), depth(:)
    logical, allocatable :: touches(:)
    real(wp) :: phi(3), dphi(3), point(2), beside
    logical :: goes_on
    type(fold_t) :: fold
    integer :: e, p, k, status, penetration, piece

    call line_rule(scene%groups(g)%rule, xi, weight)
    goes_on = .false.
    beside = 0
    associate (group => scene%groups(g), nodes => scene%dies(scene%groups(g)%die)%nodes)
      status = group%variables(find_variable(group%variables, 'contact_status'))%first
      penetration = group%variables(find_variable(group%variables, 'penetration'))%first
      piece = group%variables(find_variable(group%variables, 'die_piece'))%first
      allocate (depth(size(nodes, 2)), source=0.0_wp)
      allocate (touches(size(nodes, 2)), source=.false.)
      do k = 1, size(nodes, 2)
        e = findloc(group%connectivity(2, :), nodes(2, k), 1)
        if (e > 0) then
          ! zero when open
          if (all(nint(state(status, :, e)) == 0)) e = 0
        end if
        if (e == 0) then
          call end_fold()
          cycle
        end if
        ! the die is walked against the contour
        do p = size(xi), 1, -1
          call line3(xi(p), phi, dphi)
          beside = beside + weight(p)*length_of(matmul(x(:, group%connectivity(:, e)), dphi))
          if (nint(state(status, p, e)) == 0) cycle
          call note(k, state(penetration, p, e))
          call note(nint(state(piece, p, e)), state(penetration, p, e))
          point = matmul(x(:, group%connectivity(:, e)), phi)
          if (.not. goes_on) fold = fold_t(from=point)
          if (goes_on) fold%length = fold%length + beside
          goes_on = .true.
          fold%to = point
          beside = 0
        end do
      end do
      call end_fold()
      do k = 1, size(nodes, 2)
        if (.not. touches(k)) cycle
        call push(nodes(:, k), depth(k), x, normal, move, number)
      end do
    end associate

  contains

    subroutine note(piece, penetration)
      integer, intent(in) :: piece
      real(wp), intent(in) :: penetration

      touches(piece) = .true.
      depth(piece) = max(depth(piece), penetration)
    end subroutine note

    subroutine end_fold()
      if (goes_on) folds = [folds, fold]
      goes_on = .false.
    end subroutine end_fold

  end subroutine add_group

  !> Add a side to what its nodes move by: the largest of their sides, along the mean of the inner normals.
  pure subroutine push(nodes, depth, x, normal, move, number)
    integer, intent(in) :: nodes(3)   !! in the sense of a die: the body is on the right
    real(wp), intent(in) :: depth, x(:, :)
    real(wp), intent(inout) :: normal(:, :), move(:)
    integer, intent(inout) :: number(:)
    real(wp) :: phi(3), dphi(3), tangent(2), chord
    integer :: i

    chord = length_of(x(:, nodes(3)) - x(:, nodes(1)))
    do i = 1, 3
      call line3(real(i - 2, wp), phi, dphi)
      tangent = matmul(x(:, nodes), dphi)
      normal(:, nodes(i)) = normal(:, nodes(i)) + [tangent(2), -tangent(1)]/length_of(tangent)
      number(nodes(i)) = number(nodes(i)) + 1
      move(nodes(i)) = max(move(nodes(i)), depth, least_move*chord)
    end do
  end subroutine push

end module folded_sides
