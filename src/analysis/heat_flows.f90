!> Heat through every boundary: the flow through each set of sides with FLUX, CONVE, RADIA or COU2DC, each place with an imposed
!> temperature, and from each source in a volume. With the heat of rigid dies as COU2DC and the heat of friction in it they are
!> all that comes into the bodies.
module heat_flows
  use equations, only: equations_t
  use fields, only: find_field
  use heat_books, only: has_heat, heat_from_die, heat_through
  use kinds, only: wp
  use scene, only: role_heat_contact, scene_t
  use solution, only: solution_t
  use text, only: string_t
  implicit none
  private
  public :: book_heat_flows, heat_flow_names

contains

  !> What the boundaries are called: as groups in the listing; places of IMPOS by its label.
  function heat_flow_names(scene) result(names)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable :: names(:)   !! (nflow)
    integer, allocatable :: groups(:), fixations(:)
    character(len=:), allocatable :: label
    integer :: k

    call find_boundaries(scene, groups, fixations)
    allocate (names(size(groups) + size(fixations)))
    do k = 1, size(groups)
      names(k)%s = scene%groups(groups(k))%name
    end do
    do k = 1, size(fixations)
      ! the label is `IMPOS place T lic`
      label = scene%fixations(fixations(k))%label
      label = label(len('IMPOS ') + 1:index(label, ' ', back=.true.) - 1)
      names(size(groups) + k)%s = label(:index(label, ' ', back=.true.) - 1)//'/IMPOS'
    end do
  end function heat_flow_names

  !> Flows of the step just found; reactions are booked already.
  subroutine book_heat_flows(scene, equations, solution)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(solution_t), intent(inout) :: solution
    integer, allocatable :: groups(:), fixations(:)
    logical :: counted(size(scene%mesh%labels))
    integer :: k, n

    if (.not. has_heat(scene)) return
    call find_boundaries(scene, groups, fixations)
    if (allocated(solution%heat_flows)) deallocate (solution%heat_flows)
    allocate (solution%heat_flows(size(groups) + size(fixations)), source=0.0_wp)
    do k = 1, size(groups)
      if (scene%groups(groups(k))%role == role_heat_contact) then
        solution%heat_flows(k) = heat_from_die(scene, equations, groups(k))
      else
        solution%heat_flows(k) = heat_through(scene, equations, groups(k))
      end if
    end do
    ! a node of two places is of the first
    counted = .false.
    associate (reaction => solution%fields(find_field(scene%fields, 'temperature'))%reaction, flows => solution%heat_flows)
      do k = 1, size(fixations)
        associate (nodes => scene%fixations(fixations(k))%nodes)
          do n = 1, size(nodes)
            if (.not. counted(nodes(n))) flows(size(groups) + k) = flows(size(groups) + k) + reaction(1, nodes(n))
            counted(nodes(n)) = .true.
          end do
        end associate
      end do
    end associate
  end subroutine book_heat_flows

  !> Groups and imposed values that heat comes in by; a place with two cards alike is one.
  subroutine find_boundaries(scene, groups, fixations)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: groups(:), fixations(:)   !! places in the scene's lists
    integer :: g, k, n, f

    allocate (groups(0), fixations(0))
    if (.not. has_heat(scene)) return
    f = find_field(scene%fields, 'temperature')
    groups = pack([(g, g=1, size(scene%groups))], scene%groups%brings_heat)
    do k = 1, size(scene%fixations)
      if (scene%fixations(k)%field /= f) cycle
      if (.not. any([(scene%fixations(fixations(n))%label == scene%fixations(k)%label, n=1, size(fixations))])) &
        fixations = [fixations, k]
    end do
  end subroutine find_boundaries

end module heat_flows
