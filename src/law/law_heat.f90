!> HEAT: isotropic conduction of heat, constant numbers.
!>
!> Heat flow -LAMBDA grad T, heat content RHOC per volume of the start and per degree. SOURCE is the heat that a change of volume
!> takes up, per volume and unit of volume strain: 3 K ALPHA T of thermoelasticity (W. Thomson 1855; J.M.C. Duhamel).
module law_heat
  use law_api, only: heat_law, law_line, law_t, parameter
  use kinds, only: wp
  implicit none
  private
  public :: law_heat_row

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
  end function law_heat_row

end module law_heat
