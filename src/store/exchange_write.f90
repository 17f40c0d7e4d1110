!> Writing the checkpoint.
!>
!> Every state array carries the names, units and transfer kinds of its variables, taken from the laws and elements that declare
!> them: who reads it needs to know no law. What a scene does not have is written all the same, as 0 or empty: a dataset that is
!> missing is so always a mistake.
module exchange_write
  use contact_ends, only: contact_end_t
  use dies, only: is_deformable
  use errors, only: error_t
  use exchange_fields, only: write_fields
  use exchange_remesher, only: write_remesher
  use exchange_schema, only: fixation_place, group_place, schema_name, schema_version, set_place
  use hash, only: sha256
  use hdf5_atomic, only: commit_atomic, create_atomic
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use quadrature, only: rule_number
  use remeshing, only: estimate_t
  use scene, only: is_solid, scene_t
  use solution, only: solution_t
  use text, only: string_t
  implicit none
  private
  public :: write_checkpoint

contains

  !> Write the whole state of a run, atomically; the one before is kept beside it.
  subroutine write_checkpoint(path, deck_path, deck_text, scene, solution, ends, error)
    character(len=*), intent(in) :: path, deck_path, deck_text
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(contact_end_t), intent(in) :: ends(:)   !! (nend) where contact begins and ends now
    type(error_t), allocatable, intent(out) :: error
    type(hdf5_file_t) :: file

    call create_atomic(file, path, error)
    if (allocated(error)) return
    call file%write_attribute('/', 'schema', schema_name)
    call file%write_attribute('/', 'schema_version', schema_version)
    call file%write('deck/path', deck_path)
    call file%write('deck/text', deck_text)
    call file%write('deck/sha256', sha256(deck_text))
    call write_mesh(file, scene)
    call write_dies(file, scene)
    call write_progress(file, solution)
    call write_states(file, scene, solution)
    call file%write('estimate/wanted', merge(1, 0, scene%remesh%estimate))
    if (scene%remesh%estimate) call write_estimate(file, scene, solution%estimate)
    call write_ends(file, ends)
    call commit_atomic(file, error, keep_previous=.true.)
  end subroutine write_checkpoint

  subroutine write_mesh(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    integer :: k

    call file%write('mesh/generation', scene%generation)
    call file%write('mesh/plane_state', scene%plane_state)
    call file%write('mesh/finite', merge(1, 0, scene%finite))
    call file%write('mesh/coordinates', scene%mesh%coordinates)
    call file%write_attribute('mesh/coordinates', 'unit', 'length')
    call file%write('mesh/origin', scene%mesh%origin)
    call file%write_attribute('mesh/origin', 'unit', 'length')
    call file%write('mesh/labels', scene%mesh%labels)
    call file%write('mesh/nset', size(scene%mesh%sides))
    do k = 1, size(scene%mesh%sides)
      call file%write(set_place(k)//'/name', scene%mesh%sides(k)%name)
      call file%write(set_place(k)//'/nodes', scene%mesh%sides(k)%nodes)
    end do
    call file%write('mesh/ngroup', size(scene%groups))
    call file%write('mesh/nfixation', size(scene%fixations))
    do k = 1, size(scene%fixations)
      call file%write(fixation_place(k)//'/nodes', scene%fixations(k)%nodes)
      call file%write(fixation_place(k)//'/component', scene%fixations(k)%component)
    end do
    call write_remesher(file, scene%remesher)
  end subroutine write_mesh

  subroutine write_dies(file, scene)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(string_t) :: names(size(scene%dies))
    integer :: k
    do k = 1, size(scene%dies)
      names(k)%s = scene%dies(k)%name
    end do
    call file%write('dies_in_order', names)
    call file%group('dies')
    do k = 1, size(scene%dies)
      call file%write('dies/'//scene%dies(k)%name//'/pieces', scene%dies(k)%pieces)
      if (is_deformable(scene%dies(k))) then
        call file%write('dies/'//scene%dies(k)%name//'/nodes', scene%dies(k)%nodes)
      else
        call file%write('dies/'//scene%dies(k)%name//'/nodes', reshape([integer ::], [3, 0]))
      end if
      call file%write('dies/'//scene%dies(k)%name//'/start', scene%dies(k)%pilot)
    end do
  end subroutine write_dies

  subroutine write_progress(file, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(solution_t), intent(in) :: solution

    call file%write('progress/time', solution%time)
    call file%write('progress/step', solution%step)
    call file%write('progress/unbalanced', merge(1, 0, solution%unbalanced))
    call file%write('progress/last_step', solution%last_step)
    call file%write('progress/next_step', solution%next_step)
    call file%write('progress/recent_steps', solution%probation%recent)
    call file%write('progress/probation', solution%probation%left)
    call file%write('progress/probation_steps', [solution%probation%before, solution%probation%least])
    call file%write('progress/iterations', solution%iterations)
    call file%write('progress/cutbacks', solution%cutbacks)
    call file%write('progress/external_work', solution%external_work)
    call file%write('progress/friction_work', [solution%friction_work, solution%friction_apart])
    call file%write('progress/initial_volume', solution%initial_volume)
    call file%write('progress/worst', [solution%worst_linear_residual, solution%worst_penetration, &
                                      solution%worst_penetration_ratio, solution%least_dissipation, &
                                      solution%worst_sample, solution%worst_sample_ratio])
    call file%write('progress/spurious_mode', [solution%worst_spurious, real(solution%spurious_group, wp), &
                                              real(solution%spurious_element, wp)])
    call write_fields(file, solution%fields)
  end subroutine write_progress

  subroutine write_states(file, scene, solution)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    character(len=:), allocatable :: place
    type(string_t), allocatable :: names(:), units(:), kinds(:)
    integer :: g, v

    do g = 1, size(scene%groups)
      place = group_place(g)
      associate (group => scene%groups(g))
        call file%write(place//'/name', group%name)
        call file%write(place//'/elem', group%elem)
        call file%write(place//'/npoint', rule_number(group%rule))
        call file%write(place//'/role', group%role)
        call file%write(place//'/host', group%host)
        call file%write(place//'/connectivity', group%connectivity)
        call file%write(place//'/die_number', group%die)
        call file%write(place//'/material_number', group%material)
        if (group%material > 0) call file%write(place//'/material', scene%materials(group%material)%name)
        if (group%pairs > 0) call file%write(place//'/pairs', solution%pairs(group%pairs)%piece)
        allocate (names(size(group%variables)), units(size(group%variables)), kinds(size(group%variables)))
        do v = 1, size(group%variables)
          names(v)%s = group%variables(v)%name
          units(v)%s = group%variables(v)%unit
          kinds(v)%s = group%variables(v)%transfer
        end do
        call file%write(place//'/variables', names)
        call file%write(place//'/unit', units)
        call file%write(place//'/transfer', kinds)
        call file%write(place//'/components', group%variables%ncomp)
        call file%write(place//'/initial', group%variables%initial)
        call file%write(place//'/state', solution%groups(g)%committed)
        deallocate (names, units, kinds)
      end associate
    end do
  end subroutine write_states

  !> Errors of the mesh, element by element in the groups, and why a new one is due: triggers with value, limit, group and
  !> element (0: no place).
  subroutine write_estimate(file, scene, estimate)
    type(hdf5_file_t), intent(inout) :: file
    type(scene_t), intent(in) :: scene
    type(estimate_t), intent(in) :: estimate
    type(string_t), allocatable :: names(:)
    integer :: g, k, n, last

    call file%write('estimate/stress', estimate%stress)
    call file%write('estimate/strain', estimate%strain)
    last = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      n = last + 1
      last = last + size(scene%groups(g)%connectivity, 2)
      call file%write(group_place(g)//'/error_stress', estimate%stress_of(n:last))
      call file%write(group_place(g)//'/error_strain', estimate%strain_of(n:last))
      call file%write(group_place(g)//'/strain_sums', estimate%strain_sums(:, n:last))
    end do
    call file%write('remesh/last_stop', estimate%last_stop)
    call file%write('remesh/first_stress', estimate%first_stress)
    allocate (names(size(estimate%triggers)))
    do k = 1, size(names)
      names(k)%s = estimate%triggers(k)%name
    end do
    call file%write('remesh/triggers', names)
    call file%write('remesh/value', estimate%triggers%value)
    call file%write('remesh/limit', estimate%triggers%limit)
    call file%write('remesh/group', estimate%triggers%group)
    call file%write('remesh/element', estimate%triggers%element)
  end subroutine write_estimate

  !> Where contact begins and ends, for the remesher: one entry each. The solver does not read them back.
  subroutine write_ends(file, ends)
    type(hdf5_file_t), intent(inout) :: file
    type(contact_end_t), intent(in) :: ends(:)

    call file%write('contact_ends/begins', merge(1, 0, ends%begins))
    call file%write('contact_ends/group', ends%group)
    call file%write('contact_ends/side', ends%side)
    call file%write('contact_ends/place', ends%place)
    call file%write('contact_ends/die_piece', ends%piece)
    call file%write('contact_ends/die_xi', ends%xi)
  end subroutine write_ends

end module exchange_write
