!> What the deck asks of the remesher, in the checkpoint.
module exchange_remesher
  use errors, only: exit_input
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use remesher_options, only: as_it_comes, has_contours, has_zones, remesher_options_t
  use text, only: string_t, to_text
  use zone_marks, only: contour_card_t, zone_card_t, zone_mark_t
  implicit none
  private
  public :: read_remesher, write_remesher

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
    if (remesher%mesher /= as_it_comes) call file%write('remesher/mesher', remesher%mesher)
    call file%write('remesher/tries', remesher%tries)
    if (has_zones(remesher)) call write_zones(file, remesher%marks, remesher%zones)
    if (has_contours(remesher)) call write_contours(file, remesher%contours)
  end subroutine write_remesher

  subroutine read_remesher(file, remesher)
    type(hdf5_file_t), intent(inout) :: file
    type(remesher_options_t), intent(out) :: remesher
    integer, allocatable :: numbers(:)
    real(wp), allocatable :: sizes(:)
    integer :: wanted

    wanted = 0
    call file%read('remesher/wanted', wanted)
    remesher%wanted = wanted == 1
    call file%read('remesher/transfer', numbers)
    if (size(numbers) == 2) then
      remesher%transfer = numbers(1)
      remesher%neighbours = numbers(2)
    end if
    call file%read('remesher/exponent', remesher%exponent)
    call file%read('remesher/size', sizes)
    if (size(sizes) == 2) then
      remesher%smallest = sizes(1)
      remesher%largest = sizes(2)
    end if
    call file%read('remesher/strain_error', remesher%strain_error)
    call file%read('remesher/count', numbers)
    if (size(numbers) == 2) then
      remesher%most_elements = numbers(1)
      remesher%across_contact = numbers(2)
    end if
    call file%read('remesher/turn', remesher%turn)
    if (file%has('remesher/mesher')) call file%read('remesher/mesher', remesher%mesher)
    call file%read('remesher/tries', remesher%tries)
    if (file%has('remesher/zones')) call read_zones(file, remesher)
    if (file%has('remesher/contours')) call read_contours(file, remesher%contours)
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
    call file%read('remesher/points/numbers', numbers)
    call file%read('remesher/points/place', places)
    call file%read('remesher/zones/name', zone_names)
    call file%read('remesher/zones/numbers', corners)
    if (any(shape(numbers) /= [6, size(names)]) .or. any(shape(places) /= [2, size(names)]) &
        .or. any(shape(corners) /= [5, size(zone_names)])) then
      call file%record_error(exit_input, 'remesher/zones: names and numbers do not fit')
      return
    end if
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
      call file%read('remesher/contours/'//to_text(k)//'/pieces', contours(k)%pieces)
      call file%read('remesher/contours/'//to_text(k)//'/side', contours(k)%row)
      if (any(shape(contours(k)%pieces) /= [2, 3, size(contours(k)%row)])) &
        call file%record_error(exit_input, 'remesher/contours: pieces and sides do not fit')
    end do
  end subroutine read_contours

end module exchange_remesher
