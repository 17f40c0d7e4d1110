!> The element sizes that a scene asks for: by errors, by bends of the contour and of dies, by contact, in windows.
module sizes_of_scene
  use arcs_on_die, only: placed_piece
  use block_mesh, only: polygon_area
  use body_sizes, only: body_sizes_t, lengthen
  use contact_misfits, only: needs_of_misfits
  use contour_volume, only: volume_inside
  use contour_needs, only: geometry_settings_t, needs_of_boundary, needs_of_die
  use corrected_contours, only: contour_t, some_contours
  use dies, only: is_deformable
  use facing_sizes, only: needs_of_others
  use fields, only: pilot_field
  use kinds, only: wp
  use limits_of_bodies, only: bodies_have_sizes, limits_of_all, limits_of_body, materials_of_contours
  use scene, only: axisymmetric, scene_t
  use remesh_defaults, only: elements_at_first
  use size_field, only: join_bodies, need_t, old_mesh_t, requested_size, set_up_sizes, size_field_t, size_limits_t
  use size_windows, only: limits_around, place_window, size_window_t
  use solution, only: solution_t
  use square_sizes, only: set_up_squares, square_field_t
  use state_pieces, only: mesh_of, solid_pieces, state_pieces_t
  use thin_parts, only: find_thin_parts, thin_point_t
  use transfer_mesh, only: transfer_mesh_t
  implicit none
  private
  public :: strain_order, requested_sizes

  !> Errors of strain fall with the size to this power (8-node elements).
  real(wp), parameter :: strain_order = 2.0_wp
  !> A mesh that was strained by less than this in the mean of its elements, as by unloading or where one node is touched so far
  !> has shown no errors of what comes: its elements are not made larger.
  real(wp), parameter :: strained = 1.0e-4_wp

contains

  !> Sizes by the error of the strains, by the curvature of the contour and of nearby dies, and by contact intervals; where bodies
  !> have sizes of their own, by those of others that lie near.
  subroutine requested_sizes(scene, solution, contours, first, same, sizes, learned)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    logical, intent(in) :: first   !! there is no mesh yet: largest elements except where the geometry requires smaller ones
    logical, intent(in) :: same    !! those of the old elements, whatever the error and the geometry ask for
    type(size_field_t), intent(out) :: sizes
    type(old_mesh_t), intent(in), optional :: learned   !! with `first`: sizes that a run on such a mesh has asked for
    type(old_mesh_t), allocatable :: old, narrow
    type(size_window_t), allocatable :: windows(:)
    type(need_t), allocatable :: misfits(:), nearby(:)
    type(body_sizes_t), allocatable :: alone(:), bodies(:)
    integer :: body_of(size(contours)), b

    call place_windows(scene, solution, windows)
    allocate (misfits(0))
    if (first) then
      if (present(learned)) old = learned
      if (present(learned)) narrow = learned
    else
      call needs_of_misfits(scene, solution, misfits)
      call sizes_by_errors(scene, solution, same, size(windows) > 0, old, narrow)
      if (same) then
        call set_up_sizes(size_limits_t(), [need_t ::], sizes, old)
        return
      end if
    end if
    if (.not. bodies_have_sizes(scene%remesher)) then
      call sizes_of_contours(limits_of_all(scene), contours, [need_t ::], sizes%body_sizes_t)
      return
    end if
    body_of = materials_of_contours(scene, contours)
    allocate (alone(size(scene%remesher%contours)), bodies(size(scene%remesher%contours)))
    do b = 1, size(bodies)
      call sizes_of_contours(limits_of_body(scene, b), some_contours(contours, body_of == b), [need_t ::], alone(b))
    end do
    do b = 1, size(bodies)
      call needs_of_others(contours, body_of, alone, b, nearby)
      call sizes_of_contours(limits_of_body(scene, b), some_contours(contours, body_of == b), nearby, bodies(b))
    end do
    call join_bodies(bodies, sizes)

  contains

    !> Sizes within limits: of squares; in thin parts lengths for a larger limit, with what the geometry requires below that.
    subroutine sizes_of_contours(limits, some, others, field)
      type(size_limits_t), intent(in) :: limits
      type(contour_t), intent(in) :: some(:)   !! of one body, or of all
      type(need_t), intent(in) :: others(:)    !! of other bodies
      type(body_sizes_t), intent(out) :: field
      type(size_limits_t) :: longer
      type(square_field_t) :: lengths
      type(need_t), allocatable :: needs(:), needs_of_lengths(:)
      type(thin_point_t), allocatable :: thin(:)
      integer :: c

      call needs_of_geometry(scene, solution, some, limits_around(limits, windows), misfits, others, needs)
      call set_up_squares(limits, needs, field%square_field_t, narrow, windows)
      call find_thin_parts([(some(c)%boundary, c=1, size(some))], limits%largest, thin)
      longer = limits
      if (size(thin) > 0) longer%largest = longest_size(scene, some, first, limits%largest)
      if (.not. longer%largest > limits%largest) return
      call needs_of_geometry(scene, solution, some, limits_around(longer, windows), misfits, others, needs_of_lengths)
      call set_up_squares(longer, needs_of_lengths, lengths, old, windows)
      call lengthen(lengths, thin, field)
    end subroutine sizes_of_contours

  end subroutine requested_sizes

  !> Sizes that the old elements are wanted of by their errors, and those with a number of elements across slender bodies.
  subroutine sizes_by_errors(scene, solution, same, has_windows, old, narrow)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    logical, intent(in) :: same          !! the sizes that they have
    logical, intent(in) :: has_windows   !! where their matter began is of account
    type(old_mesh_t), allocatable, intent(out) :: old, narrow
    type(state_pieces_t) :: pieces
    type(transfer_mesh_t) :: mesh
    real(wp) :: error, now
    logical :: shown
    integer :: e

    allocate (old)
    call solid_pieces(scene, pieces, solution)
    pieces%axisymmetric = .false.
    call mesh_of(pieces, mesh)
    old%nodes = mesh%nodes
    old%connectivity = mesh%connectivity
    old%material = mesh%material
    allocate (old%requested(size(mesh%material)))
    do e = 1, size(old%requested)
      old%requested(e) = sqrt(polygon_area(old%nodes(:, old%connectivity(1:4, e))))
    end do
    if (same) return
    if (scene%remesh%estimate) then
      shown = sum(solution%estimate%strain_sums(2, :)) > strained*size(old%requested)
      do e = 1, size(old%requested)
        error = solution%estimate%strain_of(e)
        now = old%requested(e)
        old%requested(e) = requested_size(now, error, scene%remesher%strain_error, strain_order)
        if (.not. shown) old%requested(e) = min(old%requested(e), now)
      end do
    end if
    if (has_windows) old%origin = scene%mesh%origin
    narrow = old
    call keep_across(scene, pieces, narrow%requested)
  end subroutine sizes_by_errors

  !> A number of elements across slender bodies: they bend.
  pure subroutine keep_across(scene, pieces, requested)
    type(scene_t), intent(in) :: scene
    type(state_pieces_t), intent(in) :: pieces
    real(wp), intent(inout) :: requested(:)   !! (nelem) in the order of the pieces [length]
    real(wp) :: thickness
    integer :: g, last, first

    if (.not. (scene%remesher%across_slender > 0 .and. allocated(scene%remesher%own_mesh%thickness))) return
    last = 0
    do g = 1, size(pieces%groups)
      first = last + 1
      last = last + size(pieces%groups(g)%connectivity, 2)
      if (pieces%groups(g)%scene_group > size(scene%remesher%own_mesh%thickness)) cycle
      thickness = scene%remesher%own_mesh%thickness(pieces%groups(g)%scene_group)
      if (thickness > 0) requested(first:last) = min(requested(first:last), thickness/scene%remesher%across_slender)
    end do
  end subroutine keep_across

  !> Length of elements in thin parts at most. A first mesh, of which nothing is known but its contours, has no longer ones than
  !> squares as a body that is not thin would have (`remesh_defaults`).
  pure function longest_size(scene, contours, first, largest) result(longest)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)
    logical, intent(in) :: first
    real(wp), intent(in) :: largest   !! [length]
    real(wp) :: longest
    real(wp) :: area
    integer :: c

    longest = scene%remesher%stretch*largest
    if (.not. first) return
    area = 0
    do c = 1, size(contours)
      area = area + volume_inside(contours(c)%boundary, .false.)
    end do
    longest = max(largest, min(longest, sqrt(max(area, 0.0_wp)/elements_at_first)))
  end function longest_size

  !> Requirements of bends and contacts, and where sides lie off their dies.
  subroutine needs_of_geometry(scene, solution, contours, limits, misfits, others, needs)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contour_t), intent(in) :: contours(:)
    type(size_limits_t), intent(in) :: limits             !! nowhere narrower than those of any place
    type(need_t), intent(in) :: misfits(:)                !! (n)
    type(need_t), intent(in) :: others(:)                 !! (n) of other bodies
    type(need_t), allocatable, intent(out) :: needs(:)    !! (nneed)
    type(geometry_settings_t) :: settings
    type(need_t), allocatable :: bends(:), more(:)
    integer :: c, d, k

    settings%across = scene%remesher%across_contact
    settings%turn = scene%remesher%turn
    settings%turn_at_dies = scene%remesher%turn_at_dies
    allocate (needs(0), bends(0))
    do d = 1, size(scene%dies)
      if (is_deformable(scene%dies(d))) cycle
      call needs_of_die([(placed_piece(scene%dies(d), solution%fields(pilot_field)%value(:, d), k), &
                          k=1, size(scene%dies(d)%pieces, 3))], &
                        scene%dies(d)%closed, settings, limits, more)
      bends = [bends, more]
    end do
    bends = [bends, others]
    do c = 1, size(contours)
      call needs_of_boundary(contours(c)%boundary, settings, limits, more, bends)
      needs = [needs, more]
    end do
    more = misfits
    more%size = max(more%size, limits%smallest)
    needs = [needs, more]
  end subroutine needs_of_geometry

  !> Windows of the deck where they are now.
  subroutine place_windows(scene, solution, windows)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(size_window_t), allocatable, intent(out) :: windows(:)   !! (nwindow)
    real(wp) :: start(3), now(3)
    integer :: k

    allocate (windows(size(scene%remesher%windows)))
    do k = 1, size(windows)
      associate (box => scene%remesher%windows(k))
        start = 0
        now = 0
        if (box%die > 0) then
          start = scene%dies(box%die)%pilot
          now = solution%fields(pilot_field)%value(:, box%die)
        end if
        windows(k) = place_window(box, start, now)
      end associate
    end do
  end subroutine place_windows

end module sizes_of_scene
