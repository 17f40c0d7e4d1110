!> What the error of temperatures in space (space_error) takes over from one operation to the next: differences of the temperatures
!> of a mesh twice as fine, at nodes and at centres of elements, of bodies that go on.
!>
!> Nodes keep their numbers from one operation to the next; centres follow them in the order of the elements of all bodies, which
!> are others where a body comes or goes (ASLEEP). What comes has that of its START; beside the joint laid_bodies adds what the
!> temperature of the joint draws out.
module finer_temperatures
  use fields, only: find_field
  use heat_record, only: heat_record_t
  use kinds, only: wp
  use scene, only: is_solid, scene_t
  implicit none
  private
  public :: start_finer, take_finer

contains

  !> Differences at the start of a scene: what START gives at middles of sides and at centres, by the functions of eight nodes, less
  !> what is linear between the corners; none where it is the same everywhere.
  pure subroutine start_finer(scene, finer)
    type(scene_t), intent(in) :: scene
    real(wp), intent(inout) :: finer(:)    !! (nnode + nelem), 0 before; of none where they are not followed [temperature]
    real(wp) :: own(8)
    integer :: field, g, e, k, n

    if (.not. allocated(scene%starts) .or. size(finer) == 0) return
    field = find_field(scene%fields, 'temperature')
    n = size(scene%mesh%coordinates, 2)
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        n = n + 1
        associate (nodes => scene%groups(g)%connectivity(:, e))
          do k = 1, size(scene%starts)
            associate (start => scene%starts(k))
              if (start%field /= field .or. .not. (len(start%body) == 0 .or. start%body == scene%groups(g)%name)) cycle
              own = start%values(nodes(:8))
              finer(nodes(5:8)) = own(5:8) - 0.5_wp*(own(1:4) + own([2, 3, 4, 1]))
              finer(n) = 0.5_wp*(sum(own(5:8)) - sum(own(1:4)))
            end associate
          end do
        end associate
      end do
    end do
  end subroutine start_finer

  !> Differences and their heat contents at the beginning of an operation. Nodes that a body comes to keep their content. Where a
  !> body has gone it took its part of that of the nodes that it shared: contents are then 0, and the first step makes them of the
  !> temperatures.
  pure subroutine take_finer(old, before, new, after)
    type(scene_t), intent(in) :: old, new
    type(heat_record_t), intent(in) :: before
    type(heat_record_t), intent(inout) :: after   !! differences and contents are 0, of the sizes of the new scene
    logical, dimension(size(new%mesh%coordinates, 2)) :: was_there, is_there
    integer :: n, g, k, first, from, elements
    logical :: gone

    if (size(before%finer) == 0 .or. size(after%finer) == 0) return
    call list_nodes(old, was_there)
    call list_nodes(new, is_there)
    n = size(is_there)
    where (was_there .and. is_there)
      after%finer(:n) = before%finer(:n)
      after%finer_content(:n) = before%finer_content(:n)
    end where
    gone = .false.
    from = n
    do k = 1, size(old%groups)
      if (.not. is_solid(old%groups(k))) cycle
      elements = size(old%groups(k)%connectivity, 2)
      first = n
      do g = 1, size(new%groups)
        if (.not. is_solid(new%groups(g))) cycle
        if (new%groups(g)%name == old%groups(k)%name) exit
        first = first + size(new%groups(g)%connectivity, 2)
      end do
      if (g > size(new%groups)) then
        gone = .true.
      else
        after%finer(first + 1:first + elements) = before%finer(from + 1:from + elements)
        after%finer_content(first + 1:first + elements) = before%finer_content(from + 1:from + elements)
      end if
      from = from + elements
    end do
    if (gone) after%finer_content = 0
  end subroutine take_finer

  !> Nodes of bodies.
  pure subroutine list_nodes(scene, listed)
    type(scene_t), intent(in) :: scene
    logical, intent(out) :: listed(:)   !! (nnode)
    integer :: g

    listed = .false.
    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) listed([scene%groups(g)%connectivity]) = .true.
    end do
  end subroutine list_nodes

end module finer_temperatures
