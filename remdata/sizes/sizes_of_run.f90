!> Sizes for a first mesh that is made again.
!>
!> Where a part will touch its dies, and where it will be strained, is known only once it was: the first mesh of a body is made
!> blind. A short run on it shows its errors; what they ask for, with the needs of bends and contacts at the end of that run, is
!> taken back with the elements to where they began. The mesh made again so begins with the scene: nothing is transferred.
module sizes_of_run
  use block_mesh, only: polygon_area
  use contact_ends, only: contact_end_t
  use corrected_contours, only: contour_options_t, contour_report_t, contour_t
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use old_checkpoint, only: read_old_checkpoint
  use part_contour, only: build_contours
  use scene, only: lacks_mesh, scene_t
  use size_field, only: old_mesh_t, size_field_t
  use sizes_of_scene, only: requested_sizes
  use solution, only: present_coordinates, solution_t
  use state_pieces, only: solid_pieces, state_pieces_t
  implicit none
  private
  public :: learn_sizes, taken_back

contains

  !> Sizes asked for by a run on a first mesh, for the elements of that mesh where they began.
  subroutine learn_sizes(path, deck_text, options, found, generation, error)
    character(len=*), intent(in) :: path        !! checkpoint of the run
    character(len=*), intent(in) :: deck_text   !! of the scene that waits for its mesh
    type(contour_options_t), intent(in) :: options
    type(old_mesh_t), allocatable, intent(out) :: found
    integer, intent(out) :: generation          !! of the mesh that is made again
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: its_path, its_text
    type(scene_t) :: scene
    type(solution_t) :: solution
    type(contact_end_t), allocatable :: ends(:)
    type(contour_t), allocatable :: contours(:)
    type(contour_report_t) :: report
    type(size_field_t) :: sizes

    generation = 0
    call read_old_checkpoint(path, its_path, its_text, scene, solution, ends, error)
    if (allocated(error)) return
    generation = scene%generation + 1
    if (its_text /= deck_text .or. lacks_mesh(scene)) then
      call fail(error, exit_input, '--sizes-of: expected a checkpoint of the same deck on its first mesh, found '//path)
      return
    end if
    call build_contours(scene, solution, ends, options, contours, report, error)
    if (allocated(error)) return
    call requested_sizes(scene, solution, contours, .false., .false., sizes)
    allocate (found)
    call take_elements(scene, found)
    allocate (found%requested, source=taken_back(sizes%sizes, found, present_coordinates(scene, solution)))
  end subroutine learn_sizes

  !> The elements of a mesh where they began. Bodies have the numbers of a scene without mesh, where none shares nodes with another.
  pure subroutine take_elements(scene, found)
    type(scene_t), intent(in) :: scene
    type(old_mesh_t), intent(inout) :: found
    type(state_pieces_t) :: pieces
    integer :: k

    call solid_pieces(scene, pieces)
    allocate (found%nodes, source=pieces%nodes)
    allocate (found%connectivity(8, 0), found%material(0))
    do k = 1, size(pieces%groups)
      associate (elements => pieces%groups(k)%connectivity)
        found%connectivity = reshape([found%connectivity, elements], [8, size(found%connectivity, 2) + size(elements, 2)])
        found%material = [found%material, spread(k, 1, size(elements, 2))]
      end associate
    end do
  end subroutine take_elements

  !> Sizes at the corners of elements that have moved, as sizes of these elements where they began: as their own sizes have changed.
  pure function taken_back(sizes, began, moved) result(back)
    real(wp), intent(in) :: sizes(:)         !! (nnode) at corners [length]
    type(old_mesh_t), intent(in) :: began
    real(wp), intent(in) :: moved(:, :)      !! (2, nnode) where the nodes are now [length]
    real(wp) :: back(size(began%material))   !! (nelem) [length]
    real(wp) :: area
    integer :: e

    do e = 1, size(back)
      associate (corners => began%connectivity(1:4, e))
        back(e) = 0.25_wp*sum(sizes(corners))
        area = polygon_area(moved(:, corners))
        ! one that has turned over says nothing of how sizes have changed
        if (area > 0) back(e) = back(e)*sqrt(polygon_area(began%nodes(:, corners))/area)
      end associate
    end do
  end function taken_back

end module sizes_of_run
