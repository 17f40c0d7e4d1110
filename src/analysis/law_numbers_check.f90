!> Numbers of a law that no metal has: units were mixed, or a number is in per cent or in millionths.
module law_numbers_check
  use kinds, only: wp
  use law_api, only: driver_count, find_parameter, law_t
  use materials, only: material_t
  use scene, only: scene_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: judge_alpha, judge_friction, judge_hardening, judge_strains, judge_yield

  !> Metals yield at less than this share of Young's modulus: the strongest steels and glassy metals at 0.01 to 0.02.
  real(wp), parameter :: largest_yield = 0.03_wp
  !> And at more than this one: tin just below its melting point at 2e-5.
  real(wp), parameter :: smallest_yield = 1.0e-5_wp
  !> Yield and backstress grow in so much plastic strain by less than this share of it times E: springs of high strength by 0.2.
  real(wp), parameter :: first_strain = 0.01_wp, largest_hardening = 1.0_wp
  !> Plastic strains of a table end below: tests of torsion, which go farthest, at 5.
  real(wp), parameter :: largest_strain = 10.0_wp
  !> Dry metals rub at less, hot ones that stick at their shear flow stress (M).
  real(wp), parameter :: largest_friction = 1.0_wp
  !> Metals expand by 1e-5 to 3e-5 of their length for a degree, polymers by 3e-4.
  real(wp), parameter :: largest_alpha = 0.01_wp

contains

  !> A yield stress that no metal has beside its modulus: units mixed.
  subroutine judge_yield(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: m             !! place among the materials
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: young, yield

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      if (law%name /= 'EPLA') return
      call yield_of(material, law, 0.0_wp, young, yield)
      if (yield > largest_yield*young) call add(warnings, 'law '//material%name//': it yields at '//to_text(yield/young, 3) &
        //' of E, metals below '//to_text(largest_yield)//': are E and stresses in one unit?')
      if (yield > 0 .and. yield < smallest_yield*young) call add(warnings, 'law '//material%name//': it yields at ' &
        //to_text(yield/young, 3)//' of E, metals above '//to_text(smallest_yield)//': are E and stresses in one unit?')
    end associate
  end subroutine judge_yield

  !> Hardening that no metal has beside its modulus: a bar in tension would lose less than half of its stiffness as it yields. Not
  !> where the yield stress is told.
  subroutine judge_hardening(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: m             !! place among the materials
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: young, yield(2), slope

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      if (law%name /= 'EPLA') return
      call yield_of(material, law, 0.0_wp, young, yield(1))
      if (yield(1) > largest_yield*young) return
      call yield_of(material, law, first_strain, young, yield(2))
      slope = (yield(2) - yield(1))/first_strain + material%values(find_parameter(law, 'HKIN'))
      if (slope > largest_hardening*young) call add(warnings, 'law '//material%name//': it hardens by ' &
        //to_text(slope/young, 3)//' times E over the first '//to_text(100*first_strain) &
        //' % of plastic strain, metals by less than 0.3: are E and stresses in one unit?')
    end associate
  end subroutine judge_hardening

  !> Young's modulus, and the yield stress at rest after a plastic strain, at the first temperature of the law.
  subroutine yield_of(material, law, strain, young, yield)
    type(material_t), intent(in) :: material
    type(law_t), intent(in) :: law                !! EPLA
    real(wp), intent(in) :: strain                !! plastic [-]
    real(wp), intent(out) :: young, yield         !! [stress]
    real(wp) :: drivers(driver_count(law)), history(size(law%history)*4), poisson

    drivers = 0
    if (allocated(material%temperatures)) drivers(1) = material%temperatures(1)
    history = 0
    history(1) = strain
    call law%elastic(material, drivers(1), young, poisson)
    yield = law%flow_stress(material, drivers, history)
  end subroutine yield_of

  !> A table that goes to strains that no test has: they are in percent, and the metal hardens a hundred times too slowly.
  subroutine judge_strains(scene, m, warnings)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: m             !! place among the materials
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)

    associate (material => scene%materials(m))
      if (.not. allocated(material%curve)) return
      if (size(material%curve) == 0) return
      if (maxval(material%curve(1, :)) < largest_strain) return
      call add(warnings, 'law '//material%name//': its table goes to a plastic strain of ' &
               //to_text(maxval(material%curve(1, :)), 3)//', that of tests ends below '//to_text(largest_strain) &
               //': is it in percent?')
    end associate
  end subroutine judge_strains

  !> A coefficient of friction that no pair of metals has, and nothing beside it that bounds friction: a percentage.
  subroutine judge_friction(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: m             !! place among the materials
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: phi

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      if (find_parameter(law, 'PHI') == 0) return
      phi = material%values(find_parameter(law, 'PHI'))
      if (.not. (phi > largest_friction .and. phi < huge(phi))) return
      if (min(material%values(find_parameter(law, 'M')), material%values(find_parameter(law, 'TAUMAX'))) < huge(phi)) return
      call add(warnings, 'law '//material%name//': its coefficient of friction is '//to_text(phi, 3)//', of metals below ' &
               //to_text(largest_friction)//': is it in percent? Above 1 an equilibrium need not exist (what sticks: GLUE2D)')
    end associate
  end subroutine judge_friction

  !> A coefficient of expansion that no solid has: given in millionths.
  subroutine judge_alpha(scene, laws, m, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)   !! (nlaw)
    integer, intent(in) :: m             !! place among the materials
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: k

    associate (material => scene%materials(m), law => laws(scene%materials(m)%law_id))
      k = find_parameter(law, 'ALPHA')
      if (k == 0) return
      if (material%values(k) > largest_alpha) call add(warnings, 'law '//material%name//': it expands by ' &
        //to_text(material%values(k), 3)//' of its length for each degree, solids by less than '//to_text(largest_alpha) &
        //': is ALPHA in 1e-6?')
    end associate
  end subroutine judge_alpha

end module law_numbers_check
