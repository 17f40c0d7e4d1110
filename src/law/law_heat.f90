!> HEAT: isotropic conduction of heat, constant numbers.
!>
!> Heat flow -LAMBDA grad T, heat content RHOC per volume of the start and per degree. SOURCE is the heat that a change of volume
!> takes up, per volume and unit of volume strain: 3 K ALPHA T of thermoelasticity (W. Thomson 1855; J.M.C. Duhamel).
module law_heat
  use law_api, only: conduction_t, heat_law, law_line, law_t, parameter
  use kinds, only: wp
  use materials, only: material_t
  implicit none
  private
  public :: law_heat_row

  !> Places among the values of a material.
  integer, parameter :: place_conductivity = 1, place_capacity = 2, place_source = 3

contains

  function law_heat_row() result(row)
    type(law_t) :: row

    row%name = 'HEAT'
    row%number = 9001
    row%kind = heat_law
    row%purpose = 'isotropic conduction of heat'
    row%source = 'Fourier'
    allocate (row%lines, source=[law_line([parameter('LAMBDA', 'power/length/temperature', 'conductivity', above=0.0_wp), &
                                           parameter('RHOC', 'energy/length^3/temperature', 'heat capacity per volume', &
                                                     above=0.0_wp)]), &
                                 law_line([parameter('SOURCE', 'energy/length^3', &
                                                     'heat taken up by a change of volume, per volume strain', default=0.0_wp)], &
                                          pairs=.true.)])
    allocate (row%history(0))
    row%effects = ''
    row%conduct => conduct
  end function law_heat_row

  !> The same at all temperatures.
  pure function conduct(material, temperature) result(conduction)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: temperature
    type(conduction_t) :: conduction

    conduction = conduction_t(material%values(place_conductivity), material%values(place_capacity), &
                              material%values(place_source))
  end function conduct

end module law_heat
