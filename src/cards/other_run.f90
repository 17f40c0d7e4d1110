!> Temperatures of another run at nodes of this scene: `FROM file` on a card.
!>
!> A node has the temperature of the place where it stands in the deck's own mesh, taken from the mesh of the other run where that
!> began: from the elements of the body of the same name, or from all that conduct heat where that run has no such body. In space by
!> shape functions, in time linear.
module other_run
  use box_tree, only: box_tree_t, build_tree
  use deck_cursor, only: cursor_t
  use elem_api, only: elem_t
  use element_fields, only: list_body_elems
  use errors, only: error_t
  use kinds, only: wp
  use nearest_element, only: box_of_element, find_element
  use run_temperatures, only: elements_of_body, read_run_temperatures, run_temperatures_t
  use scene_draft, only: draft_t, words_of
  use shape_functions, only: quad8
  use system, only: path_beside
  use text, only: string_t, to_text
  implicit none
  private
  public :: nodes_of_body, read_file_of_run, read_instant_of_run, temperatures_at_nodes

  !> A node may be so far outside of the other mesh, over the size of the nearest element: sides of unlike meshes bend differently.
  real(wp), parameter :: outside = 0.05_wp

contains

  !> `FROM file`: the file of a mesh of another run, its place relative to the deck.
  subroutine read_file_of_run(cursor, elems, deck_path, file, run)
    type(cursor_t), intent(inout) :: cursor
    type(elem_t), intent(in) :: elems(:)   !! (nelem_row)
    character(len=*), intent(in) :: deck_path
    character(len=:), allocatable, intent(out) :: file   !! as the card names it
    type(run_temperatures_t), intent(out) :: run         !! of no use where the cursor has failed
    character(len=:), allocatable :: from
    type(string_t), allocatable :: conducting(:)
    type(error_t), allocatable :: error

    call cursor%word('FROM', from)
    call cursor%word('the file of a run, NAME.g01.h5', file)
    if (cursor%failed()) return
    call list_body_elems(elems, conducting, 'temperature')
    call read_run_temperatures(path_beside(deck_path, file), conducting, run, error)
    if (allocated(error)) call cursor%fail(error%message)
  end subroutine read_file_of_run

  !> `AT time`: an instant of another run.
  subroutine read_instant_of_run(cursor, run, what, time)
    type(cursor_t), intent(inout) :: cursor
    type(run_temperatures_t), intent(in) :: run
    character(len=*), intent(in) :: what   !! the instant, for messages
    real(wp), intent(out) :: time          !! [time]
    type(string_t), allocatable :: words(:)
    integer :: k

    time = 0
    call words_of('AT', words)
    call cursor%name('AT, and '//what, words, k)
    if (cursor%failed()) return
    call cursor%real(what//', '//to_text(run%time(1), 6)//' to '//to_text(run%time(size(run%time)), 6), time, &
                     lower=run%time(1), upper=run%time(size(run%time)), unit='time')
  end subroutine read_instant_of_run

  !> Nodes of a body, each once, ascending.
  pure subroutine nodes_of_body(draft, body, nodes)
    type(draft_t), intent(in) :: draft
    integer, intent(in) :: body                     !! position of its group
    integer, allocatable, intent(out) :: nodes(:)   !! (n)
    logical :: own(size(draft%scene%mesh%coordinates, 2))
    integer :: i

    own = .false.
    own([draft%scene%groups(body)%connectivity]) = .true.
    nodes = pack([(i, i=1, size(own))], own)
  end subroutine nodes_of_body

  !> Temperatures of the other run at some nodes, at all its instants. The card fails where a node is outside of its mesh.
  subroutine temperatures_at_nodes(cursor, draft, run, file, body, nodes, values)
    type(cursor_t), intent(inout) :: cursor
    type(draft_t), intent(in) :: draft
    type(run_temperatures_t), intent(in) :: run
    character(len=*), intent(in) :: file, body   !! as the card names it; name of the body of the nodes
    integer, intent(in) :: nodes(:)              !! (n)
    real(wp), allocatable, intent(out) :: values(:, :)   !! (n, ninstant) [temperature]
    type(box_tree_t) :: tree
    integer, allocatable :: elements(:)
    real(wp), allocatable :: boxes(:, :)
    real(wp) :: xi(2), distance, size_of, phi(8), dphi(2, 8)
    integer :: i, e

    allocate (values(size(nodes), size(run%time)), source=0.0_wp)
    call elements_of_body(run, body, elements)
    allocate (boxes(4, size(run%connectivity, 2)))
    do e = 1, size(boxes, 2)
      boxes(:, e) = box_of_element(run%coordinates(:, run%connectivity(:, e)))
    end do
    call build_tree(boxes, elements, tree)
    do i = 1, size(nodes)
      associate (place => draft%scene%mesh%origin(:, nodes(i)))
        call find_element(run%coordinates, run%connectivity, tree, place, e, xi, distance)
        size_of = maxval(boxes(3:4, e) - boxes(1:2, e))
        if (distance > outside*size_of) then
          call cursor%fail('the node at x = '//to_text(place(1), 6)//', y = '//to_text(place(2), 6)//' is '//to_text(distance, 3) &
                           //' away from the mesh of '''//file//'''')
          return
        end if
      end associate
      call quad8(xi(1), xi(2), phi, dphi)
      values(i, :) = matmul(phi, run%values(run%connectivity(:, e), :))
    end do
  end subroutine temperatures_at_nodes

end module other_run
