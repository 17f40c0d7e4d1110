!> What a REMSH card means where it does not say: limits at which a new mesh is due, and sizes of elements of bodies that are given
!> by their contours. `--check` prints them with those that are given.
module remesh_defaults
  use closed_parabolas, only: area_in
  use kinds, only: wp
  use remesher_options, only: remesher_options_t
  use remeshing, only: aspect_ratio, largest_angle, least_angle, middle_share, remesh_rules_t, scaled_jacobian
  use vectors, only: length_of
  implicit none
  private
  public :: corner, elements_at_first, facing_ratio, narrow, set_default_limits, set_default_sizes

  !> Shapes at which an element does its work badly but does it still, for every single element: a new mesh has none like these
  !> (angles from 20 degrees, scaled Jacobians from 0.25, middle nodes in the middle third), and each is some steps of distortion
  !> away from failing.
  real(wp), parameter :: angles(2) = [15.0_wp, 165.0_wp], least_scaled = 0.2_wp, middle = 0.4_wp, aspect = 10.0_wp
  !> Depth of sides between their points over what the law allows: 5 % of a side where PENETR is 1e-3. What a finer mesh can mend
  !> begins there; sides that roll onto a die are as deep as 1 % on any mesh.
  real(wp), parameter :: depth = 50.0_wp
  !> Error of the stress, and the strain of an element since its mesh began from which on it counts: on meshes that are worn so far
  !> the force is too high, and drops on the next one (remdata/README.md). New meshes begin with about half of this error.
  real(wp), parameter :: stress_error = 0.05_wp, error_strain = 0.4_wp
  !> Sides of a narrow contact over those of a new mesh: below that contact is known to within a node or two on the one as on the
  !> other.
  real(wp), parameter :: narrow = 1.5_wp
  !> Sides that corners of dies press into over their length as new: without such a limit the force went up by 2 to 8 % before the
  !> next mesh, with it by 1 % (decks/can_sharp).
  real(wp), parameter :: corner = 1.5_wp
  !> Cutbacks in a row; steps between two meshes.
  integer, parameter :: cutbacks = 4, steps = 5

  !> Elements of the first mesh of a body, and across it if it is slender: a strip of thickness t has area/perimeter = t/2.
  integer, parameter :: elements_at_first = 150, elements_across = 4
  !> The smallest element over the largest, and elements of later meshes over those of the first.
  real(wp), parameter :: smallest_share = 0.2_wp
  !> The same at a sharp corner of a die over elsewhere: a side that matter flows out of past a corner stays nearly straight, and
  !> the die acts as if it were larger by what of the side lies beyond (decks/can_sharp).
  real(wp), parameter :: corner_share = 0.35_wp
  integer, parameter :: growth = 3
  !> Elements of a body where a finer one lies on it, over those of that one. Both are known by the points of one of them, and the
  !> coarser one bends into parabolas as long as its sides: with twice the size reactions are within 0.5 % of those of meshes alike.
  real(wp), parameter :: facing_ratio = 2.0_wp

contains

  !> Limits of a card that has none; its own least number of steps stays.
  pure subroutine set_default_limits(rules, has_steps, has_dies)
    type(remesh_rules_t), intent(inout) :: rules
    logical, intent(in) :: has_steps, has_dies

    rules%shape(least_angle) = angles(1)
    rules%shape(largest_angle) = angles(2)
    rules%shape(middle_share) = middle
    rules%shape(scaled_jacobian) = least_scaled
    rules%shape(aspect_ratio) = aspect
    rules%stress_error = stress_error
    rules%error_strain = error_strain
    if (.not. has_steps) rules%least_steps = steps
    rules%distress = cutbacks
    if (has_dies) rules%contact = depth
    if (has_dies) rules%narrow = narrow
    if (has_dies) rules%corner = corner
  end subroutine set_default_limits

  !> Sizes and number of elements of bodies that are given by their contours: squares, so many in each body, and across each that is
  !> slender. One of several bodies has no smaller ones than a share of its own, or than lie on the finest of the others.
  pure subroutine set_default_sizes(options)
    type(remesher_options_t), intent(inout) :: options
    real(wp) :: area(size(options%contours)), own(size(options%contours))
    integer :: k

    if (options%largest > 0) return
    do k = 1, size(area)
      area(k) = area_in(options%contours(k)%pieces)
      if (.not. area(k) > 0) return
      own(k) = min(2*area(k)/(elements_across*perimeter_of(options%contours(k)%pieces)), sqrt(area(k)/elements_at_first))
    end do
    options%largest = maxval(own)
    options%smallest = smallest_share*minval(own)
    options%smallest_at_corners = corner_share*options%smallest
    if (size(own) > 1) then
      options%contours%largest = own
      options%contours%smallest = min(smallest_share*own, facing_ratio*minval(own))
    end if
    if (options%most_elements == 0) options%most_elements = growth*ceiling(sum(area/own**2))
  end subroutine set_default_sizes

  !> Length of the chords of parabolas, two to each: a size, not a measure [length].
  pure function perimeter_of(pieces) result(length)
    real(wp), intent(in) :: pieces(:, :, :)   !! (2, 3, npiece) [length]
    real(wp) :: length
    integer :: k

    length = 0
    do k = 1, size(pieces, 3)
      length = length + length_of(pieces(:, 2, k) - pieces(:, 1, k)) + length_of(pieces(:, 3, k) - pieces(:, 2, k))
    end do
  end function perimeter_of

end module remesh_defaults
