!> Sizes of new meshes, and how many elements they have, where the cards do not say.
!>
!> They follow the mesh of the deck itself, however often it has been remeshed since: the choice of that mesh states how fine the
!> mesh should be.
module own_mesh_sizes
  use block_mesh, only: polygon_area
  use kinds, only: wp
  use mesh_parts, only: merge_nodes, mesh_parts_t, root_of
  use remesher_options, only: own_mesh_t, remesher_options_t
  use vectors, only: length_of
  implicit none
  private
  public :: measure_own_mesh, complete_options

  !> Smallest and largest elements over those of the deck's own mesh, and how many times as many elements there may be.
  real(wp), parameter :: smallest_share = 0.4_wp, largest_share = 2.5_wp
  !> A body so many times as long as thick is slender: it bends, and keeps so many elements across. (Sheets drawn with one across
  !> took up to 8 % more plastic work than with six, and forces were off by 20 to 30 %.)
  real(wp), parameter :: slender = 10.0_wp, across = 3.0_wp
  !> The smallest element where a die bends over the smallest elsewhere, and the angle by which sides turn there over that
  !> elsewhere. A bend of small radius that sides do not follow shapes the part otherwise than the die does, and what leaves it may
  !> not touch the die any more: a rod extruded through two angles was borne by a narrow land with 4 to 7 % less than on small
  !> elements with 0.4, by the meshes that it happened to get, with 0.35 or less with 3 to 4 %.
  real(wp), parameter :: share_at_bends = 0.35_wp, turn_at_bends = 0.5_wp
  integer, parameter :: growth = 3

contains

  !> Elements of the mesh that the cards make, their sizes (sides of squares of their areas), and how thick slender bodies are.
  pure function measure_own_mesh(parts) result(own)
    type(mesh_parts_t), intent(in) :: parts
    type(own_mesh_t) :: own
    real(wp) :: area(size(parts%bodies)), perimeter(size(parts%bodies)), one
    integer :: joined(size(parts%bodies)), b, e

    own%smallest = merge(huge(one), 0.0_wp, parts%sound .and. size(parts%bodies) > 0)
    allocate (own%thickness(size(parts%bodies)))
    own%thickness = 0
    if (.not. parts%sound) return
    call measure_sides(parts, joined, perimeter)
    area = 0
    do b = 1, size(parts%bodies)
      associate (connectivity => parts%bodies(b)%connectivity)
        own%elements = own%elements + size(connectivity, 2)
        do e = 1, size(connectivity, 2)
          one = abs(polygon_area(parts%coordinates(:, connectivity(1:4, e))))
          own%smallest = min(own%smallest, sqrt(one))
          own%largest = max(own%largest, sqrt(one))
          area(joined(b)) = area(joined(b)) + one
        end do
      end associate
    end do
    ! a strip has half of its perimeter as length, and its area over that as thickness
    do b = 1, size(parts%bodies)
      associate (all => area(joined(b)), around => perimeter(joined(b)))
        if (around**2 > 4*slender*all) own%thickness(b) = 2*all/around
      end associate
    end do
  end function measure_own_mesh

  !> Bodies that share sides, each by the first of them, and of those the length of the sides that belong to one element alone, of
  !> chords from corner to corner.
  pure subroutine measure_sides(parts, joined, perimeter)
    type(mesh_parts_t), intent(in) :: parts
    integer, intent(out) :: joined(:)       !! (nbody)
    real(wp), intent(out) :: perimeter(:)   !! (nbody) of the first body of each part, 0 of others [length]
    integer :: shared(size(parts%coordinates, 2)), of_body(size(parts%coordinates, 2)), b, e, k, middle

    joined = [(b, b=1, size(joined))]
    shared = 0
    of_body = 0
    do b = 1, size(parts%bodies)
      do e = 1, size(parts%bodies(b)%connectivity, 2)
        do k = 5, 8
          middle = root_of(parts%parent, parts%bodies(b)%connectivity(k, e))
          if (shared(middle) > 0) call merge_nodes(joined, of_body(middle), b)
          shared(middle) = shared(middle) + 1
          of_body(middle) = b
        end do
      end do
    end do
    joined = [(root_of(joined, b), b=1, size(joined))]
    perimeter = 0
    do b = 1, size(parts%bodies)
      do e = 1, size(parts%bodies(b)%connectivity, 2)
        associate (nodes => parts%bodies(b)%connectivity(:, e), x => parts%coordinates)
          do k = 1, 4
            if (shared(root_of(parts%parent, nodes(4 + k))) > 1) cycle
            perimeter(joined(b)) = perimeter(joined(b)) + length_of(x(:, nodes(mod(k, 4) + 1)) - x(:, nodes(k)))
          end do
        end associate
      end do
    end do
  end subroutine measure_sides

  !> What was not given is taken from the deck's own mesh. A smallest size that is given holds at bends and corners of dies too.
  pure subroutine complete_options(factor, options)
    real(wp), intent(in) :: factor   !! the run has so many times the deck's elements along a line
    type(remesher_options_t), intent(inout) :: options

    associate (own => options%own_mesh)
      if (.not. options%largest > 0) then
        options%smallest = smallest_share*own%smallest
        options%largest = largest_share*own%largest
        options%across_slender = factor*across
        options%smallest_at_bends = share_at_bends*options%smallest
        options%turn_at_dies = min(options%turn_at_dies, turn_at_bends*options%turn)
      end if
      if (.not. options%smallest_at_bends > 0) options%smallest_at_bends = options%smallest
      if (.not. options%smallest_at_corners > 0) options%smallest_at_corners = options%smallest
      if (options%most_elements == 0) options%most_elements = growth*own%elements
    end associate
  end subroutine complete_options

end module own_mesh_sizes
