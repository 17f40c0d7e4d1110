!> The fields of a scene in the checkpoint: what each of them is, and its values.
module exchange_fields
  use exchange_rules, only: read_matrix, require, require_range
  use fields, only: field_t, mechanical_fields, on_nodes, on_section
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use text, only: string_t
  implicit none
  private
  public :: read_declared_fields, read_field_values, write_fields

contains

  subroutine write_fields(file, fields)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), intent(in) :: fields(:)   !! (nfield)
    type(string_t), allocatable :: texts(:, :)
    integer :: k

    allocate (texts(size(fields), 7))
    do k = 1, size(fields)
      texts(k, 1)%s = fields(k)%name
      texts(k, 2)%s = fields(k)%unit
      texts(k, 3)%s = fields(k)%dual
      texts(k, 4)%s = fields(k)%dual_unit
      texts(k, 5)%s = fields(k)%quantity
      texts(k, 6)%s = fields(k)%transfer
      texts(k, 7)%s = fields(k)%word
    end do
    call file%write('fields/name', texts(:, 1))
    call file%write('fields/unit', texts(:, 2))
    call file%write('fields/dual', texts(:, 3))
    call file%write('fields/dual_unit', texts(:, 4))
    call file%write('fields/quantity', texts(:, 5))
    call file%write('fields/transfer', texts(:, 6))
    call file%write('fields/word', texts(:, 7))
    call file%write('fields/place', fields%place)
    call file%write('fields/components', fields%ncomp)
    call file%write('fields/first_angle', fields%first_angle)
    call file%write('fields/flags', reshape([(merge(1, 0, [fields(k)%at_corners, fields(k)%imposed_as_value, fields(k)%declared]), &
                                              k=1, size(fields))], [3, size(fields)]))
    call file%write('fields/initial', fields%initial)
    do k = 1, size(fields)
      call file%write(member(fields(k), 'floor'), fields(k)%floor)
      call file%write(member(fields(k), 'value'), fields(k)%value)
      call file%write_attribute(member(fields(k), 'value'), 'unit', fields(k)%unit)
      call file%write_attribute(member(fields(k), 'value'), 'transfer', fields(k)%transfer)
      call file%write(member(fields(k), 'last_increment'), fields(k)%last_increment)
      call file%write(member(fields(k), 'applied'), fields(k)%applied)
      call file%write(member(fields(k), 'reaction'), fields(k)%reaction)
    end do
  end subroutine write_fields

  !> Fields as elements declared them, without values.
  subroutine read_declared_fields(file, fields)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), allocatable, intent(out) :: fields(:)   !! (nfield)
    type(string_t), allocatable, dimension(:) :: name, unit, dual, dual_unit, quantity, transfer, word
    type(field_t) :: mechanical(3)
    integer, allocatable :: place(:), ncomp(:), angle(:), flags(:, :)
    real(wp), allocatable :: initial(:)
    integer :: i, k, n

    mechanical = mechanical_fields()
    allocate (fields(0))
    call file%read('fields/name', name)
    call file%read('fields/unit', unit)
    call file%read('fields/dual', dual)
    call file%read('fields/dual_unit', dual_unit)
    call file%read('fields/quantity', quantity)
    call file%read('fields/transfer', transfer)
    call file%read('fields/word', word)
    call file%read('fields/place', place)
    call file%read('fields/components', ncomp)
    call file%read('fields/first_angle', angle)
    call file%read('fields/flags', flags)
    call file%read('fields/initial', initial)
    if (file%failed()) return
    n = size(name)
    call require(file, 'fields/name', n >= size(mechanical), 'holds fewer fields than those of mechanics')
    call require(file, 'fields/name', all([size(unit), size(dual), size(dual_unit), size(quantity), size(transfer), size(word), &
                                           size(place), size(ncomp), size(angle), size(initial), size(flags, 2)] == n) &
                 .and. size(flags, 1) == 3, 'is not as long as the other lists of fields')
    call require_range(file, 'fields/place', place, on_nodes, on_section)
    call require_range(file, 'fields/components', ncomp, 1, 3)
    call require_range(file, 'fields/first_angle', angle, 0, 3)
    call require_range(file, 'fields/flags', flags, 0, 1)
    call require_range(file, 'fields/initial', initial, -huge(1.0_wp), huge(1.0_wp))
    if (file%failed()) return
    do k = 1, n
      call require(file, 'fields/name', all([(name(k)%s /= name(i)%s, i=1, k - 1)]), 'holds a field twice')
      if (k > size(mechanical)) cycle
      call require(file, 'fields/name', name(k)%s == mechanical(k)%name .and. place(k) == mechanical(k)%place &
                   .and. ncomp(k) == mechanical(k)%ncomp, 'has not the fields of mechanics first')
    end do
    if (.not. file%failed()) then
      deallocate (fields)
      allocate (fields(n))
      do k = 1, n
        fields(k)%name = name(k)%s
        fields(k)%unit = unit(k)%s
        fields(k)%dual = dual(k)%s
        fields(k)%dual_unit = dual_unit(k)%s
        fields(k)%quantity = quantity(k)%s
        fields(k)%transfer = transfer(k)%s
        fields(k)%word = word(k)%s
      end do
      fields%place = place
      fields%ncomp = ncomp
      fields%first_angle = angle
      fields%initial = initial
      fields%at_corners = flags(1, :) == 1
      fields%imposed_as_value = flags(2, :) == 1
      fields%declared = flags(3, :) == 1
    end if
  end subroutine read_declared_fields

  !> Values of the fields of a solution that was started from its scene.
  subroutine read_field_values(file, fields)
    type(hdf5_file_t), intent(inout) :: file
    type(field_t), intent(inout) :: fields(:)   !! (nfield)
    integer :: k

    do k = 1, size(fields)
      call file%read(member(fields(k), 'floor'), fields(k)%floor)
      call require_range(file, member(fields(k), 'floor'), fields(k)%floor, 0.0_wp, huge(1.0_wp))
      call read_matrix(file, member(fields(k), 'value'), fields(k)%value)
      call read_matrix(file, member(fields(k), 'last_increment'), fields(k)%last_increment)
      call read_matrix(file, member(fields(k), 'applied'), fields(k)%applied)
      call read_matrix(file, member(fields(k), 'reaction'), fields(k)%reaction)
    end do
  end subroutine read_field_values

  !> Dataset of a member of a field.
  pure function member(field, name) result(place)
    type(field_t), intent(in) :: field
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: place

    place = 'fields/'//field%name//'/'//name
  end function member

end module exchange_fields
