!> What is known of the balance of heat in time: of a step, and of all steps since the start.
module heat_record
  use kinds, only: wp
  use path_record, only: state_error_t
  implicit none
  private
  public :: finer_share, heat_record_t, heat_step_t, note_heat_step

  !> Temperatures on corners err so many times what those of a mesh twice as fine are more: errors are of order 2 in the size of
  !> elements (L.F. Richardson, Phil. Trans. R. Soc. A 210 (1911) 307-357).
  real(wp), parameter :: finer_share = 4.0_wp/3

  type :: heat_step_t
    !> Its error was estimated; the estimate, of the heat content over the least heat capacity in the mean square of the volume; it
    !> is above what the deck allows.
    logical :: estimated = .false.
    real(wp) :: error = 0.0_wp
    !> Error at its end, of all steps so far on the mesh: heat of the nodes (nnode) and of the dies (ndie) [energy], and
    !> temperature, in the mean square.
    real(wp), allocatable :: content_error(:), die_error(:)
    real(wp) :: error_now = 0.0_wp
    !> The temperatures of the nodes that this heat makes (nnode) [temperature].
    real(wp), allocatable :: temperature_error(:)
    !> Errors of the states of points with kinetics at its end (heat_error; ngroup); not allocated where they are not known.
    type(state_error_t), allocatable :: phases(:)
    !> Motion of the unknowns by which heat flows in a step of two stages, as a mean (ndof); not allocated in others [unknown].
    real(wp), allocatable :: mean(:)
    !> Where no law flows, at the end of a run: error of the stress that comes of them, over the stress.
    real(wp) :: stress_error = 0.0_wp
    logical :: above = .false.
    !> It must be shortened by its error; largest factor for the step that follows.
    logical :: too_long = .false.
    real(wp) :: growth = huge(1.0_wp)
    !> How far temperatures are beyond those that can be there (heat_bounds); the step was made again for that. Where they stand on
    !> 8 nodes, the least and the largest that can be there so far; 0 where none are known.
    real(wp) :: excess = 0.0_wp
    real(wp) :: low = 0.0_wp, high = 0.0_wp
    logical :: fell_back = .false.
  end type heat_step_t

  type :: heat_record_t
    !> Sum and largest of the estimated errors of the steps [temperature], and how many were estimated.
    real(wp) :: error_sum = 0.0_wp, error_worst = 0.0_wp
    integer :: estimated = 0
    !> What the steps have left of their errors: of the heat of the nodes and of the dies, by those on the present mesh (nnode and
    !> ndie, of none where there is no temperature) [energy]; of the temperature, in the mean square: by these, by all, and the
    !> largest so far [temperature].
    real(wp), allocatable :: content_error(:), die_error(:)
    !> Temperatures of the nodes that these make: those of a run in shorter steps less those of this one (nnode) [temperature].
    real(wp), allocatable :: temperature_error(:)
    real(wp) :: error_of_mesh = 0.0_wp, error_now = 0.0_wp, error_largest = 0.0_wp
    !> Error of the stress that they make at the end, over the stress, where no law flows.
    real(wp) :: stress_error = 0.0_wp
    !> Temperatures of a mesh twice as fine less those of this one, and the heat contents (space_error): of the nodes and of the
    !> centres of all elements (nnode + nelem), of none where they are not followed [temperature], [energy].
    real(wp), allocatable :: finer(:), finer_content(:)
    !> Steps in which the error in space was followed; its largest size now and so far, and in the mean square of the volume
    !> [temperature]; when the largest of the latter was [time]. Least and largest temperature so far; where temperatures stand on 8
    !> nodes, those that can be there.
    integer :: space_steps = 0
    real(wp) :: space_now = 0.0_wp, space_largest = 0.0_wp, space_mean = 0.0_wp, space_mean_largest = 0.0_wp, space_time = 0.0_wp
    real(wp) :: coldest = 0.0_wp, hottest = 0.0_wp
    !> Attempts shortened by their error; steps of the least length that are above it.
    integer :: shortened = 0, above = 0
    !> Steps with temperatures beyond those that can be there, and the farthest [temperature]; steps made again for that.
    integer :: outside = 0
    real(wp) :: excess = 0.0_wp
    integer :: fallbacks = 0
  end type heat_record_t

contains

  !> Add an accepted step.
  pure subroutine note_heat_step(step, record)
    type(heat_step_t), intent(in) :: step
    type(heat_record_t), intent(inout) :: record

    if (step%estimated) then
      record%estimated = record%estimated + 1
      record%error_sum = record%error_sum + step%error
      record%error_worst = max(record%error_worst, step%error)
      ! what came on earlier meshes stays beside that of this one
      record%error_now = max(record%error_now - record%error_of_mesh, 0.0_wp) + step%error_now
      record%error_of_mesh = step%error_now
      record%error_largest = max(record%error_largest, record%error_now)
      record%stress_error = step%stress_error
      record%content_error = step%content_error
      record%die_error = step%die_error
      record%temperature_error = step%temperature_error
      if (step%above) record%above = record%above + 1
    end if
    if (step%high > step%low) then
      record%coldest = step%low
      record%hottest = step%high
    end if
    if (step%fell_back) record%fallbacks = record%fallbacks + 1
    if (.not. step%excess > 0) return
    record%outside = record%outside + 1
    record%excess = max(record%excess, step%excess)
  end subroutine note_heat_step

end module heat_record
