!> Report of a remesh: lines for the terminal, a JSON file for the cycle and the report.
module remesh_report
  use boundary_curves, only: kind_entry
  use errors, only: error_t
  use json_writer, only: json_t
  use kinds, only: wp
  use material_volumes, only: materials_kept_t
  use remesh_facts, only: remesh_facts_t
  use run_version, only: version_text
  use standard_streams, only: print_line
  use text, only: string_t, to_text
  use transfer_report, only: carried_quantity_t, in_words, report_lines
  implicit none
  private
  public :: print_facts, write_facts

  !> An end of contact has no node when the nearest one is farther than this share of the contour.
  real(wp), parameter :: without_node = 1.0e-8_wp

contains

  !> A few lines on the terminal; none after an error.
  subroutine print_facts(facts, seconds, error)
    type(remesh_facts_t), intent(in) :: facts
    real(wp), intent(in) :: seconds
    type(error_t), allocatable, intent(inout) :: error
    type(string_t), allocatable :: lines(:)
    integer :: k

    call print_line('mesh '//to_text(facts%generation)//' at step '//to_text(facts%step)//', time ' &
      //to_text(facts%time)//': '//to_text(facts%old_elements)//' -> '//to_text(facts%new_elements)//' elements, '// &
      to_text(seconds, 3)//' s', error)
    call print_line('  contour: largest move '//to_text(facts%contour%largest_move, 3)//', free sides shifted by ' &
      //to_text(facts%contour%largest_shift, 3)//', volume '//to_text(100*facts%contour%volume_error, 3)//' %', error)
    do k = 1, size(facts%contour%limits)
      associate (limit => facts%contour%limits(k))
        call print_line('  contact '//trim(merge('begins', 'ends  ', limit%kind == kind_entry))//' at x = ' &
          //to_text(limit%point(1))//', y = '//to_text(limit%point(2)), error)
      end associate
    end do
    if (allocated(facts%contour%points)) then
      do k = 1, size(facts%contour%points, 2)
        associate (point => facts%contour%points(:, k))
          call print_line('  contact at the point x = '//to_text(point(1))//', y = '//to_text(point(2)), error)
        end associate
      end do
    end if
    if (allocated(facts%contour%folds)) then
      do k = 1, size(facts%contour%folds)
        associate (fold => facts%contour%folds(k))
          call print_line('  lap from x = '//to_text(fold%from(1))//', y = '//to_text(fold%from(2))//' to x = ' &
            //to_text(fold%to(1))//', y = '//to_text(fold%to(2))//', '//to_text(fold%length, 3)//' deep', error)
        end associate
      end do
    end if
    if (allocated(facts%cuts)) call print_line('  cut: volume removed '//to_text(facts%removed, 6), error)
    call print_line('  by '//facts%mesher//', shape: scaled Jacobian from '//to_text(facts%mesh%scaled_jacobian, 3)//', angles ' &
      //to_text(facts%mesh%least_angle, 3)//' to '//to_text(facts%mesh%largest_angle, 4)//' degrees', error)
    if (facts%mesh%off_ends > without_node) call print_line('  an end of contact has no node: the nearest one is ' &
      //to_text(facts%mesh%off_ends, 3)//' of the contour away, too close to it for another element', error)
    if (facts%fit > 0) call print_line('  sides of bodies in contact fitted to each other: nodes moved by ' &
      //to_text(facts%fit, 3)//' of a side at most', error)
    call print_line('  errors expected: '//to_text(facts%expected%mean, 3)//' times the limit in the mean, ' &
      //to_text(facts%expected%worst, 3)//' at worst; '//to_text(facts%expected%elements, 3)//' times the elements it takes', error)
    if (facts%coarser > 1) call print_line('  sizes '//to_text(facts%coarser, 3) &
      //' times the requested ones, for the limit on the number of elements', error)
    if (.not. allocated(facts%transfer%rows)) return   ! a first mesh
    call report_lines(facts%transfer, lines)
    do k = 1, size(lines)
      call print_line('  '//lines(k)%s, error)
    end do
    if (.not. allocated(facts%contacts)) return
    do k = 1, size(facts%contacts)
      call print_line('  '//in_words(facts%contacts(k)), error)
    end do
  end subroutine print_facts

  !> The JSON file; `failure` is the error that ended the remesh, if there was one.
  subroutine write_facts(path, facts, seconds, failure, error)
    character(len=*), intent(in) :: path
    type(remesh_facts_t), intent(in) :: facts
    real(wp), intent(in) :: seconds
    type(error_t), allocatable, intent(in) :: failure
    type(error_t), allocatable, intent(out) :: error
    type(json_t) :: json
    integer :: k

    call json%begin_object()
    call json%add('program', 'remdata')
    call json%add('version', version_text)
    call json%add('accepted',.not. allocated(failure))
    if (allocated(failure)) then
      call json%add('stage', facts%stage)
      call json%add('reason', failure%message)
    end if
    call json%add('generation', facts%generation)
    call json%add('step', facts%step)
    call json%add('time', facts%time)
    call json%add('old_elements', facts%old_elements)
    call json%add('new_elements', facts%new_elements)
    call json%add('wall_s', seconds)
    if (allocated(facts%contour%folds)) then
      call json%add('laps', size(facts%contour%folds))
      call json%add('lap_depth', maxval([0.0_wp, facts%contour%folds%length]))
    end if
    if (allocated(facts%cuts)) call json%add('removed_volume', facts%removed)
    call json%begin_object('seconds')
    do k = 1, facts%timers%size()
      call json%add(facts%timers%name(k), facts%timers%seconds(k))
    end do
    call json%end_object()
    call add_contour(json, facts)
    call add_mesh(json, facts)
    call json%begin_array('materials')
    if (allocated(facts%materials%volumes)) call add_materials(json, facts%materials)
    call json%end_array()
    call json%begin_array('transfer')
    if (allocated(facts%transfer%rows)) call add_rows(json, facts%transfer%rows)
    if (allocated(facts%contacts)) call add_rows(json, facts%contacts)
    call json%end_array()
    call json%end_object()
    call json%write_file(path, error)
  end subroutine write_facts

  !> What the correction of the contour has done, laps that were cut off, and where contact begins and ends.
  subroutine add_contour(json, facts)
    type(json_t), intent(inout) :: json
    type(remesh_facts_t), intent(in) :: facts
    integer :: k

    call json%begin_object('contour')
    call json%add('largest_move', facts%contour%largest_move)
    call json%add('largest_shift', facts%contour%largest_shift)
    call json%add('volume_error', facts%contour%volume_error)
    call json%add('off_ends', facts%contour%off_ends)
    call json%add('small_gaps', facts%contour%small_gaps)
    call json%begin_array('laps')
    if (allocated(facts%contour%folds)) then
      do k = 1, size(facts%contour%folds)
        associate (fold => facts%contour%folds(k))
          call json%begin_object()
          call json%add('x1', fold%from(1))
          call json%add('y1', fold%from(2))
          call json%add('x2', fold%to(1))
          call json%add('y2', fold%to(2))
          call json%add('depth', fold%length)
          call json%end_object()
        end associate
      end do
    end if
    call json%end_array()
    call json%begin_array('limits')
    if (allocated(facts%contour%limits)) then
      do k = 1, size(facts%contour%limits)
        associate (limit => facts%contour%limits(k))
          call json%begin_object()
          call json%add('begins', limit%kind == kind_entry)
          call json%add('x', limit%point(1))
          call json%add('y', limit%point(2))
          call json%add('depth', limit%depth)
          call json%end_object()
        end associate
      end do
    end if
    call json%end_array()
    call json%end_object()
  end subroutine add_contour

  !> Shape of the mesh, what it misses, and the errors that are expected on it.
  subroutine add_mesh(json, facts)
    type(json_t), intent(inout) :: json
    type(remesh_facts_t), intent(in) :: facts

    call json%begin_object('mesh')
    call json%add('mesher', facts%mesher)
    call json%add('scaled_jacobian', facts%mesh%scaled_jacobian)
    call json%add('least_angle', facts%mesh%least_angle)
    call json%add('largest_angle', facts%mesh%largest_angle)
    call json%add('aspect_ratio', facts%mesh%aspect_ratio)
    call json%add('sharpest_corner', facts%mesh%sharpest_corner)
    call json%add('off_contour', facts%mesh%off_contour)
    call json%add('off_ends', facts%mesh%off_ends)
    call json%add('off_interface', facts%materials%off_interface)
    call json%add('pair_fit', facts%fit)
    call json%add('coarser', facts%coarser)
    call json%add('expected_error_mean', facts%expected%mean)
    call json%add('expected_error_worst', facts%expected%worst)
    call json%add('elements_over_wanted', facts%expected%elements)
    call json%end_object()
  end subroutine add_mesh

  !> Volumes of materials that share sides, per unit thickness or per radian.
  subroutine add_materials(json, kept)
    type(json_t), intent(inout) :: json
    type(materials_kept_t), intent(in) :: kept
    integer :: k

    do k = 1, size(kept%volumes)
      call json%begin_object()
      call json%add('name', kept%volumes(k)%name)
      call json%add('volume_before', kept%volumes(k)%before)
      call json%add('volume_after', kept%volumes(k)%after)
      call json%end_object()
    end do
  end subroutine add_materials

  subroutine add_rows(json, rows)
    type(json_t), intent(inout) :: json
    type(carried_quantity_t), intent(in) :: rows(:)
    integer :: k

    do k = 1, size(rows)
      call json%begin_object()
      call json%add('name', rows(k)%name)
      call json%add('before', rows(k)%before)
      call json%add('carried', rows(k)%carried)
      call json%add('after', rows(k)%after)
      call json%add('largest_before', rows(k)%largest_before)
      call json%add('largest_after', rows(k)%largest_after)
      call json%end_object()
    end do
  end subroutine add_rows

end module remesh_report
