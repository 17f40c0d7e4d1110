!> Cuts of a remesh: which bodies are cut for the new mesh, and what that makes of their volumes (cards TRIM and PIERC).
module remesh_cuts
  use contour_cuts, only: cut_is_due, make_cuts
  use contour_volume, only: volume_of_section
  use corrected_contours, only: contour_t
  use cuts, only: stage_of_cuts
  use elastic_volume, only: unloaded_share
  use errors, only: error_t, exit_input, fail
  use fields, only: section_field
  use kinds, only: pi, wp
  use material_interfaces, only: group_interfaces, interface_t
  use remesh_facts, only: begin_task, remesh_facts_t
  use scene, only: axisymmetric, scene_t
  use solution, only: solution_t
  implicit none
  private
  public :: cut_bodies, cut_now, note_cuts

contains

  !> Make the cuts that are due. The facts have what came of all cuts of the scene.
  subroutine cut_bodies(old, before, contours, facts, is_cut, error)
    type(scene_t), intent(in) :: old
    type(solution_t), intent(in) :: before
    type(contour_t), allocatable, intent(inout) :: contours(:)   !! (ncontour)
    type(remesh_facts_t), intent(inout) :: facts
    logical, intent(out) :: is_cut
    type(error_t), allocatable, intent(out) :: error
    type(interface_t), allocatable :: shared(:)
    integer :: g, i, k

    is_cut = any([(cut_is_due(old, before, k), k=1, size(before%cuts))])
    if (.not. is_cut) return
    call begin_task(facts, stage_of_cuts, 'cut')
    call group_interfaces(old, before, contours, shared)
    do k = 1, size(before%cuts)
      if (.not. cut_is_due(old, before, k)) cycle
      g = old%remesher%cuts(k)%group
      if (.not. any([(any(shared(i)%materials == g), i=1, size(shared))])) cycle
      call fail(error, exit_input, 'TRIM, PIERC: '//old%groups(g)%name//' shares sides with another body', &
                'cut a body that stands alone')
      return
    end do
    call make_cuts(old, before, contours, facts%cuts, error)
  end subroutine cut_bodies

  !> Bodies a part of which was cut off for the new mesh (ngroup).
  pure function cut_now(old, facts) result(yes)
    type(scene_t), intent(in) :: old
    type(remesh_facts_t), intent(in) :: facts
    logical :: yes(size(old%groups))
    integer :: k

    yes = .false.
    if (.not. allocated(facts%cuts)) return
    do k = 1, size(facts%cuts)
      if (facts%cuts(k)%generation == facts%generation) yes(old%remesher%cuts(k)%group) = .true.
    end do
  end function cut_now

  !> What was cut off is no drift of the volume. It was pressed together otherwise than what is left: the web of a punched hole more
  !> than the sheet around it. So both have a share of the first volume by their volumes without elastic strain.
  subroutine note_cuts(old, before, contours, new, facts, after)
    type(scene_t), intent(in) :: old, new
    type(solution_t), intent(in) :: before
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(remesh_facts_t), intent(inout) :: facts
    type(solution_t), intent(inout) :: after
    real(wp) :: left, share
    integer :: c

    left = 0
    do c = 1, size(contours)
      left = left + volume_of_section(contours(c)%boundary, after%fields(section_field)%value(:, 1))
    end do
    facts%removed = sum(facts%cuts%volume, mask=facts%cuts%generation == facts%generation)
    share = left/(left + facts%removed)*unloaded_share(new, after)/unloaded_share(old, before)
    after%initial_volume = share*after%initial_volume
    after%work%grown = share*after%work%grown
    after%cuts = facts%cuts
    if (old%plane_state == axisymmetric) facts%removed = 2*pi*facts%removed
  end subroutine note_cuts

end module remesh_cuts
