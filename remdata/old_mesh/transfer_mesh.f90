!> A mesh for the state transfer: elements, integration points with their volumes, and search trees, all of them by material.
module transfer_mesh
  use box_tree, only: box_tree_t, build_tree
  use kinds, only: wp
  use nearest_element, only: box_of_element
  use quadrature, only: square_rule
  use shape_functions, only: quad8
  implicit none
  private
  public :: transfer_mesh_t, set_up_mesh, build_element_trees, build_mesh_trees

  type :: transfer_mesh_t
    !> Materials are numbered 1 ... nmaterial. Values are transferred between points of the same number only.
    integer :: nmaterial = 0
    !> Points of element e are first_point(e) ... first_point(e + 1) - 1 (nelem + 1).
    integer, allocatable :: first_point(:)
    real(wp), allocatable :: nodes(:, :)                                !! (2, nnode), where they are now [length]
    integer, allocatable :: connectivity(:, :)                          !! (8, nelem)
    integer, allocatable :: material(:)                                 !! (nelem)
    real(wp), allocatable :: points(:, :)                               !! (2, n) [length]
    real(wp), allocatable :: volumes(:)  !! (n), per unit thickness, or per radian [length^2 or length^3]
    integer, allocatable :: point_material(:)                           !! (n)
    integer, allocatable :: point_element(:)                            !! (n)
    type(box_tree_t), allocatable :: point_trees(:), element_trees(:)   !! (nmaterial), where they were built
  end type transfer_mesh_t

contains

  !> Points and volumes of 8-node elements, each with its own Gauss rule.
  pure subroutine set_up_mesh(nodes, connectivity, material, npoint, axisymmetric, mesh)
    real(wp), intent(in) :: nodes(:, :)                      !! (2, nnode) coordinates [length]
    integer, intent(in) :: connectivity(:, :), material(:)   !! (8, nelem); (nelem)
    integer, intent(in) :: npoint(:)                         !! (nelem)
    logical, intent(in) :: axisymmetric                      !! the radius is x
    type(transfer_mesh_t), intent(out) :: mesh
    real(wp), allocatable :: xi(:, :), weight(:)
    real(wp) :: phi(8), dphi(2, 8), x(2, 8), jacobian(2, 2)
    integer :: e, p, k, n, rule

    mesh%nmaterial = max(0, maxval(material))
    allocate (mesh%nodes, source=nodes)
    allocate (mesh%connectivity, source=connectivity)
    allocate (mesh%material, source=material)
    allocate (mesh%first_point(size(material) + 1))
    mesh%first_point(1) = 1
    do e = 1, size(material)
      mesh%first_point(e + 1) = mesh%first_point(e) + npoint(e)
    end do
    n = sum(npoint)
    allocate (mesh%points(2, n), mesh%volumes(n), mesh%point_material(n), mesh%point_element(n))
    rule = 0
    do e = 1, size(material)
      if (npoint(e) /= rule) call square_rule(npoint(e), xi, weight)
      rule = npoint(e)
      x = nodes(:, connectivity(:, e))
      do p = 1, rule
        call quad8(xi(1, p), xi(2, p), phi, dphi)
        k = mesh%first_point(e) + p - 1
        mesh%points(:, k) = matmul(x, phi)
        jacobian = matmul(x, transpose(dphi))
        mesh%volumes(k) = weight(p)*(jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1))
        if (axisymmetric) mesh%volumes(k) = mesh%volumes(k)*mesh%points(1, k)
        mesh%point_material(k) = material(e)
        mesh%point_element(k) = e
      end do
    end do
  end subroutine set_up_mesh

  !> Trees of points and of elements, one of each per material. Only the old mesh needs them.
  pure subroutine build_mesh_trees(mesh)
    type(transfer_mesh_t), intent(inout) :: mesh
    real(wp), allocatable :: boxes(:, :)
    integer :: m, i

    call build_element_trees(mesh)
    if (allocated(mesh%point_trees)) deallocate (mesh%point_trees)
    allocate (boxes(4, size(mesh%volumes)), mesh%point_trees(mesh%nmaterial))
    boxes(1:2, :) = mesh%points
    boxes(3:4, :) = mesh%points
    do m = 1, mesh%nmaterial
      call build_tree(boxes, pack([(i, i=1, size(mesh%volumes))], mesh%point_material == m), mesh%point_trees(m))
    end do
  end subroutine build_mesh_trees

  !> Trees of elements alone, to locate points by.
  pure subroutine build_element_trees(mesh)
    type(transfer_mesh_t), intent(inout) :: mesh
    real(wp), allocatable :: boxes(:, :)
    integer :: e, m, i

    if (allocated(mesh%element_trees)) deallocate (mesh%element_trees)
    allocate (boxes(4, size(mesh%material)), mesh%element_trees(mesh%nmaterial))
    do e = 1, size(mesh%material)
      boxes(:, e) = box_of_element(mesh%nodes(:, mesh%connectivity(:, e)))
    end do
    do m = 1, mesh%nmaterial
      call build_tree(boxes, pack([(i, i=1, size(mesh%material))], mesh%material == m), mesh%element_trees(m))
    end do
  end subroutine build_element_trees

end module transfer_mesh
