!> Heat of a change of volume (SOURCE) in plane stress, where the strain across the plane is none of the motion of the nodes: what
!> is counted is the change of the area. Of an elastic body that is (1 - NU)/(1 - 2 NU) times the change of volume, of one that
!> flows, and keeps its volume, all of the strain in the plane.
module sheet_sources
  use kinds, only: wp
  use law_api, only: find_parameter, heat_law, law_t, solid_law
  use scene, only: host_of, plane_stress, scene_t
  use text, only: add_new_text, string_t
  implicit none
  private
  public :: judge_sheet_sources

contains

  !> A line for each such law of a body that moves.
  subroutine judge_sheet_sources(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: largest
    integer :: g, k, p

    if (scene%plane_state /= plane_stress) return
    do g = 1, size(scene%groups)
      if (scene%groups(g)%material == 0) cycle
      associate (material => scene%materials(scene%groups(g)%material))
        if (laws(material%law_id)%kind /= heat_law) cycle
        p = find_parameter(laws(material%law_id), 'SOURCE')
        if (p == 0) cycle
        largest = material%values(p)
        if (allocated(material%values_by_temperature)) largest = maxval(material%values_by_temperature(p, :))
        if (.not. largest > 0) cycle
        do k = 1, size(scene%groups)
          if (host_of(scene, k) /= host_of(scene, g) .or. scene%groups(k)%material == 0) cycle
          if (laws(scene%materials(scene%groups(k)%material)%law_id)%kind /= solid_law) cycle
          call add_new_text(warnings, 'LAW '//material%name//': in plane stress SOURCE counts the change of the area, not of the ' &
                            //'volume: of an elastic body take SOURCE times (1 - 2 NU)/(1 - NU), of one that flows none')
        end do
      end associate
    end do
  end subroutine judge_sheet_sources

end module sheet_sources
