!> Heat capacities and conductivities of a deck without steels whose unit is another than that of its lengths, times or stresses: as
!> J/m3/K in a deck of mm.
module heat_units
  use fields, only: displacement_field
  use kinds, only: wp
  use law_api, only: find_parameter, heat_law, law_t, solid_law
  use scene, only: host_of, lacks_mesh, scene_t
  use text, only: add => add_text, string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: judge_heat_units

  !> Heat that goes no further in the whole run than this share of the smallest element does nothing in it: the first beside
  !> mechanics, as in a blow (of 1 ms, in steel of elements of 1 mm, 0.2), the second where heat is all there is.
  real(wp), parameter :: least_way(2) = [0.01_wp, 0.1_wp]
  !> Heat capacity over Young's modulus: of metals 1e-5 to 1e-4, of plastics 1e-3, of soft rubber 2, in any unit [1/temperature].
  real(wp), parameter :: most_capacity = 10.0_wp

  !> Where Young's modulus is looked at [temperature].
  real(wp), parameter :: reference = 20.0_wp

contains

  !> Warnings, one line each.
  subroutine judge_heat_units(scene, laws, warnings)
    type(scene_t), intent(in) :: scene
    type(law_t), intent(in) :: laws(:)                          !! (nlaw)
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    logical :: told(size(scene%materials))
    real(wp) :: capacity, young, poisson, way, side
    integer :: g, k, m

    if (lacks_mesh(scene)) return
    told = .false.
    do g = 1, size(scene%groups)
      m = scene%groups(g)%material
      if (m == 0) cycle
      if (told(m) .or. laws(scene%materials(m)%law_id)%kind /= heat_law) cycle
      associate (law => laws(scene%materials(m)%law_id), material => scene%materials(m))
        if (find_parameter(law, 'RHOC') == 0) cycle
        capacity = material%values(find_parameter(law, 'RHOC'))
        if (.not. capacity > 0) cycle
        do k = 1, size(scene%groups)
          if (scene%groups(k)%material == 0 .or. told(m)) cycle
          associate (solid => scene%materials(scene%groups(k)%material), solid_row => laws(scene%materials( &
                                                                                          scene%groups(k)%material)%law_id))
            if (solid_row%kind /= solid_law .or. .not. associated(solid_row%elastic)) cycle
            if (host_of(scene, k) /= host_of(scene, g)) cycle
            call solid_row%elastic(solid, reference, young, poisson)
            if (capacity <= most_capacity*young) cycle
            call add(warnings, 'LAW '//material%name//': RHOC is '//to_text(capacity/young, 3)//' times E of LAW '//solid%name &
                     //' on the same body, 1E-5 to 1E-4 for metals and 2 for rubber, in any unit: is it in J/m3/K, in a deck of ' &
                     //'mm N s? There steel has 3.6')
            told(m) = .true.
          end associate
        end do
        if (told(m)) cycle
        way = sqrt(4*material%values(find_parameter(law, 'LAMBDA'))/capacity*scene%strategy%end_time)
        side = smallest_side(scene, g)
        if (way >= least_way(merge(1, 2, scene%fields(displacement_field)%declared))*side) cycle
        told(m) = .true.
        call add(warnings, 'LAW '//material%name//': by LAMBDA and RHOC heat goes no further than '//to_text(way, 2) &
                 //' [length] in the whole run, the smallest element is '//to_text(side, 3)//' long: are both in the units ' &
                 //'of the deck? In mm N s steel has 3.6 as RHOC')
      end associate
    end do
  end subroutine judge_heat_units

  !> Shortest side of the elements of a group.
  pure function smallest_side(scene, g) result(side)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: g
    real(wp) :: side   !! [length]
    integer :: e, i

    side = huge(side)
    associate (x => scene%mesh%coordinates, nodes => scene%groups(g)%connectivity)
      do e = 1, size(nodes, 2)
        do i = 1, 4
          side = min(side, length_of(x(:, nodes(i, e)) - x(:, nodes(1 + mod(i, 4), e))))
        end do
      end do
    end associate
  end function smallest_side

end module heat_units
