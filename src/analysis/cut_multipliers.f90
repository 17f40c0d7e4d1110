!> Multipliers and paths of torches that a run ends before: what they do after that is never seen.
module cut_multipliers
  use kinds, only: wp
  use loads, only: multiplier_at
  use scene, only: scene_t
  use text, only: add => add_text, string_t, to_text
  use weld_sources, only: name_of_torch
  implicit none
  private
  public :: judge_cut_multipliers

contains

  !> A line for each multiplier that changes after the end, and each path that goes on. Multipliers that operations share may be of
  !> a longer one, and are not looked at.
  subroutine judge_cut_multipliers(scene, warnings)
    type(scene_t), intent(in) :: scene                           !! as the deck gives it
    type(string_t), allocatable, intent(inout) :: warnings(:)    !! (nwarning) lines
    character(len=:), allocatable :: ends
    real(wp) :: last, at_end
    integer :: k, n

    associate (stop_at => scene%strategy%end_time, begins => scene%strategy%begins)
      ends = 'the end at '//to_text(stop_at - begins)
      if (scene%operation > 0) ends = 'the end of the operation '//scene%operation_name//' at '//to_text(stop_at - begins)
      do k = 1, size(scene%multipliers)
        associate (multiplier => scene%multipliers(k))
          if (multiplier%shared .or. size(multiplier%time) == 0) cycle
          n = size(multiplier%time)
          last = multiplier%time(n)
          at_end = multiplier_at(multiplier, stop_at)
          if (.not. last > stop_at + little(stop_at)) cycle
          if (.not. any(multiplier%time > stop_at .and. abs(multiplier%value - at_end) > 0)) cycle
          call add(warnings, 'LIC '//multiplier%name//' goes on after '//ends//', where it is '//to_text(at_end)//': to ' &
                   //to_text(multiplier%value(n))//' at '//to_text(last - begins)//', which the run does not come to')
        end associate
      end do
      if (.not. allocated(scene%sources)) return
      do k = 1, size(scene%sources)
        associate (path => scene%sources(k)%path)
          n = size(path, 2)
          if (scene%sources(k)%crosses .or. n < 2) cycle
          if (path(1, n) > stop_at + little(stop_at)) &
            call add(warnings, name_of_torch(scene%sources(k), k)//': its path goes on to '//to_text(path(1, n) - begins) &
                     //' after '//ends)
        end associate
      end do
    end associate
  end subroutine judge_cut_multipliers

  !> Round-off of a time.
  pure function little(time) result(dt)
    real(wp), intent(in) :: time   !! [time]
    real(wp) :: dt                 !! [time]

    dt = 1.0e-9_wp*abs(time)
  end function little

end module cut_multipliers
