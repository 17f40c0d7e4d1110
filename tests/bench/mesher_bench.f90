!> One body meshed without zones, by the free mesher or Gmsh: quality, elements and seconds, and the mesh.
!>
!>   mesher_bench OUTLINE free|gmsh MESH
!>
!> OUTLINE has smallest and largest size, the angle a side may turn by [degrees], the number of contours and of places with a
!> size; of each contour the number of its parabolas and these, by three points each; of each place x y size radius. Printed are
!> elements, smallest angle [degrees], smallest scaled Jacobian, attempts, seconds of the last one; MESH gets numbers of nodes and
!> elements, nodes, elements. Called by mesher_bench.py.
program mesher_bench
  use arguments, only: argument
  use body_outlines, only: outline_t
  use boundary_curves, only: boundary_curve_t, close_boundary, kind_end
  use contour_needs, only: geometry_settings_t, needs_of_boundary
  use corrected_contours, only: contour_options_t
  use errors, only: error_t
  use gmsh_call, only: find_gmsh
  use kinds, only: pi, wp
  use mesh_quality, only: mesh_shape
  use outline_mesh, only: mesh_outlines, mesher_t
  use remeshing, only: least_angle, ncriteria, scaled_jacobian
  use size_field, only: need_t, set_up_sizes, size_field_t, size_limits_t
  use zone_mesh, only: mesh_settings_t, new_mesh_t
  implicit none
  integer, parameter :: long = selected_int_kind(18)
  character(len=:), allocatable :: outline_file, who, mesh_file
  type(boundary_curve_t), allocatable :: boundaries(:)
  type(outline_t) :: outlines(1)
  type(contour_options_t) :: options
  type(size_limits_t) :: limits
  type(geometry_settings_t) :: bends
  type(need_t), allocatable :: needs(:), more(:)
  type(size_field_t) :: sizes
  type(mesh_settings_t) :: settings
  type(mesher_t) :: mesher
  type(new_mesh_t) :: mesh
  type(error_t), allocatable :: error
  real(wp), allocatable :: measures(:, :)
  integer(long) :: begin, finish, rate
  integer :: unit, ncontour, nneed, n, c, k, attempt

  call argument(1, outline_file)
  call argument(2, who)
  call argument(3, mesh_file)
  open (newunit=unit, file=outline_file, status='old', action='read')
  read (unit, *) limits%smallest, limits%largest, bends%turn, ncontour, nneed
  bends%turn = bends%turn*pi/180
  allocate (boundaries(ncontour), needs(0))
  do c = 1, ncontour
    read (unit, *) n
    allocate (boundaries(c)%arcs(n), boundaries(c)%kinds(n))
    boundaries(c)%kinds = kind_end
    do k = 1, n
      read (unit, *) boundaries(c)%arcs(k)%points
      boundaries(c)%arcs(k)%middle = k
      boundaries(c)%arcs(k)%side = k
    end do
    call close_boundary(options%corner_turn, boundaries(c))
    call needs_of_boundary(boundaries(c), bends, limits, more)
    needs = [needs, more]
  end do
  deallocate (more)
  allocate (more(nneed))
  do k = 1, nneed
    read (unit, *) more(k)%x, more(k)%size, more(k)%radius
  end do
  needs = [needs, more(:nneed)]
  close (unit)
  call set_up_sizes(limits, needs, sizes)
  outlines(1)%group = 1
  outlines(1)%material = 1
  outlines(1)%boundaries = [(c, c=1, ncontour)]
  settings%least_sine = 0.6_wp
  mesher%is_gmsh = who == 'gmsh'
  call find_gmsh(mesh_file, 300.0_wp, mesher%gmsh)
  ! as `mesh_without_zones`: finer, then split
  do attempt = 1, 4
    settings%division%refine = merge(1.0_wp, 1.05_wp, mod(attempt, 2) == 1)
    call system_clock(begin, rate)
    call mesh_outlines(boundaries, outlines, sizes, settings, attempt > 2, mesher, mesh, error)
    call system_clock(finish)
    if (.not. allocated(error)) exit
  end do
  if (allocated(error)) then
    print '(a)', error%message
    stop 3
  end if
  n = size(mesh%zone)
  allocate (measures(ncriteria, n))
  call mesh_shape(mesh%coordinates, mesh%connectivity, measures)
  print '(i0,2(1x,f0.3),1x,i0,1x,f0.2)', n, minval(measures(least_angle, :)), minval(measures(scaled_jacobian, :)), attempt, &
    real(finish - begin, wp)/real(rate, wp)
  open (newunit=unit, file=mesh_file, status='replace', action='write')
  write (unit, '(i0,1x,i0)') size(mesh%coordinates, 2), n
  write (unit, '(es24.16,1x,es24.16)') mesh%coordinates
  write (unit, '(8(i0,1x))') mesh%connectivity
  close (unit)
end program mesher_bench
