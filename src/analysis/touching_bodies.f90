!> Bodies whose nodes stand at the same places and that nothing joins: a JOIN or a contact was forgotten.
module touching_bodies
  use bodies, only: bodies_of_nodes
  use dies, only: is_deformable
  use kinds, only: wp
  use mesh_parts, only: sort_labels
  use scene, only: is_solid, scene_t
  use text, only: add => add_text, string_t, to_text
  implicit none
  private
  public :: are_in_contact, judge_touching

  !> Nodes stand at one place within this share of the size of the mesh.
  real(wp), parameter :: coincidence = 1.0e-6_wp
  !> Two places make a side that bodies have in common: its ends.
  integer, parameter :: least_places = 2

  type :: touch_t
    integer :: a = 0, b = 0      !! bodies, by their lowest nodes
    integer :: places = 0        !! that both have nodes at
    integer :: first = 0, last = 0   !! nodes at two of them
  end type touch_t

contains

  !> A warning for each pair of bodies that have places in common, and no contact.
  subroutine judge_touching(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)
    type(touch_t), allocatable :: touches(:)
    integer :: body(size(scene%mesh%coordinates, 2)), k

    body = bodies_of_nodes(scene)
    call find_touches(scene, body, touches)
    do k = 1, size(touches)
      associate (touch => touches(k))
        if (touch%places < least_places .or. are_in_contact(scene, touch%a, touch%b)) cycle
        call add(warnings, name_of(touch%a)//' and '//name_of(touch%b)//' have nodes at '//to_text(touch%places) &
                 //' places in common, from '//place_of(touch%first)//' to '//place_of(touch%last) &
                 //', and neither JOIN nor a contact: they come apart, or go through each other')
      end associate
    end do

  contains

    !> The first group of a body.
    pure function name_of(one) result(name)
      integer, intent(in) :: one
      character(len=:), allocatable :: name
      integer :: g

      name = ''
      do g = size(scene%groups), 1, -1
        if (.not. is_solid(scene%groups(g))) cycle
        if (body(scene%groups(g)%connectivity(1, 1)) == one) name = scene%groups(g)%name
      end do
    end function name_of

    pure function place_of(node) result(words)
      integer, intent(in) :: node
      character(len=:), allocatable :: words

      words = to_text(scene%mesh%coordinates(1, node), 6)//' '//to_text(scene%mesh%coordinates(2, node), 6)
    end function place_of

  end subroutine judge_touching

  !> Pairs of bodies with nodes at the same places: nodes in the order of x, compared within the tolerance.
  subroutine find_touches(scene, body, touches)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: body(:)   !! (nnode) the lowest node of each node's body
    type(touch_t), allocatable, intent(out) :: touches(:)
    integer :: key(size(body)), i, j
    integer, allocatable :: order(:)
    real(wp) :: tolerance

    allocate (touches(0))
    if (size(body) == 0) return
    if (all(body == body(1))) return
    associate (x => scene%mesh%coordinates)
      tolerance = coincidence*max(maxval(x(1, :)) - minval(x(1, :)), maxval(x(2, :)) - minval(x(2, :)))
      key = nint((x(1, :) - minval(x(1, :)))/tolerance)
      call sort_labels(key, order)
      do i = 1, size(order)
        do j = i + 1, size(order)
          if (key(order(j)) > key(order(i)) + 1) exit
          if (body(order(i)) == body(order(j))) cycle
          if (maxval(abs(x(:, order(i)) - x(:, order(j)))) > tolerance) cycle
          call count_place(min(body(order(i)), body(order(j))), max(body(order(i)), body(order(j))), order(i), touches)
        end do
      end do
    end associate
  end subroutine find_touches

  !> One more place of two bodies.
  pure subroutine count_place(a, b, node, touches)
    integer, intent(in) :: a, b, node
    type(touch_t), allocatable, intent(inout) :: touches(:)
    integer :: k

    do k = 1, size(touches)
      if (touches(k)%a == a .and. touches(k)%b == b) exit
    end do
    if (k > size(touches)) touches = [touches, touch_t(a, b, 0, node, node)]
    touches(k)%places = touches(k)%places + 1
    touches(k)%last = node
  end subroutine count_place

  !> Sides of the one face a die made of sides of the other.
  pure function are_in_contact(scene, a, b) result(yes)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: a, b   !! bodies, by their lowest nodes
    logical :: yes
    integer :: body(size(scene%mesh%coordinates, 2)), g

    yes = .false.
    body = bodies_of_nodes(scene)
    do g = 1, size(scene%groups)
      if (scene%groups(g)%die == 0) cycle
      if (.not. is_deformable(scene%dies(scene%groups(g)%die))) cycle
      associate (faces => body(scene%groups(g)%connectivity(1, :)), faced => body(scene%dies(scene%groups(g)%die)%nodes(1, :)))
        yes = yes .or. (any(faces == a) .and. any(faced == b)) .or. (any(faces == b) .and. any(faced == a))
      end associate
    end do
  end function are_in_contact

end module touching_bodies
