!> Bodies that are meshed from their contours alone.
!>
!> Parts of a body that are groups of their own, as two materials are, have an outline each: their share of the contours and the
!> seams between them, whose ends are ends of elements of both. How they are divided: outline_sides.
module body_outlines
  use bodies, only: elements_at_middles
  use body_seams, only: mark_sets, seams_t
  use contour_volume, only: volume_inside
  use corrected_contours, only: contour_t
  use errors, only: error_t, exit_input, fail
  use loop_group, only: group_of
  use scene, only: is_solid, scene_t
  use shape_functions, only: quad8_side
  implicit none
  private
  public :: outline_t, find_outlines, refuse_inner_sets

  !> A body in one piece: its group in the scene, and its contours. Or the part of a body that is a group.
  type :: outline_t
    integer :: group = 0, material = 0
    !> The outer contour, then the holes; of a part all contours of which it has a share.
    integer, allocatable :: boundaries(:)
    !> It shares sides with other groups.
    logical :: has_seams = .false.
  end type outline_t

contains

  !> All bodies, and the parts of those that have seams.
  pure subroutine find_outlines(scene, material, contours, outlines, error, seams)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: material(:)                         !! of each group of the scene, as for the sizes (ngroup)
    type(contour_t), intent(in) :: contours(:)                 !! (ncontour)
    type(outline_t), allocatable, intent(out) :: outlines(:)   !! (nbody)
    type(error_t), allocatable, intent(out) :: error
    type(seams_t), optional, intent(in) :: seams
    integer :: body(size(contours)), c, n
    logical :: of_parts(size(scene%groups)), in_parts(size(contours))

    of_parts = .false.
    if (present(seams)) then
      do n = 1, size(seams%interfaces)
        of_parts(seams%interfaces(n)%materials) = .true.
      end do
    end if
    call refuse_shared_nodes(scene, error, seams)
    if (.not. allocated(error)) call refuse_inner_sets(scene, contours, error, seams)
    if (allocated(error)) return
    do c = 1, size(contours)
      body(c) = contours(c)%loop%body
      in_parts(c) = .false.
      if (any(of_parts)) in_parts(c) = of_parts(group_of(scene, contours(c)%loop))
    end do
    ! numbers of bodies without parts, one after the other
    do n = maxval(body), 1, -1
      if (any(body == n .and. .not. in_parts)) cycle
      where (body > n) body = body - 1
    end do
    n = maxval([0, pack(body,.not. in_parts)])
    allocate (outlines(n + count(of_parts)))
    do n = 1, size(outlines)
      allocate (outlines(n)%boundaries(0))
    end do
    if (present(seams)) call add_parts(material, of_parts, seams, outlines(size(outlines) - count(of_parts) + 1:))
    do c = 1, size(contours)
      if (in_parts(c)) cycle
      associate (outline => outlines(body(c)))
        if (volume_inside(contours(c)%boundary, .false.) > 0) then
          outline%boundaries = [c, outline%boundaries]
        else
          outline%boundaries = [outline%boundaries, c]
        end if
        outline%group = group_of(scene, contours(c)%loop)
        outline%material = material(outline%group)
      end associate
    end do
  end subroutine find_outlines

  !> The parts of bodies, in the order of their groups.
  pure subroutine add_parts(material, of_parts, seams, outlines)
    integer, intent(in) :: material(:)            !! (ngroup)
    logical, intent(in) :: of_parts(:)            !! (ngroup)
    type(seams_t), intent(in) :: seams
    type(outline_t), intent(inout) :: outlines(:)   !! (npart)
    integer :: g, c, n

    n = 0
    do g = 1, size(of_parts)
      if (.not. of_parts(g)) cycle
      n = n + 1
      outlines(n)%has_seams = .true.
      outlines(n)%group = g
      outlines(n)%material = material(g)
      do c = 1, size(seams%groups, 2)
        if (any(seams%groups(:, c) == g)) outlines(n)%boundaries = [outlines(n)%boundaries, c]
      end do
    end do
  end subroutine add_parts

  !> Bodies that share nodes where no seam is.
  pure subroutine refuse_shared_nodes(scene, error, seams)
    type(scene_t), intent(in) :: scene
    type(error_t), allocatable, intent(out) :: error
    type(seams_t), optional, intent(in) :: seams
    integer :: owner(size(scene%mesh%coordinates, 2)), g, e, k
    logical :: on_seam(size(owner))

    call mark_shared_sides(scene, present(seams), on_seam)
    owner = 0
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 8
          associate (node => scene%groups(g)%connectivity(k, e))
            if (owner(node) == 0) owner(node) = g
            if (owner(node) == g .or. on_seam(node)) cycle
            call fail(error, exit_input, 'remdata: the bodies '//scene%groups(owner(node))%name//' and '//scene%groups(g)%name// &
                      ' share sides: a mesh without zones does not keep what is between them', 'give ZONE cards')
            return
          end associate
        end do
      end do
    end do
  end subroutine refuse_shared_nodes

  !> Nodes of sides that two groups share; none where these are not `wanted`.
  pure subroutine mark_shared_sides(scene, wanted, shared)
    type(scene_t), intent(in) :: scene
    logical, intent(in) :: wanted
    logical, intent(out) :: shared(:)   !! (nnode)
    integer :: owner(size(shared)), g, e, k

    owner = 0
    shared = .false.
    if (.not. wanted) return
    do g = 1, size(scene%groups)
      if (.not. is_solid(scene%groups(g))) cycle
      do e = 1, size(scene%groups(g)%connectivity, 2)
        do k = 1, 4
          associate (nodes => scene%groups(g)%connectivity(quad8_side(:, k), e))
            if (owner(nodes(2)) == 0) owner(nodes(2)) = g
            if (owner(nodes(2)) /= g) shared(nodes) = .true.
          end associate
        end do
      end do
    end do
  end subroutine mark_shared_sides

  !> Sets of sides are kept along contours and whole seams only: another one inside a body would be lost.
  pure subroutine refuse_inner_sets(scene, contours, error, seams)
    type(scene_t), intent(in) :: scene
    type(contour_t), intent(in) :: contours(:)   !! (ncontour)
    type(error_t), allocatable, intent(out) :: error
    type(seams_t), optional, intent(in) :: seams
    integer :: sharing(size(scene%mesh%coordinates, 2)), s
    integer, allocatable :: on_seam(:, :)
    logical :: whole(size(scene%mesh%sides))

    whole = .false.
    if (present(seams)) then
      allocate (on_seam(size(seams%interfaces), size(whole)))
      call mark_sets(scene%mesh%sides, contours, seams, on_seam, whole)
    end if
    sharing = elements_at_middles(scene)
    do s = 1, size(scene%mesh%sides)
      if (whole(s) .or. all(sharing(scene%mesh%sides(s)%nodes(2, :)) < 2)) cycle
      call fail(error, exit_input, 'remdata: the sides '//scene%mesh%sides(s)%name &
                //' lie inside a body: a new mesh does not keep them', &
                'name sides on the contour, or make the mesh of BLOCK cards')
      return
    end do
  end subroutine refuse_inner_sets

end module body_outlines
