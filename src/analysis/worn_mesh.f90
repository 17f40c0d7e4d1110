!> A first mesh of contours that nothing replaces: rows of REMSH on sizes and the like, without a limit among them, ask for the
!> first mesh alone. Where the part has flowed far it is worn by the end, and its force is that of the elements (of a can by
!> backward extrusion on 77 of them 20 % too high).
module worn_mesh
  use remesh_defaults, only: set_default_limits
  use remeshing, only: has_limit, trigger_t, trigger_words
  use scene, only: scene_t
  use solution, only: solution_t
  use text, only: add_text, string_t
  use triggers, only: find_wear
  implicit none
  private
  public :: warn_of_worn_mesh

contains

  !> A line with the limits of REMSH alone that such a mesh has passed at the end, added to the warnings of a run.
  subroutine warn_of_worn_mesh(scene, solution, warnings)
    type(scene_t), intent(in) :: scene
    type(solution_t), intent(in) :: solution
    type(string_t), allocatable, intent(inout) :: warnings(:)   !! (nwarning) lines
    type(scene_t), allocatable :: limited
    type(trigger_t), allocatable :: found(:)
    character(len=:), allocatable :: passed
    integer :: k

    if (.not. (scene%remesh%on .and. scene%finite) .or. has_limit(scene%remesh)) return
    allocate (limited, source=scene)
    call set_default_limits(limited%remesh, .true., size(scene%dies) > 0)
    allocate (found(0))
    call find_wear(limited, solution, found)
    if (size(found) == 0) return
    passed = ''
    do k = 1, size(found)
      if (k > 1) passed = passed//', '
      passed = passed//trigger_words(found(k)%name, found(k)%value, found(k)%limit)
    end do
    call add_text(warnings, 'no row of REMSH is a limit, so the first mesh was used to the end, beyond where REMSH alone makes a ' &
                  //'new one: '//passed//': forces may be far too high; REMSH without rows makes new ones, or with limits beside ' &
                  //'its rows (ERROR 0.05 0.4, SCALED 0.2, CONTACT 50., DISTRESS 4)')
  end subroutine warn_of_worn_mesh

end module worn_mesh
