!> The numbers of laws for heat that heat within a body comes from: SOURCE, heat that a change of volume takes up, and
!> QUINNEY, the share of the plastic work that becomes heat (G.I. Taylor, H. Quinney, Proc. Roy. Soc. A 143 (1934) 307-326).
module heat_sources
  use kinds, only: wp
  use law_api, only: parameter, parameter_t
  use materials, only: material_t, values_at
  implicit none
  private
  public :: heat_source_parameters, place_source, place_share, share_of_work, source_of_volume, work_heated, &
            work_name

  !> The work that has become heat, of laws with QUINNEY: none is lost where the motion is solved for after the temperature, and its
  !> heat comes a step later.
  character(len=*), parameter :: work_heated = 'work_heated'
  !> Plastic work per volume without elastic strain, of laws for solids.
  character(len=*), parameter :: work_name = 'plastic_work'
  !> Places among the values of HEAT and HEATH, after conductivity and capacity.
  integer, parameter :: place_source = 3, place_share = 4

contains

  !> SOURCE and QUINNEY.
  function heat_source_parameters() result(list)
    type(parameter_t), allocatable :: list(:)

    allocate (list(2))
    list(1) = parameter('SOURCE', 'energy/length^3', 'heat taken up by a change of volume, per volume strain', default=0.0_wp)
    list(2) = parameter('QUINNEY', '-', 'share of the plastic work that becomes heat', lower=0.0_wp, upper=1.0_wp, default=0.0_wp, &
                        turns_on=.true.)
  end function heat_source_parameters

  !> QUINNEY: it changes little with the temperature, that of the start of the step.
  pure function share_of_work(material, place, temperature) result(share)
    type(material_t), intent(in) :: material
    integer, intent(in) :: place          !! of QUINNEY among the values of the material
    real(wp), intent(in) :: temperature   !! at the start of the step [temperature]
    real(wp) :: share                     !! [-]
    real(wp) :: values(size(material%values))

    call values_at(material, temperature, values)
    share = values(place)
  end function share_of_work

  !> SOURCE, at the temperature of the start of the step.
  pure function source_of_volume(material, temperature) result(heat)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature   !! [temperature]
    real(wp) :: heat                      !! per unit of volume strain [energy/length^3]
    real(wp) :: values(size(material%values))

    call values_at(material, temperature, values)
    heat = values(place_source)
  end function source_of_volume

end module heat_sources
