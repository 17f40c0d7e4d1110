!> What the penalties of a contact follow from: the modulus of the softer of two bodies that face one another, and how many times
!> what that asks for it may bear.
!>
!> A penalty that follows from an allowed penetration makes that depth under a hundredth of Young's modulus (contact_point), as a
!> body that flows bears it. Between two bodies the pressure is what the softer one bears, whichever of them faces the other. An
!> elastic body flows nowhere: rubber that is shut in bears many times its modulus. Its penalties may be raised with the pressure
!> (soft_penalties).
module contact_stiffness
  use contact_point, only: usual_bearing
  use kinds, only: wp
  use law_api, only: is_complete
  use scene, only: group_t
  use scene_draft, only: draft_t
  implicit none
  private
  public :: find_stiffness

  !> Pressure over Young's modulus up to which penalties of an elastic body are raised.
  real(wp), parameter :: most_borne = 100.0_wp

contains

  !> `modulus` and `most_share` of a group of contact.
  subroutine find_stiffness(draft, group)
    type(draft_t), intent(in) :: draft
    type(group_t), intent(inout) :: group
    real(wp) :: modulus
    logical :: flows, other_flows

    call find_modulus(draft, group%connectivity, group%modulus, flows)
    if (group%pairs > 0 .and. draft%mesh_sound) then
      call find_modulus(draft, draft%scene%dies(group%die)%nodes, modulus, other_flows)
      if (modulus > 0 .and. modulus <= group%modulus) then
        group%modulus = modulus
        flows = other_flows
      end if
    end if
    group%most_share = 1
    if (.not. flows) group%most_share = most_borne/usual_bearing
  end subroutine find_stiffness

  !> Largest Young's modulus of the bodies that sides belong to, at the first temperature of their cards, 0 where none is known; and
  !> whether one of them flows.
  subroutine find_modulus(draft, sides, modulus, flows)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: sides(:, :)   !! (3, nside) nodes
    real(wp), intent(out) :: modulus     !! [stress]
    logical, intent(out) :: flows
    real(wp) :: young, poisson, temperature
    integer :: k

    modulus = 0
    flows = .false.
    do k = 1, size(sides, 2)
      associate (material => draft%scene%materials(draft%owner(sides(2, k))))
        if (material%law_id == 0) cycle
        associate (law => draft%laws(material%law_id))
          if (.not. associated(law%elastic) .or. .not. is_complete(law, material)) cycle
          flows = flows .or. associated(law%flow_stress)
          temperature = 0
          if (allocated(material%temperatures)) temperature = material%temperatures(1)
          call law%elastic(material, temperature, young, poisson)
        end associate
        modulus = max(modulus, young)
      end associate
    end do
  end subroutine find_modulus

end module contact_stiffness
