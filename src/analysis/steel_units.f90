!> Units of a deck with steels: a steel has those of its file, so that what its laws say of them can be compared.
!>
!> 1 W/m/K over 1 MJ/m3/K is 1e-6 m2/s: ENERGY, CONDUCT and TIME give the unit of length, and with it those of convection and of
!> radiation.
module steel_units
  use kinds, only: wp
  use law_api, only: find_parameter, heat_law, law_t, solid_law
  use loads, only: by_convection, by_radiation
  use materials, only: material_t
  use scene, only: group_t, host_of, lacks_mesh, role_heat_contact, scene_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: judge_units

  !> Units of length in use: micrometre, millimetre, centimetre, metre, inch, foot [m].
  real(wp), parameter :: lengths(6) = [1.0e-6_wp, 1.0e-3_wp, 1.0e-2_wp, 1.0_wp, 0.0254_wp, 0.3048_wp]
  !> Numbers that are rounded are no mistake.
  real(wp), parameter :: rounded = 0.05_wp
  !> Parts are thinner than this, and larger than that [m].
  real(wp), parameter :: thickest = 3.0_wp, smallest = 1.0e-4_wp
  !> No quench has more: sprays and agitated brine reach 5e4 [W/m2/K].
  real(wp), parameter :: most_convection = 5.0e5_wp
  !> Metal pressed on metal has 1e3 to 1e5; what is to be perfect contact has enough with this [W/m2/K].
  real(wp), parameter :: most_conductance = 2.0e6_wp
  !> Constant of radiation [W/m2/K4]; no surface has an emissivity below this.
  real(wp), parameter :: stefan_boltzmann = 5.670374e-8_wp, least_emissivity = 0.005_wp

contains

  !> Warnings, one line each.
  subroutine judge_units(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    logical :: told(size(scene%materials))
    real(wp) :: length, conduct
    integer :: g, k

    told = .false.
    do g = 1, size(scene%groups)
      if (.not. is_steel(scene, laws, g, heat_law)) cycle
      associate (material => scene%materials(scene%groups(g)%material))
        conduct = value_of(material, laws, 'CONDUCT')
        length = 1.0e-3_wp*sqrt(value_of(material, laws, 'TIME')*value_of(material, laws, 'ENERGY')/conduct)
        if (.not. told(scene%groups(g)%material)) call judge_length(scene, material, length, warnings)
        told(scene%groups(g)%material) = .true.
        call judge_mechanics(scene, laws, g, warnings)
      end associate
      if (.not. any(abs(length/lengths - 1) < rounded)) cycle
      do k = 1, size(scene%groups)
        if (.not. acts_on(scene, k, g)) cycle
        if (scene%groups(k)%role == role_heat_contact) then
          call judge_contact(scene%groups(k), length, conduct, warnings)
        else
          call judge_exchange(scene, scene%groups(k), length, conduct, warnings)
        end if
      end do
    end do
  end subroutine judge_units

  !> A formulation with a law of steel of this kind.
  pure function is_steel(scene, laws, g, kind) result(yes)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g, kind   !! number of the group, kind of law
    logical :: yes

    yes = scene%groups(g)%material > 0
    if (.not. yes) return
    associate (law => laws(scene%materials(scene%groups(g)%material)%law_id))
      yes = law%of_steel .and. law%kind == kind
    end associate
  end function is_steel

  !> A load on sides of a body, or on its faces.
  pure function acts_on(scene, load, g) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: load, g   !! groups of the load and of the body
    logical :: yes

    yes = .false.
    associate (group => scene%groups(load))
      if (group%role == role_heat_contact .and. size(group%connectivity) > 0) &
        yes = any(scene%groups(g)%connectivity == group%connectivity(2, 1))
      if (all(group%exchange%kind /= [by_convection, by_radiation]) .or. size(group%connectivity) == 0) return
      if (group%host > 0) then
        yes = host_of(scene, load) == host_of(scene, g)
      else
        yes = any(scene%groups(g)%connectivity == group%connectivity(2, 1))
      end if
    end associate
  end function acts_on

  !> A number of a material by its name, 0 where its law has none.
  pure function value_of(material, laws, name) result(value)
    type(material_t), intent(in) :: material
    type(law_t), intent(in) :: laws(:)
    character(len=*), intent(in) :: name
    real(wp) :: value
    integer :: p

    value = 0
    p = find_parameter(laws(material%law_id), name)
    if (p > 0) value = material%values(p)
  end function value_of

  !> The unit of length is one in use, and the part no larger and no smaller than parts are.
  subroutine judge_length(scene, material, length, warnings)
    type(scene_t), intent(in) :: scene
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: length   !! its unit [m]
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: box(2)
    character(len=:), allocatable :: unit

    unit = 'LAW '//material%name//': by ENERGY, CONDUCT and TIME the unit of length is '//to_text(1.0e3_wp*length, 3)//' mm, '
    if (.not. any(abs(length/lengths - 1) < rounded)) then
      call add(warnings, unit//'which none is: in mm N s they are 1 1 1, in m N s 1E6 1 1')
    else if (.not. lacks_mesh(scene)) then
      box = length*(maxval(scene%mesh%coordinates, 2) - minval(scene%mesh%coordinates, 2))
      if (minval(box) > thickest .or. maxval(box) < smallest) &
        call add(warnings, unit//'and what the deck has is '//to_text(1.0e3_wp*box(1), 3)//' x '//to_text(1.0e3_wp*box(2), 3) &
                 //' mm large')
    end if
  end subroutine judge_length

  !> Mechanics on the same body has the same unit of time; and that of stress where its work is heat.
  subroutine judge_mechanics(scene, laws, g, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)
    integer, intent(in) :: g   !! group of heat
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: time, energy, stress
    integer :: k

    associate (heat => scene%materials(scene%groups(g)%material))
      do k = 1, size(scene%groups)
        if (.not. is_steel(scene, laws, k, solid_law)) cycle
        if (host_of(scene, k) /= host_of(scene, g)) cycle
        associate (solid => scene%materials(scene%groups(k)%material))
          time = value_of(solid, laws, 'TIME')
          if (time > 0 .and. differ(time, value_of(heat, laws, 'TIME'))) &
            call add(warnings, 'LAW '//solid%name//': TIME is '//to_text(time, 4)//', that of LAW '//heat%name &
                     //' on the same body '//to_text(value_of(heat, laws, 'TIME'), 4)//': both are the seconds of the unit of time')
          energy = value_of(heat, laws, 'ENERGY')
          stress = value_of(solid, laws, 'STRESS')
          if (.not. max(value_of(heat, laws, 'QUINNEY'), value_of(heat, laws, 'SOURCE')) > 0) cycle
          if (differ(stress, energy)) &
            call add(warnings, 'LAW '//heat%name//': ENERGY is '//to_text(energy, 4)//', STRESS of LAW '//solid%name &
                     //' on the same body '//to_text(stress, 4)//': where work becomes heat they are one number, 1 MJ/m3 is 1 MPa')
        end associate
      end do
    end associate
  end subroutine judge_mechanics

  pure function differ(one, other) result(yes)
    real(wp), intent(in) :: one, other
    logical :: yes

    yes = abs(one - other) > rounded*max(one, other)
  end function differ

  !> Heat passes to a die as well as in perfect contact, or less.
  subroutine judge_contact(group, length, conduct, warnings)
    type(group_t), intent(in) :: group   !! heat between sides and a die
    real(wp), intent(in) :: length       !! unit of length [m]
    real(wp), intent(in) :: conduct      !! 1 W/m/K [power/length/temperature]
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: largest

    largest = group%heat_contact%conductance
    if (allocated(group%heat_contact%by_pressure)) largest = largest*maxval(group%heat_contact%by_pressure(2, :))
    largest = largest/(conduct*length)
    if (largest > most_conductance) &
      call add(warnings, group%name//': H reaches '//to_text(largest, 3)//' W/m2/K in the units of the steel, that of forging 1e5')
  end subroutine judge_contact

  !> Convection is no stronger than in any quench, and radiation that of a surface.
  subroutine judge_exchange(scene, group, length, conduct, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group   !! sides or faces
    real(wp), intent(in) :: length       !! unit of length [m]
    real(wp), intent(in) :: conduct      !! 1 W/m/K [power/length/temperature]
    type(string_t), allocatable, intent(inout) :: warnings(:)
    real(wp) :: largest

    largest = group%exchange%amplitude
    if (allocated(group%exchange%table)) largest = largest*maxval(group%exchange%table(2, :))
    if (group%exchange%multiplier > 0) largest = largest*maxval(scene%multipliers(group%exchange%multiplier)%value)
    largest = largest/(conduct*length)
    if (group%exchange%kind == by_convection) then
      if (largest > most_convection) &
        call add(warnings, group%name//': H reaches '//to_text(largest, 3) &
                 //' W/m2/K in the units of the steel, that of quenches 5e4')
    else if (largest > (1 + rounded)*stefan_boltzmann .or. (largest > 0 .and. largest < least_emissivity*stefan_boltzmann)) then
      call add(warnings, group%name//': EPS times SIGMA reaches '//to_text(largest/stefan_boltzmann, 3) &
               //' times 5.67E-8 W/m2/K4 in the units of the steel: SIGMA is '//to_text(stefan_boltzmann*conduct*length, 4) &
               //' there')
    end if
  end subroutine judge_exchange

end module steel_units
