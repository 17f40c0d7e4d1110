!> Sides against dies in known states, for the tests of CNT2D.
module contact_cases
  use dies, only: die_t
  use element_cases, only: accept, case_t, contact_case, die_of, segment
  use kinds, only: wp
  use law_cases, only: contact_material
  use materials, only: material_t
  use scene, only: generalised_plane_strain
  implicit none
  private
  public :: at_pressure, at_tau, at_penetration, at_status, at_slip, at_augmentation, at_work, at_piece
  public :: contact_die, die_names, contact_set_t, new_contact, flat_case, placed, akp, aktau

  !> Penalties [MPa/mm].
  real(wp), parameter :: akp = 1000.0_wp, aktau = 700.0_wp

  !> Places in the state of a point of CNT2D.
  integer, parameter :: at_pressure = 1, at_tau = 2, at_penetration = 3, at_status = 4, at_slip = 5, &
                        at_augmentation = 6, at_work = 7, at_piece = 8

  character(len=*), parameter :: die_names(3) = [character(len=16) :: 'segment', 'convex parabola', 'concave parabola']

  !> What a case of contact is made of.
  type :: contact_set_t
    integer :: plane_state = 1
    !> Die, of `die_names`.
    integer :: die = 1
    integer :: npoint = 2
    real(wp) :: phi = 0.3_wp
    !> Where the pilot stands.
    real(wp) :: pilot(3) = 0.0_wp
    !> Height of the side over the die before the first step, and the motion of that step along the die.
    real(wp) :: height = -0.01_wp, way = 0.0_wp
    !> Height of the middle node over the ends.
    real(wp) :: bulge = 0.005_wp
    !> Pressure carried as a multiplier.
    real(wp) :: augmentation = 0.0_wp
  end type contact_set_t

contains

  !> Die under the line from x = 1 to 2: its top is at y = 0 at x = 1.5.
  function contact_die(kind) result(die)
    integer, intent(in) :: kind
    type(die_t) :: die
    real(wp), parameter :: bend(3) = [0.0_wp, -0.05_wp, 0.05_wp]

    if (kind == 1) then
      die = die_of(segment([-3.0_wp, 0.0_wp], [6.0_wp, 0.0_wp]))
    else
      die = die_of(reshape([-1.0_wp, 6.25_wp*bend(kind), 1.5_wp, 0.0_wp, 4.0_wp, 6.25_wp*bend(kind)], [2, 3, 1]))
    end if
  end function contact_die

  !> A case after its first step: contact there is, or a gap when `height` is positive.
  subroutine new_contact(set, case)
    type(contact_set_t), intent(in) :: set
    type(case_t), intent(out) :: case
    type(die_t) :: die
    real(wp) :: x(2, 3), y(2)
    real(wp), allocatable :: way(:)
    real(wp), parameter :: along(3) = [1.05_wp, 1.5_wp, 1.95_wp]
    integer :: k

    die = contact_die(set%die)
    do k = 1, 3
      y = die_height(die, along(k))
      x(:, k) = placed([along(k), y(2) + set%height], set%pilot)
    end do
    y = placed([0.0_wp, set%bulge], set%pilot) - set%pilot(1:2)
    x(:, 2) = x(:, 2) + y
    case = contact_case(set%plane_state, contact_material(akp, aktau, set%phi), set%npoint, x, die, set%pilot)
    allocate (way(merge(12, 9, set%plane_state == generalised_plane_strain)), source=0.0_wp)
    way(1:6) = [spread(cos(set%pilot(3))*set%way, 1, 3), spread(sin(set%pilot(3))*set%way, 1, 3)]
    call accept(case, way)
    case%committed(at_augmentation, :, :) = set%augmentation
  end subroutine new_contact

  !> A straight side of length 2 over a flat die, its nodes at x = 2, 3, 4.
  function flat_case(plane_state, material, npoint, height) result(case)
    integer, intent(in) :: plane_state, npoint
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: height
    type(case_t) :: case

    case = contact_case(plane_state, material, npoint, reshape([2.0_wp, height, 3.0_wp, height, 4.0_wp, height], [2, 3]), &
                        contact_die(1), [0.0_wp, 0.0_wp, 0.0_wp])
  end function flat_case

  !> Point of the die at a place along it.
  pure function die_height(die, x) result(y)
    type(die_t), intent(in) :: die
    real(wp), intent(in) :: x
    real(wp) :: y(2)
    real(wp) :: xi

    associate (p => die%pieces(:, :, 1))
      xi = (x - p(1, 2))/(p(1, 3) - p(1, 2))
      y = 0.5_wp*xi*(xi - 1)*p(:, 1) + (1 - xi*xi)*p(:, 2) + 0.5_wp*xi*(xi + 1)*p(:, 3)
    end associate
  end function die_height

  !> A point given in the axes of a pilot.
  pure function placed(point, pilot) result(x)
    real(wp), intent(in) :: point(2), pilot(3)
    real(wp) :: x(2)

    x = pilot(1:2) + [cos(pilot(3))*point(1) - sin(pilot(3))*point(2), sin(pilot(3))*point(1) + cos(pilot(3))*point(2)]
  end function placed

end module contact_cases
