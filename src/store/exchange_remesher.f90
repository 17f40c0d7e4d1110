!> What the deck asks of the remesher, in the checkpoint.
module exchange_remesher
  use exchange_rules, only: read_count, read_flag, read_list, read_numbers, require, require_range
  use hdf5_file, only: hdf5_file_t
  use kinds, only: pi, wp
  use remesher_options, only: by_gmsh, has_contours, has_zones, remesher_options_t
  use text, only: string_t, to_text
  use zone_marks, only: contour_card_t, mark_corner, mark_inside, zone_card_t, zone_mark_t
  implicit none
  private
  public :: read_remesher, write_remesher

  !> Limits that the cards have too (remesher_rows): methods of transfer, points of moving least squares, exponent of inverse
  !> distances.
  integer, parameter :: last_transfer = 2, fewest_neighbours = 8, most_neighbours = 64
  real(wp), parameter :: largest_exponent = 20.0_wp

contains

  !> What the deck asks of the remesher.
  subroutine write_remesher(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(in) :: remesher

    call file%write('remesher/wanted', merge(1, 0, remesher%wanted))
    call file%write('remesher/transfer', [remesher%transfer, remesher%neighbours])
    call file%write('remesher/exponent', remesher%exponent)
    call file%write('remesher/size', [remesher%smallest, remesher%largest])
    call file%write('remesher/strain_error', remesher%strain_error)
    call file%write('remesher/count', [remesher%most_elements, remesher%across_contact])
    call file%write('remesher/turn', remesher%turn)
    call file%write('remesher/mesher', remesher%mesher)
    call file%write('remesher/tries', remesher%tries)
    call file%write('remesher/has_zones', merge(1, 0, has_zones(remesher)))
    call file%write('remesher/has_contours', merge(1, 0, has_contours(remesher)))
    if (has_zones(remesher)) call write_zones(file, remesher%marks, remesher%zones)
    if (has_contours(remesher)) call write_contours(file, remesher%contours)
  end subroutine write_remesher

  subroutine read_remesher(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(out) :: remesher
    integer :: transfer(2), count(2)
    real(wp) :: sizes(2)
    logical :: zones, contours

    call read_flag(file, 'remesher/wanted', remesher%wanted)
    call read_numbers(file, 'remesher/transfer', transfer)
    call require_range(file, 'remesher/transfer', transfer(1), 0, last_transfer)
    call require_range(file, 'remesher/transfer', transfer(2), fewest_neighbours, most_neighbours)
    remesher%transfer = transfer(1)
    remesher%neighbours = transfer(2)
    call file%read('remesher/exponent', remesher%exponent)
    call require_range(file, 'remesher/exponent', remesher%exponent, tiny(1.0_wp), largest_exponent)
    call read_list(file, 'remesher/size', sizes)
    call require_range(file, 'remesher/size', sizes, 0.0_wp, huge(1.0_wp))
    call require(file, 'remesher/size', sizes(1) <= sizes(2), 'holds a smallest size above the largest one')
    remesher%smallest = sizes(1)
    remesher%largest = sizes(2)
    call file%read('remesher/strain_error', remesher%strain_error)
    call require_range(file, 'remesher/strain_error', remesher%strain_error, tiny(1.0_wp), huge(1.0_wp))
    call read_numbers(file, 'remesher/count', count)
    call require_range(file, 'remesher/count', count, 0, huge(1))
    remesher%most_elements = count(1)
    remesher%across_contact = count(2)
    call file%read('remesher/turn', remesher%turn)
    call require_range(file, 'remesher/turn', remesher%turn, tiny(1.0_wp), pi/2)
    call read_count(file, 'remesher/mesher', remesher%mesher, by_gmsh)
    call read_count(file, 'remesher/tries', remesher%tries)
    call read_flag(file, 'remesher/has_zones', zones)
    call read_flag(file, 'remesher/has_contours', contours)
    if (zones) call read_zones(file, remesher)
    if (contours) call read_contours(file, remesher%contours)
  end subroutine read_remesher

  !> Zones and their points, with the names that messages call them by. A row each of numbers: what a point is, axis, pick, by
  !> matter, stays, die; and of a zone: group, four points.
  subroutine write_zones(file, marks, zones)
    type(hdf5_file_t), intent(inout) :: file
    type(zone_mark_t), intent(in) :: marks(:)
    type(zone_card_t), intent(in) :: zones(:)
    integer :: k

    call file%write('remesher/points/name', names_of(marks%name))
    call file%write('remesher/points/numbers', reshape([(marks(k)%form, marks(k)%axis, marks(k)%pick, &
                                                         merge(1, 0, marks(k)%by_matter), merge(1, 0, marks(k)%stays), &
                                                         marks(k)%die, k=1, size(marks))], [6, size(marks)]))
    call file%write('remesher/points/place', reshape([(marks(k)%x, k=1, size(marks))], [2, size(marks)]))
    call file%write_attribute('remesher/points/place', 'unit', 'length')
    call file%write('remesher/zones/name', names_of(zones%name))
    call file%write('remesher/zones/numbers', reshape([(zones(k)%group, zones(k)%marks, k=1, size(zones))], [5, size(zones)]))

  contains

    pure function names_of(list) result(names)
      character(len=*), intent(in) :: list(:)
      type(string_t) :: names(size(list))
      integer :: i

      do i = 1, size(list)
        names(i)%s = trim(list(i))
      end do
    end function names_of

  end subroutine write_zones

  subroutine read_zones(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(inout) :: remesher
    type(string_t), allocatable :: names(:), zone_names(:)
    integer, allocatable :: numbers(:, :), corners(:, :)
    real(wp), allocatable :: places(:, :)
    integer :: k

    call file%read('remesher/points/name', names)
    call file%require_shape('remesher/points/numbers', [6, size(names)])
    call file%require_shape('remesher/points/place', [2, size(names)])
    call file%read('remesher/points/numbers', numbers)
    call file%read('remesher/points/place', places)
    call file%read('remesher/zones/name', zone_names)
    call file%require_shape('remesher/zones/numbers', [5, size(zone_names)])
    call file%read('remesher/zones/numbers', corners)
    if (file%failed()) return
    call require_range(file, 'remesher/points/numbers', numbers(1, :), mark_corner, mark_inside)
    call require_range(file, 'remesher/points/numbers', numbers(2, :), 0, 2)
    call require_range(file, 'remesher/points/numbers', numbers(3, :), -1, 1)
    call require_range(file, 'remesher/points/numbers', numbers(4:5, :), 0, 1)
    call require_range(file, 'remesher/zones/numbers', corners(2:, :), 1, size(names))
    if (file%failed()) return
    allocate (remesher%marks(size(names)), remesher%zones(size(zone_names)))
    do k = 1, size(names)
      remesher%marks(k) = zone_mark_t(name=names(k)%s, form=numbers(1, k), x=places(:, k), axis=numbers(2, k), &
                                      pick=numbers(3, k), by_matter=numbers(4, k) == 1, stays=numbers(5, k) == 1, &
                                      die=numbers(6, k))
    end do
    do k = 1, size(zone_names)
      remesher%zones(k) = zone_card_t(name=zone_names(k)%s, group=corners(1, k), marks=corners(2:, k))
    end do
  end subroutine read_zones

  !> Contours of bodies: parabolas, the side of the body that each is of, and the group of the body.
  subroutine write_contours(file, contours)
    type(hdf5_file_t), intent(inout) :: file
    type(contour_card_t), intent(in) :: contours(:)
    integer :: k

    call file%write('remesher/contours/group', contours%group)
    do k = 1, size(contours)
      call file%write('remesher/contours/'//to_text(k)//'/pieces', contours(k)%pieces)
      call file%write_attribute('remesher/contours/'//to_text(k)//'/pieces', 'unit', 'length')
      call file%write('remesher/contours/'//to_text(k)//'/side', contours(k)%row)
    end do
  end subroutine write_contours

  subroutine read_contours(file, contours)
    type(hdf5_file_t), intent(inout) :: file
    type(contour_card_t), allocatable, intent(out) :: contours(:)
    integer, allocatable :: groups(:)
    integer :: k

    call file%read('remesher/contours/group', groups)
    allocate (contours(size(groups)))
    do k = 1, size(groups)
      contours(k)%group = groups(k)
      call file%read('remesher/contours/'//to_text(k)//'/side', contours(k)%row)
      call require_range(file, 'remesher/contours/'//to_text(k)//'/side', contours(k)%row, 1, huge(1))
      call require(file, 'remesher/contours/'//to_text(k)//'/side', size(contours(k)%row) > 0, 'is empty')
      call file%require_shape('remesher/contours/'//to_text(k)//'/pieces', [2, 3, size(contours(k)%row)])
      call file%read('remesher/contours/'//to_text(k)//'/pieces', contours(k)%pieces)
    end do
  end subroutine read_contours

end module exchange_remesher
