!> The members of the deck's options for the remesher, and of ends of contact, which only the remesher reads (visitors).
module visit_remesher
  use contact_ends, only: contact_end_t
  use kinds, only: pi, wp
  use remesher_options, only: by_free, own_mesh_t, remesher_options_t
  use visit_cuts, only: visit_cut_list
  use visit_windows, only: visit_window_list
  use visitors, only: kept, not_carried, visitor_t
  use zone_marks, only: contour_card_t, mark_corner, mark_inside, name_length, zone_card_t, zone_mark_t
  implicit none
  private
  public :: visit_contact_ends, visit_remesher_options

  !> Limits that the cards have too (remesher_rows): methods of transfer, points of moving least squares, exponent of inverse
  !> distances.
  integer, parameter :: last_transfer = 2, fewest_neighbours = 8, most_neighbours = 64
  real(wp), parameter :: largest_exponent = 20.0_wp
  !> Entries of a list at most.
  integer, parameter :: most_parts = 100000
  !> Parent coordinates on sides and pieces are from -1 to 1, within round-off.
  real(wp), parameter :: on_side = 1.0_wp + 1.0e-6_wp

contains

  subroutine visit_remesher_options(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(remesher_options_t), intent(inout) :: self
    integer :: k, n

    call visitor%member('wanted', self%wanted, kept)
    call visitor%member('transfer', self%transfer, kept, low=0, high=last_transfer)
    call visitor%member('exponent', self%exponent, kept, '-', low=tiny(1.0_wp), high=largest_exponent)
    call visitor%member('neighbours', self%neighbours, kept, low=fewest_neighbours, high=most_neighbours)
    call visitor%member('smallest', self%smallest, kept, 'length', low=0.0_wp)
    call visitor%member('largest', self%largest, kept, 'length', low=0.0_wp)
    call visitor%member('smallest_at_bends', self%smallest_at_bends, kept, 'length', low=0.0_wp)
    call visitor%member('smallest_at_corners', self%smallest_at_corners, kept, 'length', low=0.0_wp)
    call visitor%member('strain_error', self%strain_error, kept, '-', low=tiny(1.0_wp))
    call visitor%member('most_elements', self%most_elements, kept, low=0)
    call visitor%member('across_contact', self%across_contact, kept, low=0)
    call visitor%member('across_slender', self%across_slender, kept, '-', low=0.0_wp)
    call visitor%member('turn', self%turn, kept, 'radian', low=tiny(1.0_wp), high=pi/2)
    call visitor%member('turn_at_dies', self%turn_at_dies, kept, 'radian', low=tiny(1.0_wp), high=pi/2)
    call visitor%member('stretch', self%stretch, kept, '-', low=1.0_wp)
    call visitor%member('mesher', self%mesher, kept, low=0, high=by_free)
    call visitor%member('tries', self%tries, kept, low=0)
    call visit_window_list(visitor, self%windows)
    call visitor%enter('own_mesh')
    call visit_own_mesh(visitor, self%own_mesh)
    call visitor%leave('own_mesh')
    call visitor%derived('accept', 'the solver reads it from the deck')
    n = 0
    if (allocated(self%marks)) n = size(self%marks)
    call visitor%list('points', n, most_parts)
    if (.not. allocated(self%marks)) allocate (self%marks(n))
    do k = 1, n
      call visitor%enter_item('points', k)
      call visit_zone_mark(visitor, self%marks(k))
      call visitor%leave('points')
    end do
    n = 0
    if (allocated(self%zones)) n = size(self%zones)
    call visitor%list('zones', n, most_parts)
    if (.not. allocated(self%zones)) allocate (self%zones(n))
    do k = 1, n
      call visitor%enter_item('zones', k)
      call visit_zone_card(visitor, self%zones(k))
      call visitor%leave('zones')
    end do
    n = 0
    if (allocated(self%contours)) n = size(self%contours)
    call visitor%list('contours', n, most_parts)
    if (.not. allocated(self%contours)) allocate (self%contours(n))
    do k = 1, n
      call visitor%enter_item('contours', k)
      call visit_contour_card(visitor, self%contours(k))
      call visitor%leave('contours')
    end do
    call visit_cut_list(visitor, self%cuts)
  end subroutine visit_remesher_options

  subroutine visit_own_mesh(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(own_mesh_t), intent(inout) :: self
    integer :: b, n

    call visitor%member('elements', self%elements, kept, low=0)
    call visitor%member('smallest', self%smallest, kept, 'length', low=0.0_wp)
    call visitor%member('largest', self%largest, kept, 'length', low=0.0_wp)
    n = 0
    if (allocated(self%thickness)) n = size(self%thickness)
    call visitor%list('bodies', n, most_parts)
    if (.not. allocated(self%thickness)) allocate (self%thickness(n))
    do b = 1, n
      call visitor%enter_item('bodies', b)
      call visitor%member('thickness', self%thickness(b), kept, 'length', low=0.0_wp)
      call visitor%leave('bodies')
    end do
  end subroutine visit_own_mesh

  !> A name of constant length.
  subroutine visit_name(visitor, name)
    class(visitor_t), intent(inout) :: visitor
    character(len=name_length), intent(inout) :: name
    character(len=:), allocatable :: text

    text = trim(name)
    call visitor%member('name', text, kept)
    name = text
  end subroutine visit_name

  subroutine visit_zone_mark(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(zone_mark_t), intent(inout) :: self

    call visit_name(visitor, self%name)
    call visitor%member('form', self%form, kept, low=mark_corner, high=mark_inside)
    call visitor%fixed('position', self%x, kept, 'length')
    call visitor%member('axis', self%axis, kept, low=0, high=2)
    call visitor%member('pick', self%pick, kept, low=-1, high=1)
    call visitor%member('by_matter', self%by_matter, kept)
    call visitor%member('die', self%die, kept, low=0)
    call visitor%member('stays', self%stays, kept)
  end subroutine visit_zone_mark

  subroutine visit_zone_card(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(zone_card_t), intent(inout) :: self

    call visit_name(visitor, self%name)
    call visitor%member('group', self%group, kept, low=1)
    call visitor%fixed('points', self%marks, kept, low=1)
  end subroutine visit_zone_card

  subroutine visit_contour_card(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(contour_card_t), intent(inout) :: self

    call visitor%member('group', self%group, kept, low=1)
    call visitor%member('pieces', self%pieces, kept, '2, 3, piece', 'length')
    call visitor%member('side', self%row, kept, 'piece', low=1)
    call visitor%member('loop', self%loop, kept, 'piece', low=1)
    call visitor%member('smallest', self%smallest, kept, 'length', low=0.0_wp)
    call visitor%member('largest', self%largest, kept, 'length', low=0.0_wp)
  end subroutine visit_contour_card

  !> Where contact begins and ends now: of the instant, for the remesher alone.
  subroutine visit_contact_ends(visitor, ends)
    class(visitor_t), intent(inout) :: visitor
    type(contact_end_t), allocatable, intent(inout) :: ends(:)   !! (n)
    integer :: k, n

    n = 0
    if (allocated(ends)) n = size(ends)
    call visitor%list('contact_ends', n, most_parts)
    if (.not. allocated(ends)) allocate (ends(n))
    do k = 1, n
      call visitor%enter_item('contact_ends', k)
      call visit_contact_end(visitor, ends(k))
      call visitor%leave('contact_ends')
    end do
  end subroutine visit_contact_ends

  subroutine visit_contact_end(visitor, self)
    class(visitor_t), intent(inout) :: visitor
    type(contact_end_t), intent(inout) :: self

    call visitor%member('begins', self%begins, not_carried)
    call visitor%member('group', self%group, not_carried, low=1)
    call visitor%member('side', self%side, not_carried, low=1)
    call visitor%member('position', self%place, not_carried, '-', low=-on_side, high=on_side)
    call visitor%member('die_piece', self%piece, not_carried, low=0)
    call visitor%member('die_xi', self%xi, not_carried, '-', low=-on_side, high=on_side)
  end subroutine visit_contact_end

end module visit_remesher
