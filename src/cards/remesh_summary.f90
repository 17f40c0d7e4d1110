!> Lines of a scene's summary on remeshing: limits at which a new mesh is due, and what it will be.
module remesh_summary
  use kinds, only: wp
  use remesher_options, only: bodies_have_sizes, remesher_options_t
  use remesher_windows, only: window_text
  use remeshing, only: criterion_names, has_limit, is_upper, ncriteria, never
  use scene, only: scene_t
  use summary_words, only: direction_names
  use text, only: add_text, padded, string_t, to_text
  implicit none
  private
  public :: add_remesh_lines

contains

  subroutine add_remesh_lines(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)   !! (nline)

    call add_shape_limits(scene, lines)
    call add_instant_limits(scene, lines)
    if (.not. has_limit(scene%remesh)) call add_limit(lines, 'never again', 'after the first mesh: no row of REMSH is a limit')
    call add_new_mesh(scene, lines)
  end subroutine add_remesh_lines

  !> Limits of errors, shapes, contact and distress.
  subroutine add_shape_limits(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer :: k

    associate (rules => scene%remesh)
      if (rules%stress_error < never) &
        call add_limit(lines, 'stress_error', 'above '//to_text(rules%stress_error)//strain_text(rules%error_strain))
      do k = 1, ncriteria
        if (.not. abs(rules%shape(k)) < never) cycle
        call add_limit(lines, trim(criterion_names(k)), trim(merge('above', 'below', is_upper(k)))//' '//to_text(rules%shape(k)) &
                       //share_text(rules%bad_share))
      end do
      if (rules%contact < never) &
        call add_limit(lines, 'contact', 'deeper by '//to_text(rules%contact)//' times the allowed penetration')
      if (rules%narrow < never) call add_limit(lines, 'narrow_contact', 'sides where a die is borne by few nodes longer by '// &
                                               to_text(rules%narrow)//' than new ones')
      if (rules%corner < never) call add_limit(lines, 'corner_side', 'sides that corners of dies press into longer by '// &
                                               to_text(rules%corner)//' than when new')
      if (rules%distress < huge(0)) call add_limit(lines, 'distress', to_text(rules%distress)//' cutbacks in a row')
    end associate
  end subroutine add_shape_limits

  !> Instants and strokes of dies.
  subroutine add_instant_limits(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer :: k

    do k = 1, size(scene%remesh%times)
      call add_limit(lines, 'time', to_text(scene%remesh%times(k)))
    end do
    do k = 1, size(scene%remesh%strokes)
      associate (stroke => scene%remesh%strokes(k))
        call add_limit(lines, 'stroke', scene%dies(stroke%die)%name//' '//direction_names(stroke%component)//' = ' &
                       //to_text(stroke%value))
      end associate
    end do
  end subroutine add_instant_limits

  !> Sizes of elements of the new mesh, and its windows.
  subroutine add_new_mesh(scene, lines)
    type(scene_t), intent(in) :: scene
    type(string_t), allocatable, intent(inout) :: lines(:)
    integer :: k

    associate (wish => scene%remesher)
      call add_text(lines, 'new mesh   elements of '//to_text(wish%smallest, 4)//' to '//to_text(wish%largest, 4) &
                    //most_text(wish%most_elements)//bends_text(wish)//', error of the strain '//to_text(100*wish%strain_error) &
                    //' %')
      if (bodies_have_sizes(wish)) then
        do k = 1, size(wish%contours)
          associate (body => wish%contours(k))
            call add_text(lines, 'new mesh   '//scene%groups(body%group)%name//': elements of '//to_text(body%smallest, 4)//' to ' &
                          //to_text(body%largest, 4))
          end associate
        end do
      end if
      do k = 1, size(wish%windows)
        call add_text(lines, 'window     '//window_text(wish%windows(k), name_of_die(scene, wish%windows(k)%die)))
      end do
    end associate
  end subroutine add_new_mesh

  !> The smallest size where dies bend and at their corners, if that is another.
  pure function bends_text(wish) result(text)
    type(remesher_options_t), intent(in) :: wish
    character(len=:), allocatable :: text

    text = ''
    if (wish%smallest_at_bends < wish%smallest) text = ', from '//to_text(wish%smallest_at_bends, 4)//' where dies bend'
    if (wish%smallest_at_corners < wish%smallest) &
      text = text//', from '//to_text(wish%smallest_at_corners, 4)//' at sharp corners of dies'
  end function bends_text

  subroutine add_limit(lines, name, limit)
    type(string_t), allocatable, intent(inout) :: lines(:)
    character(len=*), intent(in) :: name, limit

    call add_text(lines, 'remesh     '//padded(name, 24)//limit)
  end subroutine add_limit

  pure function name_of_die(scene, die) result(name)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: die   !! 0 for none
    character(len=:), allocatable :: name

    name = ''
    if (die > 0) name = scene%dies(die)%name
  end function name_of_die

  pure function most_text(most) result(s)
    integer, intent(in) :: most
    character(len=:), allocatable :: s

    s = ''
    if (most > 0) s = ', at most '//to_text(most)
  end function most_text

  pure function strain_text(strain) result(s)
    real(wp), intent(in) :: strain
    character(len=:), allocatable :: s

    s = ''
    if (strain > 0) s = ' where an element has been strained by '//to_text(strain)
  end function strain_text

  pure function share_text(share) result(s)
    real(wp), intent(in) :: share
    character(len=:), allocatable :: s

    s = ''
    if (share > 0) s = ' in more than '//to_text(100*share)//' % of the elements'
  end function share_text

end module remesh_summary
