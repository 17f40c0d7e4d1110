!> Limits for a new mesh (card REMSH), and the estimated errors of the present one (cards ESTIM, REMSH).
module remeshing
  use cuts, only: trim_trigger
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: carry_error, remesh_rules_t, stroke_t, stress_error_of_all, trigger_t, estimate_t
  public :: drop_triggers, has_limit, no_limit, of_distress, of_narrow, trigger_words
  public :: ncriteria, criterion_names, is_upper, never
  public :: least_angle, largest_angle, middle_share, jacobian_ratio, scaled_jacobian, aspect_ratio

  !> Why a new mesh is due: cutbacks one after the other, or a step that can be cut back no more.
  character(len=*), parameter :: of_distress = 'distress'
  !> Limit of a trigger of distress where the deck has none.
  real(wp), parameter :: no_limit = real(huge(0), wp)
  !> Why: few sides bear a die.
  character(len=*), parameter :: of_narrow = 'narrow_contact'

  !> Criteria of the shape of an element, by position in the lists below (mesh_quality measures them).
  integer, parameter :: least_angle = 1, largest_angle = 2, middle_share = 3, jacobian_ratio = 4, scaled_jacobian = 5, &
                        aspect_ratio = 6, ncriteria = 6
  character(len=*), parameter :: criterion_names(ncriteria) = ['least_angle    ', 'largest_angle  ', 'middle_share   ', &
                                                               'jacobian_ratio ', 'scaled_jacobian', 'aspect_ratio   ']
  !> The limit is the largest good value; else the least.
  logical, parameter :: is_upper(ncriteria) = [.false., .true., .true., .false., .false., .true.]
  !> An upper limit that nothing exceeds; a lower one is its negative.
  real(wp), parameter :: never = huge(1.0_wp)

  !> A stroke at which a new mesh is made: a component of a die's pilot (x, y, angle) has moved so far.
  type :: stroke_t
    integer :: die = 0, component = 0
    real(wp) :: value = 0.0_wp
  end type stroke_t

  !> Limits beyond which a new mesh is due. Without the card nothing is checked.
  type :: remesh_rules_t
    !> A new mesh may become due; errors are estimated.
    logical :: on = .false., estimate = .false.
    !> Shape of elements, and the share of the elements that may be bad.
    real(wp) :: shape(ncriteria) = merge(never, -never, is_upper)
    real(wp) :: bad_share = 0.0_wp
    !> Error of the stress, and depth of a side or a corner over what is allowed.
    real(wp) :: stress_error = never, contact = never
    !> Sides of a contact that is narrow beside them over those of a new mesh.
    real(wp) :: narrow = never
    !> Length of a side that a corner of a die presses into over that when the mesh began.
    real(wp) :: corner = never
    !> Strain of the most strained element since the mesh began from which on the error counts.
    real(wp) :: error_strain = 0.0_wp
    !> Cutbacks of a step one after the other.
    integer :: distress = huge(0)
    !> Steps at least from one stop to the next.
    integer :: least_steps = 1
    real(wp), allocatable :: times(:)
    type(stroke_t), allocatable :: strokes(:)
  end type remesh_rules_t

  !> A limit that was passed: its name, the value found, and where it is worst (0: none). A cut along a line has neither a value nor
  !> a limit.
  type :: trigger_t
    character(len=:), allocatable :: name
    real(wp) :: value = 0.0_wp, limit = 0.0_wp
    integer :: group = 0, element = 0
  end type trigger_t

  !> Errors at the accepted instant. Those of elements are in the order of the solid groups, and are intensive: root mean
  !> square over the element, relative to that of the whole scene; where all are the same they are the error of the scene.
  type :: estimate_t
    real(wp) :: stress = 0.0_wp, strain = 0.0_wp
    real(wp), allocatable :: stress_of(:), strain_of(:)   !! (nelem)
    !> Sums over the steps since the mesh began, of the error of the strain increment and of the increment (2, nelem).
    real(wp), allocatable :: strain_sums(:, :)
    !> Step at which the mesh began; step at which it, or the operation, began or a new mesh was due last.
    integer :: began = 0, last_stop = 0
    !> Error of the stress on the mesh before, when it was replaced; 0 for the deck's own mesh.
    real(wp) :: previous_stress = 0.0_wp
    !> Share of the load that the nodes in contact on that mesh have left open (bearing_nodes).
    real(wp) :: previous_open = 0.0_wp
    !> Error of the stress that a new mesh has shown first: when it began, then when its flow has forgotten the stresses carried to
    !> it, which the transfer has smoothed; what that has fallen to, where much; 0 for the deck's own mesh.
    real(wp) :: first_stress = 0.0_wp
    !> Sides of a narrow contact over those that were wanted, with which a new mesh began or the old one went on; 0 without.
    real(wp) :: first_narrow = 0.0_wp
    !> Error of the stress with which the mesh before left it, those of older meshes in it (0 for the deck's own mesh), and the
    !> share of that which is still there: flow forgets it, elastic parts keep it.
    real(wp) :: carried_stress = 0.0_wp, stress_left = 1.0_wp
    !> Why a new mesh is due; none while the present one is good.
    type(trigger_t), allocatable :: triggers(:)
  end type estimate_t

contains

  !> A new mesh becomes due by something: not where rows of a card only say how the first mesh is made.
  pure function has_limit(rules) result(yes)
    type(remesh_rules_t), intent(in) :: rules
    logical :: yes

    yes = any(abs(rules%shape) < never) .or. rules%stress_error < never .or. rules%contact < never .or. rules%narrow < never &
          .or. rules%corner < never .or. rules%distress < huge(0)
    if (allocated(rules%times)) yes = yes .or. size(rules%times) > 0
    if (allocated(rules%strokes)) yes = yes .or. size(rules%strokes) > 0
  end function has_limit

  !> Error of the stress that comes of this mesh and of those before it: a new mesh gets the stress of the old one with its error,
  !> and what its own elements add knows nothing of that.
  pure function stress_error_of_all(estimate, stress) result(error)
    type(estimate_t), intent(in) :: estimate
    real(wp), intent(in) :: stress   !! error of this mesh [-]
    real(wp) :: error

    error = hypot(stress, estimate%carried_stress*estimate%stress_left)
  end function stress_error_of_all

  !> The error of the stress goes on to a new mesh.
  pure subroutine carry_error(before, after)
    type(estimate_t), intent(in) :: before
    type(estimate_t), intent(inout) :: after

    after%carried_stress = stress_error_of_all(before, before%stress)
    after%stress_left = 1
  end subroutine carry_error

  !> Why a new mesh is due: `aspect_ratio 12.3 (limit 10)`. Fewer cutbacks than the limit lead to the least step.
  pure function trigger_words(name, value, limit) result(words)
    character(len=*), intent(in) :: name       !! of the trigger
    real(wp), intent(in) :: value, limit       !! in the unit of what `name` measures
    character(len=:), allocatable :: words

    words = name
    if (name == of_distress .and. value < limit) then
      if (limit < no_limit) then
        words = words//' '//to_text(value, 4)//' at the least step (limit '//to_text(limit)//')'
      else
        words = words//' at the least step'
      end if
    else if (name /= trim_trigger) then
      words = words//' '//to_text(value, 4)//' (limit '//to_text(limit)//')'
    end if
  end function trigger_words

  !> No new mesh is due any more: the present one goes on. Contact that is narrow on it wears it no further, and asks again only
  !> where it becomes narrower.
  pure subroutine drop_triggers(estimate)
    type(estimate_t), intent(inout) :: estimate
    integer :: k

    do k = 1, size(estimate%triggers)
      if (estimate%triggers(k)%name == of_narrow) estimate%first_narrow = max(estimate%first_narrow, estimate%triggers(k)%value)
    end do
    deallocate (estimate%triggers)
    allocate (estimate%triggers(0))
  end subroutine drop_triggers

end module remeshing
