!> Sizes of elements that are seldom meant: neighbours of unlike sizes, and elements much longer than wide.
!>
!> The length of an element across a side is that between the middles of this side and of the one opposite. Where it differs much
!> from that of the neighbour the coarser one decides the error there, and the finer one is of no use: mostly the ratio on a BLOCK
!> was taken for that of neighbours.
module uneven_mesh
  use kinds, only: wp
  use scene, only: group_t, is_solid, scene_t
  use text, only: add => add_text, string_t, to_text
  use vectors, only: length_of
  implicit none
  private
  public :: judge_sizes

  !> Sizes grow by a tenth to a half from one element to the next in meshes that resolve something, and by 2 to 5 in crude ones.
  real(wp), parameter :: largest_jump = 8.0_wp
  !> Sheets and layers of oxide have elements some tens to hundreds of times as long as wide.
  real(wp), parameter :: largest_aspect = 1000.0_wp

contains

  !> A warning for each body, of its worst place.
  subroutine judge_sizes(scene, warnings)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    integer :: g

    do g = 1, size(scene%groups)
      if (is_solid(scene%groups(g))) call judge_body(scene, scene%groups(g), warnings)
    end do
  end subroutine judge_sizes

  subroutine judge_body(scene, group, warnings)
    type(scene_t), intent(in) :: scene
    type(group_t), intent(in) :: group
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning)
    real(wp) :: across(size(scene%mesh%coordinates, 2)), length(2), jump, aspect, worst(2)
    integer :: e, k, at(2)

    across = 0
    worst = 1
    at = 0
    do e = 1, size(group%connectivity, 2)
      associate (x => scene%mesh%coordinates(:, group%connectivity(5:8, e)), middles => group%connectivity(5:8, e))
        length = [length_of(x(:, 3) - x(:, 1)), length_of(x(:, 4) - x(:, 2))]
        aspect = maxval(length)/minval(length)
        if (aspect > worst(2)) then
          worst(2) = aspect
          at(2) = middles(1)
        end if
        do k = 1, 4
          if (across(middles(k)) > 0) then
            jump = length(merge(1, 2, mod(k, 2) == 1))/across(middles(k))
            jump = max(jump, 1/jump)
            if (jump > worst(1)) then
              worst(1) = jump
              at(1) = middles(k)
            end if
          end if
          across(middles(k)) = length(merge(1, 2, mod(k, 2) == 1))
        end do
      end associate
    end do
    if (worst(1) > largest_jump) call add(warnings, group%name//': an element is '//to_text(worst(1), 3) &
      //' times as long as the next one'//place_of(at(1))//': the ratio on a BLOCK is that of the last element to the first')
    if (worst(2) > largest_aspect) call add(warnings, group%name//': an element is '//to_text(worst(2), 3) &
                                            //' times as long as wide'//place_of(at(2)) &
                                            //': are all coordinates in one unit?')

  contains

    function place_of(node) result(place)
      integer, intent(in) :: node
      character(len=:), allocatable :: place

      place = ', at x = '//to_text(scene%mesh%coordinates(1, node), 5)//', y = '//to_text(scene%mesh%coordinates(2, node), 5)
    end function place_of

  end subroutine judge_body

end module uneven_mesh
